#include "radiosity/element_rays.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "film/pixel_random.h"
#include "geometry/embree.h"

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

Hemisphere::Hemisphere(const Vec3& normal) : x_(perpendicular_to(normal)), y_(normal.cross(x_)), normal_(normal) {}

Vec3 Hemisphere::direction(float u, float v) const {
    const float r = std::sqrt(u), angle = 2 * std::numbers::pi_v<float> * v;
    return x_ * (r * std::cos(angle)) + y_ * (r * std::sin(angle)) + normal_ * std::sqrt(std::max(1 - u, 0.0f));
}

void make_hemisphere_rays(const Elements& elements, uint32_t element, uint32_t key, uint32_t first, uint32_t count,
                          std::vector<ElementRay>& out) {
    alignas(64) uint32_t keys[kBatch], indices[kBatch];
    alignas(64) Lanes u, v, s, t;
    std::fill_n(keys, kBatch, key);
    std::iota(indices, indices + kBatch, first);
    random_pair_of(keys, indices, 0, u, v);
    random_pair_of(keys, indices, 1, s, t);
    const Vec3 normal = elements.normal(element);
    const Hemisphere hemisphere(normal);
    out.clear();
    for (uint32_t k = 0; k < count; ++k) {
        const Vec3 p = elements.point_in(element, s[k], t[k]);
        out.push_back({p + normal * clearance(p), hemisphere.direction(u[k], v[k]), k});
    }
}

uint64_t ElementTracer::trace(std::vector<ElementRay>& rays, std::vector<ElementHit>& hits) {
    uint64_t count = 0;
    while (!rays.empty()) {
        more_.clear();
        for (size_t first = 0; first < rays.size(); first += kBatch) {
            const int in_batch = static_cast<int>(std::min<size_t>(rays.size() - first, kBatch));
            batch(&rays[first], in_batch, more_, hits);
        }
        count += rays.size();
        rays.swap(more_);
    }
    return count;
}

void ElementTracer::batch(const ElementRay* rays, int count, std::vector<ElementRay>& more,
                          std::vector<ElementHit>& hits) {
    const Snapshot& snapshot = elements_.snapshot();
    bool any_special = false;
    for (int first = 0; first < count; first += 16) {
        alignas(64) RTCRayHit16 packet;
        alignas(64) int valid[16];
        for (int k = 0; k < 16; ++k) {
            valid[k] = first + k < count ? -1 : 0;
            const ElementRay& ray = rays[std::min(first + k, count - 1)];
            packet.ray.org_x[k] = ray.origin.x, packet.ray.org_y[k] = ray.origin.y, packet.ray.org_z[k] = ray.origin.z;
            packet.ray.dir_x[k] = ray.direction.x, packet.ray.dir_y[k] = ray.direction.y;
            packet.ray.dir_z[k] = ray.direction.z;
            packet.ray.tnear[k] = packet.ray.time[k] = 0;
            packet.ray.tfar[k] = 1e30f;
            packet.ray.mask[k] = kMask;
            packet.ray.flags[k] = packet.ray.id[k] = 0;
            packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        intersect16(snapshot.rays->embree(), valid, packet, Coherence::incoherent);
        for (int k = 0; k < 16 && first + k < count; ++k) {
            const int i = first + k;
            points_.slot[i] = kNoSlot;
            if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) {
                hits.push_back({rays[i].id, kNoElement, rays[i].weight, true, rays[i].mirrored});
                continue;
            }
            const unsigned instance = packet.hit.instID[0][k];
            const uint32_t slot = instance != RTC_INVALID_GEOMETRY_ID ? instance : packet.hit.geomID[k],
                           triangle = packet.hit.primID[k];
            const uint32_t material = snapshot.surfaces[slot].material(triangle);
            if (snapshot.material_flags[material] & (kMayHaveHoles | kTransmits | kMirrors)) {
                points_.slot[i] = slot;
                points_.triangle[i] = triangle;
                points_.b1[i] = packet.hit.u[k];
                points_.b2[i] = packet.hit.v[k];
                points_.time[i] = 0;
                points_.depth[i] = packet.ray.tfar[k];
                points_.to_viewer.set(i, -rays[i].direction);
                any_special = true;
                continue;
            }
            const uint32_t element =
                elements_.find(slot, triangle, packet.hit.u[k], packet.hit.v[k], rays[i].direction);
            hits.push_back({rays[i].id, element, rays[i].weight, false, rays[i].mirrored,
                            rays[i].origin + rays[i].direction * packet.ray.tfar[k]});
        }
    }
    if (any_special) go_on(rays, count, more, hits);
}

// The lanes that met a surface with holes, of glass or with a mirror.
void ElementTracer::go_on(const ElementRay* rays, int count, std::vector<ElementRay>& more,
                          std::vector<ElementHit>& hits) {
    const Snapshot& snapshot = elements_.snapshot();
    std::fill(points_.slot + count, points_.slot + kBatch, kNoSlot);
    points_.clear_footprints();
    locate(snapshot, NormalChoice::mesh, points_);
    evaluate(snapshot, points_, coefficients_, program_);
    for (int i = 0; i < count; ++i) {
        if (points_.slot[i] == kNoSlot) continue;
        const ElementRay& ray = rays[i];
        const CompiledMaterial& material = snapshot.materials[points_.material[i]];
        const float alpha = coefficients_.alpha[i];
        const auto turn = [&](const Vec3& direction, const Vec3& share, bool mirrored) {
            const Vec3 weight = ray.weight * share;
            if (ray.turns == most_turns_ || greatest(weight) < kLeastWeight) return;
            const Vec3 normal = points_.geometric_normal.get(i);
            const float off = points_.offset[i] * (direction.dot(normal) < 0 ? -1.0f : 1.0f);
            more.push_back({points_.position.get(i) + normal * off, direction, ray.id, weight, ray.turns + 1,
                            ray.mirrored || mirrored});
        };
        if (alpha > 0) {
            // An element's reflectance holds its alpha.
            const uint32_t element =
                elements_.find(points_.slot[i], points_.triangle[i], points_.b1[i], points_.b2[i], ray.direction);
            hits.push_back({ray.id, element, ray.weight, false, ray.mirrored, points_.position.get(i)});
        }
        Vec3 through = Vec3(1, 1, 1) * (1 - alpha);
        if (material.transmits) through += coefficients_.transmission.get(i) * alpha;
        if (through != Vec3(0, 0, 0)) turn(ray.direction, through, false);
        if (!material.mirrors) continue;
        const Vec3 mirror = coefficients_.mirror.get(i) * alpha, n = points_.normal.get(i);
        if (mirror != Vec3(0, 0, 0)) turn((ray.direction - n * (2 * ray.direction.dot(n))).normalized(), mirror, true);
    }
}

}  // namespace trp
