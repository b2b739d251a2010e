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

// Directions through the samples, as primary rays have them, of length 1 along the camera's axis; and where they start,
// unless all start at the eye of a perspective camera.
void make_directions(const View& view, const BlockSamples& samples, LaneVec3& origins, LaneVec3& directions);

// Slot and triangle of what the keys say is seen.
void read_keys(const DrawList& list, const uint32_t* keys, Points& points);

}  // namespace trp
