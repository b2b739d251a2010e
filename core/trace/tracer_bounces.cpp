// Where the rays of a tree go on from the surfaces that they meet.
#include <algorithm>
#include <cmath>

#include "trace/tracer.h"

namespace trp {

// The local terms of the equation at the batch's points, and what its solids are to its rays.
void Tracer::shade(Coherence coherence, const RandomPairs& random, TreeWorkspace& w) const {
    evaluate(snapshot, w.points, w.coefficients, w.program);
    cross_surfaces(w);
    add_ambient(w.points, w.coefficients, illumination.ambient, w.radiance);
    if (wants_shadow_pass) w.arriving.clear();
    ShadowCounts shadows;
    add_lights(snapshot, illumination, coherence, random, w.points, w.coefficients, w.radiance,
               wants_shadow_pass ? &w.arriving : nullptr, w.lights, w.program, shadows);
    job.counts->shadow_rays += shadows.rays;
    job.counts->shadow_time += shadows.nanoseconds;
    w.shadow_time = shadows.nanoseconds;
    if (w.points.any_mirror || w.points.any_transmission) find_bounces(w.points, w.coefficients, w.bounces);
}

// For each lane: on which side of which solids its rays go on. A surface whose space another solid fills is not there.
void Tracer::cross_surfaces(TreeWorkspace& w) const {
    if (!w.points.any_mirror && !w.points.any_transmission) {
        std::copy_n(w.media_of, kBatch, w.beyond);
        return;
    }
    for (int i = 0; i < kBatch; ++i) {
        w.beyond[i] = w.media_of[i];
        w.crosses[i] = 0;
        w.bounces.flags[i] = 0;
        w.bounces.eta[i] = 1;
        if (w.points.slot[i] == kNoSlot) continue;
        const CompiledMaterial& material = snapshot.materials[w.points.material[i]];
        w.bounces.flags[i] = static_cast<uint8_t>((material.thin ? kThin : 0) | (material.fresnel ? kFresnel : 0));
        const auto ior = [](const CompiledMaterial* filling) { return filling ? filling->constants[kIor] : 1.0f; };
        if (!material.is_solid()) {
            if (material.fresnel && !material.thin)
                w.bounces.eta[i] = ior(w.media.filling(w.media_of[i])) / w.coefficients.ior[i];
            continue;
        }
        const Media::Crossing crossing =
            w.media.cross(w.media_of[i], w.points.slot[i], w.points.material[i], w.points.behind[i]);
        w.beyond[i] = crossing.beyond;
        w.crosses[i] = crossing.is_real;
        if (crossing.is_real)
            w.bounces.eta[i] = ior(crossing.here) / ior(crossing.there);
        else
            w.coefficients.alpha[i] = 0, w.points.any_holes = true;
    }
}

void Tracer::push(const PathRay& parent, int i, RayNode::Kind kind, const Vec3& direction, const Vec3& weight,
                  TreeWorkspace& w) const {
    if (weight == Vec3(0, 0, 0)) return;
    const bool reflects = kind == RayNode::Kind::reflection;
    PathRay ray = parent;
    ray.weight = parent.weight * weight;
    const TraceLimits& limits = job.settings.trace;
    ++(reflects ? ray.reflections : ray.transmissions);
    const bool too_deep = ray.reflections + ray.transmissions > limits.depth ||
                          (reflects ? ray.reflections > limits.reflections : ray.transmissions > limits.transmissions);
    const bool too_weak = std::max({ray.weight.x, ray.weight.y, ray.weight.z}) < limits.least_weight;
    const Vec3 normal = w.points.geometric_normal.get(i);
    const float offset = w.points.offset[i] * (normal.dot(direction) < 0 ? -1.0f : 1.0f);
    ray.origin = w.points.position.get(i) + normal * offset;
    ray.direction = direction;
    ray.skipped = std::abs(normal.dot(direction)) * w.points.offset[i];
    if (w.tree) {
        RayNode node;
        node.kind = kind;
        node.end = too_deep ? RayNode::End::depth : too_weak ? RayNode::End::weight : RayNode::End::background;
        node.parent = parent.node;
        node.origin = ray.origin;
        node.direction = direction;
        // The root stands for all layers of surfaces with holes, which reach the pixel with other weights.
        node.weight = parent.node == 0 ? ray.weight : weight;
        ray.node = static_cast<int32_t>(w.tree->size());
        w.tree->push_back(node);
    }
    if (too_deep || too_weak) return;
    if (!reflects) ray.medium = w.beyond[i];
    ray.key = parent.key * 0x9E3779B1u + (reflects ? 0x85EBCA6Bu : 0xC2B2AE35u);
    ++(reflects ? w.reflection_rays : w.transmission_rays);
    w.stack.push_back(ray);
}

// The rays of a lane's next level; `parent` is as it came, but for its weight and footprint, which are those here.
void Tracer::spawn(int i, const PathRay& parent, float distance, TreeWorkspace& w) const {
    PathRay ray = parent;
    ray.width += ray.spread * distance;
    const float alpha = w.coefficients.alpha[i];
    if (!(alpha > 0)) return;
    const uint8_t flags = snapshot.material_flags[w.points.material[i]];
    if (flags & (kMirrors | kTransmits))
        push(ray, i, RayNode::Kind::reflection, w.bounces.mirror_direction.get(i),
             w.bounces.mirror_weight.get(i) * alpha, w);
    if (flags & kTransmits)
        push(ray, i, RayNode::Kind::transmission, w.bounces.transmitted_direction.get(i),
             w.bounces.transmitted_weight.get(i) * alpha, w);
}

}  // namespace trp
