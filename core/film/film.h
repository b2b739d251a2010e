// The film: samples become pixels here. Methods hand in blocks of 16 × 16 pixels on a grid fixed to the picture.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "film/passes.h"
#include "shading/batch.h"

namespace trp {

inline constexpr uint32_t kBlockSide = 16;

// The lane of a pixel within its block: packets of 16 lanes are 4 × 4 pixels, and so are the 16 packets of a block.
inline uint32_t lane_at(uint32_t x, uint32_t y) {
    return (y >> 2) * 64 + (x >> 2) * 16 + (y & 3) * 4 + (x & 3);
}

// And the pixel of a lane, across and up.
inline std::array<uint32_t, 2> pixel_of_lane(int lane) {
    const auto i = static_cast<uint32_t>(lane);
    return {(i >> 4 & 3) * 4 + (i & 3), (i >> 6) * 4 + (i >> 2 & 3)};
}

// The part of a picture that is rendered; pixels count from the bottom left.
struct Window {
    uint32_t width = 960, height = 540;  // of the whole picture
    uint32_t x = 0, y = 0, w = 960, h = 540;
    bool operator==(const Window&) const = default;
};

// The passes of a render that are asked for, and where their channels lie.
class PassList {
  public:
    PassList() {
        first_channel_.fill(-1);
        add(kCombined);
    }
    void add(PassId pass);
    bool has(PassId pass) const { return first_channel_[pass] >= 0; }
    int first_channel(PassId pass) const { return first_channel_[pass]; }
    int channels() const { return channels_; }
    const std::vector<PassId>& order() const { return order_; }

  private:
    std::array<int, kPassCount> first_channel_;
    int channels_ = 0;
    std::vector<PassId> order_;
};

// The film's memory of one block, into which methods add: for each pass asked for, sums over samples or the first
// sample's values, lane by lane.
class BlockSums {
  public:
    BlockSums() = default;
    BlockSums(const PassList& passes, float* values) : passes_(&passes), values_(values) {}
    const PassList& passes() const { return *passes_; }
    // The lanes of a channel; null where the pass was not asked for.
    float* channel(PassId pass, int c) const {
        return passes_->has(pass) ? values_ + (passes_->first_channel(pass) + c) * kBatch : nullptr;
    }
    // The lanes of Combined, which is always asked for.
    std::array<float*, 4> combined() const {
        return {channel(kCombined, 0), channel(kCombined, 1), channel(kCombined, 2), channel(kCombined, 3)};
    }
    void clear() const { std::fill_n(values_, passes_->channels() * kBatch, 0.0f); }
    // Adds a colour or vector to a pass that was asked for; without effect otherwise.
    void add(PassId pass, int lane, const Vec3& v) const {
        if (float* values = channel(pass, 0))
            for (int c = 0; c < 3; ++c) values[c * kBatch + lane] += v[c];
    }

  private:
    const PassList* passes_ = nullptr;
    float* values_ = nullptr;
};

// What is known of the noise in a block, for adaptive sampling.
struct BlockNoise {
    float squares[4][kBatch] = {};  // of the sums of rounds, colour and alpha, added up
    uint32_t open = 0xFFFF;         // packets that need more samples, a bit to each
    uint32_t edges = 0;             // packets that see an edge
};

class Film {
  public:
    // Throws Error where the picture is empty, or larger than can be held.
    Film(const Window& window, const PassList& passes);

    const Window& window() const { return window_; }
    const PassList& passes() const { return passes_; }
    bool is_for(const Window& window, const PassList& passes) const {
        return window == window_ && passes.order() == passes_.order();
    }
    size_t bytes() const;  // of its values
    // As it was when it was made.
    void clear();
    // The block at grid place (block_x, block_y), cleared when it is first asked for: methods add to it, one thread at
    // a time, and then say how many samples they have added, to which of its packets.
    BlockSums block(uint32_t block_x, uint32_t block_y);
    void add_samples(uint32_t block_x, uint32_t block_y, uint32_t samples, uint32_t packets = 0xFFFF);
    // Makes a pixel of Combined this, opaque, whatever was added before.
    void paint(uint32_t x, uint32_t y, const Vec3& color);
    // Of the block; made when it is first asked for.
    BlockNoise& noise(uint32_t block_x, uint32_t block_y);
    // The pixels of a pass, channels interleaved; sums are divided by the number of samples.
    void read(PassId pass, uint32_t x, uint32_t y, uint32_t w, uint32_t h, float* out) const;

  private:
    uint32_t block_index(uint32_t block_x, uint32_t block_y) const;
    float* values(uint32_t block) const;

    Window window_;
    PassList passes_;
    uint32_t first_block_x_, first_block_y_, blocks_across_;
    std::vector<std::array<uint32_t, 16>> samples_;  // of each packet of each block
    std::vector<std::unique_ptr<BlockNoise>> noise_;
    std::vector<uint8_t> begun_;  // blocks whose memory has been cleared
    struct Free {
        void operator()(float* p) const;
    };
    std::unique_ptr<float[], Free> values_;  // block by block, and channel by channel
};

// Throws Error unless 1 ≤ width, height ≤ 65536, the window lies within, and its pixels can be held.
void check_window(const Window& window);

}  // namespace trp
