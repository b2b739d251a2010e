// S_L: how much of the way to a light is free.
#pragma once

#include "geometry/embree.h"
#include "shading/equation.h"

namespace trp {

// Scratch of shadow rays through surfaces with holes; one to a thread.
struct ShadowScratch {
    Points points;
    Coefficients coefficients;
};

// What transparent surfaces do to shadows: block light like others, let through what K_T says, or nothing.
enum class TransparentShadows { opaque, transmission, none };

// Of the way to a light that shadow rays go, so that an emitting surface does not shade itself.
inline constexpr float kShortOfLight = 0.9999f;

// visibility: 1 where the way is free, 0 where it is blocked, between where alpha or K_T lets part through. Lanes that
// the light cannot reach are 0. Returns the number of rays.
uint64_t trace_shadows(const Snapshot& snapshot, const Points& points, const LightSamples& samples, Coherence coherence,
                       TransparentShadows transparent, LaneVec3& visibility, ShadowScratch& shadow,
                       ProgramScratch& program);

}  // namespace trp
