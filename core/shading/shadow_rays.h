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

// visibility[lane]: 1 where the way is free, 0 where it is blocked, between where alpha lets part through. Lanes that
// the light cannot reach are 0. Returns the number of rays.
uint64_t trace_shadows(const Snapshot& snapshot, const Points& points, const LightSamples& samples, Coherence coherence,
                       float* visibility, ShadowScratch& shadow, ProgramScratch& program);

}  // namespace trp
