// locate(): from a triangle and barycentrics to position, normals and material.
//
// Positions are interpolated from the triangle's vertices, which bounds their error by a few units in the last place of
// the greatest coordinate (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., sec. 6.8.4) and so gives the
// offset that clears a ray of the surface it leaves at every scale.
#include <algorithm>
#include <cmath>

#include "shading/equation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/points.cpp"
#include "hwy/foreach_target.h"

#include "shading/surface_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

// Vertices of triangles in world space.
template <class V>
struct Corners {
    Vector3<V> p0, p1, p2;
    V greatest;  // a bound of all numbers that were added up for a coordinate
};

// An affine transform of each lane.
template <class V>
struct AffineLanes {
    V rows[3][4];
};

// world_from_object at the lanes' times.
template <class D, class V>
AffineLanes<V> transform_at(D d, const PlacedSurface& surface, V time) {
    AffineLanes<V> out;
    for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 4; ++k) {
            V& entry = out.rows[r][k];
            entry = hn::Set(d, surface.motion.empty() ? surface.world_from_object.rows[r][k] : 0.0f);
            for (size_t step = 0; step < surface.motion.size(); ++step)
                entry = hn::MulAdd(step_weight(d, time, step, surface.motion.size()),
                                   hn::Set(d, surface.motion[step].rows[r][k]), entry);
        }
    return out;
}

// To world space.
template <class D, class V>
void place_corners(D d, const PlacedSurface& surface, V time, Corners<V>& c) {
    AffineLanes<V> m;
    if (!surface.baked) m = transform_at(d, surface, time);
    Vector3<V>* const points[3] = {&c.p0, &c.p1, &c.p2};
    for (Vector3<V>* p : points) {
        if (surface.baked) {
            c.greatest = hn::Max(c.greatest, greatest_component(*p));
            continue;
        }
        V out[3];
        for (int r = 0; r < 3; ++r) {
            const V x = hn::Mul(m.rows[r][0], p->x), y = hn::Mul(m.rows[r][1], p->y), z = hn::Mul(m.rows[r][2], p->z),
                    w = m.rows[r][3];
            out[r] = hn::Add(hn::Add(x, y), hn::Add(z, w));
            const V terms = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Add(hn::Abs(z), hn::Abs(w)));
            c.greatest = hn::Max(c.greatest, terms);
        }
        *p = {out[0], out[1], out[2]};
    }
}

// The cofactor matrix of the surface's transform times n: turns normals, up to length.
template <class D, class V>
Vector3<V> turn_normal(D d, const PlacedSurface& surface, const Vector3<V>& n) {
    const Affine& m = surface.world_from_object;
    const Vec3 x = m.column(0), y = m.column(1), z = m.column(2);
    const float sign = surface.normal_sign;
    return broadcast(d, y.cross(z) * sign) * n.x + broadcast(d, z.cross(x) * sign) * n.y +
           broadcast(d, x.cross(y) * sign) * n.z;
}

template <class V>
Vector3<V> column(const AffineLanes<V>& m, int k) {
    return {m.rows[0][k], m.rows[1][k], m.rows[2][k]};
}

// As turn_normal(), where the surface moves; `sign` as normal_sign_at() gives it.
template <class D, class V>
Vector3<V> turn_normal_at(D d, const PlacedSurface& surface, V time, V sign, const Vector3<V>& n) {
    const AffineLanes<V> m = transform_at(d, surface, time);
    const Vector3<V> x = column(m, 0), y = column(m, 1), z = column(m, 2);
    return (cross3(y, z) * n.x + cross3(z, x) * n.y + cross3(x, y) * n.z) * sign;
}

// −1 where the transform mirrors: one that moves may do so part of the time.
template <class D, class V>
V normal_sign_at(D d, const PlacedSurface& surface, V time) {
    if (surface.motion.empty()) return hn::Set(d, surface.normal_sign);
    const AffineLanes<V> m = transform_at(d, surface, time);
    const V determinant = dot3(column(m, 0), cross3(column(m, 1), column(m, 2)));
    return hn::IfThenElse(hn::Lt(determinant, hn::Zero(d)), hn::Set(d, -1.0f), hn::Set(d, 1.0f));
}

// A vertex at the lanes' times, as positions have it.
template <class D, class V>
Vector3<V> vertex_at(D d, const PlacedSurface& surface, uint32_t vertex, V time) {
    Vector3<V> out = broadcast(d, surface.positions[vertex]) * step_weight(d, time, 0, surface.position_steps);
    for (size_t step = 1; step < surface.position_steps; ++step)
        out = add_scaled(out, broadcast(d, surface.positions[step * surface.mesh->vertex_count + vertex]),
                         step_weight(d, time, step, surface.position_steps));
    return out;
}

