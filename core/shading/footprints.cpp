#include "shading/footprints.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/footprints.cpp"
#include "hwy/foreach_target.h"

#include "shading/equation-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

void make_footprint_lanes(const FootprintRays& rays, Points& points) {
    const hn::ScalableTag<float> d;
    using V = hn::Vec<decltype(d)>;
    const V one = hn::Set(d, 1.0f), tiny = hn::Set(d, 1e-37f);
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        // Gradients of b1 and b2 in the plane of the triangle, its edges scaled to 1 against underflow.
        Vector3<V> e1 = load3(d, points.edge1, i), e2 = load3(d, points.edge2, i);
        const V scale = hn::Div(one, hn::Max(hn::Max(greatest_component(e1), greatest_component(e2)), tiny));
        e1 = e1 * scale, e2 = e2 * scale;
        const Vector3<V> normal = cross3(e1, e2);
        const V n2 = dot3(normal, normal);
        const V inverse = hn::IfThenElseZero(hn::Gt(n2, hn::Zero(d)), hn::Div(scale, hn::Max(n2, tiny)));
        const Vector3<V> gradient1 = cross3(e2, normal) * inverse, gradient2 = cross3(normal, e1) * inverse;

        const Vector3<V> n = load3(d, points.geometric_normal, i), direction = load3(d, rays.direction, i);
        const V slope = dot3(n, direction);
        const auto steep = hn::Gt(hn::Abs(slope), hn::Set(d, 1e-8f));
        const V along = hn::IfThenElseZero(steep, hn::Div(one, slope));
        const V depth = rays.perspective ? hn::Load(d, points.depth + i) : one;
        auto footprint = [&](int k, const Vec3& step, float* b1, float* b2) {
            // The neighbour's ray moves by `across` at this depth, and on along its direction to the plane again.
            const Vector3<V> across = rays.steps ? load3(d, rays.steps[k], i) : broadcast(d, step) * depth;
            const Vector3<V> moved = across - direction * hn::Mul(dot3(n, across), along);
            hn::Store(dot3(gradient1, moved), d, b1 + i);
            hn::Store(dot3(gradient2, moved), d, b2 + i);
        };
        footprint(0, rays.step_x, points.b1_dx, points.b2_dx);
        footprint(1, rays.step_y, points.b1_dy, points.b2_dy);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(make_footprint_lanes);

void make_footprints(const FootprintRays& rays, Points& points) {
    HWY_DYNAMIC_DISPATCH(make_footprint_lanes)(rays, points);
}

}  // namespace trp
#endif
