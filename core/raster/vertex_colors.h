// Gouraud shading: the equation at every vertex, its values interpolated over the polygons (Gouraud, "Continuous
// Shading of Curved Surfaces", 1971).
#pragma once

#include <functional>
#include <vector>

#include "shading/lighting.h"

namespace trp {

// The radiance that leaves a placed surface at its vertices, or at its corners where faces that meet at a vertex differ
// there (in normals, materials, texture coordinates), towards the eye. Seen from the front, and from behind.
struct VertexColors {
    bool by_corner = false;
    std::vector<Vec3> sides[2];
    // At a corner of the surface's mesh.
    const Vec3& at(const PlacedSurface& surface, uint32_t corner, bool behind) const {
        return sides[behind][by_corner ? corner : surface.mesh->corner_vertices[corner]];
    }
};

// By slot; empty for surfaces that were not wanted.
using SceneColors = std::vector<VertexColors>;

// Evaluates a batch of points that are found but not located, seen from the front or from behind, into `radiance`.
// `batch` numbers the batches of a surface.
using PointShader = std::function<void(uint32_t slot, uint32_t batch, bool behind, Points& points, LaneVec3& radiance)>;

// The vertices of the slots that are `wanted`. `eye`: where the camera is, relative to the origin; `axis`: towards an
// orthographic one. Runs in the current arena.
SceneColors shade_vertices(const Snapshot& snapshot, const std::vector<uint8_t>& wanted, NormalChoice normals,
                           const Vec3* eye, const Vec3& axis, const PointShader& shade);

// Interpolates at points that locate() has found.
void interpolate_colors(const Snapshot& snapshot, const SceneColors& colors, const Points& points, LaneVec3& radiance);

}  // namespace trp
