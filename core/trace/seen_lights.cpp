#include "trace/seen_lights.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/seen_lights.cpp"
#include "hwy/foreach_target.h"

#include "shading/surface_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

void see_light_lanes(const ReadyLight& light, const BlockRays& rays, SeenLights& seen) {
    const hn::CappedTag<float, 16> d;
    using V = hn::Vec<decltype(d)>;
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), tiny = hn::Set(d, 1e-37f);
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const RTCRay16& ray = rays.packets[i >> 4].ray;
        const int k = i & 15;
        const V time = hn::Load(d, ray.time + k);
        const auto axis = [&](Vec3 LightFrame::*of) {
            return axis_at<decltype(d), V, LightFrame>(d, light, light.motion, of, time);
        };
        const Vector3<V> position =
            vector_at<decltype(d), V, LightFrame>(d, light, light.motion, &LightFrame::position, time);
        const Vector3<V> axis_x = axis(&LightFrame::x), axis_y = axis(&LightFrame::y), axis_z = axis(&LightFrame::z);
        const Vector3<V> direction = load3(d, rays.direction, i);
        const V slope = dot3(direction, axis_z);  // it shines to −z
        const Vector3<V> to_centre = position - load3(d, rays.origin, i);
        const V t = hn::Div(dot3(to_centre, axis_z), hn::Max(slope, tiny));
        const V nearest = hn::Load(d, seen.t + i);
        const V end = hn::IfThenElse(hn::Gt(nearest, zero), nearest, hn::Load(d, ray.tfar + k));
        auto met =
            hn::And(hn::Gt(slope, zero), hn::And(hn::Gt(t, hn::Max(hn::Load(d, ray.tnear + k), zero)), hn::Lt(t, end)));
        if (hn::AllFalse(d, met)) continue;
        const Vector3<V> offset = direction * t - to_centre;
        const V x = hn::Div(dot3(offset, axis_x), hn::Set(d, light.half_size[0])),
                y = hn::Div(dot3(offset, axis_y), hn::Set(d, light.half_size[1]));
        const V radius = light.ellipse ? hn::MulAdd(x, x, hn::Mul(y, y)) : hn::Max(hn::Abs(x), hn::Abs(y));
        met = hn::And(met, hn::Le(radius, one));
        V share = one;
        if (light.spread_tangent > 0) {
            const V cosine = hn::Div(slope, hn::Sqrt(dot3(direction, direction)));
            const V tangent =
                hn::Div(hn::Sqrt(hn::Max(hn::NegMulAdd(cosine, cosine, one), zero)), hn::Max(cosine, tiny));
            share = hn::Mul(hn::Max(hn::Sub(hn::Set(d, light.spread_tangent), tangent), zero),
                            hn::Set(d, light.spread_scale));
        }
        hn::Store(hn::IfThenElse(met, t, nearest), d, seen.t + i);
        const Vector3<V> radiance = broadcast(d, light.emission) * share;
        store3(d, select3(met, radiance, load3(d, seen.radiance, i)), seen.radiance, i);
        const hn::RebindToUnsigned<decltype(d)> du;
        hn::BlendedStore(hn::Set(du, light.group), hn::RebindMask(du, met), du, seen.group + i);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(see_light_lanes);

bool see_area_lights(const LightList& lights, bool by_camera, const BlockRays& rays, const uint8_t* active,
                     SeenLights& seen) {
    std::fill_n(seen.t, kBatch, 0.0f);
    for (const ReadyLight& light : lights)
        if (light.kind == ReadyLight::Kind::area && (!by_camera || light.visible_camera))
            HWY_DYNAMIC_DISPATCH(see_light_lanes)(light, rays, seen);
    bool any = false;
    for (int i = 0; i < kBatch; ++i) {
        if (!active[i]) seen.t[i] = 0;
        any |= seen.t[i] > 0;
    }
    return any;
}

}  // namespace trp
#endif
