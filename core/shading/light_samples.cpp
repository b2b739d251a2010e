// sample_light(): for each lane a direction towards the light and the light that comes along it, I_L = E⊥/π.
//
// Points and spots with a radius r shine like a disk of that radius that always faces the lit point, of radiance
// I/(π r²): E = I/(d² + r²) on the axis, as Blender's do. A sun is a cone of directions sampled in proportion to the
// projected solid angle about its axis, so that a surface facing it gets its irradiance exactly. The world is sampled
// half by cosine and half uniformly about the shading normal, so that no sample weighs more than four times its
// radiance.
#include <algorithm>
#include <cmath>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/light_samples.cpp"
#include "hwy/foreach_target.h"

#include "shading/surface_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

constexpr float kFar = 1e30f;

template <class D, class V>
V safe_inverse(D d, V x) {
    return hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), hn::Max(x, hn::Set(d, 1e-37f))));
}

// A uniform point of the unit disk.
template <class D, class V>
void disk(D d, V u, V v, V& x, V& y) {
    const V radius = hn::Sqrt(u), angle = hn::Mul(v, hn::Set(d, 2 * std::numbers::pi_v<float>));
    x = hn::Mul(radius, hn::Cos(d, angle));
    y = hn::Mul(radius, hn::Sin(d, angle));
}

// Two unit vectors at right angles to n and to each other (Duff et al., "Building an Orthonormal Basis, Revisited",
// 2017).
template <class D, class V>
void basis(D d, const Vector3<V>& n, Vector3<V>& s, Vector3<V>& t) {
    const V one = hn::Set(d, 1.0f);
    const V sign = hn::CopySign(one, n.z);
    const V a = hn::Neg(hn::Div(one, hn::Add(sign, n.z)));
    const V b = hn::Mul(hn::Mul(n.x, n.y), a);
    s = {hn::MulAdd(hn::Mul(sign, hn::Mul(n.x, n.x)), a, one), hn::Mul(sign, b), hn::Neg(hn::Mul(sign, n.x))};
    t = {b, hn::MulAdd(hn::Mul(n.y, n.y), a, sign), hn::Neg(n.y)};
}

// A point of a rectangle chosen uniformly by solid angle (Ureña, Fajardo, King, "An Area-Preserving Parametrization for
// Spherical Rectangles", 2013). The rectangle spans x0 … x1 by y0 … y1 at height z0 < 0 in a frame about the lit point.
// Gives the point's x and y, and the solid angle.
template <class D, class V>
V spherical_rectangle(D d, V x0, V x1, V y0, V y1, V z0, V u, V v, V& x, V& y) {
    const V one = hn::Set(d, 1.0f), tiny = hn::Set(d, 1e-12f);
    const V z2 = hn::Mul(z0, z0);
    // z components of the normals of the planes through the point and the rectangle's sides.
    auto side = [&](V a) { return hn::Div(a, hn::Sqrt(hn::Max(hn::MulAdd(a, a, z2), tiny))); };
    const V n0 = hn::Neg(side(y0)), n1 = side(x1), n2 = side(y1), n3 = hn::Neg(side(x0));
    auto inner_angle = [&](V a, V b) {
        return hn::Acos(d, hn::Max(hn::Min(hn::Neg(hn::Mul(a, b)), one), hn::Neg(one)));
    };
    const V k = hn::Sub(hn::Sub(hn::Set(d, 2 * std::numbers::pi_v<float>), inner_angle(n2, n3)), inner_angle(n3, n0));
    const V solid_angle = hn::Max(hn::Sub(hn::Add(inner_angle(n0, n1), inner_angle(n1, n2)), k), hn::Zero(d));
    const V angle = hn::MulAdd(u, solid_angle, k);
    const V sine = hn::Sin(d, angle);
    const V f = hn::Div(hn::MulSub(hn::Cos(d, angle), n0, n2), hn::IfThenElse(hn::Gt(hn::Abs(sine), tiny), sine, tiny));
    const V c =
        hn::Min(hn::Div(one, hn::Sqrt(hn::Max(hn::MulAdd(f, f, hn::Mul(n0, n0)), tiny))), hn::Set(d, 0x1.fffffep-1f));
    const V cu = hn::CopySign(c, f);
    x = hn::Neg(hn::Div(hn::Mul(cu, z0), hn::Sqrt(hn::Max(hn::NegMulAdd(cu, cu, one), tiny))));
    x = hn::Min(hn::Max(x, x0), x1);
    const V r2 = hn::MulAdd(x, x, z2);
    auto height = [&](V a) { return hn::Div(a, hn::Sqrt(hn::Max(hn::MulAdd(a, a, r2), tiny))); };
    const V h0 = height(y0), h = hn::MulAdd(v, hn::Sub(height(y1), h0), h0);
    y = hn::Div(hn::Mul(h, hn::Sqrt(r2)), hn::Sqrt(hn::Max(hn::NegMulAdd(h, h, one), tiny)));
    y = hn::Min(hn::Max(y, y0), y1);
    return solid_angle;
}