// Unit length, times `side`; vectors are scaled before they are squared, so that the smallest keep a length.
template <class D, class V>
Vector3<V> unit(D d, const Vector3<V>& v, V side) {
    const V tiny = hn::Set(d, 1e-37f);
    const Vector3<V> scaled = v * hn::Div(hn::Set(d, 1.0f), hn::Max(greatest_component(v), tiny));
    return scaled * hn::Div(side, hn::Sqrt(hn::Max(dot3(scaled, scaled), tiny)));
}

// Where the ray meets the triangle's plane (Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection",
// 1997).
template <class V>
struct Meeting {
    V b1, b2, depth;
};

template <class D, class V>
Meeting<V> meet(D d, const Vector3<V>& origin, const Vector3<V>& direction, const Vector3<V>& p0, const Vector3<V>& e1,
                const Vector3<V>& e2) {
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Vector3<V> from = origin - p0, p = cross3(direction, e2), q = cross3(from, e1);
    const V determinant = dot3(e1, p);
    const auto flat = hn::Eq(determinant, zero);
    const V inverse = hn::IfThenZeroElse(flat, hn::Div(one, hn::IfThenElse(flat, one, determinant)));
    const V b1 = hn::Min(hn::Max(hn::Mul(dot3(from, p), inverse), zero), one);
    const V b2 = hn::Min(hn::Max(hn::Mul(dot3(direction, q), inverse), zero), hn::Sub(one, b1));
    return {b1, b2, hn::Mul(dot3(e2, q), inverse)};
}

