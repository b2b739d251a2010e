// Vertices that a file split (at seams of texture coordinates, normals or materials) told to be one by their position.
#pragma once

#include "scene/mesh.h"

namespace trp {

// Of a position; the same for 0 and −0.
uint64_t position_hash(const Vec3& position);

// For each vertex, the first that has the same position, exactly.
std::vector<uint32_t> weld_vertices(const Mesh& mesh);

}  // namespace trp
