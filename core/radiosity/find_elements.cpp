#include "radiosity/find_elements.h"

#include <bit>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "radiosity/find_elements.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using TriangleOf = Elements::TriangleOf;
static_assert(std::endian::native == std::endian::little && sizeof(TriangleOf) % 4 == 0);  // as the words below

// Down from elements to the leaves where the places (u, v) within them, from 0 to 1, lie.
template <class DI, class VI, class V, class M>
VI find_leaves(DI di, const uint32_t* first_children, VI element, V u, V v, M triangular, M left) {
    const hn::RebindToFloat<DI> d;
    const V half = hn::Set(d, 0.5f);
    const VI none = hn::Set(di, static_cast<int32_t>(kNoElement)), one = hn::Set(di, 1), two = hn::Set(di, 2),
             three = hn::Set(di, 3);
    for (;;) {
        const VI children = hn::GatherIndex(di, reinterpret_cast<const int32_t*>(first_children),
                                            hn::IfThenElseZero(hn::RebindMask(di, left), element));
        left = hn::And(left, hn::RebindMask(d, hn::Ne(children, none)));
        if (hn::AllFalse(d, left)) return element;
        const auto right = hn::RebindMask(di, hn::Ge(u, half)), upper = hn::RebindMask(di, hn::Ge(v, half)),
                   middle = hn::RebindMask(di, hn::Gt(hn::Add(u, v), half)), triangle = hn::RebindMask(di, triangular);
        const VI of_quad = hn::Add(hn::IfThenElseZero(right, one), hn::IfThenElseZero(upper, two));
        const VI of_triangle =
            hn::IfThenElse(right, one, hn::IfThenElse(upper, two, hn::IfThenElseZero(middle, three)));
        const VI child = hn::IfThenElse(triangle, of_triangle, of_quad);
        element = hn::IfThenElse(hn::RebindMask(di, left), hn::Add(children, child), element);
        u = hn::Sub(hn::Add(u, u), hn::ConvertTo(d, hn::And(child, one)));
        v = hn::Sub(hn::Add(v, v), hn::ConvertTo(d, hn::ShiftRight<1>(child)));
        const auto turned = hn::And(triangular, hn::RebindMask(d, hn::Eq(child, three)));
        u = hn::IfThenElse(turned, hn::Neg(u), u);
        v = hn::IfThenElse(turned, hn::Neg(v), v);
    }
}

