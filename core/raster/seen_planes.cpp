#include "raster/seen_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/seen_planes.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMostLanes = HWY_MAX_BYTES / sizeof(float);

// The lanes' numbers, `count` of them, the last one again and again after that.
template <class D>
hn::Vec<D> load_some(D d, const float* values, size_t count) {
    if (count >= hn::Lanes(d)) return hn::LoadU(d, values);
    alignas(64) float padded[kMostLanes];
    for (size_t k = 0; k < hn::Lanes(d); ++k) padded[k] = values[std::min(k, count - 1)];
    return hn::Load(d, padded);
}

template <class D, class M>
uint64_t bits_of(D d, M mask) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    uint64_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    return bits;
}

template <class D>
hn::Mask<D> mask_of(D d, uint64_t bits) {
    uint8_t bytes[8];
    std::memcpy(bytes, &bits, sizeof bytes);
    return hn::LoadMaskBits(d, bytes);
}

// The points from `i`, as many as there are lanes. Single precision moves a point by less than half a step of the grid
// against a triangle as large as the grid, and not at all where both are within some pixels.
uint64_t test_some(SeenPlanes& planes, const SurfacePoints& points, size_t i) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    using VI = hn::Vec<decltype(di)>;
    constexpr float kTouching = 1e-6f;  // relative to the nearness
    constexpr float kPixelsBefore = 4;  // a surface as steep as 70 degrees has it between neighbouring pixels
    constexpr int kShift = std::countr_zero(Cluster::kMostPrimitives);
    SeenPlanes::Lookup look = planes.lookup();
    const size_t count = std::min(points.size() - i, hn::Lanes(d));
    const uint64_t all = (uint64_t{1} << count) - 1;
    const V x = load_some(d, &points.x[i], count), y = load_some(d, &points.y[i], count),
            nearness = load_some(d, &points.nearness[i], count);
    const V limit = hn::MulAdd(hn::Set(d, kTouching), hn::Abs(nearness), nearness);

    // The four pixels, the nearest first, as sums of what columns and rows add to a place (see tile_lane()).
    const auto places = [&](V at, int32_t first, int32_t last, auto&& place, VI out[2]) {
        const V pixels = hn::Mul(at, hn::Set(d, 1.0f / kSubpixels)), low = hn::Floor(pixels);
        const V further = hn::IfThenElseZero(hn::Gt(hn::Sub(pixels, low), hn::Set(d, 0.5f)), hn::Set(d, 1.0f));
        const VI near = hn::ConvertTo(di, hn::Add(low, further)),
                 far = hn::ConvertTo(di, hn::Add(low, hn::Sub(hn::Set(d, 1.0f), further)));
        const auto within = [&](VI pixel) {
            return place(hn::Min(hn::Max(pixel, hn::Set(di, first)), hn::Set(di, last)));
        };
        out[0] = within(near), out[1] = within(far);
    };
    const VI three = hn::Set(di, 3);
    VI columns[2], rows[2], keys[4];
    places(
        x, look.first_x, look.last_x,
        [&](VI at) {
            at = hn::Add(at, hn::Set(di, look.to_x));
            return hn::Add(hn::ShiftLeft<8>(hn::ShiftRight<4>(at)),
                           hn::Add(hn::ShiftLeft<4>(hn::And(hn::ShiftRight<2>(at), three)), hn::And(at, three)));
        },
        columns);
    places(
        y, look.first_y, look.last_y,
        [&](VI at) {
            at = hn::Add(at, hn::Set(di, look.to_y));
            return hn::Add(
                hn::Mul(hn::ShiftLeft<8>(hn::ShiftRight<4>(at)), hn::Set(di, look.blocks_across)),
                hn::Add(hn::ShiftLeft<6>(hn::And(hn::ShiftRight<2>(at), three)), hn::ShiftLeft<2>(hn::And(at, three))));
        },
        rows);
    const auto pixel = [&](int k) { return hn::Add(columns[k & 1], rows[k >> 1]); };
    for (int k = 0; k < 4; ++k) keys[k] = hn::GatherIndex(di, reinterpret_cast<const int32_t*>(look.keys), pixel(k));
    if (points.between_seen) {
        const Projection& projection = planes.projection();
        const V allowed = hn::Set(d, kPixelsBefore * projection.pixel_size());
        const V bound = projection.perspective() ? hn::MulAdd(allowed, nearness, nearness) : hn::Add(allowed, nearness);
        auto clear = hn::FirstN(di, hn::Lanes(d));
        for (int k = 0; k < 4; ++k) {
            const auto nothing = hn::Eq(keys[k], hn::Set(di, static_cast<int32_t>(kNothing)));
            const VI cluster = hn::IfThenZeroElse(nothing, hn::ShiftRight<kShift>(keys[k]));
            const VI slot = hn::GatherIndex(di, reinterpret_cast<const int32_t*>(look.slots),
                                            hn::Mul(cluster, hn::Set(di, sizeof(DrawnCluster) / sizeof(int32_t))));
            const auto own = hn::And(hn::Eq(slot, hn::Set(di, static_cast<int32_t>(points.slot))),
                                     hn::RebindMask(di, hn::Le(hn::GatherIndex(d, look.nearness, pixel(k)), bound)));
            clear = hn::And(clear, hn::Or(nothing, own));
        }
        if (hn::AllTrue(di, clear)) return all;
    }

    uint64_t hidden = 0;
    auto covered = hn::MaskFromVec(hn::Zero(d)), far_behind_nearest = covered;
    for (int k = 0; k < 4; ++k) {
        auto active = hn::Ne(keys[k], hn::Set(di, static_cast<int32_t>(kNothing)));
        for (int other = 0; other < k; ++other) active = hn::AndNot(hn::Eq(keys[k], keys[other]), active);
        if (hn::AllFalse(di, active)) continue;
        const VI key = hn::IfThenElseZero(active, keys[k]);
        const VI cluster = hn::ShiftRight<kShift>(key);
        alignas(64) int32_t all_keys[kMostLanes];
        hn::Store(key, di, all_keys);
        VI place = hn::GatherIndex(di, look.place_of, cluster);
        uint64_t missing = bits_of(di, hn::And(active, hn::Lt(place, hn::Zero(di))));
        if (missing) {
            for (; missing; missing &= missing - 1)
                planes.need(static_cast<uint32_t>(all_keys[std::countr_zero(missing)]));
            look = planes.lookup();
            place = hn::GatherIndex(di, look.place_of, cluster);
        }
        place = hn::Add(hn::Max(place, hn::Zero(di)), hn::And(key, hn::Set(di, Cluster::kMostPrimitives - 1)));
        place = hn::Mul(place, hn::Set(di, sizeof(SeenPlane) / sizeof(float)));
        const auto get = [&](int word) { return hn::GatherIndex(d, look.planes + word, place); };
        const V dx = hn::Sub(x, get(0)), dy = hn::Sub(y, get(1)), near = get(6), near_x = get(7), near_y = get(8);
        const auto here = hn::RebindMask(d, active);
        const V slack = hn::Add(hn::Abs(near_x), hn::Abs(near_y));
        const V at = hn::MulAdd(dx, near_x, hn::MulAdd(dy, near_y, near));
        const auto is_before = [&](float steps) {
            return hn::And(here, hn::Gt(hn::NegMulAdd(hn::Set(d, steps), slack, at), limit));
        };
        auto before = is_before(1), far_before = is_before(kSubpixels);
        uint64_t cut = bits_of(d, hn::And(here, hn::IsNaN(near))) & all;
        if (!cut && hn::AllFalse(d, hn::Or(before, far_behind_nearest))) continue;  // for `far_before` is `before`
        const V x1 = get(2), y1 = get(3), x2 = get(4), y2 = get(5);
        const auto cross = [](V ax, V ay, V bx, V by) { return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx)); };
        const V side1 = cross(dx, dy, x2, y2), side2 = cross(x1, y1, dx, dy),
                side0 = hn::Sub(hn::Sub(cross(x1, y1, x2, y2), side1), side2);
        auto covers = hn::And(here, hn::Gt(hn::Min(side0, hn::Min(side1, side2)), hn::Zero(d)));
        if (cut) {
            alignas(64) float limits[kMostLanes];
            hn::Store(limit, d, limits);
            uint64_t now[3] = {bits_of(d, covers) & ~cut, bits_of(d, before) & ~cut, bits_of(d, far_before) & ~cut};
            for (; cut; cut &= cut - 1) {
                const int m = std::countr_zero(cut);
                const size_t i_m = i + static_cast<size_t>(m);
                const auto by =
                    planes.cover_cut(points.x[i_m], points.y[i_m], limits[m], static_cast<uint32_t>(all_keys[m]));
                now[0] |= uint64_t{by.covers} << m;
                now[1] |= uint64_t{by.is_before} << m;
                now[2] |= uint64_t{by.is_far_before} << m;
            }
            covers = mask_of(d, now[0]), before = mask_of(d, now[1]), far_before = mask_of(d, now[2]);
        }
        if (k == 0) far_behind_nearest = far_before;
        covered = hn::Or(covered, covers);
        for (uint64_t by = bits_of(d, hn::And(covers, before)) & all & ~hidden; by; by &= by - 1) {
            const int m = std::countr_zero(by);
            if (!planes.is_own(points, i + static_cast<size_t>(m), static_cast<uint32_t>(all_keys[m])))
                hidden |= uint64_t{1} << m;
        }
    }
    // What nothing covers, and lies far behind the triangle of the nearest pixel: seen where a pixel shows its face.
    for (uint64_t rest = bits_of(d, hn::AndNot(covered, far_behind_nearest)) & all & ~hidden; rest; rest &= rest - 1) {
        const int m = std::countr_zero(rest);
        bool any = false;
        for (int k = 0; k < 4 && !any; ++k) {
            alignas(64) int32_t all_keys[kMostLanes];
            hn::Store(keys[k], di, all_keys);
            const auto key = static_cast<uint32_t>(all_keys[m]);
            any = key != kNothing && planes.is_own(points, i + static_cast<size_t>(m), key);
        }
        if (!any) hidden |= uint64_t{1} << m;
    }
    return ~hidden & all;
}

