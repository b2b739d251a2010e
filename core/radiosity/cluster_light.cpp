#include "radiosity/cluster_light.h"

#include <cmath>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "radiosity/cluster_light.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct LaneVector {
    hn::Vec<D> x, y, z;
};
template <class D>
hn::Vec<D> dot(D, const LaneVector<D>& a, const LaneVector<D>& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
template <class D>
LaneVector<D> set(D d, const Vec3& v) {
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
template <class D>
LaneVector<D> load(D d, const std::vector<float> (&axes)[3], size_t at) {
    return {hn::LoadU(d, &axes[0][at]), hn::LoadU(d, &axes[1][at]), hn::LoadU(d, &axes[2][at])};
}
// The lanes from `at` that lie in [first, end).
template <class D>
hn::Mask<D> within(D d, uint32_t at, uint32_t first, uint32_t end) {
    const hn::RebindToSigned<D> di;
    const auto number = hn::Iota(di, static_cast<int32_t>(at));
    return hn::RebindMask(d, hn::And(hn::Gt(number, hn::Set(di, static_cast<int32_t>(first) - 1)),
                                     hn::Lt(number, hn::Set(di, static_cast<int32_t>(end)))));
}

// Irradiance L · w cos / d², and what it changes by in space, but for what it changes by along the normal:
// E (4 v / d² − L / (L · v)), v the way to the light; less where that would not hold over the receiver's radius, and
// nothing where the ends are not apart.
template <class D, class Take>
void arriving(D d, const NodeLight& light, const LaneVector<D>& at, const LaneVector<D>& normal, hn::Vec<D> radius,
              Take&& take) {
    using V = hn::Vec<D>;
    const V zero = hn::Zero(d);
    const LaneVector<D> from = set(d, light.from),
                        way{hn::Sub(from.x, at.x), hn::Sub(from.y, at.y), hn::Sub(from.z, at.z)};
    const V d2 = hn::Max(dot(d, way, way), hn::Set(d, 1e-18f)), cosine = hn::Max(dot(d, way, normal), zero);
    const V room = hn::Add(d2, hn::Set(d, light.room));
    const V per_lobe = hn::Div(cosine, hn::Mul(d2, room)), nearness = hn::Div(hn::Set(d, 4.0f), d2);
    const V held = hn::Min(hn::Set(d, light.room > 0 ? 0.0f : 1.0f),
                           hn::Div(hn::Sqrt(d2), hn::Mul(hn::Set(d, 4.0f), hn::Max(radius, hn::Set(d, 1e-18f)))));
    for (int c = 0; c < 3; ++c) {
        const LaneVector<D> lobe = set(d, light.lobes[c]);
        const V leaving = hn::Neg(dot(d, lobe, way));
        const V mean = hn::Mul(hn::Max(leaving, zero), per_lobe),
                of_lobe = hn::IfThenElseZero(leaving > zero, per_lobe);
        const V scale = hn::Mul(mean, nearness);
        const auto slope = [&](V along, V of) { return hn::Mul(held, hn::MulAdd(scale, along, hn::Mul(of_lobe, of))); };
        take(c, mean, slope(way.x, lobe.x), slope(way.y, lobe.y), slope(way.z, lobe.z));
    }
}

void receive_lanes(const ElementClusters& clusters, const NodeLight& light, const Vec3& tint, uint32_t first,
                   uint32_t end, RootLight& out) {
    const hn::CappedTag<float, 16> d;
    const auto lanes = static_cast<uint32_t>(hn::Lanes(d));
    for (uint32_t k = first / lanes * lanes; k < end; k += lanes) {
        const auto here = within(d, k, first, end);
        arriving(d, light, load(d, clusters.places, k), load(d, clusters.normals, k), hn::LoadU(d, &clusters.radii[k]),
                 [&](int c, auto mean, auto x, auto y, auto z) {
                     const auto scale = hn::Set(d, tint[c]);
                     const auto add = [&](std::vector<float>& to, auto value) {
                         hn::StoreU(hn::MulAdd(hn::IfThenElseZero(here, value), scale, hn::LoadU(d, &to[k])), d,
                                    &to[k]);
                     };
                     add(out.mean[c], mean);
                     add(out.slope[c][0], x);
                     add(out.slope[c][1], y);
                     add(out.slope[c][2], z);
                 });
    }
}

void receive_one(const NodeLight& light, const Vec3& point, const Vec3& normal, float radius, Vec3& mean,
                 Vec3 (&slopes)[3]) {
    const hn::CappedTag<float, 1> d;
    arriving(d, light, set(d, point), set(d, normal), hn::Set(d, radius),
             [&](int c, auto value, auto x, auto y, auto z) {
                 mean[c] = hn::GetLane(value);
                 slopes[c] = {hn::GetLane(x), hn::GetLane(y), hn::GetLane(z)};
             });
}

float mean_lanes(const ElementClusters& clusters, const NodeLight& light, uint32_t first, uint32_t end) {
    const hn::ScalableTag<float> d;
    const auto lanes = static_cast<uint32_t>(hn::Lanes(d));
    auto sum = hn::Zero(d), area = hn::Zero(d);
    for (uint32_t k = first; k < end; k += lanes) {
        const auto own = hn::IfThenElseZero(within(d, k, first, end), hn::LoadU(d, &clusters.exposed[k]));
        area = hn::Add(area, own);
        arriving(d, light, load(d, clusters.places, k), load(d, clusters.normals, k), hn::LoadU(d, &clusters.radii[k]),
                 [&](int c, auto mean, auto, auto, auto) {
                     if (c == 0) sum = hn::MulAdd(own, mean, sum);
                 });
    }
    const float all = hn::GetLane(hn::SumOfLanes(d, area));
    return all > 0 ? hn::GetLane(hn::SumOfLanes(d, sum)) / all : 0;
}

NodeLight light_lanes(const ElementClusters& clusters, uint32_t first, uint32_t end, const RootColors* radiosity,
                      const Vec3& towards) {
    const hn::ScalableTag<float> d;
    using D = hn::ScalableTag<float>;
    using V = hn::Vec<D>;
    const auto lanes = static_cast<uint32_t>(hn::Lanes(d));
    const V zero = hn::Zero(d);
    const LaneVector<D> direction = set(d, towards);
    const V weights[3] = {hn::Set(d, 0.2126f), hn::Set(d, 0.7152f), hn::Set(d, 0.0722f)};
    V lobes[3][3], from[3] = {zero, zero, zero}, power = zero, shown = zero;
    for (auto& lobe : lobes)
        for (V& axis : lobe) axis = zero;
    for (uint32_t k = first; k < end; k += lanes) {
        const LaneVector<D> normal = load(d, clusters.normals, k), place = load(d, clusters.places, k);
        const V cosine = dot(d, normal, direction);
        const auto shows = hn::And(within(d, k, first, end), cosine > zero);
        const V area = hn::IfThenElseZero(shows, hn::LoadU(d, &clusters.exposed[k]));
        const V in_view = hn::Mul(area, cosine);
        V bright = zero;
        for (int c = 0; c < 3; ++c) {
            const V color = radiosity ? hn::LoadU(d, &radiosity->of[c][k]) : hn::Set(d, 1.0f);
            bright = hn::MulAdd(weights[c], color, bright);
            const V given = hn::Mul(color, area);
            lobes[c][0] = hn::MulAdd(given, normal.x, lobes[c][0]);
            lobes[c][1] = hn::MulAdd(given, normal.y, lobes[c][1]);
            lobes[c][2] = hn::MulAdd(given, normal.z, lobes[c][2]);
        }
        bright = hn::Mul(bright, in_view);
        power = hn::Add(power, bright);
        shown = hn::Add(shown, in_view);
        from[0] = hn::MulAdd(bright, place.x, from[0]);
        from[1] = hn::MulAdd(bright, place.y, from[1]);
        from[2] = hn::MulAdd(bright, place.z, from[2]);
    }
    const auto sum = [&](V v) { return hn::GetLane(hn::SumOfLanes(d, v)); };
    NodeLight out;
    const float all = sum(power);
    if (!(all > 0)) return out;
    const float in_view = sum(shown);
    out.mean = all / in_view;
    for (int k = 0; k < 3; ++k) {
        out.from[k] = sum(from[k]) / all;
        for (int c = 0; c < 3; ++c) out.lobes[c][k] = sum(lobes[c][k]) * std::numbers::inv_pi_v<float>;
    }
    return out;
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(receive_lanes);
HWY_EXPORT(receive_one);
HWY_EXPORT(mean_lanes);
HWY_EXPORT(light_lanes);

void RootColors::resize(const ElementClusters& clusters) {
    for (std::vector<float>& values : of) values.assign(clusters.exposed.size(), 0);
}

void RootColors::set(size_t root, const Vec3d& color) {
    for (int c = 0; c < 3; ++c) of[c][root] = static_cast<float>(color[c]);
}

void RootLight::clear(const ElementClusters& clusters) {
    for (int c = 0; c < 3; ++c) {
        mean[c].assign(clusters.exposed.size(), 0);
        for (std::vector<float>& values : slope[c]) values.assign(clusters.exposed.size(), 0);
    }
}

Linear RootLight::at(size_t root, const PlaneAxes& axes) const {
    Linear out;
    for (int c = 0; c < 3; ++c) {
        const Vec3 change(slope[c][0][root], slope[c][1][root], slope[c][2][root]);
        out.mean[c] = mean[c][root];
        out.x[c] = change.dot(axes.x);
        out.y[c] = change.dot(axes.y);
    }
    return out;
}

NodeLight light_of(const ElementClusters& clusters, NodeId cluster, const RootColors* radiosity, const Vec3& towards) {
    const ElementCluster& of = clusters.of(cluster);
    return HWY_DYNAMIC_DISPATCH(light_lanes)(clusters, of.first_root, of.first_root + of.root_count, radiosity,
                                             towards);
}

NodeLight light_of(const Elements& elements, uint32_t element, const Vec3d& radiosity) {
    const auto area = static_cast<float>(elements[element].exposed_area());
    const Vec3 lobe = elements.normal(element) * (area * std::numbers::inv_pi_v<float>);
    NodeLight out;
    out.from = elements[element].centre;
    out.mean = luminance(Vec3(radiosity));
    for (int c = 0; c < 3; ++c) out.lobes[c] = lobe * static_cast<float>(radiosity[c]);
    return out;
}

void receive(const ElementClusters& clusters, const NodeLight& light, const Vec3& tint, uint32_t first, uint32_t end,
             RootLight& out) {
    HWY_DYNAMIC_DISPATCH(receive_lanes)(clusters, light, tint, first, end, out);
}

Linear receive(const Elements& elements, uint32_t element, const NodeLight& light, const PlaneAxes& axes) {
    Vec3 mean, slopes[3];
    HWY_DYNAMIC_DISPATCH(receive_one)
    (light, elements[element].centre, elements.normal(element), elements.radius(element), mean, slopes);
    Linear out{Vec3d(mean)};
    for (int c = 0; c < 3; ++c) out.x[c] = slopes[c].dot(axes.x), out.y[c] = slopes[c].dot(axes.y);
    return out;
}

double irradiance_at(const NodeLight& light, const Vec3& point, const Vec3& normal) {
    Vec3 mean, slopes[3];
    HWY_DYNAMIC_DISPATCH(receive_one)(light, point, normal, 0, mean, slopes);
    return mean.x;
}

float mean_irradiance(const ElementClusters& clusters, NodeId cluster, const NodeLight& light) {
    const ElementCluster& of = clusters.of(cluster);
    return HWY_DYNAMIC_DISPATCH(mean_lanes)(clusters, light, of.first_root, of.first_root + of.root_count);
}

}  // namespace trp
#endif
