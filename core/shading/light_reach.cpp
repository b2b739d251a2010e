// reached_packets(): lights that cannot matter to points cost next to nothing.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/light_reach.cpp"
#include "hwy/foreach_target.h"

#include "shading/equation-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

uint32_t reached_lanes(const ReadyLight& light, float reach, bool by_shadow_rays, const Points& points) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    using V = hn::Vec<decltype(d)>;
    const bool any_place =
        light.motion.empty() && (light.kind == ReadyLight::Kind::point || light.kind == ReadyLight::Kind::spot ||
                                 light.kind == ReadyLight::Kind::area);
    // A cone that is wider than a half space is not convex, and nothing is kept from it.
    const bool cone = light.kind == ReadyLight::Kind::spot && light.cos_half_angle > 0;
    const float sine = std::sqrt(std::max(1 - light.cos_half_angle * light.cos_half_angle, 0.0f));
    const V extent = hn::Set(d, light.extent()), zero = hn::Zero(d);
    const Vector3<V> centre = broadcast(d, light.position), z = broadcast(d, light.z);
    uint32_t packets = 0;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        auto reached = hn::RebindMask(d, hn::Ne(hn::Load(du, points.slot + i), hn::Set(du, kNoSlot)));
        if (any_place && !hn::AllFalse(d, reached)) {
            const Vector3<V> to_light = centre - load3(d, points.position, i);
            const V distance = hn::Sqrt(dot3(to_light, to_light));
            // Rounding is not to hide what is just seen.
            const V margin = hn::MulAdd(distance, hn::Set(d, 1e-4f), extent);
            reached = hn::And(reached, hn::Le(hn::Sub(distance, extent), hn::Set(d, reach)));
            const auto is_before = [&](const LaneVec3& normal) {
                return hn::Gt(hn::Add(dot3(load3(d, normal, i), to_light), margin), zero);
            };
            reached = hn::And(reached, is_before(points.normal));
            // Without shadows the shading normal alone says what a light reaches.
            if (by_shadow_rays) reached = hn::And(reached, is_before(points.geometric_normal));
            const V height = dot3(to_light, z);  // of the light's plane over the point; it looks along −z
            if (light.kind == ReadyLight::Kind::area) reached = hn::And(reached, hn::Ge(height, zero));
            if (cone) {
                // The distance from the cone, or less.
                const V across = hn::Sqrt(hn::Max(hn::NegMulAdd(height, height, hn::Mul(distance, distance)), zero));
                const V outside =
                    hn::MulSub(across, hn::Set(d, light.cos_half_angle), hn::Mul(height, hn::Set(d, sine)));
                reached = hn::And(reached, hn::Le(outside, hn::MulAdd(distance, hn::Set(d, 1e-3f), extent)));
            }
        }
        if (!hn::AllFalse(d, reached)) packets |= 1u << (i >> 4);
    }
    return packets;
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(reached_lanes);

float ReadyLight::strength() const {
    const float focus = kind == Kind::area && spread_tangent > 0 ? spread_tangent * spread_scale : 1;
    return greatest(emission) * (kind == Kind::area ? area * focus : 1) / std::numbers::pi_v<float>;
}

float ReadyLight::extent() const {
    return kind == Kind::area ? std::hypot(half_size[0], half_size[1]) : radius;
}

uint32_t reached_packets(const ReadyLight& light, int32_t falloff, float least, bool by_shadow_rays,
                         const Points& points) {
    float reach = std::numeric_limits<float>::infinity();
    if (least > 0) {
        // strength / d^k ≤ least
        const float ratio = light.strength() / least;
        const int32_t kind = falloff < 0 ? light.falloff : falloff;
        if (kind == TRP_FALLOFF_PHYSICAL) reach = std::sqrt(ratio);
        if (kind == TRP_FALLOFF_LINEAR) reach = ratio;
        if (kind == TRP_FALLOFF_CONSTANT && ratio < 1) reach = 0;
    }
    return HWY_DYNAMIC_DISPATCH(reached_lanes)(light, reach, by_shadow_rays, points);
}

}  // namespace trp
#endif
