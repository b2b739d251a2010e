// Parallel work on oneTBB. Work runs in an Arena of the number of threads asked for; the caller's thread is not one of
// them while a thread of its own drives the arena, so that it is free to hand on callbacks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace trp {

// The number of threads meant by `requested`: all cores where it is 0.
unsigned thread_count(unsigned requested);

class Arena {
  public:
    explicit Arena(unsigned threads);
    ~Arena();
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;
    void run(const std::function<void()>& work);

  private:
    struct Threads;
    std::unique_ptr<Threads> threads_;
};

// Calls work(begin, end) over [0, count) in ranges of about `grain`, within the current arena.
void parallel_ranges(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& work);

// Calls work() so many times, once on each of as many threads of the current arena as are free.
void parallel_workers(unsigned count, const std::function<void()>& work);

// Sorts by runs of equal length, which are then merged two by two, within the current arena: oneTBB's own sort would
// have its code in every file that sorts (see parallel.cpp).
template <class T, class Less = std::less<T>>
void parallel_sort(std::vector<T>& values, Less less = {}) {
    constexpr size_t kRuns = 16, kShort = 4096;
    const size_t count = values.size(), length = std::max(kShort, (count + kRuns - 1) / kRuns);
    const auto at = [&](std::vector<T>& v, size_t place) {
        return v.begin() + static_cast<ptrdiff_t>(std::min(place, count));
    };
    parallel_ranges((count + length - 1) / length, 1, [&](size_t begin, size_t end) {
        for (size_t run = begin; run < end; ++run)
            std::sort(at(values, run * length), at(values, (run + 1) * length), less);
    });
    std::vector<T> merged(count > length ? count : 0);
    for (size_t sorted = length; sorted < count; sorted *= 2) {
        parallel_ranges((count + 2 * sorted - 1) / (2 * sorted), 1, [&](size_t begin, size_t end) {
            for (size_t pair = begin; pair < end; ++pair) {
                const size_t first = 2 * pair * sorted;
                std::merge(at(values, first), at(values, first + sorted), at(values, first + sorted),
                           at(values, first + 2 * sorted), at(merged, first), less);
            }
        });
        values.swap(merged);
    }
}

// Denormals cost a hundred times as much as other floats and mean nothing in a picture: zero while this stands.
class FlushDenormals {
  public:
    FlushDenormals();
    ~FlushDenormals();
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

  private:
    unsigned saved_;
};

}  // namespace trp
