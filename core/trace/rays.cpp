#include "trace/rays.h"

#include <cmath>
#include <numbers>

#include "film/film.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/rays.cpp"
#include "hwy/foreach_target.h"

#include "base/sobol-inl.h"
#include "hwy/contrib/math/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

// The pixel of each lane: its offsets within a packet repeat every 16 lanes.
template <class D, class VU = hn::Vec<hn::RebindToUnsigned<D>>>
void pixel_of(D, uint32_t block_x, uint32_t block_y, int i, VU& x, VU& y) {
    const hn::RebindToUnsigned<D> du;
    const VU lane = hn::Iota(du, static_cast<uint32_t>(i));
    const VU three = hn::Set(du, 3u);
    x = hn::Add(hn::Add(hn::ShiftLeft<2>(hn::And(hn::ShiftRight<4>(lane), three)), hn::And(lane, three)),
                hn::Set(du, block_x * kBlockSide));
    y = hn::Add(hn::Add(hn::ShiftLeft<2>(hn::ShiftRight<6>(lane)), hn::And(hn::ShiftRight<2>(lane), three)),
                hn::Set(du, block_y * kBlockSide));
}

template <class D, class VU>
VU pixel_key(D, VU x, VU y, uint32_t seed) {
    const hn::RebindToUnsigned<D> du;
    return mix_bits(du, hn::Add(x, mix_bits(du, hn::Add(y, mix_bits(du, hn::Set(du, seed + 1u))))));
}

void random_pair_lanes(uint32_t block_x, uint32_t block_y, uint32_t seed, uint32_t sample, uint32_t pair, float* u,
                       float* v) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        auto x = hn::Zero(du), y = hn::Zero(du);
        pixel_of(d, block_x, block_y, i, x, y);
        auto a = hn::Zero(d), b = hn::Zero(d);
        sobol_pair(d, pixel_key(d, x, y, seed), sample, pair, a, b);
        hn::Store(a, d, u + i);
        hn::Store(b, d, v + i);
    }
}

// The filter's offset for u in [0, 1).
template <class D, class V>
V filter_offset(D d, const float* offsets, V u) {
    const hn::RebindToSigned<D> di;
    const V scaled = hn::Mul(u, hn::Set(d, static_cast<float>(PixelFilter::kSteps)));
    const auto index = hn::ConvertTo(di, scaled);
    const V within = hn::Sub(scaled, hn::ConvertTo(d, index));
    const V low = hn::GatherIndex(d, offsets, index), high = hn::GatherIndex(d, offsets + 1, index);
    return hn::MulAdd(within, hn::Sub(high, low), low);
}

// A uniform point of the aperture, of radius 1: a disk, or a regular polygon, of which a triangle is chosen by u.
template <class D, class V>
void aperture_point(D d, const View& view, V u, V v, V& x, V& y) {
    const V one = hn::Set(d, 1.0f);
    if (view.blade_count < 3) {
        const V radius = hn::Sqrt(u), angle = hn::Mul(v, hn::Set(d, 2 * std::numbers::pi_v<float>));
        x = hn::Mul(radius, hn::Cos(d, angle));
        y = hn::Mul(radius, hn::Sin(d, angle));
        return;
    }
    const V blades = hn::Set(d, static_cast<float>(view.blade_count));
    const V scaled = hn::Mul(u, blades), blade = hn::Floor(scaled), within = hn::Sub(scaled, blade);
    const V root = hn::Sqrt(v);
    const V step = hn::Set(d, 2 * std::numbers::pi_v<float> / static_cast<float>(view.blade_count));
    const V angle0 = hn::MulAdd(blade, step, hn::Set(d, view.blade_rotation)), angle1 = hn::Add(angle0, step);
    const V w0 = hn::Mul(root, hn::Sub(one, within)), w1 = hn::Mul(root, within);
    x = hn::MulAdd(w0, hn::Cos(d, angle0), hn::Mul(w1, hn::Cos(d, angle1)));
    y = hn::MulAdd(w0, hn::Sin(d, angle0), hn::Mul(w1, hn::Sin(d, angle1)));
}

