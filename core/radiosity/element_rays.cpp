#include "radiosity/element_rays.h"

#include <algorithm>

#include "hwy/cache_control.h"

namespace trp {
namespace {

constexpr float kLeastWeight = 1e-3f;
constexpr unsigned kMask = kSeenByCamera | kCastsShadow | kFiltersShadow | kTransmitsShadow;

}  // namespace

bool has_mirrors(const Elements& elements) {
    const std::vector<uint8_t>& flags = elements.snapshot().material_flags;
    return std::any_of(elements.facets().begin(), elements.facets().end(),
                       [&](const Facet& facet) { return (flags[facet.material] & kMirrors) != 0; });
}

ElementTracer::ElementTracer(const Elements& elements, uint32_t most_turns, bool eye)
    : elements_(elements), most_turns_(most_turns), eye_(eye) {
    std::fill_n(packet_.ray.tnear, 16, 0.0f);
    std::fill_n(packet_.ray.time, 16, 0.0f);
    std::fill_n(packet_.ray.mask, 16, kMask);
    std::fill_n(packet_.ray.flags, 16, 0u);
    std::fill_n(packet_.ray.id, 16, 0u);
}

uint64_t ElementTracer::trace(std::vector<ElementRay>& rays, std::vector<ElementHit>& hits) {
    uint64_t count = 0;
    while (!rays.empty()) {
        more_.clear();
        for (size_t first = 0; first < rays.size(); first += kBatch) {
            const int in_batch = static_cast<int>(std::min<size_t>(rays.size() - first, kBatch));
            batch(&rays[first], in_batch, hits);
        }
        count += rays.size();
        rays.swap(more_);
    }
    return count;
}

uint64_t ElementTracer::trace(const HemisphereRays& from, uint32_t first, int count, uint32_t* counts,
                              std::vector<ElementHit>& others) {
    from.make(first, origins_, directions_);
    RTCRay16& ray = packet_.ray;
    const uint32_t none = elements_.size();
    for (int begin = 0; begin < count; begin += 16) {
        float* const origin[3] = {ray.org_x, ray.org_y, ray.org_z};
        float* const direction[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
        for (int c = 0; c < 3; ++c) {
            std::copy_n(origins_[c] + begin, 16, origin[c]);
            std::copy_n(directions_[c] + begin, 16, direction[c]);
        }
        const bool any_goes_on = meet(begin, std::min(count - begin, 16));
        for (int k = begin; k < begin + 16; ++k) hwy::Prefetch(&counts[std::min(met_[k], none)]);
        for (int k = 0; k < 16 && any_goes_on; ++k)
            if (met_[begin + k] == kGoesOn) hold(begin + k, k);
    }
    for (int k = 0; k < count; ++k) ++counts[std::min(met_[k], none)];
    if (!any_held_) return static_cast<uint64_t>(count);
    std::vector<ElementRay> rays(count), onward;
    for (int i = 0; i < count; ++i) rays[i] = {origins_.get(i), directions_.get(i)};
    more_.clear();
    go_on(rays.data(), count, others);
    onward.swap(more_);
    return static_cast<uint64_t>(count) + trace(onward, others);
}

// The packet holds so many of the batch's rays, from number `first` on. Returns whether any goes on.
bool ElementTracer::meet(int first, int count) {
    alignas(64) int valid[16];
    for (int k = 0; k < 16; ++k) valid[k] = k < count ? -1 : 0;
    std::fill_n(packet_.ray.tfar, 16, 1e30f);
    std::fill_n(packet_.hit.geomID, 16, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packet_.hit.instID[0], 16, RTC_INVALID_GEOMETRY_ID);
    intersect16(elements_.snapshot().rays->embree(), valid, packet_, Coherence::incoherent);
    return find_elements(elements_, packet_, eye_, met_ + first);
}

// What lane `k` of the packet has met, ray `i` of the batch, until the batch goes on.
void ElementTracer::hold(int i, int k) {
    if (!passed_) passed_ = std::make_unique<Passed>();
    Points& points = passed_->points;
    if (!any_held_) std::fill_n(points.slot, kBatch, kNoSlot);
    any_held_ = true;
    const unsigned instance = packet_.hit.instID[0][k];
    points.slot[i] = instance != RTC_INVALID_GEOMETRY_ID ? instance : packet_.hit.geomID[k];
    points.triangle[i] = packet_.hit.primID[k];
    points.b1[i] = packet_.hit.u[k];
    points.b2[i] = packet_.hit.v[k];
    points.time[i] = 0;
    points.depth[i] = packet_.ray.tfar[k];
    points.to_viewer.set(i, -Vec3(packet_.ray.dir_x[k], packet_.ray.dir_y[k], packet_.ray.dir_z[k]));
}

void ElementTracer::batch(const ElementRay* rays, int count, std::vector<ElementHit>& hits) {
    RTCRay16& to = packet_.ray;
    for (int first = 0; first < count; first += 16) {
        const int here = std::min(count - first, 16);
        for (int k = 0; k < 16; ++k) {
            const ElementRay& ray = rays[first + std::min(k, here - 1)];
            to.org_x[k] = ray.origin.x, to.org_y[k] = ray.origin.y, to.org_z[k] = ray.origin.z;
            to.dir_x[k] = ray.direction.x, to.dir_y[k] = ray.direction.y, to.dir_z[k] = ray.direction.z;
        }
        meet(first, here);
        for (int k = 0; k < here; ++k) {
            const ElementRay& ray = rays[first + k];
            if (met_[first + k] == kGoesOn) {
                hold(first + k, k);
                continue;
            }
            ElementHit& hit = hits.emplace_back();
            hit = {ray.id, met_[first + k], ray.weight, packet_.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID, ray.mirrored};
            if (!hit.left) hit.position = ray.origin + ray.direction * packet_.ray.tfar[k];
        }
    }
    if (any_held_) go_on(rays, count, hits);
}

// The lanes that are held.
void ElementTracer::go_on(const ElementRay* rays, int count, std::vector<ElementHit>& hits) {
    const Snapshot& snapshot = elements_.snapshot();
    any_held_ = false;
    Points& points = passed_->points;
    Coefficients& coefficients = passed_->coefficients;
    points.clear_footprints();
    locate(snapshot, NormalChoice::mesh, points);
    evaluate(snapshot, points, coefficients, passed_->program, eye_ ? nullptr : kEveryLane.data());
    for (int i = 0; i < count; ++i) {
        if (points.slot[i] == kNoSlot) continue;
        const ElementRay& ray = rays[i];
        const CompiledMaterial& material = snapshot.materials[points.material[i]];
        const float alpha = coefficients.alpha[i];
        const auto turn = [&](const Vec3& direction, const Vec3& share, bool mirrored) {
            const Vec3 weight = ray.weight * share;
            if (ray.turns == most_turns_ || greatest(weight) < kLeastWeight) return;
            const Vec3 normal = points.geometric_normal.get(i);
            const float off = points.offset[i] * (direction.dot(normal) < 0 ? -1.0f : 1.0f);
            more_.push_back({points.position.get(i) + normal * off, direction, ray.id, weight, ray.turns + 1,
                             ray.mirrored || mirrored});
        };
        if (alpha > 0) {
            // An element's reflectance holds its alpha.
            const uint32_t element =
                elements_.find(points.slot[i], points.triangle[i], points.b1[i], points.b2[i], ray.direction);
            hits.push_back({ray.id, element, ray.weight, false, ray.mirrored, points.position.get(i)});
        }
        Vec3 through = Vec3(1, 1, 1) * (1 - alpha);
        if (material.transmits) through += coefficients.transmission.get(i) * alpha;
        if (through != Vec3(0, 0, 0)) turn(ray.direction, through, false);
        if (!material.mirrors) continue;
        const Vec3 mirror = coefficients.mirror.get(i) * alpha, n = points.normal.get(i);
        if (mirror != Vec3(0, 0, 0)) turn((ray.direction - n * (2 * ray.direction.dot(n))).normalized(), mirror, true);
    }
}

}  // namespace trp
