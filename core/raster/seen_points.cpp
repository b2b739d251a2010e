#include "raster/seen_points.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/seen_points.cpp"
#include "hwy/foreach_target.h"

#include "film/pixel_random-inl.h"
#include "shading/surface_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

void make_direction_lanes(const View& view, const BlockSamples& samples, LaneVec3& origins, LaneVec3& directions) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        auto px = hn::Zero(du), py = hn::Zero(du);
        pixel_of(d, samples.x / kBlockSide, samples.y / kBlockSide, i, px, py);
        auto place = [&](auto pixel, float offset, float step, float begin) {
            const V at = hn::Add(hn::ConvertTo(d, hn::BitCast(di, pixel)), hn::Set(d, offset));
            return hn::MulAdd(at, hn::Set(d, step), hn::Set(d, begin));
        };
        const V x = place(px, samples.offset_x, view.step_x, view.left),
                y = place(py, samples.offset_y, view.step_y, view.bottom);
        const Vector3<V> eye = broadcast(d, view.position), axis = broadcast(d, -view.z);
        const Vector3<V> across = broadcast(d, view.x) * x + broadcast(d, view.y) * y;
        store3(d, view.perspective ? eye : eye + across, origins, i);
        store3(d, view.perspective ? axis + across : axis, directions, i);
    }
}

void find_point_lanes(const Snapshot& snapshot, const LaneVec3& origins, const LaneVec3& directions, Points& points) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    using VI = hn::Vec<decltype(di)>;
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    auto load = [&](const uint32_t* values) { return hn::Load(di, reinterpret_cast<const int32_t*>(values)); };
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const VI slots = load(points.slot + i), triangles = load(points.triangle + i);
        const Vector3<V> origin = load3(d, origins, i), direction = load3(d, directions, i);
        V b1 = zero, b2 = zero, depth = zero;
        const auto hit = hn::Ne(slots, hn::Set(di, static_cast<int32_t>(kNoSlot)));
        for_each_surface(di, snapshot, slots, hit, [&](const PlacedSurface& surface, auto here) {
            const auto mask = hn::RebindMask(d, here);
            const VI first = hn::Mul(hn::IfThenElseZero(here, triangles), hn::Set(di, 3));
            const Corners<V> c =
                load_corners(d, surface, triangle_vertex(di, surface, first, 0), triangle_vertex(di, surface, first, 1),
                             triangle_vertex(di, surface, first, 2));
            // Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
            const Vector3<V> e1 = c.p1 - c.p0, e2 = c.p2 - c.p0, to_origin = origin - c.p0;
            const Vector3<V> p = cross3(direction, e2), q = cross3(to_origin, e1);
            const V determinant = dot3(e1, p);
            const auto flat = hn::Eq(determinant, zero);
            const V inverse = hn::IfThenZeroElse(flat, hn::Div(one, hn::IfThenElse(flat, one, determinant)));
            b1 = hn::IfThenElse(mask, hn::Mul(dot3(to_origin, p), inverse), b1);
            b2 = hn::IfThenElse(mask, hn::Mul(dot3(direction, q), inverse), b2);
            depth = hn::IfThenElse(mask, hn::Mul(dot3(e2, q), inverse), depth);
        });
        b1 = hn::Min(hn::Max(b1, zero), one);
        b2 = hn::Min(hn::Max(b2, zero), hn::Sub(one, b1));
        hn::Store(b1, d, points.b1 + i);
        hn::Store(b2, d, points.b2 + i);
        hn::Store(depth, d, points.depth + i);
        hn::Store(zero, d, points.time + i);
        const V scale = hn::Div(hn::Set(d, -1.0f), hn::Sqrt(dot3(direction, direction)));
        store3(d, direction * scale, points.to_viewer, i);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(make_direction_lanes);
HWY_EXPORT(find_point_lanes);

void make_directions(const View& view, const BlockSamples& samples, LaneVec3& origins, LaneVec3& directions) {
    HWY_DYNAMIC_DISPATCH(make_direction_lanes)(view, samples, origins, directions);
}

void find_points(const Snapshot& snapshot, const DrawList& list, const uint32_t* keys, const LaneVec3& origins,
                 const LaneVec3& directions, Points& points) {
    for (int i = 0; i < kBatch; ++i) {
        points.slot[i] = kNoSlot;
        points.triangle[i] = 0;
        if (keys[i] == kNothing) continue;
        const DrawnCluster& drawn = list.clusters[keys[i] / Cluster::kMostTriangles];
        const ClusterSet& set = snapshot.surfaces[drawn.slot].surface->clusters();
        points.slot[i] = drawn.slot;
        points.triangle[i] =
            set.triangles[set.clusters[drawn.cluster].first_triangle + keys[i] % Cluster::kMostTriangles];
    }
    HWY_DYNAMIC_DISPATCH(find_point_lanes)(snapshot, origins, directions, points);
}

}  // namespace trp
#endif
