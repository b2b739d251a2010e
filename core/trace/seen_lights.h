// Area lights that rays meet. They are no geometry of the ray scene: each ray asks every one of them.
#pragma once

#include "shading/lights.h"
#include "trace/rays.h"

namespace trp {

struct SeenLights {
    alignas(64) Lanes t;                 // the ray's parameter at the nearest one; 0: none is met
    LaneVec3 radiance;                   // seen there
    alignas(64) uint32_t group[kBatch];  // the light's
};

// For lanes of rays that have been traced: the nearest of the area lights (of those that the camera sees, where
// `by_camera` says so) whose front is met before what the ray hit. Returns whether any `active` lane meets one.
bool see_area_lights(const LightList& lights, bool by_camera, const BlockRays& rays, const uint8_t* active,
                     SeenLights& seen);

}  // namespace trp
