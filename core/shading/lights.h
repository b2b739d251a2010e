// Lights made ready to be sampled: lamps, emitting surfaces and the world in one list.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/items.h"
#include "shading/batch.h"
#include "textures/texture_set.h"

namespace trp {

struct Snapshot;
struct PlacedSurface;
class ProgramScratch;

// A discrete distribution, sampled by inversion, which keeps well-distributed numbers well distributed.
class Distribution {
  public:
    Distribution() = default;
    explicit Distribution(const std::vector<float>& weights);
    bool empty() const { return cdf_.empty(); }
    double total() const { return total_; }
    // The entry that u in [0, 1) falls on; u becomes its place within the entry, again in [0, 1).
    uint32_t sample(float& u) const;
    float probability(uint32_t entry) const { return cdf_[entry + 1] - cdf_[entry]; }

  private:
    std::vector<float> cdf_;  // entries + 1, from 0 to 1
    double total_ = 0;
};

// A picture of the world's radiance, sampled by luminance times solid angle.
struct WorldMap {
    uint32_t width = 0, height = 0;
    std::vector<float> radiance;  // rgb, row 0 at the bottom
    Distribution rows;
    std::vector<Distribution> columns;
};

struct LightFrame {
    Vec3 position{0, 0, 0};                   // relative to the origin
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  // unit axes of the light; it looks along −z
};

struct ReadyLight : LightFrame {
    enum class Kind { point, spot, sun, area, surface, world, world_map } kind = Kind::point;
    std::vector<LightFrame> motion;  // at each time sample; empty: it stands still
    Vec3 emission{0, 0, 0};          // as TrpLightDesc; world: radiance
    float radius = 0, sin_half_angle = 0, cos_half_angle = 0, blend_range = 0;
    float half_size[2] = {0, 0}, area = 0;
    float spread_tangent = 0, spread_scale = 0;  // area: 0 is none
    bool ellipse = false, cast_shadow = true, visible_camera = false;
    int32_t falloff = 0;
    uint32_t group = 0;
    // surface: triangles of one placed surface that emit
    uint32_t slot = 0;
    std::vector<uint32_t> triangles;
    std::vector<float> areas;
    Distribution choice;
    std::shared_ptr<const WorldMap> map;
    Affine texture_from_world;  // a rotation

    bool is_hit_by_rays() const { return kind == Kind::area || kind == Kind::surface; }
    // A bound of I_L, and the radius of a ball that holds the light; for lamps with a place.
    float strength() const;
    float extent() const;
    // Whether two numbers of the random sequence are used.
    bool is_sampled() const {
        return !((kind == Kind::point || kind == Kind::spot) && radius == 0) &&
               !(kind == Kind::sun && sin_half_angle == 0);
    }
};

using LightList = std::vector<ReadyLight>;

// The list of a snapshot whose surfaces, materials and lamps are ready.
LightList make_lights(const Snapshot& snapshot);

// The packets of 16 lanes, a bit to each, that light can reach: not those that it lies behind, or that lie behind it,
// outside its cone, or so far away that less than `least` of I_L would arrive. `falloff` as below; `by_shadow_rays`:
// whether such will be traced.
uint32_t reached_packets(const ReadyLight& light, int32_t falloff, float least, bool by_shadow_rays,
                         const Points& points);

// Light samples of one light for the lanes of samples.packets, by u and v in [0, 1) (unused where the light is not
// sampled). `falloff` overrides the light's own where it is not negative.
void sample_light(const Snapshot& snapshot, const ReadyLight& light, int32_t falloff, const Points& points,
                  const float* u, const float* v, LightSamples& samples, ProgramScratch& scratch);

}  // namespace trp
