#include "radiosity/leaf_lanes.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "radiosity/leaf_lanes.cpp"
#include "hwy/foreach_target.h"

#include "shading/surface_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using MI = hn::Mask<DI>;

VI load_numbers(const uint32_t* numbers) {
    return hn::Load(DI(), reinterpret_cast<const int32_t*>(numbers));
}
VI set_number(uint32_t number) {
    return hn::Set(DI(), static_cast<int32_t>(number));
}
MI is_element(VI number) {
    return hn::Ne(number, set_number(kNoElement));
}

uint64_t bits_of(MI mask) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(DI(), mask, bytes);
    return bytes[0] | uint64_t{bytes[1]} << 8;
}

// Lanes of one facet: an element, and a place in its cell.
struct InCell {
    VI element;
    V u, v;
};

// The coordinates of points of a triangle in its facet, a quad that is no parallelogram; as Elements::coordinates_at().
void coordinates_in_skewed(const Facet& facet, std::span<const Vec3> c, const uint8_t (&corners)[3], const V (&b)[3],
                           InCell& at) {
    const D d;
    const V zero = hn::Zero(d);
    const Vec3 side1 = c[1] - c[0], side2 = c[3] - c[0], side3 = c[2] - c[1] - side2;
    const Vector3<V> e1 = broadcast(d, side1), e2 = broadcast(d, side2), e3 = broadcast(d, side3),
                     normal = broadcast(d, facet.normal);
    Vector3<V> p{zero, zero, zero};
    for (int k = 0; k < 3; ++k) p = add_scaled(p, broadcast(d, c[corners[k]] - c[0]), b[k]);
    const V minus_qa = hn::Set(d, side2.cross(side3).dot(facet.normal)),
            qb = hn::Add(dot3(cross3(p, e3), normal), hn::Set(d, side1.cross(side2).dot(facet.normal))),
            qc = dot3(cross3(p, e1), normal);
    const V discriminant = hn::MulAdd(qb, qb, hn::Mul(hn::Mul(hn::Set(d, 4.0f), minus_qa), qc));
    const V root = hn::Add(qb, hn::CopySign(hn::Sqrt(hn::Max(discriminant, zero)), qb));
    const auto none = hn::Eq(root, zero);
    at.v =
        hn::IfThenZeroElse(none, hn::Div(hn::Mul(hn::Set(d, -2.0f), qc), hn::IfThenElse(none, hn::Set(d, 1.0f), root)));
    const Vector3<V> along = add_scaled(e1, e3, at.v);
    at.u = hn::Div(dot3(p - e2 * at.v, along), hn::Max(dot3(along, along), hn::Set(d, 1e-37f)));
}

// The coordinates of points of a triangle in its facet.
void coordinates(const Elements& elements, const Elements::TriangleOf& of, const V (&b)[3], InCell& at) {
    const D d;
    const Facet& facet = elements.facets()[of.facet];
    const bool quad = facet.shape == Facet::Shape::quad;
    if (facet.skewed)
        coordinates_in_skewed(facet, elements.corners_of(facet), of.corners, b, at);
    else
        for (int k = 0; k < 3; ++k) {
            const int corner = of.corners[k];
            if (corner == 1 || (quad && corner == 2)) at.u = hn::Add(at.u, b[k]);
            if (corner == 2 || (quad && corner == 3)) at.v = hn::Add(at.v, b[k]);
        }
    at.u = hn::Min(hn::Max(at.u, hn::Zero(d)), hn::Set(d, 1.0f));
    at.v = hn::Min(hn::Max(at.v, hn::Zero(d)), hn::Set(d, 1.0f));
}

