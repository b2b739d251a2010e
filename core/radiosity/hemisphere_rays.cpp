#include "radiosity/hemisphere_rays.h"

#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "radiosity/hemisphere_rays.cpp"
#include "hwy/foreach_target.h"

#include "base/sobol_four-inl.h"
#include "shading/equation-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

// As part_below().
template <class D>
hn::Vec<D> part_below_lanes(D d, hn::Vec<D> at_0, hn::Vec<D> change, hn::Vec<D> u) {
    const auto twice = hn::Mul(hn::Add(u, u), hn::MulAdd(change, hn::Set(d, 0.5f), at_0));
    const auto root = hn::Sqrt(hn::Max(hn::MulAdd(at_0, at_0, hn::Mul(change, twice)), hn::Zero(d)));
    return hn::Div(twice, hn::Max(hn::Add(at_0, root), hn::Set(d, 1e-37f)));
}

// Of a polygon, s and t stand in the place of origins.
void make_hemisphere_lanes(const HemisphereRays::Source& source, uint32_t first, LaneVec3& origins,
                           LaneVec3& directions) {
    const hn::ScalableTag<float> d;
    using V = hn::Vec<decltype(d)>;
    const V one = hn::Set(d, 1.0f);
    const auto set = [&](const Vec3& v) { return broadcast(d, v); };
    const Hemisphere& hemisphere = source.hemisphere;
    for (uint32_t i = 0; i < kBatch; i += static_cast<uint32_t>(hn::Lanes(d))) {
        const auto lane = static_cast<int>(i);
        V u = hn::Zero(d), v = u, s = u, t = u;
        sobol_four(d, source.key, first + i, u, v, s, t);
        const V radius = hn::Sqrt(u), angle = hn::Mul(v, hn::Set(d, 2 * std::numbers::pi_v<float>));
        const Vector3<V> across = set(hemisphere.x) * hn::Mul(radius, hn::Cos(d, angle)),
                         along = add_scaled(across, set(hemisphere.y), hn::Mul(radius, hn::Sin(d, angle)));
        store3(d, add_scaled(along, set(hemisphere.normal), hn::Sqrt(hn::Sub(one, u))), directions, lane);
        if (source.shape == Facet::Shape::polygon) {
            store3(d, Vector3<V>{s, t, t}, origins, lane);
            continue;
        }
        if (source.shape == Facet::Shape::triangle) {
            const V root = hn::Sqrt(s);
            s = hn::Mul(root, hn::Sub(one, t));
            t = hn::Mul(root, t);
        }
        if (source.area.by_s != 0 || source.area.by_t != 0) {
            const V by_s = hn::Set(d, source.area.by_s), by_t = hn::Set(d, source.area.by_t),
                    at_0 = hn::Set(d, source.area.at_0);
            t = part_below_lanes(d, hn::MulAdd(by_s, hn::Set(d, 0.5f), at_0), by_t, t);
            s = part_below_lanes(d, hn::MulAdd(by_t, t, at_0), by_s, s);
        }
        const Vector3<V> point =
            add_scaled(add_scaled(add_scaled(set(source.corner), set(source.sides[0]), s), set(source.sides[1]), t),
                       set(source.twist), hn::Mul(s, t));
        const V off = hn::Mul(hn::Max(greatest_component(point), hn::Set(d, kLeastClearance)), hn::Set(d, kClearance));
        store3(d, add_scaled(point, set(hemisphere.normal), off), origins, lane);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(make_hemisphere_lanes);

Hemisphere::Hemisphere(const Vec3& about) : x(perpendicular_to(about)), y(about.cross(x)), normal(about) {}

Vec3 Hemisphere::direction(float u, float v) const {
    const float r = std::sqrt(u), angle = 2 * std::numbers::pi_v<float> * v;
    return x * (r * std::cos(angle)) + y * (r * std::sin(angle)) + normal * std::sqrt(std::max(1 - u, 0.0f));
}

HemisphereRays::HemisphereRays(const Elements& elements, uint32_t element, uint32_t seed)
    : elements_(elements),
      element_(element),
      source_{Hemisphere(elements.normal(element)), element * 0x9E3779B9u ^ seed * 0x85EBCA6Bu,
              elements.facet_of(element).shape} {
    std::vector<Vec3d> corners;
    elements.corners(element, corners);
    source_.corner = Vec3(corners.front());
    source_.sides[0] = Vec3(corners[1] - corners[0]);
    source_.sides[1] = Vec3(corners.back() - corners[0]);
    if (source_.shape != Facet::Shape::quad) return;
    source_.twist = Vec3(corners[2] - corners[1] - corners[3] + corners[0]);
    if (elements.facet_of(element).skewed) source_.area = area_over(corners, elements.normal(element));
}

void HemisphereRays::make(uint32_t first, LaneVec3& origins, LaneVec3& directions) const {
    HWY_DYNAMIC_DISPATCH(make_hemisphere_lanes)(source_, first, origins, directions);
    if (source_.shape != Facet::Shape::polygon) return;
    for (int lane = 0; lane < kBatch; ++lane) {
        const Vec3 p = elements_.point_in(element_, origins.x[lane], origins.y[lane]);
        origins.set(lane, p + source_.hemisphere.normal * clearance(p));
    }
}

}  // namespace trp
#endif
