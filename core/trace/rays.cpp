#include "trace/rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/film.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/rays.cpp"
#include "hwy/foreach_target.h"

#include "film/pixel_random-inl.h"
#include "shading/surface_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

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

void make_keys(const RayMaker& maker, uint32_t block_x, uint32_t block_y, BlockRays& rays) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        auto px = hn::Zero(du), py = hn::Zero(du);
        pixel_of(d, block_x, block_y, i, px, py);
        hn::Store(sequence_key(d, px, py, maker.sequence), du, rays.keys + i);
        hn::Store(first_index(d, px, py, maker.sequence), du, rays.indices + i);
    }
}

// Of the pairs of random numbers the first is for the film, the next for the lens, and the third for time.
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
        const auto key = hn::Load(du, rays.keys + i);
        const auto index = reverse_bits(du, hn::Add(hn::Load(du, rays.indices + i), hn::Set(du, sample)));
        V u = hn::Zero(d), v = hn::Zero(d);
        sobol_pair(d, key, index, 0, u, v);
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
            sobol_pair(d, key, index, 1, u, v);
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
        V time = hn::Zero(d);
        if (maker.moves) {
            sobol_pair(d, key, index, 2, u, v);
            time = hn::MulAdd(u, set(maker.shutter[1] - maker.shutter[0]), set(maker.shutter[0]));
        }
        hn::Store(time, d, packet.ray.time + lane);
        const Vector3<V> z = axis_at(d, view, maker.motion, &View::z, time),
                         position = vector_at(d, view, maker.motion, &View::position, time);
        Vector3<V> x = vector_at(d, view, maker.motion, &View::x, time),
                   y = vector_at(d, view, maker.motion, &View::y, time);
        if (!maker.motion.empty()) {
            x = unit_or(d, add_scaled(x, z, hn::Neg(dot3(x, z))), view.x);
            y = cross3(z, x);
        }
        const Vector3<V> origins3 = add_scaled(add_scaled(position, y, origin_y), x, origin_x),
                         directions3 = add_scaled(y * direction_y - z, x, direction_x);
        const V* const of_origin[3] = {&origins3.x, &origins3.y, &origins3.z};
        const V* const of_direction[3] = {&directions3.x, &directions3.y, &directions3.z};
        for (int k = 0; k < 3; ++k) {
            const V origin = *of_origin[k], direction = *of_direction[k];
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

void read_hit_lanes(const BlockRays& rays, const uint8_t* active, Points& points) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    const auto none = hn::Set(di, static_cast<int32_t>(RTC_INVALID_GEOMETRY_ID)),
               no_slot = hn::Set(di, static_cast<int32_t>(kNoSlot));
    auto load = [&](const unsigned* ids) { return hn::Load(di, reinterpret_cast<const int32_t*>(ids)); };
    auto store = [&](auto ids, uint32_t* out) { hn::Store(ids, di, reinterpret_cast<int32_t*>(out)); };
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const RTCHit16& hit = rays.packets[i >> 4].hit;
        const int k = i & 15;
        alignas(64) int32_t is_active[HWY_MAX_BYTES / sizeof(int32_t)];
        for (size_t lane = 0; lane < hn::Lanes(d); ++lane) is_active[lane] = active[i + lane];
        const auto geometry = load(hit.geomID + k), instance = load(hit.instID[0] + k);
        const auto met = hn::AndNot(hn::Eq(geometry, none), hn::Ne(hn::Load(di, is_active), hn::Zero(di)));
        const auto slot = hn::IfThenElse(hn::Ne(instance, none), instance, geometry);
        store(hn::IfThenElse(met, slot, no_slot), points.slot + i);
        store(load(hit.primID + k), points.triangle + i);
        hn::Store(hn::Load(d, hit.u + k), d, points.b1 + i);
        hn::Store(hn::Load(d, hit.v + k), d, points.b2 + i);
        hn::Store(hn::Load(d, rays.packets[i >> 4].ray.time + k), d, points.time + i);
        hn::Store(hn::Load(d, rays.packets[i >> 4].ray.tfar + k), d, points.depth + i);
        const auto direction = load3(d, rays.direction, i);
        const auto scale = hn::Div(hn::Set(d, -1.0f), hn::Sqrt(dot3(direction, direction)));
        store3(d, direction * scale, points.to_viewer, i);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(make_keys);
HWY_EXPORT(make_rays);
HWY_EXPORT(read_hit_lanes);

RayMaker make_ray_maker(const Snapshot& snapshot, const Settings& settings, const PixelFilter& filter, uint32_t width,
                        uint32_t height) {
    if (!snapshot.camera) fail(TRP_ERROR_STATE, "the scene has no camera to render from");
    const Camera& camera = *snapshot.camera;
    RayMaker maker{make_view(camera, snapshot.origin, width, height),
                   filter,
                   SampleSequence(settings.seed, settings.samples),
                   std::max(0.125f, 1 / std::sqrt(static_cast<float>(settings.samples))),
                   snapshot.moves,
                   {camera.shutter[0], camera.shutter[1]},
                   {}};
    const size_t steps = camera.world_from_camera.size();
    for (size_t step = 0; step < steps && steps > 1; ++step)
        maker.motion.push_back(make_view(camera, snapshot.origin, width, height, step));
    return maker;
}

void prepare_block(const RayMaker& maker, uint32_t block_x, uint32_t block_y, BlockRays& rays) {
    HWY_DYNAMIC_DISPATCH(make_keys)(maker, block_x, block_y, rays);
}

void make_primary_rays(const RayMaker& maker, uint32_t block_x, uint32_t block_y, uint32_t sample, BlockRays& rays) {
    HWY_DYNAMIC_DISPATCH(make_rays)(maker, block_x, block_y, sample, rays);
}

void prepare(BlockRays& rays, unsigned mask) {
    for (RTCRayHit16& packet : rays.packets) {
        std::fill_n(packet.ray.time, 16, 0.0f);
        std::fill_n(packet.ray.mask, 16, mask);
        std::fill_n(packet.ray.flags, 16, 0u);
        std::fill_n(packet.ray.id, 16, 0u);
    }
}

void trace_primary(RTCScene scene, const uint8_t* active, Coherence coherence, BlockRays& rays) {
    for (int p = 0; p < kPackets; ++p) {
        RTCRayHit16& packet = rays.packets[p];
        alignas(64) int valid[16];
        int any = 0;
        for (int k = 0; k < 16; ++k) {
            valid[k] = -active[16 * p + k];
            any |= valid[k];
        }
        std::fill_n(packet.hit.geomID, 16, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(packet.hit.instID[0], 16, RTC_INVALID_GEOMETRY_ID);
        if (any) intersect16(scene, valid, packet, coherence);
    }
}

void read_hits(const BlockRays& rays, const uint8_t* active, Points& points) {
    HWY_DYNAMIC_DISPATCH(read_hit_lanes)(rays, active, points);
}

Found find_missed(const uint8_t* active, const Points& points, uint8_t* missed) {
    Found found;
    for (int i = 0; i < kBatch; ++i) {
        missed[i] = active[i] && points.slot[i] == kNoSlot;
        found.any_missed |= missed[i];
        found.any_hit |= points.slot[i] != kNoSlot;
    }
    return found;
}

}  // namespace trp
#endif