// From the facet to the root in which the lanes lie, as the roots stand in the grid.
void enter_root(const Facet& facet, InCell& at) {
    const D d;
    const DI di;
    const V one = hn::Set(d, 1.0f);
    const VI last_column = set_number(facet.across - 1), last_row = set_number(facet.up - 1);
    at.u = hn::Mul(at.u, hn::Set(d, static_cast<float>(facet.across)));
    at.v = hn::Mul(at.v, hn::Set(d, static_cast<float>(facet.up)));
    const bool quad = facet.shape == Facet::Shape::quad;
    const VI row = hn::Min(hn::ConvertTo(di, at.v), last_row), left = hn::Sub(set_number(facet.up), row),
             last = quad ? last_column : hn::Sub(left, hn::Set(di, 1)), column = hn::Min(hn::ConvertTo(di, at.u), last);
    at.u = hn::Sub(at.u, hn::ConvertTo(d, column)), at.v = hn::Sub(at.v, hn::ConvertTo(d, row));
    if (quad) {
        at.element = hn::Add(at.element, hn::Add(hn::Mul(row, set_number(facet.across)), column));
        return;
    }
    const auto turned = hn::And(hn::Lt(column, last), hn::RebindMask(di, hn::Gt(hn::Add(at.u, at.v), one)));
    const VI before = hn::Sub(set_number(facet.across * facet.across), hn::Mul(left, left)),
             place = hn::Add(hn::Add(column, column), hn::IfThenElseZero(turned, hn::Set(di, 1)));
    at.element = hn::Add(at.element, hn::Add(before, place));
    const auto mirrored = hn::RebindMask(d, turned);
    at.u = hn::IfThenElse(mirrored, hn::Sub(one, at.u), at.u);
    at.v = hn::IfThenElse(mirrored, hn::Sub(one, at.v), at.v);
}

// From the roots to the leaves, for the lanes `here`.
void enter_leaf(const uint32_t* first_children, bool quad, MI here, InCell& at) {
    const D d;
    const DI di;
    const V half = hn::Set(d, 0.5f);
    const VI one = hn::Set(di, 1), two = hn::Set(di, 2);
    for (;;) {
        const VI first =
            hn::GatherIndex(di, reinterpret_cast<const int32_t*>(first_children), hn::IfThenElseZero(here, at.element));
        here = hn::And(here, is_element(first));
        if (hn::AllFalse(di, here)) return;
        const auto right = hn::RebindMask(di, hn::Ge(at.u, half)), upper = hn::RebindMask(di, hn::Ge(at.v, half));
        VI column = hn::IfThenElseZero(right, one), row = hn::IfThenElseZero(upper, one);
        auto turned = hn::And(right, upper);
        if (!quad) {
            turned = hn::AndNot(hn::Or(right, upper), hn::RebindMask(di, hn::Gt(hn::Add(at.u, at.v), half)));
            column = hn::IfThenElse(turned, one, column);
            row = hn::IfThenElse(turned, one, hn::IfThenZeroElse(right, row));
        }
        const VI child = hn::Add(first, hn::Add(column, hn::Mul(row, two)));
        V u = hn::Sub(hn::Add(at.u, at.u), hn::ConvertTo(d, column)),
          v = hn::Sub(hn::Add(at.v, at.v), hn::ConvertTo(d, row));
        if (!quad) {
            u = hn::IfThenElse(hn::RebindMask(d, turned), hn::Neg(u), u);
            v = hn::IfThenElse(hn::RebindMask(d, turned), hn::Neg(v), v);
        }
        at.element = hn::IfThenElse(here, child, at.element);
        at.u = hn::IfThenElse(hn::RebindMask(d, here), u, at.u);
        at.v = hn::IfThenElse(hn::RebindMask(d, here), v, at.v);
    }
}

