// `extras.triptych` of a scene: world, camera, film and settings (extras_triptych.md). SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gltf_file.h"
#include "gltf_texture.h"

namespace triptych::cli {

struct SceneExtras {
    bool has_world = false;  // that gives light
    int camera_node = -1;
    uint32_t film_width = 0, film_height = 0;  // 0: not said
    std::vector<std::pair<std::string, std::string>> settings;
};

// Reads the extras of glTF scene `index`, and gives the core its world. -1: no scene.
SceneExtras read_scene_extras(const GltfFile& file, int index, TextureLoader& textures, TrpScene* scene,
                              Warnings& warnings);

}  // namespace triptych::cli
