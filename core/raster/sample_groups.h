// Which samples of a pixel show one surface, so that it is shaded once for them.
#pragma once

#include "raster/draw_list.h"
#include "shading/batch.h"

namespace trp {

// The samples of a block's pixels, each with the key of what it sees: sample s of lane i at keys[s * stride + i].
struct BlockKeys {
    const uint32_t* keys;
    size_t stride;
    uint32_t samples;  // at most 32
};

// For each lane, samples that show one surface.
struct SampleGroup {
    alignas(64) uint32_t key[kBatch];    // of the first of them; kNothing also where there are none
    alignas(64) uint32_t first[kBatch];  // the number of that sample
    alignas(64) Lanes count;             // of the samples
};

class SampleGroups {
  public:
    // `by_face`: a surface is a face; otherwise, smooth neighbours of one material are one too.
    SampleGroups(const DrawList& list, bool by_face) : list_(list), by_face_(by_face) {}

    // Takes the first sample of each lane's `left` (bits by sample) and those that show the same surface. Returns
    // whether any lane has samples left.
    bool take(const BlockKeys& block, uint32_t* left, SampleGroup& out) const;
    // Whether two triangles of different keys are parts of one surface that look alike.
    bool is_one_surface(uint32_t key, uint32_t other) const;

    bool by_face() const { return by_face_; }
    const DrawList& list() const { return list_; }

  private:
    const DrawList& list_;
    bool by_face_;
};

}  // namespace trp
