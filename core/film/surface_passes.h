// What a batch shows, into the passes: for methods that see surfaces from nearest to farthest through their holes.
#pragma once

#include "film/film.h"
#include "shading/equation.h"

namespace trp {

inline constexpr float kNothingSeen = 1e10f;  // depth, as Blender has it
inline constexpr int kGreatestLayers = 64;    // of surfaces with holes in a row, one behind the other

// The lanes that lights add to: radiance, and what the passes that are asked for need beside it.
class LightLanes {
  public:
    explicit LightLanes(const PassList& passes);
    LightLanes(const LightLanes&) = delete;
    LightLanes& operator=(const LightLanes&) = delete;

    LaneVec3 radiance;
    const LightSums sums;  // of these lanes
    // All but the radiance.
    void clear();

  private:
    ArrivingLight arriving_;
    LaneVec3 diffuse_;
    GroupLight groups_;
};

// Adds a light's or a lane's radiance to the pass of its group; without effect where there is none.
inline void add_to_group(uint32_t group, int lane, const Vec3& radiance, const BlockSums& sums) {
    if (group >= 1 && group <= kLightGroups) sums.add(static_cast<PassId>(kLightGroup1 + group - 1), lane, radiance);
}

struct SeenSurfaces {
    const Snapshot& snapshot;
    const Points& points;
    const Coefficients& coefficients;
    LightSums light;             // 0 where a lane sees nothing; where `arriving` is null, all light arrives
    const LaneVec3* throughput;  // of the surfaces before; null: there is none
    Vec3 ambient{0, 0, 0};       // I_A
    bool straight = true;        // K_T lets what lies straight behind shine through; false: rays are traced for it
};

// Adds the lanes that see a surface. `first`: null, or in the first sample, whether a lane has its values of passes
// that are not averaged; they are written for those that have not, and marked.
void add_surfaces(const SeenSurfaces& seen, uint8_t* first, const BlockSums& sums);

// What goes on to the surface behind a lane's, along the straight way: throughput (1 − α + α K_T), or, where K_T is not
// `straight`, throughput (1 − α); 0 where it is next to nothing.
Vec3 throughput_behind(const Points& points, const Coefficients& coefficients, int lane, const Vec3& throughput,
                       bool straight = true);

// Adds the background to the lanes that are `missed`.
void add_background(const Snapshot& snapshot, const LaneVec3& directions, const uint8_t* missed,
                    const LaneVec3* throughput, bool transparent, const BlockSums& sums);

// Adds a light of a group that a lane sees.
void add_seen_light(int lane, const Vec3& throughput, const Vec3& radiance, uint32_t group, const BlockSums& sums);

// After the first sample: the depth of lanes that have seen no surface.
void finish_depth(const uint8_t* first, const BlockSums& sums);

}  // namespace trp
