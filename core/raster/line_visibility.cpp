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
    const double length = std::max(std::abs(dx), std::abs(dy));
    const double count = std::max(1.0, std::ceil(length / kSpacing));
    const bool whole = !s.is_cut;
    if (count <= kFew) return {count, whole ? 1 : 0, static_cast<int>(count) - 1, whole, false};
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
    if (from > to) return {count, 0, -1, false, false};
    return {count, static_cast<int>(std::max(0.0, std::floor(from * count - 0.5))),
            static_cast<int>(std::min(count - 1, std::ceil(to * count))), false, false};
}

void LineVisibility::need_vertex(const PlacedCluster& cluster, const ClusterVertices& vertices, uint8_t number) {
    if (vertex_place_[number] >= 0) return;
    vertex_place_[number] = static_cast<int16_t>(vertices_.size());
    vertices_.add(static_cast<float>(vertices.x[number]), static_cast<float>(vertices.y[number]), vertices.near[number],
                  cluster.set.vertices[cluster.cluster().first_vertex + number]);
}

void LineVisibility::add_point(const PlacedCluster& cluster, const DrawnLine& line, double at, SurfacePoints& points) {
    const Segment& s = line.segment;
    const auto place = [&](const float(&ends)[2]) { return ends[0] + at * (double{ends[1]} - double{ends[0]}); };
    points.add(static_cast<float>(place(s.x) * kSubpixels), static_cast<float>(place(s.y) * kSubpixels),
               static_cast<float>(place(s.near)), cluster.set.primitives[cluster.cluster().first + s.number]);
}

void LineVisibility::test_lines(const PlacedCluster& cluster, const ClusterVertices& vertices,
                                std::span<const DrawnLine> lines) {
    std::fill_n(vertex_place_, cluster.cluster().vertex_count, int16_t{-1});
    parts_.clear();
    for (const DrawnLine& line : lines) {
        parts_.push_back(parts_of(line.segment));
        if (parts_.back().has_ends)
            for (const uint8_t end : line.segment.ends) need_vertex(cluster, vertices, end);
    }
    planes_.test(vertices_, seen_vertices_);
    for (size_t n = 0; n < lines.size(); ++n) {
        const Parts& parts = parts_[n];
        SurfacePoints& points = ends_are_seen(parts, lines[n]) ? between_ : points_;
        for (int k = parts.first; k <= parts.last; ++k) add_point(cluster, lines[n], parts.place(k), points);
    }
    planes_.test(between_, seen_between_);
    planes_.test(points_, seen_points_);
}

// Where lines change between seen and hidden.
void LineVisibility::find_changes(const PlacedCluster& cluster, std::span<const DrawnLine> lines) {
    changes_.clear();
    const uint8_t *between = seen_between_.data(), *point = seen_points_.data();
    for (size_t n = 0; n < lines.size(); ++n) {
        Parts& parts = parts_[n];
        double at = 0;
        bool last = false;
        const auto next = [&](double place, bool seen) {
            if (seen != last) changes_.push_back({n, at, place, last});
            at = place, last = seen;
        };
        const uint8_t*& tested = ends_are_seen(parts, lines[n]) ? between : point;
        int k = parts.first;
        if (parts.has_ends)
            last = end_is_seen(lines[n], 0);
        else if (k <= parts.last)
            at = parts.place(k++), last = *tested++ != 0;
        parts.first_is_seen = last;
        for (; k <= parts.last; ++k) next(parts.place(k), *tested++ != 0);
        if (parts.has_ends) next(1, end_is_seen(lines[n], 1));
    }
    constexpr int kHalvings = 5;
    for (int halving = 0; halving < kHalvings && !changes_.empty(); ++halving) {
        points_.clear();
        for (const Change& change : changes_)
            add_point(cluster, lines[change.line], (change.low + change.high) / 2, points_);
        planes_.test(points_, seen_points_);
        for (size_t c = 0; c < changes_.size(); ++c) {
            Change& change = changes_[c];
            ((seen_points_[c] != 0) == change.low_is_seen ? change.low : change.high) = (change.low + change.high) / 2;
        }
    }
}

void LineVisibility::split(uint32_t slot, const PlacedCluster& cluster, const ClusterVertices& vertices,
                           std::span<const DrawnLine> lines) {
    for (SurfacePoints* points : {&vertices_, &between_, &points_}) {
        points->clear();
        points->slot = slot;
    }
    test_lines(cluster, vertices, lines);
    find_changes(cluster, lines);

    runs_.clear();
    first_run_.clear();
    auto change = changes_.begin();
    for (size_t n = 0; n < lines.size(); ++n) {
        first_run_.push_back(runs_.size());
        const Parts& parts = parts_[n];
        if (!parts.has_ends && parts.first > parts.last) continue;
        Run run{parts.has_ends ? 0 : static_cast<float>(parts.first / parts.count), 0, parts.first_is_seen};
        for (; change != changes_.end() && change->line == n; ++change) {
            run.end = static_cast<float>((change->low + change->high) / 2);
            runs_.push_back(run);
            run = {run.end, 0, !run.seen};
        }
        run.end = parts.has_ends ? 1 : static_cast<float>((parts.last + 1) / parts.count);
        runs_.push_back(run);
    }
    first_run_.push_back(runs_.size());
}

}  // namespace trp
