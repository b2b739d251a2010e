// A data race between two pieces of parallel work, which the thread sanitizer must find, and which would be none
// between what comes before, within and after the work.
#include <atomic>
#include <cstdio>

#include "base/parallel.h"

int main() {
    int before = 1, racing = 0, after[2] = {0, 0};
    std::atomic<int> begun{0};
    trp::Arena arena(2);
    arena.run([&] {
        trp::parallel_ranges(2, 1, [&](size_t begin, size_t) {
            begun.fetch_add(1, std::memory_order_relaxed);
            // Both at a time, where the machine has two threads for them.
            for (int k = 0; begun.load(std::memory_order_relaxed) < 2 && k < 1000; ++k)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            after[begin] = before;
            racing += before;
        });
    });
    std::printf("%d\n", racing + after[0] + after[1]);
}
