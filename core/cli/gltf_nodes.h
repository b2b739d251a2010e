// The node tree of a glTF scene: where its meshes, lights and cameras stand. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gltf_file.h"
#include "gltf_mesh.h"
#include "transform.h"

namespace triptych::cli {

struct CameraEntry {
    uint32_t id;
    int node;
    std::string name;         // the node's
    std::string camera_name;  // the camera's own
    std::array<float, 12> world_from_camera;
};

struct NodeCounts {
    std::vector<CameraEntry> cameras;  // in the scene's order
    uint32_t lights = 0;
};

// Walks the tree below the nodes of glTF scene `scene_index` (-1: below every node without a parent), and adds what it
// finds to the core's scene. Throws an Error for a node that is reached twice.
NodeCounts add_nodes(const GltfFile& file, int scene_index, TrpScene* scene, MeshLoader& meshes,
                     MaterialLoader& materials, Warnings& warnings);

}  // namespace triptych::cli
