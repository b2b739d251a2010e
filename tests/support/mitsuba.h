// Pictures against means over blocks of pixels that another renderer has found.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace trp_test {

constexpr uint32_t kBlocks = 4;                                           // to a side
using BlockMeans = std::array<std::array<double, 3>, kBlocks * kBlocks>;  // row after row from above, rgb

// Two RGBA pictures that differ in their noise alone, row 0 at the bottom, have the expected means, whose relative
// noise is `noise_of_means`.
inline void expect_block_means(const std::vector<float>& a, const std::vector<float>& b, uint32_t width,
                               uint32_t height, const BlockMeans& expected, double noise_of_means) {
    const uint32_t block_width = width / kBlocks, block_height = height / kBlocks;
    double greatest = 0, whole[3] = {}, theirs[3] = {};
    for (uint32_t row = 0; row < kBlocks; ++row)
        for (uint32_t column = 0; column < kBlocks; ++column)
            for (size_t c = 0; c < 3; ++c) {
                double sum = 0, noise = 0;
                for (uint32_t y = 0; y < block_height; ++y)
                    for (uint32_t x = 0; x < block_width; ++x) {
                        const size_t line = height - 1 - row * block_height - y;
                        const size_t i = 4 * (line * width + column * block_width + x) + c;
                        sum += (a[i] + b[i]) / 2;
                        noise += (a[i] - b[i]) * (a[i] - b[i]) / 4;
                    }
                const double pixels = static_cast<double>(block_width) * block_height,
                             theirs_is = expected[row * kBlocks + column][c];
                greatest = std::max(greatest, std::abs(sum - theirs_is * pixels) /
                                                  std::sqrt(noise + std::pow(noise_of_means * theirs_is * pixels, 2)));
                whole[c] += sum / pixels;
                theirs[c] += theirs_is;
            }
    EXPECT_LT(greatest, 4) << "standard deviations, of 48 means";
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(whole[c] / theirs[c], 1, 2e-3) << c;
}

}  // namespace trp_test
