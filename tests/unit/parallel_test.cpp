// parallel_sort() beside std::sort, around the lengths at which runs are split and merged.
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <random>

namespace trp {
namespace {

TEST(ParallelSort, SortsWhatStdSortSorts) {
    std::mt19937 random(1);
    for (const size_t count : {0, 1, 2, 4095, 4096, 4097, 8192, 12289, 16 * 4096, 16 * 4096 + 1, 200003}) {
        std::vector<uint32_t> values(count);
        for (uint32_t& value : values) value = random() % 10007;
        std::vector<uint32_t> expected = values;
        std::sort(expected.begin(), expected.end(), std::greater<uint32_t>());
        parallel_sort(values, std::greater<uint32_t>());
        EXPECT_EQ(values, expected) << count;
    }
}

}  // namespace
}  // namespace trp
