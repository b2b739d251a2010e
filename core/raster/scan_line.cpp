#include "raster/scan_line.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace trp {
namespace {

// Calls take(lane, surface, scan line) for all lanes with a slot; neighbours mostly show one face.
template <class Take>
void for_each_lane(const ScanLines& lines, const Points& points, Take&& take) {
    uint32_t slot = kNoSlot, face = 0;
    std::optional<ScanPolygon> polygon;
    for (int i = 0; i < kBatch; ++i) {
        if (points.slot[i] == kNoSlot) continue;
        const PlacedSurface& surface = lines.snapshot.surfaces[points.slot[i]];
        if (!polygon || points.slot[i] != slot || surface.face(points.triangle[i]) != face) {
            slot = points.slot[i];
            face = surface.face(points.triangle[i]);
            polygon.emplace(surface, face, lines.list.transforms[slot], lines.projection);
        }
        const auto [x, y] = pixel_of_lane(i);
        take(i, surface,
             polygon->at(static_cast<double>(lines.samples.x + x) + static_cast<double>(lines.samples.offset_x[i]),
                         static_cast<double>(lines.samples.y + y) + static_cast<double>(lines.samples.offset_y[i])));
    }
}

}  // namespace

void scan_colors(const ScanLines& lines, const SceneColors& colors, const Points& points, LaneVec3& radiance) {
    for (int c = 0; c < 3; ++c) std::fill_n(radiance[c], kBatch, 0.0f);
    for_each_lane(lines, points, [&](int i, const PlacedSurface& surface, const ScanLine& line) {
        const VertexColors& of = colors[points.slot[i]];
        radiance.set(
            i, interpolate(line, [&](uint32_t corner) { return of.at(surface, corner, points.behind[i]); }).value);
    });
}

void scan_normals(const ScanLines& lines, NormalChoice choice, Points& points) {
    for_each_lane(lines, points, [&](int i, const PlacedSurface& surface, const ScanLine& line) {
        const uint32_t face = surface.face(points.triangle[i]);
        bool smooth = true;
        const Vec3 normal = interpolate(line, [&](uint32_t corner) {
                                Vec3 n(0, 0, 0);
                                smooth &= corner_normal(surface, choice, face, corner, n);
                                return n;
                            }).value;
        if (!smooth || normal == Vec3(0, 0, 0)) return;
        points.normal.set(i, normal.normalized() * (points.behind[i] ? -1.0f : 1.0f));
    });
}

bool corner_normal(const PlacedSurface& surface, NormalChoice choice, uint32_t face, uint32_t corner, Vec3& out) {
    const NormalLayer& layer = surface.surface->normals(choice);
    if (layer.domain == NormalLayer::Domain::flat || (surface.face_smooth && !surface.face_smooth[face])) return false;
    const uint32_t element =
        layer.domain == NormalLayer::Domain::corner ? corner : surface.mesh->corner_vertices[corner];
    const Vec3& normal = layer.values[element];
    out = surface.identity ? normal : (surface.world_from_object.normal(normal) * surface.normal_sign).normalized();
    return true;
}

