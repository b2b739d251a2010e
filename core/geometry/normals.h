// Shading normals of a mesh. Averages are weighted by the angle of each face at the vertex (Thürmer and Wüthrich 1998),
// as Blender's are; all results have unit length.
#pragma once

#include <vector>

#include "scene/mesh.h"

namespace trp {

// The mesh's own normals, made unit length; empty where they are so already. A zero normal becomes its face's.
std::vector<Vec3> unit_normals(const Mesh& mesh);
// One to a vertex, over all faces around it.
std::vector<Vec3> averaged_vertex_normals(const Mesh& mesh);
// One to a corner, over the faces around its vertex that can be reached without crossing a sharp edge or a border.
std::vector<Vec3> averaged_corner_normals(const Mesh& mesh);
// One to a vertex, over all faces around its position: vertices of equal position count as one.
std::vector<Vec3> welded_vertex_normals(const Mesh& mesh);

}  // namespace trp
