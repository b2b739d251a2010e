// Primitives of one mesh joined into one set of arrays, so that welding, edges and subdivision see the whole mesh.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gltf_primitive.h"

namespace triptych::cli {

struct MergedFaces {
    PrimitiveData data;                // `material` has no meaning
    std::vector<uint32_t> face_slots;  // by face: the place of its primitive in the list
    std::vector<uint8_t> face_smooth;  // by face; empty where all have normals, or none
};

// Throws an Error that names `where` where an index is beyond its own primitive's vertices.
MergedFaces merge_faces(const std::vector<PrimitiveData>& primitives, const std::string& where);

// All edges of primitives of lines, over one array of positions.
PrimitiveData merge_lines(const std::vector<PrimitiveData>& primitives, const std::string& where);

}  // namespace triptych::cli
