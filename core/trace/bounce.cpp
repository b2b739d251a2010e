#include "trace/bounce.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/bounce.cpp"
#include "hwy/foreach_target.h"

#include "shading/equation-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

// Fresnel's reflectance of a surface, by the cosines on both sides.
template <class D, class V>
V fresnel(D d, V eta, V cos_here, V cos_there) {
    const V across = hn::Div(hn::MulSub(eta, cos_here, cos_there), hn::MulAdd(eta, cos_here, cos_there));
    const V along = hn::Div(hn::NegMulAdd(eta, cos_there, cos_here), hn::MulAdd(eta, cos_there, cos_here));
    return hn::Mul(hn::Set(d, 0.5f), hn::MulAdd(across, across, hn::Mul(along, along)));
}

// Rounding is not to add up along a path.
template <class D, class V>
V inverse_length(D d, const Vector3<V>& v) {
    return hn::Div(hn::Set(d, 1.0f), hn::Sqrt(hn::Max(dot3(v, v), hn::Set(d, 1e-30f))));
}

void find_bounce_lanes(const Points& points, const Coefficients& coefficients, Bounces& out) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::Rebind<uint8_t, decltype(di)> d8;
    using V = hn::Vec<decltype(d)>;
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const auto seen =
            hn::RebindMask(d, hn::Ne(hn::Load(di, reinterpret_cast<const int32_t*>(points.slot) + i), hn::Set(di, -1)));
        const auto flags = hn::PromoteTo(di, hn::LoadU(d8, out.flags + i));
        const auto has = [&](int32_t flag) {
            return hn::RebindMask(d, hn::Ne(hn::And(flags, hn::Set(di, flag)), hn::Zero(di)));
        };
        const auto thin = has(kThin), by_fresnel = has(kFresnel);
        const Vector3<V> v = load3(d, points.to_viewer, i), g = load3(d, points.geometric_normal, i);
        // A shading normal that is turned away from the viewer is not used.
        const Vector3<V> shading = load3(d, points.normal, i);
        const Vector3<V> n = select3(hn::Gt(dot3(shading, v), zero), shading, g);
        const V cosine = hn::Min(hn::Max(dot3(n, v), zero), one);
        const Vector3<V> back = v * hn::Neg(one);
        Vector3<V> mirror = add_scaled(back, n, hn::Mul(two, cosine));
        // Nor are reflections into the surface.
        const V away = hn::Max(dot3(g, v), zero);
        mirror = select3(hn::Gt(dot3(g, mirror), zero), mirror, add_scaled(back, g, hn::Mul(two, away)));

        const V eta = hn::IfThenElse(thin, hn::Div(one, hn::Load(d, coefficients.ior + i)), hn::Load(d, out.eta + i));
        const V squared = hn::NegMulAdd(hn::Mul(eta, eta), hn::NegMulAdd(cosine, cosine, one), one);
        const auto total = hn::AndNot(thin, hn::Not(hn::Gt(squared, zero)));
        const V beyond = hn::Sqrt(hn::Max(squared, zero));
        Vector3<V> through = add_scaled(back * eta, n, hn::MulSub(eta, cosine, beyond));
        through = select3(thin, back, through);
        through = select3(hn::Lt(dot3(g, through), zero), through, back);

        V reflected = hn::IfThenElse(hn::Not(hn::Gt(squared, zero)), one, fresnel(d, eta, cosine, beyond));
        reflected = hn::IfThenElse(thin, hn::Div(hn::Mul(two, reflected), hn::Add(one, reflected)), reflected);
        const V mirror_share = hn::IfThenElse(by_fresnel, reflected, one),
                through_share = hn::IfThenElse(by_fresnel, hn::Sub(one, reflected), one);
        for (int c = 0; c < 3; ++c) {
            const V k_t = points.any_transmission ? hn::Load(d, coefficients.transmission[c] + i) : zero;
            V k_s = points.any_mirror ? hn::Load(d, coefficients.mirror[c] + i) : zero;
            k_s = hn::Mul(k_s, mirror_share);
            // What cannot get through is reflected; where Fresnel's share counts, K_S has it already.
            k_s = hn::IfThenElse(hn::AndNot(by_fresnel, total), hn::Add(k_s, k_t), k_s);
            hn::Store(hn::IfThenElseZero(seen, k_s), d, out.mirror_weight[c] + i);
            hn::Store(hn::IfThenElseZero(hn::AndNot(total, seen), hn::Mul(k_t, through_share)), d,
                      out.transmitted_weight[c] + i);
        }
        store3(d, mirror * inverse_length(d, mirror), out.mirror_direction, i);
        store3(d, through * inverse_length(d, through), out.transmitted_direction, i);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(find_bounce_lanes);

void find_bounces(const Points& points, const Coefficients& coefficients, Bounces& bounces) {
    HWY_DYNAMIC_DISPATCH(find_bounce_lanes)(points, coefficients, bounces);
}

}  // namespace trp
#endif