void make_rays(const RayMaker& maker, uint32_t block_x, uint32_t block_y, uint32_t sample, BlockRays& rays) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    const View& view = maker.view;
    auto set = [&](float s) { return hn::Set(d, s); };
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        auto px = hn::Zero(du), py = hn::Zero(du);
        pixel_of(d, block_x, block_y, i, px, py);
        const auto key = pixel_key(d, px, py, maker.seed);
        V u = hn::Zero(d), v = hn::Zero(d);
        sobol_pair(d, key, sample, 0, u, v);
        const V film_x = hn::Add(hn::Add(hn::ConvertTo(d, hn::BitCast(di, px)), set(0.5f)),
                                 filter_offset(d, maker.filter.offsets(), u));
        const V film_y = hn::Add(hn::Add(hn::ConvertTo(d, hn::BitCast(di, py)), set(0.5f)),
                                 filter_offset(d, maker.filter.offsets(), v));
        V plane_x = hn::MulAdd(film_x, set(view.step_x), set(view.left)),
          plane_y = hn::MulAdd(film_y, set(view.step_y), set(view.bottom));
        // Origin and direction in camera space, where the direction's z is −1.
        V origin_x = hn::Zero(d), origin_y = hn::Zero(d), direction_x = plane_x, direction_y = plane_y;
        if (!view.perspective) {
            origin_x = plane_x, origin_y = plane_y;
            direction_x = direction_y = hn::Zero(d);
        }
        if (view.aperture_radius > 0) {
            sobol_pair(d, key, sample, 1, u, v);
            V lens_x = hn::Zero(d), lens_y = hn::Zero(d);
            aperture_point(d, view, u, v, lens_x, lens_y);
            lens_x = hn::Mul(lens_x, set(view.aperture_radius)), lens_y = hn::Mul(lens_y, set(view.aperture_radius));
            // The ray through the lens meets the one through its centre at the focus distance.
            const V to_focus = set(-1 / view.focus_distance);
            origin_x = hn::Add(origin_x, lens_x), origin_y = hn::Add(origin_y, lens_y);
            direction_x = hn::MulAdd(lens_x, to_focus, direction_x),
            direction_y = hn::MulAdd(lens_y, to_focus, direction_y);
        }
        RTCRayHit16& packet = rays.packets[i >> 4];
        const int lane = i & 15;
        for (int k = 0; k < 3; ++k) {
            const V origin =
                hn::MulAdd(set(view.x[k]), origin_x, hn::MulAdd(set(view.y[k]), origin_y, set(view.position[k])));
            const V direction =
                hn::MulAdd(set(view.x[k]), direction_x, hn::MulAdd(set(view.y[k]), direction_y, set(-view.z[k])));
            hn::Store(origin, d, rays.origin[k] + i);
            hn::Store(direction, d, rays.direction[k] + i);
            float* const origins[3] = {packet.ray.org_x, packet.ray.org_y, packet.ray.org_z};
            float* const directions[3] = {packet.ray.dir_x, packet.ray.dir_y, packet.ray.dir_z};
            hn::Store(origin, d, origins[k] + lane);
            hn::Store(direction, d, directions[k] + lane);
        }
        hn::Store(set(view.clip_start), d, packet.ray.tnear + lane);
        hn::Store(set(view.clip_end), d, packet.ray.tfar + lane);
    }
}

void read_viewers(const BlockRays& rays, Points& points) {
    const hn::ScalableTag<float> d;
    using V = hn::Vec<decltype(d)>;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const V x = hn::Load(d, rays.direction.x + i), y = hn::Load(d, rays.direction.y + i),
                z = hn::Load(d, rays.direction.z + i);
        const V scale = hn::Div(hn::Set(d, -1.0f), hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)))));
        hn::Store(hn::Mul(x, scale), d, points.to_viewer.x + i);
        hn::Store(hn::Mul(y, scale), d, points.to_viewer.y + i);
        hn::Store(hn::Mul(z, scale), d, points.to_viewer.z + i);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(random_pair_lanes);
HWY_EXPORT(make_rays);
HWY_EXPORT(read_viewers);

void random_pair(uint32_t block_x, uint32_t block_y, uint32_t seed, uint32_t sample, uint32_t pair, float* u,
                 float* v) {
    HWY_DYNAMIC_DISPATCH(random_pair_lanes)(block_x, block_y, seed, sample, pair, u, v);
}

void make_primary_rays(const RayMaker& maker, uint32_t block_x, uint32_t block_y, uint32_t sample, BlockRays& rays) {
    HWY_DYNAMIC_DISPATCH(make_rays)(maker, block_x, block_y, sample, rays);
}

void trace_primary(RTCScene scene, const uint8_t* active, unsigned mask, Coherence coherence, BlockRays& rays) {
    for (int p = 0; p < kPackets; ++p) {
        RTCRayHit16& packet = rays.packets[p];
        alignas(64) int valid[16];
        int any = 0;
        for (int k = 0; k < 16; ++k) {
            valid[k] = active[16 * p + k] ? -1 : 0;
            any |= valid[k];
            packet.ray.time[k] = 0;
            packet.ray.mask[k] = mask;
            packet.ray.flags[k] = 0;
            packet.ray.id[k] = 0;
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        if (any) intersect16(scene, valid, packet, coherence);
    }
}

void read_hits(const BlockRays& rays, const uint8_t* active, Points& points) {
    for (int i = 0; i < kBatch; ++i) {
        const RTCHit16& hit = rays.packets[i >> 4].hit;
        const int k = i & 15;
        const uint32_t slot = hit.instID[0][k] != RTC_INVALID_GEOMETRY_ID ? hit.instID[0][k] : hit.geomID[k];
        points.slot[i] = active[i] && hit.geomID[k] != RTC_INVALID_GEOMETRY_ID ? slot : kNoSlot;
        points.triangle[i] = hit.primID[k];
        points.b1[i] = hit.u[k];
        points.b2[i] = hit.v[k];
        points.time[i] = 0;
    }
    HWY_DYNAMIC_DISPATCH(read_viewers)(rays, points);
}

void make_footprints(const RayMaker& maker, const BlockRays& rays, Points& points) {
    const View& view = maker.view;
    const Vec3 step[2] = {view.x * (view.step_x * maker.footprint), view.y * (view.step_y * maker.footprint)};
    for (int i = 0; i < kBatch; ++i) {
        if (points.slot[i] == kNoSlot) continue;
        const Vec3 n = points.geometric_normal.get(i), direction = rays.direction.get(i);
        const float slope = n.dot(direction);
        for (int k = 0; k < 2; ++k) {
            // The neighbour's ray moves by `across` at this depth, and on along its direction to the plane again.
            const Vec3 across = view.perspective ? step[k] * hit_depth(rays, i) : step[k];
            const Vec3 moved = std::abs(slope) > 1e-8f ? across - direction * (n.dot(across) / slope) : across;
            (k == 0 ? points.position_dx : points.position_dy).set(i, moved);
        }
    }
}

}  // namespace trp
#endif
