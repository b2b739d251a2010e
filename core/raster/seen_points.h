// From the visibility buffer to shading points.
#pragma once

#include "film/view.h"
#include "raster/visibility_tile.h"

namespace trp {

// Samples of a block's pixels: its lower left pixel, and where in each pixel, lane by lane, they lie, in pixels.
struct BlockSamples {
    uint32_t x, y;
    alignas(64) Lanes offset_x, offset_y;
    // Offsets from the pixels' centres in 1/256 pixel, as SampleOffset has them; the same in all lanes.
    BlockSamples(uint32_t at_x, uint32_t at_y, int32_t dx = 0, int32_t dy = 0) : x(at_x), y(at_y) {
        for (int i = 0; i < kBatch; ++i) set(i, dx, dy);
    }
    void set(int lane, int32_t dx, int32_t dy) {
        offset_x[lane] = 0.5f + static_cast<float>(dx) / kSubpixels;
        offset_y[lane] = 0.5f + static_cast<float>(dy) / kSubpixels;
    }
};

// Directions through the samples, as primary rays have them, of length 1 along the camera's axis; and where they start,
// unless all start at the eye of a perspective camera.
void make_directions(const View& view, const BlockSamples& samples, LaneVec3& origins, LaneVec3& directions);

// Slot and triangle of what the keys say is seen. Returns whether any lane sees something.
bool read_keys(const DrawList& list, const uint32_t* keys, Points& points);

}  // namespace trp
