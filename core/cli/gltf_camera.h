// Cameras of nodes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gltf_file.h"
#include "transform.h"

namespace triptych::cli {

// Adds the camera of a node (node.camera >= 0) under `name`, and gives its id.
uint32_t add_camera(const GltfFile& file, const tinygltf::Node& node, const std::string& name,
                    const Imath::M44d& world_from_node, TrpScene* scene, Warnings& warnings);

}  // namespace triptych::cli
