#include "shading/shadow_rays.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/shadow_rays.cpp"
#include "hwy/foreach_target.h"

#include "shading/equation-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

// Rays of 16 lanes from `first` on, to where the light was sampled. Returns whether any is to be traced.
bool make_shadow_packet(const Points& points, const LightSamples& samples, unsigned mask, int first, RTCRay16& ray,
                        int* valid) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::RebindToUnsigned<decltype(d)> du;
    using V = hn::Vec<decltype(d)>;
    bool any = false;
    for (int k = 0; k < 16; k += static_cast<int>(hn::Lanes(d))) {
        const int i = first + k;
        const V zero = hn::Zero(d);
        const Vector3<V> l = load3(d, samples.direction, i), g = load3(d, points.geometric_normal, i),
                         n = load3(d, points.normal, i);
        const V light = hn::Add(hn::Load(d, samples.light.x + i),
                                hn::Add(hn::Load(d, samples.light.y + i), hn::Load(d, samples.light.z + i)));
        auto wanted = hn::RebindMask(d, hn::Ne(hn::Load(du, points.slot + i), hn::Set(du, kNoSlot)));
        wanted =
            hn::And(wanted, hn::And(hn::Gt(light, zero), hn::And(hn::Gt(dot3(g, l), zero), hn::Gt(dot3(n, l), zero))));
        any |= !hn::AllFalse(d, wanted);
        hn::Store(hn::BitCast(di, hn::VecFromMask(du, hn::RebindMask(du, wanted))), di, valid + k);
        const V offset = hn::Load(d, points.offset + i);
        hn::Store(hn::MulAdd(g.x, offset, hn::Load(d, points.position.x + i)), d, ray.org_x + k);
        hn::Store(hn::MulAdd(g.y, offset, hn::Load(d, points.position.y + i)), d, ray.org_y + k);
        hn::Store(hn::MulAdd(g.z, offset, hn::Load(d, points.position.z + i)), d, ray.org_z + k);
        hn::Store(l.x, d, ray.dir_x + k);
        hn::Store(l.y, d, ray.dir_y + k);
        hn::Store(l.z, d, ray.dir_z + k);
        hn::Store(zero, d, ray.tnear + k);
        hn::Store(hn::Mul(hn::Load(d, samples.distance + i), hn::Set(d, kShortOfLight)), d, ray.tfar + k);
        hn::Store(hn::Load(d, points.time + i), d, ray.time + k);
        hn::Store(hn::Set(du, mask), du, ray.mask + k);
        hn::Store(hn::Zero(du), du, ray.flags + k);
        hn::Store(hn::Zero(du), du, ray.id + k);
    }
    return any;
}

