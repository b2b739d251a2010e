// The whole equation at a batch, as every method evaluates it: where, and with which terms, is the method's.
#pragma once

#include <functional>

#include "shading/shadow_rays.h"

namespace trp {

// The terms of the equation that settings choose.
struct Illumination {
    Specular specular = Specular::phong;
    int32_t falloff = -1;  // TRP_FALLOFF_… for all lights; −1: each light's own
    bool shadows = true;
    TransparentShadows transparent_shadows = TransparentShadows::opaque;
    bool mirrors = false;   // I_R is traced: lights that rays can hit have no highlight on mirrors
    Vec3 ambient{0, 0, 0};  // I_A
    float least_light = 0;  // of I_L: lamps that give a point less give it nothing
};

// Gives numbers in [0, 1) of the batch's random sequence by their pair: u, v[kBatch].
using RandomPairs = std::function<void(uint32_t pair, float* u, float* v)>;
inline constexpr uint32_t kFirstLightPair = 5;  // a pair to each light; those before are the rays'

// One to a thread.
struct LightScratch {
    LightSamples samples;
    alignas(64) Lanes u, v;
    LaneVec3 visibility;
    LaneVec3 weight;  // of highlights of lights that rays can hit
    ShadowScratch shadow;
};

struct ShadowCounts {
    uint64_t rays = 0, nanoseconds = 0;
};

// radiance += the terms of all lights, each sampled once. `coherence`: of the batch's lanes, for shadow rays.
void add_lights(const Snapshot& snapshot, const Illumination& illumination, Coherence coherence,
                const RandomPairs& random, const Points& points, const Coefficients& coefficients,
                const LightSums& sums, LightScratch& scratch, ProgramScratch& program, ShadowCounts& counts);

}  // namespace trp
