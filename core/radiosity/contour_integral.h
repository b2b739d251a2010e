// The form factor of two polygons as a double contour integral (1/2π) ∮∮ ln r dr_a·dr_b: Sparrow, "A New and Simpler
// Formulation for Radiative Angle Factors", J. Heat Transfer 1963, as in Goral, Torrance, Greenberg, Battaile,
// "Modeling the Interaction of Light Between Diffuse Surfaces", SIGGRAPH 1984. It holds where polygons touch, too.
#pragma once

#include <span>

#include "base/vec.h"

namespace trp {

// A_a F_ab, where neither has a part behind the other's plane.
double contour_integral(std::span<const Vec3d> a, std::span<const Vec3d> b, double relative_error);

}  // namespace trp
