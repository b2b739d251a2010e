// Bodies and materials that several tests look at.
#pragma once

#include <algorithm>

#include "support/abi.h"

namespace trp_test {

inline uint32_t glass(Scene& scene, float ior, const std::function<void(TrpMaterialDesc&)>& change = {}) {
    return scene.material([&](TrpMaterialDesc& d) {
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.mirror = d.transmission = {{1, 1, 1}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
        d.ior = {{ior, 0, 0}, TRP_NO_NODE};
        d.fresnel = 1;
        if (change) change(d);
    });
}
inline uint32_t glowing(Scene& scene, float radiance) {
    return scene.material([&](TrpMaterialDesc& d) {
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.emission = {{radiance, radiance, radiance}, TRP_NO_NODE};
    });
}

// A closed box with the faces outwards.
inline MeshData box(Vec low, Vec high) {
    MeshData m;
    for (int k = 0; k < 8; ++k)
        for (int c = 0; c < 3; ++c) m.positions.push_back(k >> c & 1 ? high[c] : low[c]);
    m.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    m.offsets = {0, 4, 8, 12, 16, 20, 24};
    return m;
}
inline MeshData inwards(MeshData m) {
    for (size_t f = 0; f + 1 < m.offsets.size(); ++f)
        std::reverse(m.corners.begin() + m.offsets[f], m.corners.begin() + m.offsets[f + 1]);
    return m;
}

}  // namespace trp_test
