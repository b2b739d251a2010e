// Line drawings, and how much ink they have where.
#pragma once

#include "support/bodies.h"

namespace trp_test {

// Coverage is 1 − the picture: black lines on white paper.
inline float ink(const Image& image, int x, int y) {
    if (x < 0 || y < 0 || x >= static_cast<int>(image.width) || y >= static_cast<int>(image.height)) return 0;
    return 1 - image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y))[0];
}

inline double total_ink(const Image& image) {
    return (1 - mean(image)) * image.width * image.height;
}

inline Image draw(Scene& scene, uint32_t width, uint32_t height, const char* method, const Settings& settings = {}) {
    return Render(scene, width, height, settings, {}, method).run().read();
}

// An edge without a face.
inline uint32_t loose_edge(Scene& scene, Vec a, Vec b) {
    MeshData m;
    for (const Vec& p : {a, b}) m.positions.insert(m.positions.end(), p.begin(), p.end());
    const std::vector<uint32_t> edge = {0, 1};
    return scene.instance(scene.mesh(m, [&](TrpMeshDesc& d) { d.edges = indices(edge, 2); }));
}

// A picture seen from above, 10 pixels to the metre, whose middle is at the world's origin.
inline constexpr uint32_t kWidth = 100, kHeight = 80;
inline void see_from_above(Scene& scene) {
    scene.camera_above(10);
    scene.commit();
}

}  // namespace trp_test
