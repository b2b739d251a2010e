// Where mirror and transmitted rays go from the points of a batch, and with which weights.
//
// R = 2 (N·V) N − V. Thin surfaces let light straight on, T = −V; into solids by Snell's law. With η = η_here /
// η_there:
//
//   cos² Θt = 1 − η² (1 − (N·V)²),  T = −η V + (η (N·V) − cos Θt) N
//
// and where cos² Θt is not positive, all is reflected (Whitted, "An Improved Illumination Model for Shaded Display",
// 1980; Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", 1984, for T). Fresnel's reflectance for unpolarized
// light is the mean of r∥² and r⊥² (Born and Wolf, "Principles of Optics", sec. 1.5); a thin pane reflects 2 R / (1 +
// R), all ways within it summed.
#pragma once

#include "shading/batch.h"

namespace trp {

enum BounceFlag : uint8_t {
    kThin = 1,
    kFresnel = 2,
};

struct Bounces {
    // To be set for each lane that mirrors or transmits.
    alignas(64) Lanes eta;              // η_here / η_there
    alignas(64) uint8_t flags[kBatch];  // BounceFlag
    // Found.
    LaneVec3 mirror_direction, transmitted_direction;  // unit
    LaneVec3 mirror_weight, transmitted_weight;
};

// For the lanes with a slot; weights are 0 where coefficients are.
void find_bounces(const Points& points, const Coefficients& coefficients, Bounces& bounces);

}  // namespace trp
