// What else is in a scene: instances, textures, materials, lights, cameras and the world. Plain data with the ABI's
// units, checked when it was made (describe.h).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "triptych/triptych.h"

namespace trp {

struct Instance {
    std::string name;
    uint32_t mesh = TRP_NO_ID;
    std::vector<Affine> world_from_object{Affine{}};  // one to a time sample
    std::vector<uint32_t> materials;
    Vec3 color{1, 1, 1};
    int32_t index = 0;
    bool visible_camera = true, visible_shadow = true;
};

struct Texture {
    std::string name, path;
    std::vector<unsigned char> file;  // an image file's bytes
    std::vector<float> pixels;        // width · height · channels, row 0 at the bottom
    uint32_t width = 0, height = 0, channels = 0;
    int32_t color_space = 0, wrap_u = 0, wrap_v = 0, filter = 0;
};

struct Node {
    int32_t type = 0;
    std::array<int32_t, TRP_NODE_INPUTS> inputs{};
    std::array<std::array<float, 4>, TRP_NODE_INPUTS> values{};  // what an input of none reads
    uint32_t texture = TRP_NO_ID;
    std::string name;
};

struct Coefficient {
    Vec3 value{0, 0, 0};
    int32_t node = TRP_NO_NODE;
};

struct Material {
    std::string name;
    std::vector<Node> nodes;
    Coefficient emission, ambient, diffuse, specular, shininess, mirror, transmission, ior, alpha;
    int32_t normal = TRP_NO_NODE;
    bool thin = false, double_sided = true, fresnel = false;
    int32_t index = 0, priority = 0;
    Vec3 absorption{0, 0, 0};  // 1/m
};

struct Light {
    std::string name;
    int32_t type = 0, falloff = 0, shape = 0;
    std::vector<Affine> world_from_light{Affine{}};
    Vec3 emission{1, 1, 1};
    float radius = 0, angle = 0, blend = 0, size[2] = {1, 1};
    bool cast_shadow = true, visible_camera = false;
    uint32_t group = 0;
};

struct World {
    uint32_t texture = TRP_NO_ID;
    Vec3 radiance{0, 0, 0};
    Affine world_from_texture;
    bool visible_camera = true, light = true;

    // The transpose of a rotation is its inverse.
    Affine texture_from_world() const {
        Affine m;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) m.rows[r][c] = world_from_texture.rows[c][r];
        return m;
    }
};

struct Camera {
    std::string name;
    int32_t type = 0, fit = 0;
    std::vector<Affine> world_from_camera{Affine{}};
    float field_of_view = 0, width = 0, shift[2] = {0, 0}, clip_start = 0, clip_end = 0;
    float aperture_radius = 0, focus_distance = 0;
    uint32_t blade_count = 0;
    float blade_rotation = 0, shutter[2] = {0, 1}, pixel_aspect = 1;
};

}  // namespace trp