// `from`: null where the lanes' barycentrics are known.
void locate_lanes(const Snapshot& snapshot, NormalChoice choice, Side seen_side, const SeenFrom* from, Points& points) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    using VI = hn::Vec<decltype(di)>;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    auto load = [&](const uint32_t* values) { return hn::Load(di, reinterpret_cast<const int32_t*>(values)); };
    uint8_t flags = 0;
    for (int i = 0; i < kBatch; i += lanes) {
        const VI slots = load(points.slot + i), triangles = load(points.triangle + i);
        const auto hit = hn::Ne(slots, hn::Set(di, static_cast<int32_t>(kNoSlot)));
        V b1 = zero, b2 = zero, depth = zero;
        const V time = from ? zero : hn::Load(d, points.time + i);
        Vector3<V> origin{zero, zero, zero}, direction = origin;
        if (from) {
            origin = from->origins ? load3(d, *from->origins, i) : broadcast(d, from->eye);
            direction = load3(d, from->directions, i);
            const V scale = hn::Div(hn::Neg(one), hn::Sqrt(dot3(direction, direction)));
            store3(d, direction * scale, points.to_viewer, i);
        } else {
            b1 = hn::Load(d, points.b1 + i), b2 = hn::Load(d, points.b2 + i);
        }
        const Vector3<V> none{zero, zero, zero};
        Vector3<V> position = none, edge1 = none, edge2 = none, geometric{zero, zero, one}, normal = geometric;
        V greatest = zero;
        hn::Store(hn::Zero(di), di, reinterpret_cast<int32_t*>(points.material) + i);

        for_each_surface(di, snapshot, slots, hit, [&](const PlacedSurface& surface, auto here) {
            const auto mask = hn::RebindMask(d, here);
            const NormalLayer& layer = surface.surface->normals(choice);
            Corners<V> c{none, none, none, zero}, rest = c;
            const bool bends = surface.mesh->time_count > 1;
            Vector3<V> n0 = none, n1 = none, n2 = none;
            auto smooth = hn::MaskFromVec(zero);
            for_each_number(di, triangles, here, [&](uint32_t triangle, auto these) {
                const auto lanes_of = hn::RebindMask(d, these);
                const uint32_t* const v = surface.vertices + 3 * size_t{triangle};
                Vector3<V>* const corners[3] = {&c.p0, &c.p1, &c.p2};
                for (int k = 0; k < 3; ++k)
                    *corners[k] = select3(lanes_of,
                                          surface.position_steps == 1 ? broadcast(d, surface.positions[v[k]])
                                                                      : vertex_at(d, surface, v[k], time),
                                          *corners[k]);
                Vector3<V>* const rest_corners[3] = {&rest.p0, &rest.p1, &rest.p2};
                for (int k = 0; k < 3 && bends; ++k)
                    *rest_corners[k] = select3(lanes_of, broadcast(d, surface.positions[v[k]]), *rest_corners[k]);
                const uint32_t material = surface.material(triangle);
                hn::BlendedStore(hn::Set(di, static_cast<int32_t>(material)), these, di,
                                 reinterpret_cast<int32_t*>(points.material) + i);
                flags |= snapshot.material_flags[material];
                if (layer.domain == NormalLayer::Domain::flat ||
                    (surface.face_smooth && !surface.face_smooth[surface.face(triangle)]))
                    return;
                smooth = hn::Or(smooth, lanes_of);
                const bool by_vertex = layer.domain == NormalLayer::Domain::vertex;
                auto normal_of = [&](int k) {
                    return broadcast(d, layer.values[by_vertex ? v[k] : surface.corner(triangle, k)]);
                };
                n0 = select3(lanes_of, normal_of(0), n0);
                n1 = select3(lanes_of, normal_of(1), n1);
                n2 = select3(lanes_of, normal_of(2), n2);
            });
            // Where a mesh bends, its normals, which are of the first time sample, follow the faces.
            const V sign = normal_sign_at(d, surface, time);
            Vector3<V> bend = none;
            if (bends)
                bend = unit(d, cross3(c.p1 - c.p0, c.p2 - c.p0), surface.baked ? sign : one) -
                       unit(d, cross3(rest.p1 - rest.p0, rest.p2 - rest.p0),
                            surface.baked ? hn::Set(d, surface.normal_sign) : one);
            place_corners(d, surface, time, c);
            const Vector3<V> e1 = c.p1 - c.p0, e2 = c.p2 - c.p0;
            if (from) {
                const Meeting<V> at = meet(d, origin, direction, c.p0, e1, e2);
                b1 = hn::IfThenElse(mask, at.b1, b1);
                b2 = hn::IfThenElse(mask, at.b2, b2);
                depth = hn::IfThenElse(mask, at.depth, depth);
            }
            position = select3(mask, add_scaled(add_scaled(c.p0, e1, b1), e2, b2), position);
            edge1 = select3(mask, e1, edge1);
            edge2 = select3(mask, e2, edge2);
            greatest = hn::IfThenElse(mask, c.greatest, greatest);
            const Vector3<V> plane = cross3(e1, e2) * sign;
            geometric = select3(mask, plane, geometric);

            Vector3<V> shading = plane;
            if (!hn::AllFalse(d, smooth)) {
                Vector3<V> n = add_scaled(add_scaled(n0, n1 - n0, b1), n2 - n0, b2);
                if (bends && !surface.baked) n = unit(d, n, one) + bend;
                if (!surface.identity)
                    n = surface.motion.empty() || (bends && surface.baked) ? turn_normal(d, surface, n)
                                                                           : turn_normal_at(d, surface, time, sign, n);
                if (bends && surface.baked) n = unit(d, n, one) + bend;
                shading = select3(smooth, n, plane);
            }
            normal = select3(mask, shading, normal);
        });

        if (from) {
            hn::Store(b1, d, points.b1 + i);
            hn::Store(b2, d, points.b2 + i);
            hn::Store(depth, d, points.depth + i);
            hn::Store(zero, d, points.time + i);
        }
        const V facing = seen_side == Side::seen    ? dot3(geometric, load3(d, points.to_viewer, i))
                         : seen_side == Side::front ? one
                                                    : hn::Neg(one);
        const auto behind = hn::Lt(facing, zero);
        const V side = hn::IfThenElse(behind, hn::Neg(one), one);
        store3(d, position, points.position, i);
        store3(d, edge1, points.edge1, i);
        store3(d, edge2, points.edge2, i);
        store3(d, unit(d, geometric, side), points.geometric_normal, i);
        store3(d, unit(d, normal, side), points.normal, i);
        hn::Store(hn::Mul(greatest, hn::Set(d, 0x1p-19f)), d, points.offset + i);
        alignas(64) float is_behind[HWY_MAX_BYTES / sizeof(float)];
        hn::Store(hn::IfThenElseZero(behind, one), d, is_behind);
        for (int k = 0; k < lanes; ++k) points.behind[i + k] = is_behind[k] != 0;
    }
    points.any_program = flags & kHasProgram;
    points.any_holes = flags & kMayHaveHoles;
    points.any_transmission = flags & kTransmits;
    points.any_mirror = flags & kMirrors;
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(locate_lanes);

void locate(const Snapshot& snapshot, NormalChoice choice, Points& points, Side side) {
    HWY_DYNAMIC_DISPATCH(locate_lanes)(snapshot, choice, side, nullptr, points);
}

void locate_seen(const Snapshot& snapshot, NormalChoice choice, const SeenFrom& from, Points& points) {
    HWY_DYNAMIC_DISPATCH(locate_lanes)(snapshot, choice, Side::seen, &from, points);
}

}  // namespace trp
#endif