void find_leaf_lanes(const Elements& elements, const Points& points, LeafLanes& out) {
    const D d;
    const DI di;
    const hn::Rebind<uint8_t, DI> d8;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const VI slots = load_numbers(points.slot + i), triangles = load_numbers(points.triangle + i);
        const auto behind = hn::Ne(hn::PromoteTo(di, hn::LoadU(d8, points.behind + i)), hn::Zero(di));
        const auto hit = hn::Ne(slots, set_number(kNoSlot));
        const V b1 = hn::Load(d, points.b1 + i), b2 = hn::Load(d, points.b2 + i),
                b[3] = {hn::Sub(hn::Sub(hn::Set(d, 1.0f), b1), b2), b1, b2};
        InCell all{set_number(kNoElement), hn::Zero(d), hn::Zero(d)};
        for_each_number(di, slots, hit, [&](uint32_t slot, MI on_slot) {
            for_each_number(di, triangles, on_slot, [&](uint32_t triangle, MI here) {
                const Elements::TriangleOf& of = elements.of_triangle(slot, triangle);
                if (of.facet == kNoElement) return;
                const Facet& facet = elements.facets()[of.facet];
                InCell at{hn::IfThenElse(behind, set_number(facet.roots[1]), set_number(facet.roots[0])), hn::Zero(d),
                          hn::Zero(d)};
                here = hn::And(here, is_element(at.element));
                if (facet.shape != Facet::Shape::polygon) {
                    coordinates(elements, of, b, at);
                    enter_root(facet, at);
                    enter_leaf(elements.first_children(), facet.shape == Facet::Shape::quad, here, at);
                }
                all.element = hn::IfThenElse(here, at.element, all.element);
                all.u = hn::IfThenElse(hn::RebindMask(d, here), at.u, all.u);
                all.v = hn::IfThenElse(hn::RebindMask(d, here), at.v, all.v);
            });
        });
        hn::Store(all.element, di, reinterpret_cast<int32_t*>(out.leaf) + i);
        hn::Store(all.u, d, out.u + i);
        hn::Store(all.v, d, out.v + i);
    }
}

void interpolate_lanes(const ElementVertices& vertices, const LeafLanes& places, const std::vector<Vec3>& at_vertices,
                       const std::vector<Vec3>& at_leaves, LaneVec3& out) {
    using Way = ElementVertices::Way;
    const D d;
    const DI di;
    const V one = hn::Set(d, 1.0f);
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const VI leaves = load_numbers(places.leaf + i);
        const V u = hn::Load(d, places.u + i), v = hn::Load(d, places.v + i), left = hn::Sub(one, u),
                low = hn::Sub(one, v);
        Vector3<V> all = broadcast(d, Vec3(0, 0, 0));
        MI in_sectors = hn::MaskFromVec(hn::Zero(di));
        for_each_number(di, leaves, is_element(leaves), [&](uint32_t leaf, MI here) {
            const std::span<const uint32_t> loop = vertices.around(leaf);
            const auto at = [&](size_t k) { return broadcast(d, at_vertices[loop[k]]); };
            Vector3<V> value = broadcast(d, at_leaves[leaf]);
            switch (vertices.way(leaf)) {
                case Way::constant:
                    break;
                case Way::linear:
                    value = add_scaled(add_scaled(at(0) * hn::Sub(left, v), at(1), u), at(2), v);
                    break;
                case Way::bilinear:
                    value = add_scaled(add_scaled(at(0) * left, at(1), u) * low, add_scaled(at(3) * left, at(2), u), v);
                    break;
                case Way::triangle_sectors:
                case Way::quad_sectors:
                    in_sectors = hn::Or(in_sectors, here);
                    return;
            }
            all = select3(hn::RebindMask(d, here), value, all);
        });
        store3(d, all, out, i);
        for (uint64_t rest = bits_of(in_sectors); rest; rest &= rest - 1) {
            const int k = i + std::countr_zero(rest);
            out.set(k, vertices.in_sectors(places.leaf[k], places.u[k], places.v[k], at_vertices, at_leaves));
        }
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(find_leaf_lanes);
HWY_EXPORT(interpolate_lanes);

void find_leaves(const Elements& elements, const Points& points, LeafLanes& out) {
    HWY_DYNAMIC_DISPATCH(find_leaf_lanes)(elements, points, out);
}

void interpolate(const ElementVertices& vertices, const LeafLanes& places, const std::vector<Vec3>& at_vertices,
                 const std::vector<Vec3>& at_leaves, LaneVec3& out) {
    HWY_DYNAMIC_DISPATCH(interpolate_lanes)(vertices, places, at_vertices, at_leaves, out);
}

}  // namespace trp
#endif
