// The pixel of each lane of a block, and its random sequence. Included once for each instruction set.
#if defined(TRIPTYCH_PIXEL_RANDOM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIPTYCH_PIXEL_RANDOM_INL
#undef TRIPTYCH_PIXEL_RANDOM_INL
#else
#define TRIPTYCH_PIXEL_RANDOM_INL
#endif

#include "base/sobol-inl.h"
#include "film/film.h"
#include "film/pixel_random.h"
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

// The key of the pixels' sequence, and the index of their first numbers in it.
template <class D, class VU>
VU sequence_key(D, VU x, VU y, const SampleSequence& sequence) {
    const hn::RebindToUnsigned<D> du;
    const VU square_x = hn::ShiftRight<7>(x), square_y = hn::ShiftRight<7>(y);
    return mix_bits(du,
                    hn::Add(square_x, mix_bits(du, hn::Add(square_y, mix_bits(du, hn::Set(du, sequence.seed + 1u))))));
}

template <class D, class VU>
VU first_index(D, VU x, VU y, const SampleSequence& sequence) {
    const hn::RebindToUnsigned<D> du;
    const auto spread = [&](VU v) {  // of 7 bits, one to every other place
        v = hn::And(v, hn::Set(du, 0x7Fu));
        v = hn::And(hn::Or(v, hn::ShiftLeft<4>(v)), hn::Set(du, 0x0F0Fu));
        v = hn::And(hn::Or(v, hn::ShiftLeft<2>(v)), hn::Set(du, 0x3333u));
        return hn::And(hn::Or(v, hn::ShiftLeft<1>(v)), hn::Set(du, 0x5555u));
    };
    return hn::ShiftLeftSame(hn::Or(spread(x), hn::ShiftLeft<1>(spread(y))), static_cast<int>(sequence.bits));
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
