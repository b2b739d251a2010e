// What a batch shows, into the passes: for methods that see surfaces from nearest to farthest through their holes.
#pragma once

#include "film/film.h"
#include "shading/equation.h"

namespace trp {

inline constexpr int kGreatestLayers = 64;        // of surfaces with holes in a row, one behind the other
inline constexpr float kLeastThroughput = 1e-3f;  // less is nothing

struct SeenSurfaces {
    const Snapshot& snapshot;
    const Points& points;
    const Coefficients& coefficients;
    const LaneVec3& radiance;       // 0 where a lane sees nothing
    const float* throughput;        // of the surfaces before
    const ArrivingLight* arriving;  // null: all light arrives, or the Shadow pass was not asked for
};

// Adds the lanes that see a surface. `first`: null, or in the first sample, whether a lane has its values of passes
// that are not averaged; they are written for those that have not, and marked.
void add_surfaces(const SeenSurfaces& seen, uint8_t* first, const BlockSums& sums);

// Adds the background to the lanes that are `missed`.
void add_background(const Snapshot& snapshot, const LaneVec3& directions, const uint8_t* missed,
                    const float* throughput, bool transparent, const BlockSums& sums);

// After the first sample: the depth of lanes that have seen no surface.
void finish_depth(const uint8_t* first, const BlockSums& sums);

}  // namespace trp
