// The stages of shading a batch, for every method. See batch.h for their order.
#pragma once

#include <array>

#include "shading/batch.h"
#include "shading/snapshot.h"

namespace trp {

enum class Specular { none, phong, blinn };

// Positions, normals and materials of the lanes with a slot, on the side of the surface that the viewer sees, or on
// that which is said.
enum class Side { seen, front, back };
void locate(const Snapshot& snapshot, NormalChoice choice, Points& points, Side side = Side::seen);

// As locate(), where only slot and triangle are known, and the ray through which each lane sees them: barycentrics are
// those of the ray's point in the triangle's plane, held within the triangle; depth and to_viewer follow too.
struct SeenFrom {
    Vec3 eye;                    // where all rays start
    const LaneVec3* origins;     // or where each does; null: at the eye
    const LaneVec3& directions;  // of length 1 along the camera's axis
};
void locate_seen(const Snapshot& snapshot, NormalChoice choice, const SeenFrom& from, Points& points);

// Coefficients of the lanes with a slot; material programs may replace shading normals. The back of a one-sided surface
// is not seen, alpha 0; for those lanes of `light`, which are on light's way to another surface and not the eye's, it
// stands there and is dark.
void evaluate(const Snapshot& snapshot, Points& points, Coefficients& coefficients, ProgramScratch& scratch,
              const uint8_t* light = nullptr);
inline constexpr auto kEveryLane = [] {
    std::array<uint8_t, kBatch> lanes{};
    lanes.fill(1);
    return lanes;
}();

// radiance = I_E + K_A I_A
void add_ambient(const Points& points, const Coefficients& coefficients, const Vec3& ambient_light, LaneVec3& radiance);

// Sums of (N·L) I_L, unblocked and blocked, for the shadow pass.
struct ArrivingLight {
    LaneVec3 unblocked, blocked;
    void clear() {
        unblocked.clear();
        blocked.clear();
    }
};

inline constexpr uint32_t kLightGroups = 8;  // 1 to 8; 0 is none

// What the lamps of each light group add to the radiance.
struct GroupLight {
    LaneVec3 of[kLightGroups];
    void clear() {
        for (LaneVec3& group : of) group.clear();
    }
};

// What lights add to: lanes of radiance, and of what is asked for beside it (null: not).
struct LightSums {
    LaneVec3& radiance;
    ArrivingLight* arriving = nullptr;
    LaneVec3* diffuse = nullptr;  // the part of K_D
    GroupLight* groups = nullptr;
};

// radiance += (K_D (N·L) + K_S (V·R)^n) S_L I_L; `weight` is K_S, `visibility` S_L, a fraction where the way is partly
// blocked, of each colour. `group`: the light's.
void add_light(Specular specular, const Points& points, const Coefficients& coefficients, const LaneVec3& weight,
               const LightSamples& samples, const LaneVec3& visibility, const LightSums& sums, uint32_t group);

}  // namespace trp
