#include "film/film.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstdlib>

#include "base/error.h"

namespace trp {

void PassList::add(PassId pass) {
    if (has(pass)) return;
    first_channel_[pass] = channels_;
    channels_ += static_cast<int>(channel_count(pass));
    order_.push_back(pass);
}

void check_window(const Window& window) {
    constexpr uint32_t kGreatestSide = 65536;
    constexpr uint64_t kGreatestPixels = uint64_t{1} << 30;
    if (window.width < 1 || window.height < 1)
        fail(TRP_ERROR_ARGUMENT, "a film of {} x {} pixels has no pixels", window.width, window.height);
    if (window.width > kGreatestSide || window.height > kGreatestSide)
        fail(TRP_ERROR_ARGUMENT, "a film of {} x {} pixels: a side has at most {}", window.width, window.height,
             kGreatestSide);
    if (window.w < 1 || window.h < 1 || window.x + uint64_t{window.w} > window.width ||
        window.y + uint64_t{window.h} > window.height)
        fail(TRP_ERROR_ARGUMENT, "a window of {} x {} pixels at ({}, {}) is not within the film of {} x {}", window.w,
             window.h, window.x, window.y, window.width, window.height);
    if (uint64_t{window.w} * window.h > kGreatestPixels)
        fail(TRP_ERROR_MEMORY, "a window of {} x {} pixels: at most {} pixels can be held; render it in parts",
             window.w, window.h, kGreatestPixels);
}

void Film::Free::operator()(float* p) const {
    std::free(p);
}

Film::Film(const Window& window, const PassList& passes) : window_(window), passes_(passes) {
    check_window(window);
    first_block_x_ = window.x / kBlockSide;
    first_block_y_ = window.y / kBlockSide;
    blocks_across_ = (window.x + window.w - 1) / kBlockSide - first_block_x_ + 1;
    const uint32_t blocks_up = (window.y + window.h - 1) / kBlockSide - first_block_y_ + 1;
    const size_t blocks = size_t{blocks_across_} * blocks_up;
    samples_.assign(blocks, {});
    noise_.resize(blocks);
    // Cleared block by block, by the threads that fill them.
    begun_.assign(blocks, 0);
    const size_t bytes = this->bytes();
    values_.reset(static_cast<float*>(std::aligned_alloc(64, bytes)));
    if (!values_)
        fail(TRP_ERROR_MEMORY, "no memory for a film of {} x {} pixels with {} channels", window.w, window.h,
             passes.channels());
#ifdef __linux__
    // Large pages, where the system has them, make the first touch of a film much cheaper.
    constexpr size_t kPage = 4096;
    char* const first = reinterpret_cast<char*>(values_.get());
    const size_t skipped = (kPage - reinterpret_cast<uintptr_t>(first) % kPage) % kPage;
    if (bytes > (size_t{4} << 20)) madvise(first + skipped, bytes - skipped, MADV_HUGEPAGE);
#endif
}

size_t Film::bytes() const {
    return begun_.size() * kBatch * static_cast<size_t>(passes_.channels()) * sizeof(float);
}

void Film::clear() {
    std::fill(samples_.begin(), samples_.end(), std::array<uint32_t, 16>{});
    for (auto& noise : noise_) noise.reset();
    std::fill(begun_.begin(), begun_.end(), uint8_t{0});
}

uint32_t Film::block_index(uint32_t block_x, uint32_t block_y) const {
    return (block_y - first_block_y_) * blocks_across_ + block_x - first_block_x_;
}

float* Film::values(uint32_t block) const {
    return &values_[size_t{block} * kBatch * static_cast<size_t>(passes_.channels())];
}

BlockSums Film::block(uint32_t block_x, uint32_t block_y) {
    const uint32_t index = block_index(block_x, block_y);
    const BlockSums sums(passes_, values(index));
    if (!begun_[index]) {
        begun_[index] = 1;
        sums.clear();
    }
    return sums;
}

void Film::add_samples(uint32_t block_x, uint32_t block_y, uint32_t samples, uint32_t packets) {
    std::array<uint32_t, 16>& taken = samples_[block_index(block_x, block_y)];
    for (size_t p = 0; p < taken.size(); ++p)
        if (packets >> p & 1) taken[p] += samples;
}

void Film::paint(uint32_t x, uint32_t y, const Vec3& color) {
    const uint32_t block_x = x / kBlockSide, block_y = y / kBlockSide;
    const uint32_t lane = lane_at(x % kBlockSide, y % kBlockSide);
    const auto combined = block(block_x, block_y).combined();
    const auto samples = static_cast<float>(std::max(samples_[block_index(block_x, block_y)][lane >> 4], 1u));
    for (int c = 0; c < 4; ++c) combined[static_cast<size_t>(c)][lane] = samples * (c < 3 ? color[c] : 1);
}

BlockNoise& Film::noise(uint32_t block_x, uint32_t block_y) {
    std::unique_ptr<BlockNoise>& noise = noise_[block_index(block_x, block_y)];
    if (!noise) noise = std::make_unique<BlockNoise>();
    return *noise;
}

void Film::read(PassId pass, uint32_t x, uint32_t y, uint32_t w, uint32_t h, float* out) const {
    const size_t count = channel_count(pass);
    for (uint32_t row = y; row < y + h; ++row)
        for (uint32_t begin = x; begin < x + w;) {
            // The part of the row that lies in one block.
            const uint32_t end = std::min((begin / kBlockSide + 1) * kBlockSide, x + w);
            const uint32_t block = block_index(begin / kBlockSide, row / kBlockSide);
            const float* first = BlockSums(passes_, values(block)).channel(pass, 0);
            for (uint32_t column = begin; column < end; ++column) {
                const uint32_t lane = lane_at(column % kBlockSide, row % kBlockSide);
                const uint32_t samples = samples_[block][lane >> 4];
                const float scale = kPasses[pass].averaged && samples ? 1 / static_cast<float>(samples) : 1;
                for (size_t c = 0; c < count; ++c)
                    *out++ = pass == kSampleCount ? static_cast<float>(samples)
                             : begun_[block]      ? first[c * kBatch + lane] * scale
                                                  : 0.0f;
            }
            begin = end;
        }
}

}  // namespace trp
