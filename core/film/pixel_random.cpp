#include "film/pixel_random.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "film/pixel_random.cpp"
#include "hwy/foreach_target.h"

#include "film/pixel_random-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

void random_pair_lanes(uint32_t block_x, uint32_t block_y, const SampleSequence& sequence, uint32_t sample,
                       uint32_t pair, float* u, float* v) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        auto x = hn::Zero(du), y = hn::Zero(du);
        pixel_of(d, block_x, block_y, i, x, y);
        auto a = hn::Zero(d), b = hn::Zero(d);
        const auto index = hn::Add(first_index(d, x, y, sequence), hn::Set(du, sample));
        sobol_pair(d, sequence_key(d, x, y, sequence), reverse_bits(du, index), pair, a, b);
        hn::Store(a, d, u + i);
        hn::Store(b, d, v + i);
    }
}

void random_pair_of_lanes(const uint32_t* keys, const uint32_t* indices, uint32_t pair, float* u, float* v) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        auto a = hn::Zero(d), b = hn::Zero(d);
        sobol_pair(d, hn::Load(du, keys + i), reverse_bits(du, hn::Load(du, indices + i)), pair, a, b);
        hn::Store(a, d, u + i);
        hn::Store(b, d, v + i);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(random_pair_lanes);
HWY_EXPORT(random_pair_of_lanes);

void random_pair(uint32_t block_x, uint32_t block_y, const SampleSequence& sequence, uint32_t sample, uint32_t pair,
                 float* u, float* v) {
    HWY_DYNAMIC_DISPATCH(random_pair_lanes)(block_x, block_y, sequence, sample, pair, u, v);
}

void random_pair_of(const uint32_t* keys, const uint32_t* indices, uint32_t pair, float* u, float* v) {
    HWY_DYNAMIC_DISPATCH(random_pair_of_lanes)(keys, indices, pair, u, v);
}

}  // namespace trp
#endif
