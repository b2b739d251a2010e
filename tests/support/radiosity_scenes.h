// Rooms and materials that tests of radiosity look at.
#pragma once

#include <random>

#include "support/bodies.h"
#include "support/radiosity.h"

namespace trp_test {

inline constexpr float kPiF = std::numbers::pi_v<float>;

// Reflects, and emits a radiosity.
inline uint32_t wall(Scene& scene, float reflectance, float radiosity = 0, bool double_sided = true) {
    return scene.material([&](TrpMaterialDesc& d) {
        d.diffuse = {{reflectance, reflectance, reflectance}, TRP_NO_NODE};
        const float radiance = radiosity / kPiF;
        d.emission = {{radiance, radiance, radiance}, TRP_NO_NODE};
        d.double_sided = double_sided;
    });
}

// The unit cube with its faces inwards; the first, at z = 0, of a material of its own.
inline void add_cube(Scene& scene, uint32_t first, uint32_t others) {
    MeshData cube = inwards(box({0, 0, 0}, {1, 1, 1}));
    cube.materials = {first, others};
    cube.face_materials = {0, 1, 1, 1, 1, 1};
    scene.object(cube);
}

inline Solution::Settings by(const std::string& solver, const std::string& form_factors = "analytic") {
    return {{"radiosity.solver", solver}, {"radiosity.form_factors", form_factors}};
}

struct Random {
    std::mt19937 engine;
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine); }
};

inline uint32_t paint(Scene& scene, Random& random, float radiance = 0) {
    return scene.material([&](TrpMaterialDesc& d) {
        d.diffuse = {{random.between(0.1f, 0.8f), random.between(0.1f, 0.8f), random.between(0.1f, 0.8f)}, TRP_NO_NODE};
        d.specular = {{0, 0, 0}, TRP_NO_NODE};
        d.emission = {{radiance, radiance, radiance}, TRP_NO_NODE};
    });
}

inline MeshData painted(Scene& scene, Random& random, MeshData mesh) {
    for (uint32_t face = 0; face < 6; ++face) {
        mesh.materials.push_back(paint(scene, random));
        mesh.face_materials.push_back(face);
    }
    return mesh;
}

// The eye in every random room.
inline constexpr Vec kEye = {0.03f, 0.04f, 0.5f};

// A sealed room of one metre, in colours of its own on each face, with a lamp under the ceiling and a block, turned,
// that stands on the floor or floats.
inline void make_room(Scene& scene, Random& random, bool stands) {
    scene.object(painted(scene, random, inwards(box({0, 0, 0}, {1, 1, 1}))));
    const float x = random.between(0.2f, 0.5f), y = random.between(0.2f, 0.5f), z = random.between(0.8f, 0.95f);
    scene.object(quad({x, y, z}, {x, y + 0.3f, z}, {x + 0.3f, y + 0.3f, z}, {x + 0.3f, y, z}), paint(scene, random, 5));
    const float a = random.between(0.08f, 0.15f), b = random.between(0.08f, 0.15f),
                low = stands ? 0 : random.between(0.1f, 0.3f), high = low + random.between(0.2f, 0.4f);
    MeshData block = painted(scene, random, box({-a, -b, low}, {a, b, high}));
    const float angle = random.between(0, 3), c = std::cos(angle), s = std::sin(angle),
                middle_x = random.between(0.4f, 0.7f), middle_y = random.between(0.4f, 0.7f);
    for (size_t k = 0; k < block.positions.size(); k += 3) {
        const float px = block.positions[k], py = block.positions[k + 1];
        block.positions[k] = middle_x + c * px - s * py;
        block.positions[k + 1] = middle_y + s * px + c * py;
    }
    scene.object(block);
    scene.camera(look_at(kEye, {0.6f, 0.5f, 0.35f}), [](TrpCameraDesc& d) { d.field_of_view = 1.6f; });
}

}  // namespace trp_test
