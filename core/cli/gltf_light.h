// Lights of nodes: KHR_lights_punctual and extras.triptych. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gltf_file.h"
#include "transform.h"

namespace triptych::cli {

// Adds the light of a node, if it has one. Gives whether it has.
bool add_light(const GltfFile& file, const tinygltf::Node& node, const std::string& where,
               const Imath::M44d& world_from_node, TrpScene* scene, Warnings& warnings);

}  // namespace triptych::cli
