// The random sequence: its second dimension is Sobol's, and its points are as well distributed as a (0,2)-sequence's.
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <vector>

#include "base/sobol-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

uint32_t one_pascal(uint32_t x) {
    const hn::CappedTag<uint32_t, 1> du;
    return hn::GetLane(pascal(du, hn::Set(du, x)));
}

uint32_t one_reversed(uint32_t x) {
    const hn::CappedTag<uint32_t, 1> du;
    return hn::GetLane(reverse_bits(du, hn::Set(du, x)));
}

std::pair<float, float> one_pair(uint32_t key, uint32_t sample, uint32_t pair) {
    const hn::CappedTag<float, 1> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    auto u = hn::Zero(d), v = hn::Zero(d);
    sobol_pair(d, hn::Set(du, key), reverse_bits(du, hn::Set(du, sample)), pair, u, v);
    return {hn::GetLane(u), hn::GetLane(v)};
}

TEST(Sobol, SecondDimensionHasItsDirectionNumbers) {
    // Sobol' 1967: v_0 = 1/2, v_i = v_{i-1} xor v_{i-1}/2 for the polynomial 1 + x.
    uint32_t directions[32] = {1u << 31};
    for (int i = 1; i < 32; ++i) directions[i] = directions[i - 1] ^ (directions[i - 1] >> 1);
    for (uint32_t i = 0; i < 100000; i = i * 5 / 4 + 1) {
        uint32_t expected = 0;
        for (int bit = 0; bit < 32; ++bit)
            if ((i >> bit) & 1) expected ^= directions[bit];
        EXPECT_EQ(one_reversed(one_pascal(i)), expected) << i;
    }
}

TEST(Sobol, EveryElementaryIntervalHoldsOnePoint) {
    for (const uint32_t key : {1u, 12345u, 0xDEADBEEFu})
        for (const uint32_t pair : {0u, 4u, 77u})
            for (int across = 0; across <= 8; ++across) {  // 2^across by 2^(8 − across) boxes, 256 points
                std::set<std::pair<int, int>> boxes;
                for (uint32_t sample = 0; sample < 256; ++sample) {
                    const auto [u, v] = one_pair(key, sample, pair);
                    ASSERT_GE(u, 0);
                    ASSERT_LT(u, 1);
                    boxes.emplace(static_cast<int>(u * static_cast<float>(1 << across)),
                                  static_cast<int>(v * static_cast<float>(1 << (8 - across))));
                }
                EXPECT_EQ(boxes.size(), 256u) << "key " << key << ", pair " << pair << ", 2^" << across << " across";
            }
}

TEST(Sobol, PixelsAndPairsAreUncorrelated) {
    for (const auto& [key_b, pair_b] : {std::pair{2u, 0u}, {1u, 1u}}) {
        double sum = 0, a2 = 0, b2 = 0;
        for (uint32_t sample = 0; sample < 4096; ++sample) {
            const double a = one_pair(1, sample, 0).first - 0.5, b = one_pair(key_b, sample, pair_b).first - 0.5;
            sum += a * b, a2 += a * a, b2 += b * b;
        }
        EXPECT_LT(std::abs(sum) / std::sqrt(a2 * b2), 0.06);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
