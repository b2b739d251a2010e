// `extras.triptych` of a material: the classic coefficients and node programs (extras_triptych.md).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf_fields.h"
#include "gltf_texture.h"
#include "node_program.h"

namespace triptych::cli {

// Overrides what `desc` and `program` hold. `texture_count` is the number of the file's textures.
void apply_material_extras(const Fields& extras, TextureLoader& textures, size_t texture_count, NodeProgram& program,
                           TrpMaterialDesc& desc, Warnings& warnings);

}  // namespace triptych::cli
