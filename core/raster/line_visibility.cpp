#include "raster/line_visibility.h"

#include <algorithm>
#include <cmath>

namespace trp {
namespace {

// Surfaces that touch hide no edge of each other; relative to the depth.
constexpr double kTouching = 1e-6;

}  // namespace

LineVisibility::LineVisibility(const DrawList& triangles, const Projection& projection)
    : triangles_(triangles), projection_(projection), needed_by_(triangles.clusters.size(), nullptr) {}

void LineVisibility::begin(const TileReach& tile, const VisibilityTile& visibility) {
    tile_ = tile;
    visibility_ = &visibility;
    for (const uint32_t number : numbers_) needed_by_[number] = nullptr;
    numbers_.clear();
}

const LineVisibility::Needed& LineVisibility::cluster_of(uint32_t key) {
    const uint32_t number = key / Cluster::kMostPrimitives;
    Needed*& needed = needed_by_[number];
    if (needed) return *needed;
    if (numbers_.size() == memory_.size()) memory_.push_back(std::make_unique<Needed>());
    needed = memory_[numbers_.size()].get();
    numbers_.push_back(number);

    const DrawnCluster& drawn = triangles_.clusters[number];
    const PlacedCluster placed = triangles_.placed(drawn, projection_);
    const Cluster& cluster = placed.cluster();
    ClusterVertices vertices;
    project_vertices(placed, grid_centre(static_cast<int32_t>(tile_.x0)), grid_centre(static_cast<int32_t>(tile_.y0)),
                     vertices);
    needed->slot = drawn.slot;
    needed->primitives = &placed.set.primitives[cluster.first];
    for (uint32_t v = 0; v < cluster.vertex_count; ++v)
        needed->vertices[v] = {static_cast<float>(vertices.x[v]), static_cast<float>(vertices.y[v]), vertices.near[v],
                               vertices.is_cut[v] != 0};
    for (uint32_t k = 0; k < cluster.count; ++k)
        for (int corner = 0; corner < 3; ++corner)
            needed->corners[k][corner] = placed.set.corners[corner][cluster.first + k];
    return *needed;
}

// By homogeneous edge functions, which need no clipping (Olano and Greer, "Triangle Scan Conversion Using 2D
// Homogeneous Coordinates", 1997).
LineVisibility::Cover LineVisibility::cover_cut(const Place& p, uint32_t key) const {
    const PlacedCluster cluster = triangles_.placed(triangles_.clusters[key / Cluster::kMostPrimitives], projection_);
    const double at[3] = {p.x / kSubpixels + 0.5 + tile_.x0, p.y / kSubpixels + 0.5 + tile_.y0, 1};
    FilmPoint q[3];
    double near[3];
    for (int m = 0; m < 3; ++m) {
        q[m] = on_film(cluster.transform, cluster.positions[cluster.vertex(key % Cluster::kMostPrimitives, m)]);
        near[m] = projection_.perspective() ? 1 : -q[m][2];
        if (!projection_.perspective()) q[m][2] = 1;
    }
    double determinant = 0, sides[3], nearness = 0, steps[2] = {0, 0};
    for (int m = 0; m < 3; ++m) {
        const FilmPoint &a = q[(m + 1) % 3], &b = q[(m + 2) % 3];
        sides[m] = 0;
        for (int r = 0; r < 3; ++r) {
            const int s = (r + 1) % 3, t = (r + 2) % 3;
            const double product = a[s] * b[t] - a[t] * b[s];
            sides[m] += product * at[r];
            if (r < 2) steps[r] += product * near[m] / kSubpixels;
            if (m == 0) determinant += product * q[0][r];
        }
        nearness += sides[m] * near[m];
    }
    const double sign = determinant < 0 ? -1 : 1;
    return {sides[0] * sign > 0 && sides[1] * sign > 0 && sides[2] * sign > 0, nearness, determinant,
            std::abs(steps[0]) + std::abs(steps[1])};
}

LineVisibility::Cover LineVisibility::cover(const Place& p, uint32_t key) {
    const Needed& cluster = cluster_of(key);
    const uint8_t* const corners = cluster.corners[key % Cluster::kMostPrimitives];
    double x[3], y[3], near[3];
    bool is_cut = false;
    for (int k = 0; k < 3; ++k) {
        const Needed::Vertex& vertex = cluster.vertices[corners[k]];
        x[k] = vertex.x - p.x;
        y[k] = vertex.y - p.y;
        near[k] = vertex.near;
        is_cut |= vertex.is_cut;
    }
    if (is_cut) return cover_cut(p, key);
    // Edge functions, each of the vertex across from its side.
    const double sides[3] = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
    const bool covers =
        (sides[0] > 0) & (sides[1] > 0) & (sides[2] > 0) || (sides[0] < 0) & (sides[1] < 0) & (sides[2] < 0);
    const double step_x = near[0] * (y[1] - y[2]) + near[1] * (y[2] - y[0]) + near[2] * (y[0] - y[1]),
                 step_y = near[0] * (x[2] - x[1]) + near[1] * (x[0] - x[2]) + near[2] * (x[1] - x[0]);
    return {covers, sides[0] * near[0] + sides[1] * near[1] + sides[2] * near[2], sides[0] + sides[1] + sides[2],
            std::abs(step_x) + std::abs(step_y)};
}

bool LineVisibility::is_own(const Place& p, uint32_t key) {
    const Needed& cluster = cluster_of(key);
    if (cluster.slot != p.slot) return false;
    const uint32_t face = triangles_.surfaces[p.slot]->face(cluster.primitives[key % Cluster::kMostPrimitives]);
    return face == p.faces[0] || face == p.faces[1];
}

bool LineVisibility::sees(const Place& p) {
    const double limit = p.nearness + kTouching * std::abs(p.nearness);
    const double px = p.x / kSubpixels, py = p.y / kSubpixels, left = std::floor(px), low = std::floor(py);
    // The four pixels, the nearest first.
    const int near_x = px - left > 0.5, near_y = py - low > 0.5;
    uint32_t keys[4];
    for (int k = 0; k < 4; ++k) {
        const auto x = static_cast<int32_t>(left) + (near_x ^ (k & 1)) + static_cast<int32_t>(tile_.x0),
                   y = static_cast<int32_t>(low) + (near_y ^ (k >> 1)) + static_cast<int32_t>(tile_.y0);
        keys[k] = visibility_->key_at(std::clamp(x, 0, static_cast<int32_t>(projection_.width()) - 1),
                                      std::clamp(y, 0, static_cast<int32_t>(projection_.height()) - 1));
    }
    bool covered = false, nearest_is_before = false;
    for (int k = 0; k < 4; ++k) {
        if (keys[k] == kNothing || std::find(keys, keys + k, keys[k]) != keys + k) continue;
        const Cover by = cover(p, keys[k]);
        const bool before = by.is_before(limit);
        nearest_is_before |= k == 0 && before;
        if (!by.covers) continue;
        if (before && !is_own(p, keys[k])) return false;
        covered = true;
    }
    if (covered || !nearest_is_before) return true;
    return std::any_of(keys, keys + 4, [&](uint32_t key) { return key != kNothing && is_own(p, key); });
}

void LineVisibility::split(const Segment& s, uint32_t slot, const Edge& edge, std::vector<Run>& runs) {
    runs.clear();
    const double dx = s.x[1] - s.x[0], dy = s.y[1] - s.y[0],
                 dn = static_cast<double>(s.near[1]) - static_cast<double>(s.near[0]);
    const auto sees_at = [&](double t) {
        return sees(
            {(s.x[0] + t * dx) * kSubpixels, (s.y[0] + t * dy) * kSubpixels, s.near[0] + t * dn, slot, edge.faces});
    };
    // Points a pixel and a half apart, whose places do not depend on the tile; those that it may show, and one more.
    const double count = std::max(1.0, std::ceil(std::max(std::abs(dx), std::abs(dy)) / 1.5));
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
    if (from > to) return;
    const auto first = static_cast<int>(std::max(0.0, std::floor(from * count - 0.5))),
               last = static_cast<int>(std::min(count - 1, std::ceil(to * count)));
    Run run{static_cast<float>(first / count), 0, sees_at((first + 0.5) / count)};
    for (int k = first + 1; k <= last; ++k) {
        const bool seen = sees_at((k + 0.5) / count);
        if (seen == run.seen) continue;
        double low = (k - 0.5) / count, high = (k + 0.5) / count;
        for (int halving = 0; halving < 5; ++halving) {
            const double middle = (low + high) / 2;
            (sees_at(middle) == run.seen ? low : high) = middle;
        }
        run.end = static_cast<float>((low + high) / 2);
        runs.push_back(run);
        run = {run.end, 0, seen};
    }
    run.end = static_cast<float>((last + 1) / count);
    runs.push_back(run);
}

}  // namespace trp
