// Reading TrpArray as the header of the core describes it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <triptych/triptych.h>

#include <cstring>
#include <vector>

namespace triptych::test {

inline uint32_t format_size(int32_t format) {
    return format == TRP_FORMAT_UINT8 ? 1 : format == TRP_FORMAT_UINT16 ? 2 : 4;
}

// Calls `take` with the bytes of each number.
template <typename Take>
void for_each_number(const TrpArray& array, int components, Take take) {
    const uint32_t size = format_size(array.format);
    const uint32_t stride = array.stride != 0 ? array.stride : size * static_cast<uint32_t>(components);
    for (uint64_t i = 0; i < array.count; ++i) {
        for (int k = 0; k < components; ++k) {
            take(static_cast<const unsigned char*>(array.data) + i * stride + static_cast<uint32_t>(k) * size);
        }
    }
}

inline std::vector<float> floats_of(const TrpArray& array, int components) {
    std::vector<float> values;
    for_each_number(array, components, [&](const unsigned char* bytes) {
        float value;
        std::memcpy(&value, bytes, sizeof value);
        values.push_back(value);
    });
    return values;
}

inline std::vector<uint32_t> integers_of(const TrpArray& array, int components) {
    std::vector<uint32_t> values;
    for_each_number(array, components, [&](const unsigned char* bytes) {
        uint32_t value = 0;
        std::memcpy(&value, bytes, format_size(array.format));  // little-endian
        values.push_back(value);
    });
    return values;
}

}  // namespace triptych::test
