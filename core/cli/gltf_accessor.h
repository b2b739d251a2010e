// Accessors: arrays of numbers in a glTF file's buffers, bounds checked, handed on in place where their format allows.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gltf_file.h"

namespace triptych::cli {

// An array of `components` numbers to an element: in the file's memory, or owned where it had to be converted.
// It can be moved, not copied: `data` may point into it.
struct NumberArray {
    const void* data = nullptr;
    uint64_t count = 0;
    uint32_t stride = 0;  // bytes; never 0 where there is data
    int32_t format = TRP_FORMAT_FLOAT32;
    int components = 0;
    std::vector<float> floats;
    std::vector<uint32_t> integers;

    NumberArray() = default;
    NumberArray(NumberArray&&) = default;
    NumberArray& operator=(NumberArray&&) = default;

    bool given() const { return components > 0; }
    TrpArray array() const { return {data, count, stride, format}; }
    float real(uint64_t element, int component) const;  // of FLOAT32
    uint32_t integer(uint64_t element) const;           // of UINT8, UINT16 and UINT32

    static NumberArray of(std::vector<float> values, int components);
    static NumberArray of(std::vector<uint32_t> values, int components = 1);
};

// Floats of an accessor with least to most components. Integers are converted, normalized ones to 0…1 or -1…1. In place
// where the accessor is plain float. Throws an Error that names `where` and the accessor.
NumberArray read_floats(const GltfFile& file, int accessor, int least, int most, const std::string& where);

// Unsigned integers of a SCALAR accessor (UINT8, UINT16 or UINT32), in place unless sparse.
NumberArray read_integers(const GltfFile& file, int accessor, const std::string& where);

}  // namespace triptych::cli
