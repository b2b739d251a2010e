// What is seen through each pixel of a tile: a visibility buffer (Burns and Hunt, "The Visibility Buffer: A
// Cache-Friendly Approach to Deferred Shading", 2013) with exact coverage.
//
// Vertices are snapped to 1/256 pixel; a pixel belongs to a triangle where its three edge functions, exact integers,
// are positive, or zero on a left or upper edge (Pineda, "A Parallel Algorithm for Polygon Rasterization", 1988), so
// that triangles which share an edge leave no gap and no pixel twice. Of several, the nearest is kept, of equally near
// ones the first drawn.
#pragma once

#include <cstdint>
#include <memory>

#include "hwy/aligned_allocator.h"
#include "raster/draw_list.h"
#include "shading/batch.h"

namespace trp {

inline constexpr uint32_t kNothing = ~0u;  // the key of a pixel that sees nothing

// Where the pixel (x, y) of a tile lies in its buffers, block after block.
inline size_t tile_lane(uint32_t blocks_across, uint32_t x, uint32_t y) {
    return (size_t{y / kBlockSide} * blocks_across + x / kBlockSide) * kBatch + lane_at(x % kBlockSide, y % kBlockSide);
}

class VisibilityTile {
  public:
    // Makes it a tile of blocks of 16 × 16 pixels, whose lower left pixel is (x0, y0), which may lie outside of the
    // film; its memory is used again.
    void place(int32_t x0, int32_t y0, uint32_t blocks_across, uint32_t blocks_up);

    // Forgets all. Samples lie at the pixels' centres plus (offset_x, offset_y) / 256 pixels from now on. With
    // `behind`, only what lies behind the last picture is seen, where a pixel shows something: pixels that show
    // nothing stay so.
    void begin(const Projection& projection, int32_t offset_x, int32_t offset_y, bool behind);
    // Draws the cluster of that number, from near to far. Its triangles get the keys number · 128 + k.
    void draw(const Projection& projection, const DrawList& list, uint32_t number);

    // The lanes of a block, by its place in the tile.
    const uint32_t* keys(uint32_t block) const { return &keys_[size_t{block} * kBatch]; }
    const float* nearness(uint32_t block) const { return &nearness_[size_t{block} * kBatch]; }
    // Whether all of the cluster lies behind what is drawn, by a thousandth of its nearness at least.
    bool hides(const DrawnCluster& cluster);
    // Removes a lane from what is seen, so that nothing is seen behind it either.
    void close(uint32_t block, int lane) { keys_[size_t{block} * kBatch + static_cast<size_t>(lane)] = kNothing; }

    int32_t x0() const { return x0_; }
    int32_t y0() const { return y0_; }
    uint32_t blocks_across() const { return blocks_across_; }
    uint32_t blocks_up() const { return blocks_up_; }
    size_t pixels() const { return size_t{blocks_across_} * blocks_up_ * kBatch; }

    // For the drawing functions.
    struct Buffers {
        uint32_t* keys;
        float* nearness;
        const uint32_t* last_keys;  // null: everything may be seen
        const float* last_nearness;
        uint32_t blocks_across, width, height;  // in pixels
        int32_t origin_x, origin_y;             // of the first pixel's sample, on the film's grid
    };

  private:
    bool hidden(const DrawnCluster& cluster, float nearness);
    void touch(const DrawnCluster& cluster);
    bool block_range(const DrawnCluster& cluster, uint32_t range[4]) const;

    int32_t x0_ = 0, y0_ = 0;
    uint32_t blocks_across_ = 0, blocks_up_ = 0;
    size_t room_ = 0;  // in pixels
    hwy::AlignedFreeUniquePtr<uint32_t[]> keys_, last_keys_;
    hwy::AlignedFreeUniquePtr<float[]> nearness_, last_nearness_;
    std::vector<float> farthest_;  // of each block: nothing farther can be seen in it; valid where not `touched_`
    std::vector<uint8_t> touched_;
    Buffers buffers_{};
};

}  // namespace trp
