// The random sequence: its second dimension is Sobol's, and its points are as well distributed as a (0,2)-sequence's;
// and four of its dimensions together as a (3,4)-sequence's.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include "base/sobol_four-inl.h"

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

std::array<float, 4> one_four(uint32_t key, uint32_t index) {
    const hn::CappedTag<float, 1> d;
    auto u = hn::Zero(d), v = u, s = u, t = u;
    sobol_four(d, key, index, u, v, s, t);
    return {hn::GetLane(u), hn::GetLane(v), hn::GetLane(s), hn::GetLane(t)};
}

TEST(Sobol, FourTogetherFillEveryElementaryIntervalAlike) {
    // The sum of the degrees of the polynomials less one is 3: boxes of 2^-5, cut up among the dimensions in any way,
    // hold 8 of 256 points each. Two pairs together do not: they are independent of each other.
    for (const uint32_t key : {1u, 12345u, 0xDEADBEEFu})
        for (const uint32_t first : {0u, 256u, 77u * 256u})
            for (int cuts = 0; cuts < 6 * 6 * 6; ++cuts) {
                const int a = cuts % 6, b = cuts / 6 % 6, c = cuts / 36, d = 5 - a - b - c;
                if (d < 0) continue;
                std::array<int, 32> points{};
                for (uint32_t k = 0; k < 256; ++k) {
                    const std::array<float, 4> p = one_four(key, first + k);
                    int box = 0;
                    for (const auto& [value, bits] : {std::pair{p[0], a}, {p[1], b}, {p[2], c}, {p[3], d}}) {
                        ASSERT_GE(value, 0);
                        ASSERT_LT(value, 1);
                        box = (box << bits) + static_cast<int>(value * static_cast<float>(1 << bits));
                    }
                    ++points[static_cast<size_t>(box)];
                }
                for (const int of_box : points)
                    ASSERT_EQ(of_box, 8) << "key " << key << ", cut 2^" << a << ", " << b << ", " << c << ", " << d;
            }
}

TEST(Sobol, FourAreTheSameForAnyNumberOfLanes) {
    const hn::ScalableTag<float> d;
    for (uint32_t first = 0; first < 100 * hn::Lanes(d); first += static_cast<uint32_t>(hn::Lanes(d))) {
        std::array<std::array<float, SobolDimension::kMostLanes>, 4> all;
        auto u = hn::Zero(d), v = u, s = u, t = u;
        sobol_four(d, 7, first, u, v, s, t);
        hn::StoreU(u, d, all[0].data());
        hn::StoreU(v, d, all[1].data());
        hn::StoreU(s, d, all[2].data());
        hn::StoreU(t, d, all[3].data());
        for (uint32_t lane = 0; lane < hn::Lanes(d); ++lane)
            for (size_t k = 0; k < 4; ++k) EXPECT_EQ(all[k][lane], one_four(7, first + lane)[k]) << first + lane;
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
