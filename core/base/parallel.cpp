#include "base/parallel.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <algorithm>

namespace trp {

unsigned thread_count(unsigned requested) {
    return requested ? requested : std::max(1u, std::thread::hardware_concurrency());
}

Arena::Arena(unsigned threads)
    : limit_(tbb::global_control::max_allowed_parallelism, std::max<size_t>(2, thread_count(threads))),
      arena_(static_cast<int>(thread_count(threads))) {}

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
