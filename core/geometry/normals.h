// Shading normals of a mesh, of unit length.
#pragma once

#include <vector>

#include "scene/mesh.h"

namespace trp {

// Shading normals, object space: none (flat), one to a vertex, or one to a corner.
struct NormalLayer {
    enum class Domain { flat, vertex, corner } domain = Domain::flat;
    const Vec3* values = nullptr;
};

// The unit normal of a face (Newell's), object space; 0 where it has no area.
Vec3 face_normal(const Mesh& mesh, uint32_t face);

// The mesh's own normals, made unit length; empty where they are so already. A zero normal becomes its face's.
std::vector<Vec3> unit_normals(const Mesh& mesh);

// How a face counts in the average at a vertex: as every other (Gouraud 1971), by its angle there (Thürmer and Wüthrich
// 1998; Blender's), or by its area.
enum class NormalWeight { plain, angle, area };

// Averages over the faces around each vertex; where the mesh has sharp edges, those that can be reached without
// crossing one or a border.
struct AveragedNormals {
    NormalLayer::Domain domain;
    std::vector<Vec3> values;
};
// `weld`: vertices of equal position count as one.
AveragedNormals averaged_normals(const Mesh& mesh, NormalWeight weight, bool weld);

}  // namespace trp
