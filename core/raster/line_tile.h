// The lines of a tile, composited as they are drawn, from near to far.
//
// A pixel that several lines cover in part holds as much of them as the one that covers most of it: lines that meet at
// a vertex do not darken it. Of colours, nearer lines come first, and farther ones get what those leave.
#pragma once

#include <array>
#include <span>

#include "hwy/aligned_allocator.h"
#include "raster/line_profile.h"
#include "raster/segments.h"
#include "shading/batch.h"

namespace trp {

// A segment's part from `begin` to `end`, which go from 0 to 1 along it.
struct DrawnLine {
    Segment segment;
    float begin = 0, end = 1;
    Vec3 color;
    uint32_t key;  // what the passes tell of the nearest line
};

// Lines fade into the paper, from the near depth, where the share of the paper is 0, to the far one.
struct DepthCue {
    float strength = 0, near_depth = 0, far_depth = 1;
    bool perspective = true;  // how nearness tells depth
    Vec3 paper{1, 1, 1};
};

class LineTile {
  public:
    // `plain`: all lines have one colour, which is not kept, and nothing but coverage is.
    explicit LineTile(bool plain) : plain_(plain) {}
    // Makes it a tile of blocks of 16 × 16 pixels, without a line.
    void begin(uint32_t blocks_across, uint32_t blocks_up);
    void draw(std::span<const DrawnLine> lines, const LineProfile& profile, const DepthCue& cue);

    // kBatch lanes of a block, by its place in the tile.
    const float* coverage(size_t block) const { return &coverage_[block * kBatch]; }
    const float* color(int c, size_t block) const { return &color_[c][block * kBatch]; }  // times coverage
    const float* nearness(size_t block) const { return &nearness_[block * kBatch]; }      // of the nearest line
    const uint32_t* keys(size_t block) const { return &keys_[block * kBatch]; }           // kNothing: none

    // For the drawing functions; null pointers where plain.
    struct Buffers {
        float *coverage, *color[3], *nearness;
        uint32_t* keys;
        uint32_t blocks_across, width, height;  // in blocks, and in pixels
    };

  private:
    bool plain_;
    uint32_t blocks_across_ = 0, blocks_up_ = 0;
    size_t room_ = 0;
    template <class T>
    using Lanes = hwy::AlignedFreeUniquePtr<T[]>;
    Lanes<float> coverage_, color_[3], nearness_;
    Lanes<uint32_t> keys_;
};

}  // namespace trp
