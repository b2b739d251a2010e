// A glTF file as a scene of the core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "gltf_nodes.h"
#include "handles.h"

namespace triptych::cli {

struct LoadedScene {
    SceneHandle scene;  // committed
    std::vector<CameraEntry> cameras;
    std::string camera_name;  // the one that renders; empty: there is none in the file
    std::array<float, 12> world_from_camera{};
    bool needs_camera = false;                                  // none in the file: the whole scene is framed
    bool needs_light = false;                                   // nothing in it gives light
    uint32_t film_width = 0, film_height = 0;                   // as the file says; 0: it does not
    std::vector<std::pair<std::string, std::string>> settings;  // as the file says
    std::string generator, version;
    std::vector<std::string> extensions_used, extensions_required;
    Warnings warnings;                               // of the reading; the core's own are read from the scene
    double load_seconds = 0.0;                       // without the commits
    double commit_seconds = 0.0, bvh_seconds = 0.0;  // of all commits
};

// Commits the scene, and adds the time to the sums above.
void commit(LoadedScene& loaded, uint32_t threads);

// Reads a .glb or .gltf, and commits it with `threads` (0: all). `camera`: the name of the camera wanted; empty: the
// file's choice. Throws an Error that names the file and the item.
LoadedScene load_gltf(const std::filesystem::path& path, const std::string& camera, uint32_t threads);

}  // namespace triptych::cli
