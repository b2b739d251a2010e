// What rays of a tree are, and what traces them block by block.
//
// A block's primary rays are shaded together; the rays of their trees go on a stack, from which as many as a batch
// holds are taken at a time, whatever pixel, kind or depth they are of. So batches are full, and the stack holds no
// more than a batch for each level of the tree. A ray carries what its pixel gains from it: each pixel is summed as its
// rays end.
#pragma once

#include "film/surface_passes.h"
#include "trace/bounce.h"
#include "trace/media.h"
#include "trace/ray_tracing.h"
#include "trace/rays.h"

namespace trp {

struct PathRay {
    Vec3 origin, direction;  // unit
    Vec3 weight;             // of what it sees, in its pixel
    uint32_t key, sample;    // of its random sequence
    Media::State medium;
    int32_t node;  // of the tree that is recorded
    uint16_t lane;
    uint16_t reflections, transmissions, holes;  // on the way to it
    float width, spread;                         // of its footprint where it starts, and how that grows with distance
    float skipped;                               // of its way: its start is off the surface
};

// What a thread works with; large, so made once for a tile.
struct TreeWorkspace {
    explicit TreeWorkspace(const Snapshot& snapshot) : media(snapshot) {
        prepare(primary, kSeenByCamera);
        prepare(secondary, kSeenByCamera | kCastsShadow | kFiltersShadow | kTransmitsShadow);
    }
    BlockRays primary, secondary;
    Points points;
    Coefficients coefficients;
    LaneVec3 radiance, background, steps[2];
    Bounces bounces;
    ArrivingLight arriving;
    LaneVec3 throughput;
    uint8_t active[kBatch], missed[kBatch];
    alignas(64) uint32_t keys[kBatch], samples[kBatch];
    Media::State media_of[kBatch], beyond[kBatch];
    float travelled[kBatch];  // by primary rays that start in a solid
    uint8_t crosses[kBatch];  // the surface of a solid that is there
    LightScratch lights;
    ProgramScratch program;
    BlockSums sums;

    Media media;
    Media::State start = Media::kOutside;  // where primary rays are
    std::vector<PathRay> stack;
    PathRay rays[kBatch];

    uint64_t reflection_rays = 0, transmission_rays = 0;
    uint64_t shadow_time = 0;              // of the last batch
    std::vector<RayNode>* tree = nullptr;  // null: nothing is recorded
};

// A render's constants.
struct Tracer {
    const RenderJob& job;
    const Snapshot& snapshot;
    RayMaker maker;
    Illumination illumination;
    bool wants_shadow_pass, sees_lights, any_area_lights;
    float pixel_step;                                       // of a primary ray's footprint, at depth 1
    std::vector<std::pair<uint32_t, uint32_t>> around_eye;  // slots and materials of the solids that the eye is in

    void tile(const TileWork& work) const;
    void begin_block(uint32_t block_x, uint32_t block_y, TreeWorkspace& w) const;
    void block(uint32_t block_x, uint32_t block_y, const TileWork& work, TreeWorkspace& w) const;
    void primary(uint32_t block_x, uint32_t block_y, uint32_t sample, TreeWorkspace& w) const;
    void secondary(TreeWorkspace& w) const;
    void drain(size_t least, TreeWorkspace& w) const;
    void shade(Coherence coherence, const RandomPairs& random, TreeWorkspace& w) const;
    void cross_surfaces(TreeWorkspace& w) const;
    void spawn(int i, const PathRay& parent, float distance, TreeWorkspace& w) const;
    void push(const PathRay& parent, int i, RayNode::Kind kind, const Vec3& direction, const Vec3& weight,
              TreeWorkspace& w) const;
    void add_seen_lights(TreeWorkspace& w) const;
    void fade_primary(TreeWorkspace& w) const;
    SeenLight nearest_light(const Vec3& origin, const Vec3& direction, float from, float to, bool by_camera) const;
    void record_hit(const PathRay& ray, int i, float distance, TreeWorkspace& w) const;
};

}  // namespace trp