void test_lanes(SeenPlanes& planes, const SurfacePoints& points, uint8_t* seen) {
    const hn::ScalableTag<float> d;
    for (size_t i = 0; i < points.size(); i += hn::Lanes(d)) {
        const uint64_t bits = test_some(planes, points, i);
        for (size_t k = 0; k < std::min(hn::Lanes(d), points.size() - i); ++k) seen[i + k] = bits >> k & 1;
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(test_lanes);

namespace {

SeenPlane plane_of(const ClusterVertices& v, const uint8_t corner[3]) {
    const uint8_t first = corner[0];
    uint8_t second = corner[1], third = corner[2];
    const auto x = [&](uint8_t at) { return static_cast<float>(v.x[at] - v.x[first]); };
    const auto y = [&](uint8_t at) { return static_cast<float>(v.y[at] - v.y[first]); };
    double area = double{x(second)} * y(third) - double{y(second)} * x(third);
    if (area < 0) std::swap(second, third), area = -area;
    const float near = v.near[first];
    const double per_area = area > 0 ? 1 / area : 0, near1 = (v.near[second] - near) * per_area,
                 near2 = (v.near[third] - near) * per_area;
    SeenPlane plane{static_cast<float>(v.x[first]),
                    static_cast<float>(v.y[first]),
                    x(second),
                    y(second),
                    x(third),
                    y(third),
                    near,
                    static_cast<float>(near1 * y(third) - near2 * y(second)),
                    static_cast<float>(near2 * x(second) - near1 * x(third))};
    if (area == 0) plane.near = -3e38f;  // seen edge-on it is before nothing
    if (v.is_cut[first] | v.is_cut[second] | v.is_cut[third]) plane.near = std::numeric_limits<float>::quiet_NaN();
    return plane;
}

}  // namespace

SeenPlanes::SeenPlanes(const DrawList& triangles, const Projection& projection)
    : triangles_(triangles), projection_(projection), place_of_(triangles.clusters.size(), -1) {}

void SeenPlanes::begin(const TileReach& tile, const VisibilityTile& visibility) {
    tile_ = tile;
    visibility_ = &visibility;
    for (const uint32_t number : needed_) place_of_[number] = -1;
    needed_.clear();
}

SeenPlanes::Lookup SeenPlanes::lookup() const {
    const auto x0 = static_cast<int32_t>(tile_.x0), y0 = static_cast<int32_t>(tile_.y0);
    return {visibility_->keys(0),
            visibility_->nearness(0),
            static_cast<int32_t>(visibility_->blocks_across()),
            x0 - visibility_->x0(),
            y0 - visibility_->y0(),
            -x0,
            -y0,
            static_cast<int32_t>(projection_.width()) - 1 - x0,
            static_cast<int32_t>(projection_.height()) - 1 - y0,
            triangles_.clusters.empty() ? nullptr : &triangles_.clusters[0].slot,
            place_of_.data(),
            planes_.empty() ? nullptr : &planes_[0].x};
}

void SeenPlanes::need(uint32_t key) {
    const uint32_t number = key / Cluster::kMostPrimitives;
    if (place_of_[number] >= 0) return;
    const size_t first = needed_.size() * Cluster::kMostPrimitives;
    place_of_[number] = static_cast<int32_t>(first);
    needed_.push_back(number);
    if (planes_.size() < first + Cluster::kMostPrimitives) planes_.resize(first + Cluster::kMostPrimitives);

    const PlacedCluster placed = triangles_.placed(triangles_.clusters[number], projection_);
    const Cluster& cluster = placed.cluster();
    ClusterVertices vertices;
    project_vertices(placed, grid_centre(static_cast<int32_t>(tile_.x0)), grid_centre(static_cast<int32_t>(tile_.y0)),
                     vertices);
    for (uint32_t k = 0; k < cluster.count; ++k) {
        uint8_t corner[3];
        for (int m = 0; m < 3; ++m) corner[m] = placed.set.corners[m][cluster.first + k];
        planes_[first + k] = plane_of(vertices, corner);
    }
}

// By homogeneous edge functions, which need no clipping (Olano and Greer, "Triangle Scan Conversion Using 2D
// Homogeneous Coordinates", 1997).
SeenPlanes::Cover SeenPlanes::cover_cut(float x, float y, float limit, uint32_t key) const {
    const PlacedCluster cluster = triangles_.placed(triangles_.clusters[key / Cluster::kMostPrimitives], projection_);
    const double at[3] = {double{x} / kSubpixels + 0.5 + tile_.x0, double{y} / kSubpixels + 0.5 + tile_.y0, 1};
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
    const double sign = determinant < 0 ? -1 : 1, slack = std::abs(steps[0]) + std::abs(steps[1]);
    const auto is_before = [&](int32_t steps_off) {
        return nearness * sign - steps_off * slack > limit * std::abs(determinant);
    };
    return {sides[0] * sign > 0 && sides[1] * sign > 0 && sides[2] * sign > 0, is_before(1), is_before(kSubpixels)};
}

bool SeenPlanes::is_own(const SurfacePoints& points, size_t i, uint32_t key) const {
    const DrawnCluster& drawn = triangles_.clusters[key / Cluster::kMostPrimitives];
    if (drawn.slot != points.slot) return false;
    const ClusterSet& set = *triangles_.sets[drawn.slot];
    const uint32_t triangle = set.primitives[set.clusters[drawn.cluster].first + key % Cluster::kMostPrimitives];
    const PlacedSurface& surface = *triangles_.surfaces[drawn.slot];
    const uint32_t face = surface.face(triangle);
    if (points.owners == SurfacePoints::Owners::edges) {
        const Edge& edge = surface.surface->edges().edges[points.owner[i]];
        return face == edge.faces[0] || face == edge.faces[1];
    }
    // A vertex's triangles have a corner at its place, also where the mesh has several vertices there.
    const SeenPlane& plane =
        planes_[static_cast<size_t>(place_of_[key / Cluster::kMostPrimitives]) + key % Cluster::kMostPrimitives];
    const float dx = points.x[i] - plane.x, dy = points.y[i] - plane.y;
    if ((dx == 0 && dy == 0) || (dx == plane.x1 && dy == plane.y1) || (dx == plane.x2 && dy == plane.y2)) return true;
    const Mesh& mesh = surface.surface->mesh();
    if (mesh.triangles_only()) return false;
    const auto begin = mesh.corner_vertices.begin();
    return std::find(begin + mesh.face_begin(face), begin + mesh.face_end(face), points.owner[i]) !=
           begin + mesh.face_end(face);
}

void SeenPlanes::test(const SurfacePoints& points, std::vector<uint8_t>& seen) {
    seen.resize(points.size());
    HWY_DYNAMIC_DISPATCH(test_lanes)(*this, points, seen.data());
}

}  // namespace trp
#endif