ScanPolygon::ScanPolygon(const PlacedSurface& surface, uint32_t face, const FilmTransform& transform,
                         const Projection& projection) {
    const Mesh& mesh = *surface.mesh;
    std::vector<uint32_t> corners;
    mesh.distinct_corners(face, corners);
    const auto count = static_cast<uint32_t>(corners.size());
    std::vector<FilmPoint> film(count);
    for (uint32_t k = 0; k < count; ++k)
        film[k] = on_film(transform, surface.positions[mesh.corner_vertices[corners[k]]]);
    const auto add = [&](uint32_t corner, uint32_t other, double share, const FilmPoint& q) {
        const double depth = projection.perspective() ? q[2] : 1;
        // On the grid as far as it reaches; beyond, sides must keep their slopes.
        const auto grid = [&](double at) {
            const double pixels = at / depth;
            return std::abs(pixels) < double{kGuardBand} ? std::round(pixels * kSubpixels) / kSubpixels : pixels;
        };
        points_.push_back({corners[corner], corners[other], static_cast<float>(share), grid(q[0]), grid(q[1])});
    };
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t next = k + 1 < count ? k + 1 : 0;
        const FilmPoint &a = film[k], &b = film[next];
        const double at_a = a[2] - projection.clip_start(), at_b = b[2] - projection.clip_start();
        if (at_a >= 0) add(k, k, 0, a);
        if ((at_a >= 0) == (at_b >= 0)) continue;
        const double t = at_a / (at_a - at_b);
        FilmPoint cut;
        for (int r = 0; r < 3; ++r) cut[r] = a[r] + (b[r] - a[r]) * t;
        add(k, next, t, cut);
    }
    // Seen in a pixel, and yet by rounding behind the near plane.
    if (points_.empty()) points_.push_back({corners[0], corners[0], 0, 0, 0});
    for (const PolygonPoint& p : points_) low_ = std::min(low_, p.y), high_ = std::max(high_, p.y);
}

const PolygonPoint& ScanPolygon::nearest(double x, double y) const {
    const PolygonPoint* nearest = nullptr;
    double least = 0;
    for (const PolygonPoint& p : points_) {
        const double distance = std::hypot(p.x - x, p.y - y);
        if (nearest && distance >= least) continue;
        nearest = &p;
        least = distance;
    }
    return *nearest;
}

const ScanPolygon::Row& ScanPolygon::row(double y) {
    const auto known = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.y == y; });
    if (known != rows_.end()) return *known;
    if (rows_.size() < kBlockSide) rows_.emplace_back();
    Row& row = rows_[next_row_];
    next_row_ = (next_row_ + 1) % kBlockSide;
    row.y = y;
    row.crossings.clear();
    for (size_t k = 0; k < points_.size(); ++k) {
        const PolygonPoint *upper = &points_[k], *lower = &points_[k + 1 < points_.size() ? k + 1 : 0];
        if ((upper->y <= y) == (lower->y <= y)) continue;
        if (upper->y < lower->y) std::swap(upper, lower);
        const double share = (y - lower->y) / (upper->y - lower->y);
        row.crossings.push_back({lower->x + (upper->x - lower->x) * share, static_cast<float>(share), upper, lower});
    }
    std::stable_sort(row.crossings.begin(), row.crossings.end(),
                     [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
    return row;
}

ScanLine ScanPolygon::at(double x, double y) {
    ScanLine line;
    // Rounding may have put the point just above or below the polygon; one that is thinner than the grid's step has no
    // scan line, and the value of the nearest point.
    const bool thin = high_ - low_ < 1.0 / kSubpixels;
    static const std::vector<Crossing> kNone;
    const std::vector<Crossing>& crossings =
        thin ? kNone : row(std::clamp(y, low_, high_ - 0.5 / kSubpixels)).crossings;
    if (crossings.size() < 2) {
        std::fill_n(line.ends, 4, nearest(x, y));
        line.alpha = line.beta = 1;
        return line;
    }
    // Concave polygons are crossed more than twice: the span that holds the point, or comes nearest to it.
    size_t best = 0;
    double least = 1e30;
    for (size_t k = 0; k + 1 < crossings.size(); k += 2) {
        const double away = std::max({crossings[k].x - x, x - crossings[k + 1].x, 0.0});
        if (away < least) least = away, best = k;
    }
    const Crossing &a = crossings[best], &b = crossings[best + 1];
    line.ends[0] = *a.upper, line.ends[1] = *a.lower, line.ends[2] = *b.upper, line.ends[3] = *b.lower;
    line.alpha = a.share;
    line.beta = b.share;
    line.gamma = b.x > a.x ? static_cast<float>(std::clamp((x - a.x) / (b.x - a.x), 0.0, 1.0)) : 0.0f;
    return line;
}

}  // namespace trp