// What the light's falloff does beside 1/d².
template <class D, class V>
V falloff_factor(D d, int32_t falloff, V distance) {
    if (falloff == TRP_FALLOFF_LINEAR) return distance;
    if (falloff == TRP_FALLOFF_CONSTANT) return hn::Mul(distance, distance);
    return hn::Set(d, 1.0f);
}

template <class D, class V = hn::Vec<D>>
void sample_lanes(D d, const ReadyLight& light, int32_t falloff, const Points& points, int i, V u, V v,
                  LightSamples& samples) {
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const V time = hn::Load(d, points.time + i);
    const auto axis = [&](Vec3 LightFrame::*of) { return axis_at<D, V, LightFrame>(d, light, light.motion, of, time); };
    const Vector3<V> position = vector_at<D, V, LightFrame>(d, light, light.motion, &LightFrame::position, time);
    const Vector3<V> z = axis(&LightFrame::z);
    Vector3<V> direction;
    V distance = hn::Set(d, kFar), weight;  // I_L = emission · weight
    switch (light.kind) {
        case ReadyLight::Kind::point:
        case ReadyLight::Kind::spot: {
            const Vector3<V> to_centre = position - load3(d, points.position, i);
            const V centre_distance2 = dot3(to_centre, to_centre);
            const V centre_distance = hn::Sqrt(centre_distance2);
            const Vector3<V> axis = to_centre * safe_inverse(d, centre_distance);
            Vector3<V> to_light = to_centre;
            V facing = one;
            distance = centre_distance;
            direction = axis;
            if (light.radius > 0) {
                Vector3<V> s, t;
                basis(d, axis, s, t);
                V x, y;
                disk(d, u, v, x, y);
                const V r = hn::Set(d, light.radius);
                to_light = to_centre + s * hn::Mul(x, r) + t * hn::Mul(y, r);
                distance = hn::Sqrt(dot3(to_light, to_light));
                direction = to_light * safe_inverse(d, distance);
                facing = dot3(direction, axis);
            }
            const V inverse = safe_inverse(d, distance);
            weight = hn::Mul(hn::Mul(facing, hn::Mul(inverse, inverse)), falloff_factor(d, falloff, distance));
            if (light.kind == ReadyLight::Kind::spot) {
                const V cosine = dot3(direction, z);
                const V edge = hn::Set(d, light.cos_half_angle);
                if (light.blend_range > 0) {
                    const V t =
                        hn::Min(hn::Max(hn::Mul(hn::Sub(cosine, edge), hn::Set(d, 1 / light.blend_range)), zero), one);
                    weight =
                        hn::Mul(weight, hn::Mul(hn::Mul(t, t), hn::NegMulAdd(hn::Set(d, 2.0f), t, hn::Set(d, 3.0f))));
                } else {
                    weight = hn::IfThenElseZero(hn::Gt(cosine, edge), weight);
                }
            }
            break;
        }
        case ReadyLight::Kind::sun: {
            direction = z;
            weight = one;
            if (light.sin_half_angle > 0) {
                V x, y;
                disk(d, u, v, x, y);
                const V s = hn::Set(d, light.sin_half_angle);
                x = hn::Mul(x, s), y = hn::Mul(y, s);
                const V cosine = hn::Sqrt(hn::Max(hn::NegMulAdd(x, x, hn::NegMulAdd(y, y, one)), hn::Set(d, 1e-6f)));
                direction = z * cosine + axis(&LightFrame::x) * x + axis(&LightFrame::y) * y;
                weight = hn::Div(one, cosine);
            }
            break;
        }
        case ReadyLight::Kind::area: {
            // Where the light is small to the eye, uniformly over its area; a rectangle that is large, by solid angle,
            // so that what lies close to it is as free of noise as the rest.
            const V half_x = hn::Set(d, light.half_size[0]), half_y = hn::Set(d, light.half_size[1]);
            V x = hn::MulSub(hn::Set(d, 2.0f), u, one), y = hn::MulSub(hn::Set(d, 2.0f), v, one);
            if (light.ellipse) disk(d, u, v, x, y);
            x = hn::Mul(x, half_x), y = hn::Mul(y, half_y);
            const Vector3<V> axis_x = axis(&LightFrame::x), axis_y = axis(&LightFrame::y);
            const Vector3<V> to_centre = position - load3(d, points.position, i);
            auto wide = hn::Lt(one, zero);
            V solid_angle = zero;
            if (!light.ellipse) {
                const V cx = dot3(to_centre, axis_x), cy = dot3(to_centre, axis_y), cz = dot3(to_centre, z);
                V wide_x = zero, wide_y = zero;
                solid_angle = spherical_rectangle(d, hn::Sub(cx, half_x), hn::Add(cx, half_x), hn::Sub(cy, half_y),
                                                  hn::Add(cy, half_y), hn::Neg(hn::Abs(cz)), u, v, wide_x, wide_y);
                wide = hn::Gt(solid_angle, hn::Set(d, 0.02f));
                x = hn::IfThenElse(wide, hn::Sub(wide_x, cx), x);
                y = hn::IfThenElse(wide, hn::Sub(wide_y, cy), y);
            }
            const Vector3<V> to_light = to_centre + axis_x * x + axis_y * y;
            distance = hn::Sqrt(dot3(to_light, to_light));
            const V inverse = safe_inverse(d, distance);
            direction = to_light * inverse;
            const V cosine = hn::Max(dot3(direction, z), zero);  // it shines to −z
            const V by_area = hn::Mul(hn::Mul(cosine, hn::Set(d, light.area)), hn::Mul(inverse, inverse));
            weight = hn::IfThenElse(wide, hn::IfThenElseZero(hn::Gt(cosine, zero), solid_angle), by_area);
            weight = hn::Mul(weight, falloff_factor(d, falloff, distance));
            if (light.spread_tangent > 0) {
                const V sine = hn::Sqrt(hn::Max(hn::NegMulAdd(cosine, cosine, one), zero));
                const V tangent = hn::Mul(sine, safe_inverse(d, cosine));
                weight = hn::Mul(weight, hn::Mul(hn::Max(hn::Sub(hn::Set(d, light.spread_tangent), tangent), zero),
                                                 hn::Set(d, light.spread_scale)));
            }
            break;
        }
        default: {  // a constant world
            const Vector3<V> n = load3(d, points.normal, i);
            // u < 1/2 chooses the cosine, the rest the uniform hemisphere; each half is stretched to the whole again.
            const V half = hn::Set(d, 0.5f);
            const auto by_cosine = hn::Lt(u, half);
            const V w =
                hn::Min(hn::Sub(hn::Add(u, u), hn::IfThenElse(by_cosine, zero, one)), hn::Set(d, 0x1.fffffep-1f));
            const V cosine = hn::IfThenElse(by_cosine, hn::Sqrt(hn::Sub(one, w)), hn::Sub(one, w));
            const V sine = hn::Sqrt(hn::Max(hn::NegMulAdd(cosine, cosine, one), zero));
            const V angle = hn::Mul(v, hn::Set(d, 2 * std::numbers::pi_v<float>));
            Vector3<V> s, t;
            basis(d, n, s, t);
            direction = n * cosine + s * hn::Mul(sine, hn::Cos(d, angle)) + t * hn::Mul(sine, hn::Sin(d, angle));
            // π times the density: 1/2 cos + 1/4
            weight = hn::Div(one, hn::MulAdd(half, cosine, hn::Set(d, 0.25f)));
            weight = hn::Mul(weight, hn::Set(d, std::numbers::pi_v<float>));
            break;
        }
    }
    store3(d, direction, samples.direction, i);
    hn::Store(distance, d, samples.distance + i);
    weight = hn::Mul(weight, hn::Set(d, 1 / std::numbers::pi_v<float>));
    for (int c = 0; c < 3; ++c) hn::Store(hn::Mul(weight, hn::Set(d, light.emission[c])), d, samples.light[c] + i);
}

