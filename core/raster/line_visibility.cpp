#include "raster/line_visibility.h"

#include <algorithm>
#include <cmath>

namespace trp {

void LineVisibility::begin(const TileReach& tile, const VisibilityTile& visibility) {
    tile_ = tile;
    planes_.begin(tile, visibility);
}

// Points a pixel and a half apart, whose places do not depend on the tile; those that it may show, and one more.
LineVisibility::Parts LineVisibility::parts_of(const Segment& s) const {
    constexpr double kSpacing = 1.5, kFew = 4;
    const double dx = s.x[1] - s.x[0], dy = s.y[1] - s.y[0];
    const double count = std::max(1.0, std::ceil(std::max(std::abs(dx), std::abs(dy)) / kSpacing));
    if (count <= kFew) return {count, 0, static_cast<int>(count) - 1};
    double from = 0, to = 1;
    const auto clip = [&](double begin, double step, double size) {
        const double low = -tile_.reach, high = size - 1 + tile_.reach;
        if (std::abs(step) < 1e-6) {
            if (begin < low || begin > high) from = 2;
            return;
        }
        const double a = (low - begin) / step, b = (high - begin) / step;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    };
    clip(s.x[0], dx, tile_.width);
    clip(s.y[0], dy, tile_.height);
    if (from > to) return {count, 0, -1};
    return {count, static_cast<int>(std::max(0.0, std::floor(from * count - 0.5))),
            static_cast<int>(std::min(count - 1, std::ceil(to * count)))};
}

void LineVisibility::add_point(const Line& line, double at) {
    const Segment& s = *line.segment;
    const auto place = [&](const float(&ends)[2]) { return ends[0] + at * (double{ends[1]} - double{ends[0]}); };
    points_.x.push_back(place(s.x) * kSubpixels);
    points_.y.push_back(place(s.y) * kSubpixels);
    points_.nearness.push_back(place(s.near));
    points_.edges.push_back(line.edge);
}

void LineVisibility::split(uint32_t slot, std::span<const Line> lines) {
    points_.slot = slot;
    points_.clear();
    parts_.clear();
    for (const Line& line : lines) {
        const Parts parts = parts_of(*line.segment);
        parts_.push_back(parts);
        for (int k = parts.first; k <= parts.last; ++k) add_point(line, (k + 0.5) / parts.count);
    }
    planes_.test(points_, seen_);

    changes_.clear();
    const uint8_t* seen = seen_.data();
    for (size_t n = 0; n < lines.size(); ++n) {
        const Parts& parts = parts_[n];
        for (int k = parts.first + 1; k <= parts.last; ++k)
            if (seen[k - parts.first] != seen[k - parts.first - 1])
                changes_.push_back(
                    {n, (k - 0.5) / parts.count, (k + 0.5) / parts.count, seen[k - parts.first - 1] != 0});
        seen += parts.last - parts.first + 1;
    }
    constexpr int kHalvings = 5;
    for (int halving = 0; halving < kHalvings && !changes_.empty(); ++halving) {
        points_.clear();
        for (const Change& change : changes_) add_point(lines[change.line], (change.low + change.high) / 2);
        planes_.test(points_, seen_between_);
        for (size_t c = 0; c < changes_.size(); ++c) {
            Change& change = changes_[c];
            ((seen_between_[c] != 0) == change.low_is_seen ? change.low : change.high) = (change.low + change.high) / 2;
        }
    }

    runs_.clear();
    first_run_.clear();
    seen = seen_.data();
    auto change = changes_.begin();
    for (size_t n = 0; n < lines.size(); ++n) {
        first_run_.push_back(runs_.size());
        const Parts& parts = parts_[n];
        if (parts.first > parts.last) continue;
        Run run{static_cast<float>(parts.first / parts.count), 0, seen[0] != 0};
        for (; change != changes_.end() && change->line == n; ++change) {
            run.end = static_cast<float>((change->low + change->high) / 2);
            runs_.push_back(run);
            run = {run.end, 0, !run.seen};
        }
        run.end = static_cast<float>((parts.last + 1) / parts.count);
        runs_.push_back(run);
        seen += parts.last - parts.first + 1;
    }
    first_run_.push_back(runs_.size());
}

}  // namespace trp