bool find_lanes(const Elements& elements, const RTCRayHit16& packet, bool eye, uint32_t* out) {
    bool any_goes_on = false;
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    using VI = hn::Vec<decltype(di)>;
    const Elements::Lookup look = elements.lookup();
    const VI none = hn::Set(di, static_cast<int32_t>(kNoElement)), zero = hn::Zero(di), last = hn::Set(di, 1);
    const auto ids = [&](const unsigned* of) { return hn::Load(di, reinterpret_cast<const int32_t*>(of)); };
    for (int i = 0; i < 16; i += static_cast<int>(hn::Lanes(d))) {
        const VI geometry = ids(packet.hit.geomID + i), instance = ids(packet.hit.instID[0] + i);
        const auto met = hn::Ne(geometry, hn::Set(di, static_cast<int32_t>(RTC_INVALID_GEOMETRY_ID)));
        if (hn::AllFalse(di, met)) {
            hn::StoreU(none, di, reinterpret_cast<int32_t*>(out + i));
            continue;
        }
        const VI slot = hn::IfThenElse(hn::Ne(instance, hn::Set(di, static_cast<int32_t>(RTC_INVALID_GEOMETRY_ID))),
                                       instance, geometry);
        const VI first =
            hn::GatherIndex(di, reinterpret_cast<const int32_t*>(look.first_triangles), hn::IfThenElseZero(met, slot));
        const VI triangle = hn::IfThenElseZero(met, hn::Add(first, ids(packet.hit.primID + i)));
        const VI place = hn::Mul(triangle, hn::Set(di, sizeof(TriangleOf) / 4));
        const auto word = [&](size_t offset, VI at) {
            return hn::GatherIndex(di, reinterpret_cast<const int32_t*>(look.triangles) + offset / 4, at);
        };
        const auto number = [&](size_t offset) { return hn::BitCast(d, word(offset, place)); };

        const V towards = hn::MulAdd(
            number(offsetof(TriangleOf, normal)), hn::Load(d, packet.ray.dir_x + i),
            hn::MulAdd(number(offsetof(TriangleOf, normal) + 4), hn::Load(d, packet.ray.dir_y + i),
                       hn::Mul(number(offsetof(TriangleOf, normal) + 8), hn::Load(d, packet.ray.dir_z + i))));
        const VI behind = hn::IfThenElseZero(hn::RebindMask(di, hn::Gt(towards, hn::Zero(d))), last);
        const VI bits = word(offsetof(TriangleOf, corners), place), grid = word(offsetof(TriangleOf, across), place);
        VI element = word(offsetof(TriangleOf, roots), hn::Add(place, behind));
        const auto has = [&](uint32_t flag) {
            return hn::TestBit(bits, hn::Set(di, static_cast<int32_t>(flag << 24)));
        };
        const auto triangular = has(TriangleOf::kTriangle);

        // Each corner of the triangle has the number k of one of the facet; s is 1 at 1 and, of a quad, at 2, and t at
        // 2 and 3.
        const VI of_quad = hn::AndNot(hn::VecFromMask(di, triangular), hn::Set(di, 0x10101));
        const VI at_s = hn::Xor(bits, hn::And(hn::ShiftRight<1>(bits), of_quad)), at_t = hn::ShiftRight<1>(bits);
        const V one = hn::Set(d, 1.0f), b1 = hn::Load(d, packet.hit.u + i), b2 = hn::Load(d, packet.hit.v + i),
                b0 = hn::Sub(hn::Sub(one, b1), b2);
        const auto sum = [&](VI at) {
            const auto share = [&](V b, int32_t bit) {
                return hn::IfThenElseZero(hn::RebindMask(d, hn::TestBit(at, hn::Set(di, bit))), b);
            };
            return hn::Add(hn::Add(share(b0, 1), share(b1, 1 << 8)), share(b2, 1 << 16));
        };
        V s = sum(at_s), t = sum(at_t);
        const auto skewed = has(TriangleOf::kSkewed);
        if (!hn::AllFalse(di, skewed)) {
            // In the sides of the quad p = (a, b), with a = s + g s t and b = t + h s t.
            const V third = sum(hn::AndNot(bits, at_t)), g = number(offsetof(TriangleOf, twist)),
                    h = number(offsetof(TriangleOf, twist) + 4), a = hn::MulAdd(g, third, s),
                    b = hn::MulAdd(h, third, t);
            const V middle = hn::MulAdd(h, a, hn::NegMulAdd(g, b, one));
            const V square = hn::MulAdd(middle, middle, hn::Mul(hn::Set(d, 4.0f), hn::Mul(g, b)));
            const V root = hn::Add(middle, hn::Sqrt(hn::Max(square, hn::Zero(d)))), of_t = hn::Div(hn::Add(b, b), root);
            s = hn::IfThenElse(hn::RebindMask(d, skewed), hn::Div(a, hn::MulAdd(g, of_t, one)), s);
            t = hn::IfThenElse(hn::RebindMask(d, skewed), of_t, t);
        }
        const auto within = [&](V x) { return hn::Min(hn::Max(x, hn::Zero(d)), one); };
        const VI across = hn::And(grid, hn::Set(di, 0xFFFF)),
                 up = hn::And(hn::ShiftRight<16>(grid), hn::Set(di, 0xFFFF));
        V u = hn::Mul(within(s), hn::ConvertTo(d, across)), v = hn::Mul(within(t), hn::ConvertTo(d, up));
        // The cell, and the place within it.
        const VI row = hn::Min(hn::ConvertTo(di, v), hn::Sub(up, last)),
                 left = hn::Sub(up, row);  // in a triangle's row
        const VI column = hn::Min(hn::ConvertTo(di, u), hn::Sub(hn::IfThenElse(triangular, left, across), last));
        u = hn::Sub(u, hn::ConvertTo(d, column));
        v = hn::Sub(v, hn::ConvertTo(d, row));
        const auto turned = hn::And(hn::And(triangular, hn::Lt(hn::Add(column, last), left)),
                                    hn::RebindMask(di, hn::Gt(hn::Add(u, v), one)));
        u = hn::IfThenElse(hn::RebindMask(d, turned), hn::Sub(one, u), u);
        v = hn::IfThenElse(hn::RebindMask(d, turned), hn::Sub(one, v), v);
        const VI before = hn::IfThenElse(triangular, hn::Add(hn::Sub(hn::Mul(up, up), hn::Mul(left, left)), column),
                                         hn::Mul(row, across));
        const VI of_cell = hn::Add(hn::Add(before, column), hn::IfThenElseZero(turned, last));
        const auto exists = hn::And(met, hn::Ne(element, none));
        element = hn::IfThenElse(exists, hn::Add(element, of_cell), none);
        if (look.first_children)
            element = find_leaves(di, look.first_children, element, u, v, hn::RebindMask(d, triangular),
                                  hn::RebindMask(d, exists));
        auto passes = has(TriangleOf::kPass);
        if (eye) passes = hn::Or(passes, hn::And(hn::Ne(behind, zero), has(TriangleOf::kOneSided)));
        const auto goes_on = hn::And(met, passes);
        any_goes_on |= !hn::AllFalse(di, goes_on);
        const VI found = hn::IfThenElse(goes_on, hn::Set(di, static_cast<int32_t>(kGoesOn)), element);
        hn::StoreU(found, di, reinterpret_cast<int32_t*>(out + i));
    }
    return any_goes_on;
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(find_lanes);

bool find_elements(const Elements& elements, const RTCRayHit16& packet, bool eye, uint32_t* out) {
    return HWY_DYNAMIC_DISPATCH(find_lanes)(elements, packet, eye, out);
}

}  // namespace trp
#endif
