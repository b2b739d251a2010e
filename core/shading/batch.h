// Batches of shading points and what is known at them, as structures of arrays.
//
// A visibility method (rays or projection) writes for each lane which triangle is seen and from where; locate() finds
// position, normals and material; evaluate() the coefficients of the equation; sample_light() the light that could
// arrive; add_light() and add_ambient() evaluate the equation. Lanes keep their places throughout: a lane that sees
// nothing, or is done, has slot kNoSlot. No lane's result depends on another lane.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/vec.h"

namespace trp {

inline constexpr int kBatch = 256;  // lanes: a block of 16 × 16 pixels; its arrays fit the nearest caches
inline constexpr uint32_t kNoSlot = ~0u;

using Lanes = float[kBatch];

struct LaneVec3 {
    alignas(64) Lanes x, y, z;
    Vec3 get(int i) const { return {x[i], y[i], z[i]}; }
    void set(int i, const Vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
    void clear() {
        for (float* lanes : {x, y, z}) std::fill_n(lanes, kBatch, 0.0f);
    }
    float* operator[](int k) { return k == 0 ? x : k == 1 ? y : z; }
    const float* operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
};

struct Points {
    // Written by the visibility method.
    alignas(64) uint32_t slot[kBatch];      // the placed surface, or kNoSlot
    alignas(64) uint32_t triangle[kBatch];  // of the surface
    alignas(64) Lanes b1, b2;               // barycentric weights of the triangle's second and third vertex
    alignas(64) Lanes time;                 // 0 to 1 over the time samples
    alignas(64) Lanes depth;                // along the camera's axis; for passes and footprints
    LaneVec3 to_viewer;                     // unit
    // Written by locate().
    LaneVec3 position;                      // world space, relative to the snapshot's origin
    LaneVec3 edge1, edge2;                  // from the triangle's first vertex to its second and third
    LaneVec3 geometric_normal;              // unit, on the viewer's side
    LaneVec3 normal;                        // unit shading normal, on the same side of the surface
    alignas(64) Lanes offset;               // along the geometric normal, clears the surface of itself (rounding bound)
    alignas(64) uint32_t material[kBatch];  // index into Snapshot::materials
    alignas(64) uint8_t behind[kBatch];     // 1: the viewer sees the back
    bool any_program = false;               // a lane's material has nodes
    bool any_holes = false;                 // a lane's material may have alpha below 1, or one side
    bool any_transmission = false;          // a lane's material transmits
    bool any_mirror = false;                // a lane's material mirrors

    // The footprint, by the visibility method after locate(): the change of b1 and b2 by one pixel to the right and one
    // pixel up, in the plane of the triangle. Needed where textures are (Snapshot::needs_footprint), else unset.
    alignas(64) Lanes b1_dx, b2_dx, b1_dy, b2_dy;
    void clear_footprints() {
        for (Lanes* lanes : {&b1_dx, &b2_dx, &b1_dy, &b2_dy}) std::fill_n(*lanes, kBatch, 0.0f);
    }
};

struct Coefficients {
    LaneVec3 emission, ambient, diffuse, specular;
    alignas(64) Lanes shininess, alpha;
    LaneVec3 mirror, transmission;  // where Points::any_mirror; any_transmission
    alignas(64) Lanes ior;          // where one of both
};

// Light that would arrive at each point from one light, if nothing were in between.
struct LightSamples {
    uint32_t packets;  // a bit to each 16 lanes: the others have no samples, as nothing reaches them
    bool reaches(int lane) const { return packets >> (lane >> 4) & 1; }
    LaneVec3 direction;          // unit, towards the light
    alignas(64) Lanes distance;  // to the sampled point; huge for sun and world
    LaneVec3 light;              // I_L = E⊥/π, divided by the density of the sample; 0 where none can arrive
};

}  // namespace trp