void read_shadow_packet(const RTCRay16& ray, const int* valid, int first, LaneVec3& visibility) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    for (int k = 0; k < 16; k += static_cast<int>(hn::Lanes(d))) {
        const auto traced = hn::RebindMask(d, hn::Ne(hn::Load(di, valid + k), hn::Zero(di)));
        const auto open = hn::And(traced, hn::Ge(hn::Load(d, ray.tfar + k), hn::Zero(d)));
        for (int c = 0; c < 3; ++c) hn::Store(hn::IfThenElseZero(open, hn::Set(d, 1.0f)), d, visibility[c] + first + k);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(make_shadow_packet);
HWY_EXPORT(read_shadow_packet);

namespace {

constexpr int kGreatestLayers = 64;  // of holes in a row along one shadow ray; beyond, it counts as blocked

// What a surface on the way lets through.
Vec3 passing(const Snapshot& snapshot, const Points& hits, const Coefficients& coefficients, int i,
             TransparentShadows transparent) {
    const CompiledMaterial& material = snapshot.materials[hits.material[i]];
    const float alpha = coefficients.alpha[i];
    const Vec3 one(1, 1, 1);
    if (!material.transmits || transparent == TransparentShadows::opaque) return one * (1 - alpha);
    if (transparent == TransparentShadows::none) return one;
    return one * (1 - alpha) + coefficients.transmission.get(i) * alpha;
}

// Multiplies visibility by what the surfaces with holes or transmission on the way let through, layer by layer; the
// lanes whose way is still open are kept close together, so that few cost little.
uint64_t filter_shadows(const Snapshot& snapshot, const Points& points, const LightSamples& samples,
                        TransparentShadows transparent, LaneVec3& visibility, ShadowScratch& shadow,
                        ProgramScratch& program) {
    const unsigned mask =
        transparent == TransparentShadows::opaque ? kFiltersShadow : kFiltersShadow | kTransmitsShadow;
    Points& hits = shadow.points;
    hits.clear_footprints();
    int open[kBatch], count = 0;  // lanes
    Lanes reached;                // ray parameter that each has come to
    for (int i = 0; i < kBatch; ++i)
        if (visibility.get(i) != Vec3(0, 0, 0)) open[count++] = i, reached[i] = 0;
    uint64_t rays = 0;
    for (int layer = 0; layer < kGreatestLayers && count > 0; ++layer) {
        rays += static_cast<uint64_t>(count);
        int hit_count = 0;
        for (int first = 0; first < count; first += 16) {
            alignas(64) RTCRayHit16 packet = {};
            alignas(64) int valid[16] = {};
            const int in_packet = std::min(count - first, 16);
            for (int k = 0; k < in_packet; ++k) {
                const int i = open[first + k];
                const Vec3 origin = points.position.get(i) + points.geometric_normal.get(i) * points.offset[i],
                           direction = samples.direction.get(i);
                valid[k] = -1;
                packet.ray.org_x[k] = origin.x, packet.ray.org_y[k] = origin.y, packet.ray.org_z[k] = origin.z;
                packet.ray.dir_x[k] = direction.x, packet.ray.dir_y[k] = direction.y, packet.ray.dir_z[k] = direction.z;
                packet.ray.tnear[k] = reached[i];
                packet.ray.tfar[k] = samples.distance[i] * kShortOfLight;
                packet.ray.time[k] = points.time[i];
                packet.ray.mask[k] = mask;
                packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
            }
            intersect16(snapshot.rays->embree(), valid, packet, Coherence::incoherent);
            for (int k = 0; k < in_packet; ++k) {
                if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
                const int i = open[first + k], to = hit_count++;
                const unsigned instance = packet.hit.instID[0][k];
                hits.slot[to] = instance != RTC_INVALID_GEOMETRY_ID ? instance : packet.hit.geomID[k];
                hits.triangle[to] = packet.hit.primID[k];
                hits.b1[to] = packet.hit.u[k];
                hits.b2[to] = packet.hit.v[k];
                hits.time[to] = points.time[i];
                hits.to_viewer.set(to, -samples.direction.get(i));
                // Past the surface by as much as rounding can place it wrong.
                reached[i] = packet.ray.tfar[k] * (1 + 4e-7f);
                open[to] = i;  // no later than where it was
            }
        }
        count = 0;
        if (hit_count == 0) return rays;
        std::fill(hits.slot + hit_count, hits.slot + kBatch, kNoSlot);
        locate(snapshot, NormalChoice::mesh, hits);
        evaluate(snapshot, hits, shadow.coefficients, program, kEveryLane.data());
        for (int at = 0; at < hit_count; ++at) {
            const int i = open[at];
            const Vec3 left = visibility.get(i) * passing(snapshot, hits, shadow.coefficients, at, transparent);
            const bool goes_on = greatest(left) >= 1e-4f;
            visibility.set(i, goes_on ? left : Vec3(0, 0, 0));
            reached[i] += 2 * hits.offset[at];
            if (goes_on) open[count++] = i;
        }
    }
    for (int at = 0; at < count; ++at) visibility.set(open[at], {0, 0, 0});
    return rays;
}

}  // namespace

uint64_t trace_shadows(const Snapshot& snapshot, const Points& points, const LightSamples& samples, Coherence coherence,
                       TransparentShadows transparent, LaneVec3& visibility, ShadowScratch& shadow,
                       ProgramScratch& program) {
    const bool blocks = transparent == TransparentShadows::opaque;
    const unsigned mask = blocks ? kCastsShadow | kTransmitsShadow : kCastsShadow;
    uint64_t rays = 0;
    if (snapshot.rays->occlusion_coherence() == Coherence::incoherent) coherence = Coherence::incoherent;
    for (int first = 0; first < kBatch; first += 16) {
        alignas(64) RTCRay16 ray;
        alignas(64) int valid[16];
        if (!samples.reaches(first) ||
            !HWY_DYNAMIC_DISPATCH(make_shadow_packet)(points, samples, mask, first, ray, valid)) {
            for (int c = 0; c < 3; ++c) std::fill_n(visibility[c] + first, 16, 0.0f);
            continue;
        }
        for (int k = 0; k < 16; ++k) rays += valid[k] != 0;
        occluded16(snapshot.rays->embree(), valid, ray, coherence);
        HWY_DYNAMIC_DISPATCH(read_shadow_packet)(ray, valid, first, visibility);
    }
    if (snapshot.any_holes || (!blocks && snapshot.any_transmission))
        rays += filter_shadows(snapshot, points, samples, transparent, visibility, shadow, program);
    return rays;
}

}  // namespace trp
#endif
