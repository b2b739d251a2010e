// What rays of a tree are, and what traces them block by block.
//
// A block's primary rays are shaded together; the rays of their trees go on a stack, from which as many as a batch
// holds are taken at a time, whatever pixel, kind or depth they are of. So batches are full, and the stack holds no
// more than a batch for each level of the tree. A ray carries what its pixel gains from it: each pixel is summed as its
// rays end.
//
// A path is a tree of which only one branch is followed at each surface, chosen at random by what it would count for,
// and to which diffuse and glossy reflection have been added. Through a hole that is not clear both go on: the
// surface's branch and the ray itself.
//
// Ray casting follows no branch: primary rays alone, which go straight on through holes and by K_T.
#pragma once

#include "film/surface_passes.h"
#include "trace/bounce.h"
#include "trace/media.h"
#include "trace/ray_tracing.h"
#include "trace/seen_lights.h"

namespace trp {

// How a ray goes on from a surface.
enum class Way : uint8_t { reflection, transmission, diffuse };
inline constexpr int kWays = 3;

// Those of a surface that are followed: ray casting, trees, paths.
enum class Branches : uint8_t { none, all, one };

struct PathRay {
    Vec3 origin{0, 0, 0}, direction{0, 0, 1};  // unit
    Vec3 weight{1, 1, 1};                      // of what it sees, in its pixel
    uint32_t key = 0, index = 0;               // of its random sequence, and its place there
    Media::State medium = Media::kOutside;
    int32_t node = 0;  // of the tree that is recorded
    uint16_t lane = 0;
    uint16_t ways[kWays] = {0, 0, 0}, holes = 0;  // on the way to it
    PassId part = kCombined;                      // the pass that gains what its pixel gains, by the first way
    // Where it starts, these lights have been counted already.
    bool lamps_sampled = false, world_sampled = false;
    float width = 0, spread = 0;  // of its footprint where it starts; its growth with distance
    float time = 0;
    float skipped = 0;  // of its way: its start is off the surface

    uint32_t depth() const { return uint32_t{ways[0]} + ways[1] + ways[2]; }
};

// What a thread works with; large, so made once for a tile.
struct TreeWorkspace {
    TreeWorkspace(const Snapshot& snapshot, const PassList& passes) : light(passes), media(snapshot) {
        prepare(primary, kSeenByCamera);
        prepare(secondary, kSeenByCamera | kCastsShadow | kFiltersShadow | kTransmitsShadow);
    }
    BlockRays primary, secondary;
    Points points;
    Coefficients coefficients;
    LightLanes light;
    LaneVec3 background, steps[2];
    Bounces bounces;
    LaneVec3 throughput;
    SeenLights seen;
    uint8_t active[kBatch], missed[kBatch], lamps_sampled[kBatch];
    uint8_t scattered[kBatch];  // by a surface on the way; what the eye sees itself or in mirrors and glass is not
    alignas(64) uint32_t keys[kBatch], indices[kBatch];
    Media::State media_of[kBatch], beyond[kBatch];
    alignas(64) Lanes turn_u, turn_v, choice, survival;  // a path's random numbers at its surfaces
    float travelled[kBatch];                             // by primary rays that start in a solid
    uint8_t crosses[kBatch];                             // the surface of a solid that is there
    LightScratch lights;
    ProgramScratch program;
    BlockSums sums;

    Media media;
    Media::State start = Media::kOutside;  // where primary rays are
    std::vector<PathRay> stack;
    PathRay rays[kBatch];

    uint64_t rays_of[kWays] = {};
    uint64_t shadow_time = 0;              // of the last batch
    std::vector<RayNode>* tree = nullptr;  // null: nothing is recorded
    RayNode* node_of(const PathRay& ray) const { return tree ? &(*tree)[static_cast<size_t>(ray.node)] : nullptr; }
};

// A render's constants.
struct Tracer {
    const RenderJob& job;
    const Snapshot& snapshot;
    RayMaker maker;
    Illumination illumination;
    Branches branches;
    bool sees_lights, any_area_lights;
    float pixel_step;                                       // of a primary ray's footprint, at depth 1
    std::vector<std::pair<uint32_t, uint32_t>> around_eye;  // slots and materials of the solids that the eye is in

    bool straight() const { return branches == Branches::none; }
    bool one_way() const { return branches == Branches::one; }

    // Of blocks.
    void tile(const TileWork& work) const;
    void begin_block(uint32_t block_x, uint32_t block_y, TreeWorkspace& w) const;
    void block(uint32_t block_x, uint32_t block_y, const TileWork& work, TreeWorkspace& w) const;
    void drain(size_t least, TreeWorkspace& w) const;

    // Of primary rays.
    uint32_t primary(uint32_t block_x, uint32_t block_y, uint32_t sample, TreeWorkspace& w) const;
    void add_seen_lights(TreeWorkspace& w) const;
    void fade_primary(TreeWorkspace& w) const;
    void add_missed(const LaneVec3* throughput, TreeWorkspace& w) const;
    void spawn_primary(uint32_t sample, TreeWorkspace& w) const;
    bool pass_primary(TreeWorkspace& w) const;

    // Of the rays on the stack.
    void secondary(TreeWorkspace& w) const;
    int take_rays(TreeWorkspace& w) const;
    Found end_rays(int count, TreeWorkspace& w) const;
    void gain(const PathRay& ray, const Vec3& value, TreeWorkspace& w) const;
    void pass_hole(int i, const PathRay& ray, TreeWorkspace& w) const;

    // At surfaces.
    void shade(Coherence coherence, const RandomPairs& random, TreeWorkspace& w) const;
    void cross_surfaces(TreeWorkspace& w) const;
    void roughen(TreeWorkspace& w) const;
    void spawn(int i, const PathRay& parent, float distance, TreeWorkspace& w) const;
    void spawn_one(int i, const PathRay& parent, TreeWorkspace& w) const;
    void push(const PathRay& parent, int i, Way way, const Vec3& direction, const Vec3& weight, TreeWorkspace& w) const;
    void record_hit(const PathRay& ray, int i, float distance, TreeWorkspace& w) const;
};

}  // namespace trp
