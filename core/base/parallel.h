// Parallel work on oneTBB. Work runs in an Arena of the number of threads asked for; the caller's thread is not one of
// them while a Worker drives the arena, so that it is free to hand on callbacks.
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace trp {

// Tells the thread sanitizer what it cannot see, as oneTBB is not built for it: work begins after what its caller did
// before, and the caller goes on after the work. Nothing in other builds.
class ForkJoin {
  public:
    ForkJoin() { release(); }
    ~ForkJoin() { acquire(); }
    ForkJoin(const ForkJoin&) = delete;
    ForkJoin& operator=(const ForkJoin&) = delete;
    template <class Work>
    auto wrap(Work& work) {
        return [this, &work](auto&&... arguments) {
            acquire();
            work(arguments...);
            release();
        };
    }

  private:
#ifdef __SANITIZE_THREAD__
    void acquire() {
        __tsan_acquire(this);
    }
    void release() {
        __tsan_release(this);
    }
#else
    void acquire() {}
    void release() {}
#endif
};

// The number of threads meant by `requested`: all cores where it is 0.
unsigned thread_count(unsigned requested);

class Arena {
  public:
    explicit Arena(unsigned threads);
    template <class Work>
    void run(Work&& work) {
        ForkJoin fork;
        arena_.execute(fork.wrap(work));
    }

  private:
    tbb::global_control limit_;  // TBB's own limit is the number of cores
    tbb::task_arena arena_;
};

// Calls work(begin, end) over [0, count) in ranges of about `grain`, within the current arena.
template <class Work>
void parallel_ranges(size_t count, size_t grain, Work&& work) {
    auto range_work = [&](const tbb::blocked_range<size_t>& r) { work(r.begin(), r.end()); };
    ForkJoin fork;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, grain), fork.wrap(range_work));
}

// Sorts by runs of equal length, which are then merged two by two, within the current arena: oneTBB's own sort is
// nothing that ForkJoin could tell the sanitizer about.
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

// Calls work() once on each of so many threads of the current arena.
template <class Work>
void parallel_workers(unsigned count, Work&& work) {
    auto worker = [&](unsigned) { work(); };
    ForkJoin fork;
    tbb::parallel_for(0u, count, fork.wrap(worker), tbb::simple_partitioner());
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
