// The pixel of each lane of a block, and the key of its random sequence. Included once for each instruction set.
#if defined(TRIPTYCH_PIXEL_RANDOM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIPTYCH_PIXEL_RANDOM_INL
#undef TRIPTYCH_PIXEL_RANDOM_INL
#else
#define TRIPTYCH_PIXEL_RANDOM_INL
#endif

#include "base/sobol-inl.h"
#include "film/film.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The pixel of each lane: its offsets within a packet repeat every 16 lanes.
template <class D, class VU = hn::Vec<hn::RebindToUnsigned<D>>>
void pixel_of(D, uint32_t block_x, uint32_t block_y, int i, VU& x, VU& y) {
    const hn::RebindToUnsigned<D> du;
    const VU lane = hn::Iota(du, static_cast<uint32_t>(i));
    const VU three = hn::Set(du, 3u);
    x = hn::Add(hn::Add(hn::ShiftLeft<2>(hn::And(hn::ShiftRight<4>(lane), three)), hn::And(lane, three)),
                hn::Set(du, block_x * kBlockSide));
    y = hn::Add(hn::Add(hn::ShiftLeft<2>(hn::ShiftRight<6>(lane)), hn::And(hn::ShiftRight<2>(lane), three)),
                hn::Set(du, block_y * kBlockSide));
}

template <class D, class VU>
VU pixel_key(D, VU x, VU y, uint32_t seed) {
    const hn::RebindToUnsigned<D> du;
    return mix_bits(du, hn::Add(x, mix_bits(du, hn::Add(y, mix_bits(du, hn::Set(du, seed + 1u))))));
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
