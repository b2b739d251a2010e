// N-gons to triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace trp {

// Twice the area vector of a closed polygon (Newell's method), in double.
Vec3d newell(std::span<const Vec3> positions);

// Appends the triangles of one simple polygon, each as three indices into `polygon`; concave polygons by ear clipping
// in the plane of their mean normal. `normal` is newell(polygon), not zero. Always appends polygon.size() − 2
// triangles; for self-intersecting polygons they overlap.
void triangulate(std::span<const Vec3> polygon, const Vec3d& normal, std::vector<uint32_t>& triangles);

}  // namespace trp
