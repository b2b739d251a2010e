#include "film/surface_passes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "film/surface_passes.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V>
void add_to(D d, float* sum, V value) {
    hn::Store(hn::Add(hn::Load(d, sum), value), d, sum);
}

// `weights`: of each lane, the part of the pixel that ends at its surface.
void add_radiance_lanes(const SeenSurfaces& seen, const BlockSums& sums, float* weights) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    using V = hn::Vec<decltype(d)>;
    const std::array<float*, 4> rgba = sums.combined();
    const bool transmits = seen.straight && seen.points.any_transmission;
    const V one = hn::Set(d, 1.0f), third = hn::Set(d, 1.0f / 3);
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const auto sees = hn::Ne(hn::Load(du, seen.points.slot + i), hn::Set(du, kNoSlot));
        const V alpha = hn::IfThenElseZero(hn::RebindMask(d, sees), hn::Load(d, seen.coefficients.alpha + i));
        V weight = alpha;
        if (seen.throughput || transmits) weight = hn::Zero(d);
        for (int c = 0; c < 3; ++c) {
            const V share = seen.throughput ? hn::Mul(alpha, hn::Load(d, (*seen.throughput)[c] + i)) : alpha;
            const V radiance = hn::IfThenElseZero(hn::Gt(share, hn::Zero(d)), hn::Load(d, seen.light.radiance[c] + i));
            hn::Store(hn::MulAdd(share, radiance, hn::Load(d, rgba[c] + i)), d, rgba[c] + i);
            if (transmits) {
                const V ends = hn::Mul(share, hn::Sub(one, hn::Load(d, seen.coefficients.transmission[c] + i)));
                weight = hn::MulAdd(ends, third, weight);
            } else if (seen.throughput) {
                weight = hn::MulAdd(share, third, weight);
            }
        }
        weight = hn::IfThenElseZero(hn::RebindMask(d, sees), weight);
        hn::Store(weight, d, weights + i);
        add_to(d, rgba[3] + i, weight);
    }
}

// `radiance`: null where nothing is shown but the lanes' alpha, and that unless `transparent`.
void add_background_lanes(const uint8_t* missed, const LaneVec3* throughput, const LaneVec3* radiance, bool transparent,
                          const BlockSums& sums) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::Rebind<uint8_t, decltype(di)> d8;
    using V = hn::Vec<decltype(d)>;
    const std::array<float*, 4> rgba = sums.combined();
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const auto misses = hn::RebindMask(d, hn::Ne(hn::PromoteTo(di, hn::LoadU(d8, missed + i)), hn::Zero(di)));
        const V one = hn::IfThenElseZero(misses, hn::Set(d, 1.0f));
        V ends = throughput ? hn::Zero(d) : one;
        for (int c = 0; c < 3; ++c) {
            const V share = throughput ? hn::IfThenElseZero(misses, hn::Load(d, (*throughput)[c] + i)) : one;
            if (throughput) ends = hn::MulAdd(share, hn::Set(d, 1.0f / 3), ends);
            if (float* const shadow = sums.channel(kShadow, c)) add_to(d, shadow + i, share);
            if (!radiance) continue;
            const V seen = hn::Mul(share, hn::Load(d, (*radiance)[c] + i));
            add_to(d, rgba[c] + i, seen);
            if (float* const part = sums.channel(kEnvironment, c)) add_to(d, part + i, seen);
        }
        if (!transparent) add_to(d, rgba[3] + i, ends);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(add_radiance_lanes);
HWY_EXPORT(add_background_lanes);

