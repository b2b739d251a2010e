// From the visibility buffer to shading points.
#pragma once

#include "film/view.h"
#include "raster/visibility_tile.h"

namespace trp {

// Samples of a block's pixels: its lower left pixel, and where in each pixel they lie, in pixels.
struct BlockSamples {
    uint32_t x = 0, y = 0;
    float offset_x = 0.5f, offset_y = 0.5f;
};

// Directions through the samples, as primary rays have them, of length 1 along the camera's axis; and where they start.
void make_directions(const View& view, const BlockSamples& samples, LaneVec3& origins, LaneVec3& directions);

// What the keys say is seen, and where: slot, triangle, barycentrics by intersecting the ray with the triangle's plane,
// held within the triangle, depth and the direction to the viewer.
void find_points(const Snapshot& snapshot, const DrawList& list, const uint32_t* keys, const LaneVec3& origins,
                 const LaneVec3& directions, Points& points);

}  // namespace trp
