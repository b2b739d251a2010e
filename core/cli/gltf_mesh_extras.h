// `extras.triptych` of a mesh: Blender's own arrays, read in place of the primitives (extras_triptych.md).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf_fields.h"
#include "gltf_material.h"

namespace triptych::cli {

// Adds the mesh that the extras describe, and gives its id.
uint32_t add_mesh_of_extras(const GltfFile& file, const Fields& extras, const std::string& name, TrpScene* scene,
                            MaterialLoader& materials, Warnings& warnings);

}  // namespace triptych::cli
