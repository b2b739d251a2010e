#include "raster/line_tile.h"

#include <algorithm>
#include <cmath>

#include "raster/visibility_tile.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/line_tile.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The 16 pixels of a packet whose lower left one is (x, y).
template <bool plain>
HWY_INLINE void draw_packet(const DrawnLine& line, float x, float y, float per_length2, const LineProfile& profile,
                            const DepthCue& cue, const LineTile::Buffers& tile, size_t packet) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::RebindToUnsigned<decltype(d)> du;
    using V = hn::Vec<decltype(d)>;
    const Segment& s = line.segment;
    const V ux = hn::Set(d, s.x[1] - s.x[0]), uy = hn::Set(d, s.y[1] - s.y[0]);
    for (size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
        const auto index = hn::Iota(di, static_cast<int32_t>(lane));
        const V px = hn::Add(hn::ConvertTo(d, hn::And(index, hn::Set(di, 3))), hn::Set(d, x - s.x[0])),
                py = hn::Add(hn::ConvertTo(d, hn::ShiftRight<2>(index)), hn::Set(d, y - s.y[0]));
        // The nearest point of the part.
        const V along = hn::Mul(hn::MulAdd(px, ux, hn::Mul(py, uy)), hn::Set(d, per_length2));
        const V t = hn::Min(hn::Max(along, hn::Set(d, line.begin)), hn::Set(d, line.end));
        const V ex = hn::NegMulAdd(t, ux, px), ey = hn::NegMulAdd(t, uy, py);
        const V distance = hn::Sqrt(hn::MulAdd(ex, ex, hn::Mul(ey, ey)));
        const V place = hn::Min(hn::Mul(distance, hn::Set(d, profile.scale)), hn::Set(d, float{LineProfile::kSteps}));
        const V coverage = hn::GatherIndex(d, profile.coverage.data(), hn::NearestInt(place));
        const size_t at = packet + lane;
        const V before = hn::Load(d, tile.coverage + at);
        if constexpr (plain) {
            hn::Store(hn::Max(before, coverage), d, tile.coverage + at);
            continue;
        }
        const auto covers = hn::Gt(coverage, hn::Zero(d));
        if (hn::AllFalse(d, covers)) continue;
        const V nearness = hn::MulAdd(t, hn::Set(d, s.near[1] - s.near[0]), hn::Set(d, s.near[0]));
        const auto nearer = hn::And(covers, hn::Gt(nearness, hn::Load(d, tile.nearness + at)));
        // What this line adds to the pixel, and what is left of the others.
        const V after = hn::Max(before, coverage);
        const V share = hn::IfThenElse(nearer, coverage, hn::Sub(after, before));
        const V left = hn::IfThenElse(hn::Gt(before, hn::Zero(d)), hn::Div(hn::Sub(after, share), before), hn::Zero(d));
        const V depth = cue.perspective ? hn::Div(hn::Set(d, 1.0f), nearness) : hn::Neg(nearness);
        const V far =
            hn::Mul(hn::Sub(depth, hn::Set(d, cue.near_depth)), hn::Set(d, 1 / (cue.far_depth - cue.near_depth)));
        const V fade = hn::Mul(hn::Set(d, cue.strength), hn::Min(hn::Max(far, hn::Zero(d)), hn::Set(d, 1.0f)));
        for (int c = 0; c < 3; ++c) {
            const V color = hn::MulAdd(fade, hn::Set(d, cue.paper[c] - line.color[c]), hn::Set(d, line.color[c]));
            float* const to = tile.color[c] + at;
            hn::Store(hn::MulAdd(color, share, hn::Mul(hn::Load(d, to), left)), d, to);
        }
        hn::Store(after, d, tile.coverage + at);
        hn::BlendedStore(nearness, nearer, d, tile.nearness + at);
        hn::BlendedStore(hn::Set(du, line.key), hn::RebindMask(du, nearer), du, tile.keys + at);
    }
}

template <bool plain>
void draw_line(const DrawnLine& line, const LineProfile& profile, const DepthCue& cue, const LineTile::Buffers& tile) {
    const Segment& s = line.segment;
    const float ux = s.x[1] - s.x[0], uy = s.y[1] - s.y[0], length2 = ux * ux + uy * uy, r = profile.radius;
    const float per_length2 = length2 > 0 ? 1 / length2 : 0;
    const auto first = [](float at) { return static_cast<int32_t>(std::max(std::ceil(at), 0.0f)); };
    const auto last = [](float at, uint32_t size) {
        return static_cast<int32_t>(std::floor(std::min(at, static_cast<float>(size) - 1)));
    };
    const float ya = s.y[0] + uy * line.begin, yb = s.y[0] + uy * line.end;
    const int32_t begin_j = first(std::min(ya, yb) - r), end_j = last(std::max(ya, yb) + r, tile.height);
    for (int32_t j = begin_j & ~3; j <= end_j; j += 4) {
        // What reaches these four rows.
        float from = line.begin, to = line.end;
        if (std::abs(uy) > 4) {
            const float a = (static_cast<float>(j) - r - s.y[0]) / uy,
                        b = (static_cast<float>(j) + 3 + r - s.y[0]) / uy;
            from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
            if (from > to) continue;
        }
        const float xa = s.x[0] + ux * from, xb = s.x[0] + ux * to;
        const int32_t begin_i = first(std::min(xa, xb) - r), end_i = last(std::max(xa, xb) + r, tile.width);
        for (int32_t i = begin_i & ~3; i <= end_i; i += 4)
            draw_packet<plain>(line, static_cast<float>(i), static_cast<float>(j), per_length2, profile, cue, tile,
                               tile_lane(tile.blocks_across, static_cast<uint32_t>(i), static_cast<uint32_t>(j)));
    }
}

void draw_lines(std::span<const DrawnLine> lines, const LineProfile& profile, const DepthCue& cue,
                const LineTile::Buffers& tile) {
    for (const DrawnLine& line : lines)
        if (tile.keys)
            draw_line<false>(line, profile, cue, tile);
        else
            draw_line<true>(line, profile, cue, tile);
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(draw_lines);

void LineTile::begin(uint32_t blocks_across, uint32_t blocks_up) {
    blocks_across_ = blocks_across;
    blocks_up_ = blocks_up;
    const size_t pixels = size_t{blocks_across} * blocks_up * kBatch;
    if (pixels > room_) {
        room_ = pixels;
        coverage_ = hwy::AllocateAligned<float>(pixels);
        if (!plain_) {
            for (auto& lanes : color_) lanes = hwy::AllocateAligned<float>(pixels);
            nearness_ = hwy::AllocateAligned<float>(pixels);
            keys_ = hwy::AllocateAligned<uint32_t>(pixels);
        }
    }
    std::fill_n(coverage_.get(), pixels, 0.0f);
    if (plain_) return;
    for (auto& lanes : color_) std::fill_n(lanes.get(), pixels, 0.0f);
    std::fill_n(nearness_.get(), pixels, -3e38f);
    std::fill_n(keys_.get(), pixels, kNothing);
}

void LineTile::draw(std::span<const DrawnLine> lines, const LineProfile& profile, const DepthCue& cue) {
    HWY_DYNAMIC_DISPATCH(draw_lines)
    (lines, profile, cue,
     {coverage_.get(),
      {color_[0].get(), color_[1].get(), color_[2].get()},
      nearness_.get(),
      keys_.get(),
      blocks_across_,
      blocks_across_ * kBlockSide,
      blocks_up_ * kBlockSide});
}

}  // namespace trp
#endif
