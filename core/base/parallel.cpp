// All of oneTBB's templates that run our work are compiled here, without the thread sanitizer, which does not see how
// oneTBB synchronizes, as that is not built for it: it would find races in those templates, and to pass over what has
// them on its stack would pass over all parallel work.
#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#ifdef TRIPTYCH_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace trp {
namespace {

// Tells the thread sanitizer that each piece of work begins after what its caller did before, and that the caller goes
// on after all of them; not that one piece comes after another. Nothing in other builds.
class ForkJoin {
  public:
    ForkJoin() { release(&fork_); }
    ~ForkJoin() { acquire(&join_); }
    ForkJoin(const ForkJoin&) = delete;
    ForkJoin& operator=(const ForkJoin&) = delete;
    template <class Work>
    void piece(const Work& work) {
        acquire(&fork_);
        work();
        release(&join_);
    }

  private:
#ifdef TRIPTYCH_THREAD_SANITIZER
    static void acquire(char* at) {
        __tsan_acquire(at);
    }
    static void release(char* at) {
        __tsan_release(at);
    }
#else
    static void acquire(char*) {}
    static void release(char*) {}
#endif
    char fork_ = 0, join_ = 0;
};

}  // namespace

unsigned thread_count(unsigned requested) {
    return requested ? requested : std::max(1u, std::thread::hardware_concurrency());
}

struct Arena::Threads {
    tbb::global_control limit;  // TBB's own limit is the number of cores
    tbb::task_arena arena;
};

Arena::Arena(unsigned threads)
    : threads_(new Threads{{tbb::global_control::max_allowed_parallelism, std::max<size_t>(2, thread_count(threads))},
                           tbb::task_arena(static_cast<int>(thread_count(threads)))}) {}

Arena::~Arena() = default;

void Arena::run(const std::function<void()>& work) {
    ForkJoin fork;
    threads_->arena.execute([&] { fork.piece(work); });
}

void parallel_ranges(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& work) {
    ForkJoin fork;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, grain), [&](const tbb::blocked_range<size_t>& range) {
        fork.piece([&] { work(range.begin(), range.end()); });
    });
}

void parallel_workers(unsigned count, const std::function<void()>& work) {
    ForkJoin fork;
    tbb::parallel_for(
        0u, count, [&](unsigned) { fork.piece(work); }, tbb::simple_partitioner());
}

FlushDenormals::FlushDenormals() : saved_(0) {
#if defined(__SSE__)
    saved_ = _mm_getcsr();
    _mm_setcsr(saved_ | 0x8040);  // flush to zero, denormals are zero
#endif
}

FlushDenormals::~FlushDenormals() {
#if defined(__SSE__)
    _mm_setcsr(saved_);
#endif
}

}  // namespace trp
