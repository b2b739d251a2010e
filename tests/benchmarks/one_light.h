// A glTF scene whose own lights, emitting materials and world give no light, lit by one point light: then every lit
// point casts exactly one shadow ray.
#pragma once

#include <array>

#include "gltf_scene.h"

namespace trp_bench {

// Reads and commits the scene as it is.
triptych::cli::LoadedScene load_complete(const std::string& path, uint32_t film_width, uint32_t film_height,
                                         uint32_t threads);

// Reads and commits the scene. `light`: its place in world space. The film's shape is for a file without a camera.
// Throws as load_gltf does.
triptych::cli::LoadedScene load_with_one_light(const std::string& path, const std::array<float, 3>& light,
                                               uint32_t film_width, uint32_t film_height, uint32_t threads);

}  // namespace trp_bench
