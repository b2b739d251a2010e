// Form factors between planar polygons in closed form, with nothing between them.
//
// Lengths in any one unit (metres), angles in radians, all in double. A polygon is three or more corners in order,
// simple and planar, convex or concave; its front is the side from which they run counterclockwise. Planes off by
// rounding are fine. Pure functions, safe from any thread; degenerate input (fewer corners, no area, NaN, infinity)
// gives 0.
#pragma once

#include <span>

#include "base/vec.h"

namespace trp {

// The form factor, 0 to 1, from a differential area at `point` with unit `normal` to a polygon, the part of it below
// the horizon cut away. 0 behind the polygon and in its plane.
double point_to_polygon(const Vec3d& point, const Vec3d& normal, std::span<const Vec3d> polygon);

// A_a F_ab = A_b F_ba, in square metres, front to front: what lies behind the other's plane counts for nothing. To
// about 1e-12 of the smaller area, for sizes within a factor of 10 000, whether the two touch, cross or share an edge,
// and to about 1e-12 of itself where they are far apart. 1 to 60 microseconds for two quads.
double polygon_to_polygon(std::span<const Vec3d> a, std::span<const Vec3d> b);

// The same to about `relative_error` (1e-12 to 0.1) of itself, for the many far pairs of a matrix: at 1e-4 half a
// microsecond for two quads three sizes apart.
double polygon_to_polygon(std::span<const Vec3d> a, std::span<const Vec3d> b, double relative_error);

}  // namespace trp
