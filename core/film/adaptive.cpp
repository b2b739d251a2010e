#include "film/adaptive.h"

#include <algorithm>
#include <cmath>

namespace trp {
namespace {

constexpr uint32_t kRound = 4;          // samples
constexpr uint32_t kEdgesTakeMore = 4;  // times the least number
constexpr float kDarkest = 0.01f;       // radiance below which errors are no longer seen better

// The packets, a bit to each, with a pixel whose standard error is above the threshold. The error is told in proportion
// to the square root of the radiance, about as it is seen.
uint32_t noisy_packets(const BlockSums& sums, const BlockNoise& noise, uint32_t rounds, float threshold) {
    const std::array<float*, 4> rgba = sums.combined();
    const float r = static_cast<float>(rounds);
    uint32_t noisy = 0;
    for (int i = 0; i < kBatch; ++i)
        for (int c = 0; c < 4; ++c) {
            const float sum = rgba[c][i];
            const float variance = std::max(noise.squares[c][i] - sum * sum / r, 0.0f) / (r - 1);  // of a round's sum
            const float error = std::sqrt(variance / r) / kRound, mean = sum / (r * kRound);
            if (!(error <= threshold * std::sqrt(std::max(mean, kDarkest)))) noisy |= 1u << (i >> 4);
        }
    return noisy;
}

// With those beside them, on the block's grid of 4 × 4 packets.
uint32_t with_neighbours(uint32_t packets) {
    constexpr uint32_t kFirstColumn = 0x1111, kLastColumn = 0x8888;
    const uint32_t across = packets | (packets & ~kLastColumn) << 1 | (packets & ~kFirstColumn) >> 1;
    return (across | across << 4 | across >> 4) & 0xFFFF;
}

}  // namespace

void take_samples(const RenderJob& job, const TileWork& work, uint32_t block_x, uint32_t block_y, uint8_t* active,
                  const std::function<uint32_t(uint32_t)>& sample, const std::function<void()>& finish) {
    Film& film = *job.film;
    const AdaptiveSampling& adaptive = job.settings.adaptive;
    if (!(adaptive.threshold > 0)) {
        for (uint32_t s = work.first_sample; s < work.end_sample && !*job.cancelled; ++s) {
            std::fill_n(active, kBatch, uint8_t{1});
            sample(s);
            film.add_samples(block_x, block_y, 1);
        }
        return finish();
    }
    const BlockSums sums = film.block(block_x, block_y);
    const std::array<float*, 4> rgba = sums.combined();
    BlockNoise& noise = film.noise(block_x, block_y);
    float before[4][kBatch];
    for (uint32_t first = work.first_sample; first < work.end_sample && noise.open; first += kRound) {
        const uint32_t end = std::min(first + kRound, work.end_sample);
        for (int c = 0; c < 4; ++c) std::copy_n(rgba[c], kBatch, before[c]);
        for (uint32_t s = first; s < end; ++s) {
            if (*job.cancelled) return;
            for (int i = 0; i < kBatch; ++i) active[i] = noise.open >> (i >> 4) & 1;
            noise.edges |= sample(s);
            film.add_samples(block_x, block_y, 1, noise.open);
        }
        finish();
        if (end - first < kRound) return;
        for (int c = 0; c < 4; ++c)
            for (int i = 0; i < kBatch; ++i) {
                const float of_round = rgba[c][i] - before[c][i];
                noise.squares[c][i] += of_round * of_round;
            }
        if (end < adaptive.least_samples) continue;
        // Packets that are done keep their sums: what is told of them here changes nothing.
        uint32_t open = with_neighbours(noisy_packets(sums, noise, end / kRound, adaptive.threshold) & noise.open);
        if (end < kEdgesTakeMore * adaptive.least_samples) open |= noise.edges;
        noise.open &= open;
    }
}

uint32_t packets_at_edges(const Points& points) {
    constexpr float kSameNormal = 0.9f;
    uint32_t edges = 0;
    for (int i = 0; i < kBatch; ++i) {
        const int first = i & ~15;
        const bool differs =
            points.slot[i] != points.slot[first] ||
            (points.slot[i] != kNoSlot && points.normal.get(i).dot(points.normal.get(first)) < kSameNormal);
        if (differs) edges |= 1u << (i >> 4);
    }
    return edges;
}

}  // namespace trp
