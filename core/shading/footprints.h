// The footprint of a pixel on what is seen through it (Igehy, "Tracing Ray Differentials", 1999, eq. 10-12).
#pragma once

#include "shading/batch.h"

namespace trp {

// Rays from the eye, as lanes: through a perspective camera all from one point, directions of length 1 along its axis.
struct FootprintRays {
    const LaneVec3& direction;
    bool perspective = true;
    Vec3 step_x, step_y;  // from a ray to that of the pixel's right and upper end, at depth 1; orthographic: anywhere
    const LaneVec3* steps = nullptr;  // two, lane by lane, at what is seen, in their stead
};

// Points::b1_dx … from what locate() has found.
void make_footprints(const FootprintRays& rays, Points& points);

}  // namespace trp
