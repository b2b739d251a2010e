// Parallel work on oneTBB. Work runs in an Arena of the number of threads asked for; the caller's thread is not one of
// them while a Worker drives the arena, so that it is free to hand on callbacks.
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <exception>
#include <thread>

namespace trp {

// The number of threads meant by `requested`: all cores where it is 0.
unsigned thread_count(unsigned requested);

class Arena {
  public:
    explicit Arena(unsigned threads);
    template <class Work>
    void run(Work&& work) {
        arena_.execute(work);
    }

  private:
    tbb::global_control limit_;  // TBB's own limit is the number of cores
    tbb::task_arena arena_;
};

// Calls work(begin, end) over [0, count) in ranges of about `grain`, within the current arena.
template <class Work>
void parallel_ranges(size_t count, size_t grain, Work&& work) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, grain),
                      [&](const tbb::blocked_range<size_t>& r) { work(r.begin(), r.end()); });
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