namespace {
void add_first(const SeenSurfaces& seen, int i, const BlockSums& sums) {
    const Points& points = seen.points;
    const PlacedSurface& surface = seen.snapshot.surfaces[points.slot[i]];
    if (float* depth = sums.channel(kDepth, 0)) depth[i] = points.depth[i];
    sums.add(kPosition, i, points.position.get(i) + Vec3(seen.snapshot.origin));
    if (sums.channel(kUv, 0)) {
        const Vec2 uv = first_uv(surface, points, i);
        sums.add(kUv, i, {uv.x, uv.y, 1});
    }
    if (float* index = sums.channel(kObjectIndex, 0)) index[i] = static_cast<float>(surface.index);
    if (float* index = sums.channel(kMaterialIndex, 0))
        index[i] = static_cast<float>(seen.snapshot.materials[points.material[i]].index);
}

// The parts of the radiance.
void add_parts(const SeenSurfaces& seen, int i, const BlockSums& sums) {
    const Vec3 share = (seen.throughput ? seen.throughput->get(i) : Vec3(1, 1, 1)) * seen.coefficients.alpha[i];
    const Vec3 emitted = seen.coefficients.emission.get(i), ambient = seen.coefficients.ambient.get(i) * seen.ambient;
    sums.add(kEmit, i, share * emitted);
    sums.add(kAmbientPart, i, share * ambient);
    for (uint32_t group = 1; group <= kLightGroups && seen.light.groups; ++group)
        add_to_group(group, i, share * seen.light.groups->of[group - 1].get(i), sums);
    if (!seen.light.diffuse) return;
    const Vec3 diffuse = seen.light.diffuse->get(i);
    sums.add(kDiffuseDirect, i, share * diffuse);
    sums.add(kSpecularDirect, i, share * (seen.light.radiance.get(i) - emitted - ambient - diffuse));
}

bool wants_groups(const PassList& passes) {
    return std::any_of(passes.order().begin(), passes.order().end(),
                       [](PassId pass) { return pass >= kLightGroup1 && pass <= kLastLightGroup; });
}

}  // namespace

LightLanes::LightLanes(const PassList& passes)
    : sums{radiance, passes.has(kShadow) ? &arriving_ : nullptr,
           passes.has(kDiffuseDirect) || passes.has(kSpecularDirect) ? &diffuse_ : nullptr,
           wants_groups(passes) ? &groups_ : nullptr} {}

void LightLanes::clear() {
    if (sums.arriving) sums.arriving->clear();
    if (sums.diffuse) sums.diffuse->clear();
    if (sums.groups) sums.groups->clear();
}

void add_surfaces(const SeenSurfaces& seen, uint8_t* first, const BlockSums& sums) {
    const Points& points = seen.points;
    alignas(64) Lanes weights;
    HWY_DYNAMIC_DISPATCH(add_radiance_lanes)(seen, sums, weights);
    if (sums.passes().order().size() == 1) return;

    for (int i = 0; i < kBatch; ++i) {
        if (points.slot[i] == kNoSlot) continue;
        add_parts(seen, i, sums);
        if (!(weights[i] > 0)) continue;
        sums.add(kNormal, i, points.normal.get(i) * weights[i]);
        sums.add(kAlbedo, i, seen.coefficients.diffuse.get(i) * weights[i]);
        Vec3 share(1, 1, 1);
        const ArrivingLight* const arriving = seen.light.arriving;
        for (int c = 0; c < 3 && arriving; ++c)
            if (arriving->unblocked[c][i] > 0) share[c] = arriving->blocked[c][i] / arriving->unblocked[c][i];
        sums.add(kShadow, i, share * weights[i]);
        if (!first || first[i]) continue;
        first[i] = 1;
        add_first(seen, i, sums);
    }
}

Vec3 throughput_behind(const Points& points, const Coefficients& coefficients, int lane, const Vec3& throughput,
                       bool straight) {
    constexpr float kLeast = 1e-3f;
    const float alpha = coefficients.alpha[lane];
    Vec3 left = throughput * (1 - alpha);
    if (straight && points.any_transmission) left += throughput * coefficients.transmission.get(lane) * alpha;
    return greatest(left) < kLeast ? Vec3(0, 0, 0) : left;
}

void add_background(const Snapshot& snapshot, const LaneVec3& directions, const uint8_t* missed,
                    const LaneVec3* throughput, bool transparent, const BlockSums& sums) {
    const bool shows = !transparent && snapshot.world.visible_camera && snapshot.world.radiance != Vec3(0, 0, 0);
    static thread_local LaneVec3 radiance;
    if (shows) sample_background(snapshot, directions, missed, radiance);
    HWY_DYNAMIC_DISPATCH(add_background_lanes)(missed, throughput, shows ? &radiance : nullptr, transparent, sums);
}

void add_seen_light(int lane, const Vec3& throughput, const Vec3& radiance, uint32_t group, const BlockSums& sums) {
    add_to_group(group, lane, throughput * radiance, sums);
    sums.add(kCombined, lane, throughput * radiance);
    sums.add(kEmit, lane, throughput * radiance);
    sums.channel(kCombined, 3)[lane] += throughput.x;
    sums.add(kShadow, lane, throughput);
}

void finish_depth(const uint8_t* first, const BlockSums& sums) {
    if (float* depth = sums.channel(kDepth, 0))
        for (int i = 0; i < kBatch; ++i)
            if (!first[i]) depth[i] = kNothingSeen;
}

}  // namespace trp
#endif