void sample_batch(const ReadyLight& light, int32_t falloff, const Points& points, const float* u, const float* v,
                  LightSamples& samples) {
    const hn::ScalableTag<float> d;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        if (!samples.reaches(i)) continue;
        sample_lanes(d, light, falloff, points, i, hn::Load(d, u + i), hn::Load(d, v + i), samples);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(sample_batch);

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Emitting triangles: one by emission times area, a uniform point on it.
void sample_surface(const Snapshot& snapshot, const ReadyLight& light, const Points& points, const float* u,
                    const float* v, LightSamples& samples, ProgramScratch& scratch) {
    // Points on the light, so that its own material says what it emits there.
    static thread_local Points emitters;
    static thread_local Coefficients emitted;
    emitters.clear_footprints();
    for (int i = 0; i < kBatch; ++i) {
        samples.light.set(i, {0, 0, 0});
        samples.direction.set(i, {0, 0, 1});
        samples.distance[i] = 1;
        emitters.slot[i] = kNoSlot;
        if (points.slot[i] == kNoSlot) continue;
        float su = u[i];
        const uint32_t entry = light.choice.sample(su);
        const float root = std::sqrt(su);
        emitters.slot[i] = light.slot;
        emitters.triangle[i] = light.triangles[entry];
        emitters.b1[i] = root * (1 - v[i]);
        emitters.b2[i] = root * v[i];
        emitters.time[i] = points.time[i];
        const PlacedSurface& surface = snapshot.surfaces[light.slot];
        const uint32_t* t = surface.vertices + 3 * static_cast<size_t>(emitters.triangle[i]);
        const Vec3 p0 = surface.world_position(t[0], points.time[i]), p1 = surface.world_position(t[1], points.time[i]),
                   p2 = surface.world_position(t[2], points.time[i]);
        const float area = surface.moves() ? (p1 - p0).cross(p2 - p0).length() / 2 : light.areas[entry];
        const Vec3 at = p0 * (1 - root) + p1 * emitters.b1[i] + p2 * emitters.b2[i];
        const Vec3 to_light = at - points.position.get(i);
        const float distance = to_light.length();
        if (!(distance > 0)) {
            emitters.slot[i] = kNoSlot;
            continue;
        }
        samples.distance[i] = distance;
        samples.direction.set(i, to_light / distance);
        emitters.to_viewer.set(i, -(to_light / distance));
        // Area density over the light, for the weight below.
        const float density = light.choice.probability(entry) / std::max(area, 1e-37f);
        samples.light.x[i] = 1 / (kPi * std::max(density, 1e-37f) * distance * distance);
    }
    locate(snapshot, NormalChoice::mesh, emitters);
    evaluate(snapshot, emitters, emitted, scratch, kEveryLane.data());
    for (int i = 0; i < kBatch; ++i) {
        if (emitters.slot[i] == kNoSlot) continue;
        const float cosine = std::abs(emitters.geometric_normal.get(i).dot(samples.direction.get(i)));
        samples.light.set(i, emitted.emission.get(i) * (samples.light.x[i] * cosine * emitted.alpha[i]));
    }
}

void sample_world_map(const ReadyLight& light, const Points& points, const float* u, const float* v,
                      LightSamples& samples) {
    const WorldMap& map = *light.map;
    for (int i = 0; i < kBatch; ++i) {
        samples.light.set(i, {0, 0, 0});
        samples.direction.set(i, {0, 0, 1});
        samples.distance[i] = 1e30f;
        if (points.slot[i] == kNoSlot) continue;
        float su = u[i], sv = v[i];
        const uint32_t y = map.rows.sample(sv), x = map.columns[y].sample(su);
        const float longitude = (0.5f - (static_cast<float>(x) + su) / map.width) * 2 * kPi;
        const float latitude = ((static_cast<float>(y) + sv) / map.height - 0.5f) * kPi;
        const float cosine = std::cos(latitude);
        const Vec3 d(cosine * std::cos(longitude), cosine * std::sin(longitude), std::sin(latitude));
        const float density = map.rows.probability(y) * map.height * map.columns[y].probability(x) * map.width /
                              (2 * kPi * kPi * std::max(cosine, 1e-6f));
        // texture_from_world is a rotation: its transpose turns back.
        const Affine& m = light.texture_from_world;
        samples.direction.set(i, Vec3(m.column(0).dot(d), m.column(1).dot(d), m.column(2).dot(d)));
        const float* c = &map.radiance[3 * (static_cast<size_t>(y) * map.width + x)];
        samples.light.set(i, density > 0 ? Vec3(c[0], c[1], c[2]) / (kPi * density) : Vec3(0, 0, 0));
    }
}

}  // namespace

void sample_light(const Snapshot& snapshot, const ReadyLight& light, int32_t falloff, const Points& points,
                  const float* u, const float* v, LightSamples& samples, ProgramScratch& scratch) {
    if (light.kind == ReadyLight::Kind::surface) return sample_surface(snapshot, light, points, u, v, samples, scratch);
    if (light.kind == ReadyLight::Kind::world_map) return sample_world_map(light, points, u, v, samples);
    HWY_DYNAMIC_DISPATCH(sample_batch)(light, falloff < 0 ? light.falloff : falloff, points, u, v, samples);
}

}  // namespace trp
#endif
