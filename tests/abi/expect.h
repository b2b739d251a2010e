// What the tests of the C ABI share: a failure that names its cause, and small pictures to compare.
#pragma once

#include <cstring>
#include <limits>

#include "support/abi.h"

namespace trp_test {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A call that failed with this status, and a message of one line in which all the words stand.
inline testing::AssertionResult fails(TrpStatus got, TrpStatus wanted, const std::vector<std::string>& words = {}) {
    const std::string message = trp_error_message();
    if (got != wanted) return testing::AssertionFailure() << "status " << got << " (" << message << "), not " << wanted;
    if (message.empty()) return testing::AssertionFailure() << "no message";
    if (message.find('\n') != std::string::npos) return testing::AssertionFailure() << "several lines: " << message;
    for (const std::string& word : words)
        if (message.find(word) == std::string::npos)
            return testing::AssertionFailure() << "\"" << message << "\" says nothing of \"" << word << "\"";
    return testing::AssertionSuccess();
}

// Bit for bit, so that NaN equals itself and 0 does not equal −0.
inline bool same(const Image& a, const Image& b) {
    return a.values.size() == b.values.size() &&
           std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

inline const Settings kFewSamples = {{"samples", "4"}};

// A box with its corners at ±half, of quads that face outwards.
inline MeshData box(float half) {
    MeshData m;
    for (int v = 0; v < 8; ++v)
        for (int k = 0; k < 3; ++k) m.positions.push_back(v >> k & 1 ? half : -half);
    m.offsets = {0, 4, 8, 12, 16, 20, 24};
    m.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    return m;
}

// A box over a floor with a sun, seen from the side.
struct SmallScene : Scene {
    SmallScene() {
        red = diffuse(0.7f, 0.1f, 0.1f);
        box_mesh = mesh(with_material(box(0.5f), red));
        box_instance = instance(box_mesh, translation({0, 0, 0.5f}));
        floor_instance = object(floor_square(3));
        sun = light(TRP_LIGHT_SUN, {2, 2, 2}, look_at({1, 2, 3}, {0, 0, 0}));
        eye = camera(look_at({3, -4, 3}, {0, 0, 0}));
    }
    static MeshData with_material(MeshData data, uint32_t material) {
        data.materials = {material};
        return data;
    }
    Image picture() { return render(*this, 40, 24, kFewSamples); }

    uint32_t red, box_mesh, box_instance, floor_instance, sun, eye;
};

}  // namespace trp_test
