#include "raster/line_visibility.h"

#include <algorithm>
#include <cmath>

namespace trp {
namespace {

constexpr uint32_t kOccluders = 1024;
constexpr double kGrid = 1.0 / kSubpixels;
// Surfaces that touch hide no edge of each other; relative to the depth.
constexpr double kTouching = 1e-5;

double dot(const double (&a)[3], double x, double y) {
    return a[0] * x + a[1] * y + a[2];
}

}  // namespace

LineVisibility::LineVisibility(const DrawList& list, const Projection& projection)
    : list_(list), projection_(projection), occluders_(kOccluders) {}

bool LineVisibility::Occluder::covers(double x, double y) const {
    return dot(sides[0], x, y) > kGrid && dot(sides[1], x, y) > kGrid && dot(sides[2], x, y) > kGrid;
}

// By homogeneous edge functions, which need no clipping (Olano and Greer, "Triangle Scan Conversion Using 2D
// Homogeneous Coordinates", 1997).
const LineVisibility::Occluder& LineVisibility::occluder(uint32_t key) {
    Occluder& out = occluders_[key % kOccluders];
    if (out.key == key) return out;
    const DrawnCluster& drawn = list_.clusters[key / Cluster::kMostPrimitives];
    const PlacedCluster cluster = list_.placed(drawn, projection_);
    const uint32_t k = key % Cluster::kMostPrimitives;
    const PlacedSurface& surface = *list_.surfaces[drawn.slot];
    out.key = key;
    out.slot = drawn.slot;
    out.face = surface.face(cluster.set.primitives[cluster.cluster().first + k]);
    FilmPoint q[3];
    double near[3];
    for (int m = 0; m < 3; ++m) {
        q[m] = on_film(cluster.transform, cluster.positions[cluster.vertex(k, m)]);
        near[m] = projection_.perspective() ? 1 : -q[m][2];
        if (!projection_.perspective()) q[m][2] = 1;
    }
    double determinant = 0;
    for (int m = 0; m < 3; ++m) {
        const FilmPoint &a = q[(m + 1) % 3], &b = q[(m + 2) % 3];
        for (int r = 0; r < 3; ++r) {
            const int s = (r + 1) % 3, t = (r + 2) % 3;
            out.sides[m][r] = a[s] * b[t] - a[t] * b[s];
        }
        if (m == 0)
            for (int r = 0; r < 3; ++r) determinant += out.sides[0][r] * q[0][r];
    }
    for (int r = 0; r < 3; ++r) {
        out.nearness[r] = 0;
        for (int m = 0; m < 3 && determinant != 0; ++m) out.nearness[r] += out.sides[m][r] * near[m] / determinant;
    }
    for (auto& side : out.sides) {
        const double length = std::hypot(side[0], side[1]) * (determinant < 0 ? -1 : 1);
        for (double& value : side) value = determinant != 0 && length != 0 ? value / length : -1;
    }
    return out;
}

bool LineVisibility::sees(const Place& p, const VisibilityTile& visibility) {
    const double limit = p.nearness + kTouching * std::abs(p.nearness);
    const auto left = static_cast<int32_t>(std::floor(p.x - 0.5)), low = static_cast<int32_t>(std::floor(p.y - 0.5));
    bool proven = false;
    uint32_t nearest = kNothing, last = kNothing;
    double least = 1e30;
    for (int k = 0; k < 4; ++k) {
        const int32_t x = left + (k & 1), y = low + (k >> 1);
        if (x < 0 || y < 0 || x >= static_cast<int32_t>(projection_.width()) ||
            y >= static_cast<int32_t>(projection_.height()))
            continue;
        const uint32_t key = visibility.key_at(x, y);
        const double dx = x + 0.5 - p.x, dy = y + 0.5 - p.y, distance2 = dx * dx + dy * dy;
        if (distance2 < least) {
            least = distance2;
            nearest = key;
        }
        if (key == kNothing || key == last) continue;
        last = key;
        const Occluder& o = occluder(key);
        if (o.slot == p.slot && (o.face == p.faces[0] || o.face == p.faces[1])) {
            proven = true;
        } else if (o.covers(p.x, p.y)) {
            if (o.nearness_at(p.x, p.y) > limit) return false;
            proven = true;
        }
    }
    return proven || nearest == kNothing || !(occluder(nearest).nearness_at(p.x, p.y) > limit);
}

void LineVisibility::split(const Segment& s, uint32_t slot, const Edge& edge, const TileReach& tile,
                           const VisibilityTile& visibility, std::vector<Run>& runs) {
    runs.clear();
    const double x0 = s.x[0] + 0.5 + tile.x0, y0 = s.y[0] + 0.5 + tile.y0, dx = s.x[1] - s.x[0], dy = s.y[1] - s.y[0],
                 dn = static_cast<double>(s.near[1]) - static_cast<double>(s.near[0]);
    const auto sees_at = [&](double t) {
        return sees({x0 + t * dx, y0 + t * dy, s.near[0] + t * dn, slot, edge.faces}, visibility);
    };
    // Points a pixel apart, whose places do not depend on the tile; those that it may show, and one more.
    const double count = std::max(1.0, std::ceil(std::max(std::abs(dx), std::abs(dy))));
    double from = 0, to = 1;
    const auto clip = [&](double begin, double step, double size) {
        const double low = -tile.reach, high = size - 1 + tile.reach;
        if (std::abs(step) < 1e-6) return;
        const double a = (low - begin) / step, b = (high - begin) / step;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    };
    clip(s.x[0], dx, tile.width);
    clip(s.y[0], dy, tile.height);
    if (from > to) return;
    const double first = std::max(0.0, std::floor(from * count - 0.5)),
                 last = std::min(count - 1, std::ceil(to * count));
    Run run{static_cast<float>(first / count), 0, sees_at((first + 0.5) / count)};
    for (double k = first + 1; k <= last; ++k) {
        const bool seen = sees_at((k + 0.5) / count);
        if (seen == run.seen) continue;
        double low = (k - 0.5) / count, high = (k + 0.5) / count;
        for (int halving = 0; halving < 6; ++halving) {
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
