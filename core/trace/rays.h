// Primary rays of a block and what they hit.
#pragma once

#include "film/pixel_random.h"
#include "film/settings.h"
#include "film/view.h"
#include "geometry/embree.h"
#include "shading/snapshot.h"

namespace trp {

inline constexpr int kPackets = kBatch / 16;  // packets of a block

// The rays of one sample of all pixels of a block. Directions have length 1 along the camera's axis, so that a ray's
// parameter is depth.
struct BlockRays {
    alignas(64) RTCRayHit16 packets[kPackets];
    LaneVec3 origin, direction;
    alignas(64) uint32_t keys[kBatch], indices[kBatch];  // of the pixels' random sequences, and their first numbers
};

// What primary rays are made of, once for a render.
struct RayMaker {
    View view;  // at the first time sample
    PixelFilter filter;
    SampleSequence sequence;
    float footprint = 1;        // of a pixel: what one of many samples stands for
    bool moves = false;         // each ray has a time of its own
    float shutter[2] = {0, 0};  // when it opens and closes, within the time samples
    std::vector<View> motion;   // at each time sample; empty: the camera stands still
};

// Throws Error where there is no camera.
RayMaker make_ray_maker(const Snapshot& snapshot, const Settings& settings, const PixelFilter& filter, uint32_t width,
                        uint32_t height);

// What all rays of a block have in common, once: they meet what `mask` names.
void prepare(BlockRays& rays, unsigned mask);

// For the block whose rays are to be made, whatever the sample.
void prepare_block(const RayMaker& maker, uint32_t block_x, uint32_t block_y, BlockRays& rays);

void make_primary_rays(const RayMaker& maker, uint32_t block_x, uint32_t block_y, uint32_t sample, BlockRays& rays);

// Traces all packets for the lanes where `active` is 1.
void trace_primary(RTCScene scene, const uint8_t* active, Coherence coherence, BlockRays& rays);

// Slot, triangle, barycentrics, depth and the direction to the viewer; kNoSlot where nothing was hit or the lane is not
// active.
void read_hits(const BlockRays& rays, const uint8_t* active, Points& points);

// What rays have found of their lanes: those that are active and have hit nothing are marked in `missed`.
struct Found {
    bool any_missed = false, any_hit = false;
};
Found find_missed(const uint8_t* active, const Points& points, uint8_t* missed);

// Has a lane's ray go on behind the surface that it hit, as far as `end`.
inline void pass_surface(BlockRays& rays, int lane, const Points& points, float end) {
    RTCRay16& ray = rays.packets[lane >> 4].ray;
    ray.tnear[lane & 15] = ray.tfar[lane & 15] * (1 + 4e-7f) + 2 * points.offset[lane];
    ray.tfar[lane & 15] = end;
}

}  // namespace trp
