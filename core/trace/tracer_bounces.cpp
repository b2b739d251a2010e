// Where the rays of a tree or a path go on from the surfaces that they meet.
//
// A path goes on by one of: mirror reflection, transmission, diffuse reflection, chosen in proportion to the cosine
// (weight K_D), and gloss, which scatters light as the highlight does where no mirror stands for it. With f cos =
// K_S (V·R)^n / π, and directions chosen by (n + 1) / 2π (V·R)^n (Lafortune and Willems, "Using the Modified Phong
// Reflectance Model for Physically Based Rendering", 1994), its weight is 2 K_S / (n + 1); Blinn's, with H chosen by
// (n + 1) / 2π (N·H)^n, whose density in L is that over 4 (V·H), is 8 K_S (V·H) / (n + 1). Lights are sampled at each
// surface, so that diffuse and glossy rays count nothing where they meet one. Paths end by Russian roulette (Arvo and
// Kirk, "Particle Transport and Image Synthesis", 1990).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "trace/tracer.h"

namespace trp {
namespace {

constexpr uint32_t kTurnPair = 3, kChoicePair = 4;  // of random numbers
constexpr float kGreatestWeight = 1e18f;            // of surfaces that give more light than they get
constexpr uint32_t kSureWays = 3;                   // a path is as long as this, unless it counts for nothing
constexpr float kPi = std::numbers::pi_v<float>;

// The direction at the given angle about an axis, turned around it by a share of the circle.
Vec3 around(const Vec3& axis, float cosine, float turn) {
    const Vec3 s = perpendicular_to(axis);
    const float sine = std::sqrt(std::max(1 - cosine * cosine, 0.0f)), angle = 2 * kPi * turn;
    return (axis * cosine + s * (sine * std::cos(angle)) + axis.cross(s) * (sine * std::sin(angle))).normalized();
}

// Chosen in proportion to cosine^n about an axis.
Vec3 lobe(const Vec3& axis, float n, float u, float v) {
    return around(axis, std::pow(1 - u, 1 / (n + 1)), v);
}

}  // namespace

// The local terms of the equation at the batch's points, and what its solids are to its rays.
void Tracer::shade(Coherence coherence, const RandomPairs& random, TreeWorkspace& w) const {
    evaluate(snapshot, w.points, w.coefficients, w.program, w.scattered);
    cross_surfaces(w);
    for (int i = 0; i < kBatch; ++i)
        if (w.lamps_sampled[i]) w.coefficients.emission.set(i, {0, 0, 0});
    add_ambient(w.points, w.coefficients, illumination.ambient, w.light.radiance);
    w.light.clear();
    ShadowCounts shadows;
    add_lights(snapshot, illumination, coherence, random, w.points, w.coefficients, w.light.sums, w.lights, w.program,
               shadows);
    job.counts->shadow_rays += shadows.rays;
    job.counts->shadow_time += shadows.nanoseconds;
    w.shadow_time = shadows.nanoseconds;
    if (straight()) return;
    const bool bounces = w.points.any_mirror || w.points.any_transmission;
    if (bounces) find_bounces(w.points, w.coefficients, w.bounces);
    if (one_way() || (bounces && job.settings.trace.rough)) random(kTurnPair, w.turn_u, w.turn_v);
    if (one_way()) random(kChoicePair, w.choice, w.survival);
    if (bounces && job.settings.trace.rough) roughen(w);
}

// Rays are spread about the directions of polished surfaces like the highlight (Cook, Porter and Carpenter,
// "Distributed Ray Tracing", 1984); those that would end on the wrong side of the surface are mirrored by it.
void Tracer::roughen(TreeWorkspace& w) const {
    for (int i = 0; i < kBatch; ++i) {
        if (w.points.slot[i] == kNoSlot) continue;
        if (!(snapshot.material_flags[w.points.material[i]] & (kMirrors | kTransmits))) continue;
        const Vec3 g = w.points.geometric_normal.get(i);
        for (LaneVec3* directions : {&w.bounces.mirror_direction, &w.bounces.transmitted_direction}) {
            const float side = directions == &w.bounces.mirror_direction ? 1.0f : -1.0f;
            Vec3 d = lobe(directions->get(i), w.coefficients.shininess[i], w.turn_u[i], w.turn_v[i]);
            const float height = g.dot(d) * side;
            if (height < 0) d -= g * (2 * height * side);
            directions->set(i, d);
        }
    }
}

// For each lane: on which side of which solids its rays go on. A surface whose space another solid fills is not there.
void Tracer::cross_surfaces(TreeWorkspace& w) const {
    if (straight() || (!w.points.any_mirror && !w.points.any_transmission)) {
        std::copy_n(w.media_of, kBatch, w.beyond);
        std::fill_n(w.crosses, kBatch, uint8_t{0});
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

void Tracer::push(const PathRay& parent, int i, Way way, const Vec3& direction, const Vec3& weight,
                  TreeWorkspace& w) const {
    if (weight == Vec3(0, 0, 0)) return;
    static constexpr uint32_t kSalts[kWays] = {0x85EBCA6Bu, 0xC2B2AE35u, 0x27D4EB2Fu};
    static constexpr PassId kParts[kWays] = {kReflectionPart, kTransmissionPart, kDiffuseIndirect};
    const auto k = static_cast<int>(way);
    const TraceLimits& limits = job.settings.trace;
    PathRay ray = parent;
    ray.weight = parent.weight * weight;
    if (!(greatest(ray.weight) <= kGreatestWeight)) return;
    ++ray.ways[k];
    if (parent.depth() == 0) ray.part = kParts[k];
    const bool too_deep = ray.depth() > limits.depth || ray.ways[k] > limits.ways[k];
    const bool too_weak = !one_way() && greatest(ray.weight) < limits.least_weight;
    const Vec3 normal = w.points.geometric_normal.get(i);
    const float offset = w.points.offset[i] * (normal.dot(direction) < 0 ? -1.0f : 1.0f);
    ray.origin = w.points.position.get(i) + normal * offset;
    ray.direction = direction;
    ray.skipped = std::abs(normal.dot(direction)) * w.points.offset[i];
    ray.lamps_sampled = ray.world_sampled = false;
    if (w.tree) {
        RayNode node;
        node.kind = way == Way::reflection ? RayNode::Kind::reflection : RayNode::Kind::transmission;
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
    if (way == Way::transmission) ray.medium = w.beyond[i];
    ray.key = parent.key * 0x9E3779B1u + kSalts[k];
    ++w.rays_of[k];
    w.stack.push_back(ray);
}

// The rays of a lane's next level; `parent` is as it came.
void Tracer::spawn(int i, const PathRay& parent, float distance, TreeWorkspace& w) const {
    const float alpha = w.coefficients.alpha[i];
    if (!(alpha > 0)) return;
    PathRay ray = parent;
    ray.width += ray.spread * distance;
    if (one_way()) return spawn_one(i, ray, w);
    const uint8_t flags = snapshot.material_flags[w.points.material[i]];
    if (flags & (kMirrors | kTransmits))
        push(ray, i, Way::reflection, w.bounces.mirror_direction.get(i), w.bounces.mirror_weight.get(i) * alpha, w);
    if (flags & kTransmits)
        push(ray, i, Way::transmission, w.bounces.transmitted_direction.get(i),
             w.bounces.transmitted_weight.get(i) * alpha, w);
}

// A path's next ray, which counts for all ways that it could have taken.
void Tracer::spawn_one(int i, const PathRay& parent, TreeWorkspace& w) const {
    const uint8_t flags = snapshot.material_flags[w.points.material[i]];
    const float n = w.coefficients.shininess[i];
    const Vec3 none(0, 0, 0);
    const Vec3 mirror = flags & (kMirrors | kTransmits) ? w.bounces.mirror_weight.get(i) : none;
    const Vec3 through = flags & kTransmits ? w.bounces.transmitted_weight.get(i) : none;
    const Vec3 diffuse = w.coefficients.diffuse.get(i);
    const bool blinn = illumination.specular == Specular::blinn;
    const bool glossy =
        illumination.specular != Specular::none && (!(flags & kMirrors) || w.coefficients.mirror.get(i) == none);
    const Vec3 gloss = glossy ? w.coefficients.specular.get(i) * ((blinn ? 8 : 2) / (n + 1)) : none;

    enum { kMirrorWay, kThroughWay, kDiffuseWay, kGlossWay, kChoices };
    const Vec3 weights[kChoices] = {mirror, through, diffuse, gloss};
    float total = 0;
    for (const Vec3& weight : weights) total += greatest(weight);
    if (!(total > 0)) return;
    float left = w.choice[i] * total;
    int chosen = 0;
    while (chosen < kChoices - 1 && left >= greatest(weights[chosen])) left -= greatest(weights[chosen++]);
    while (chosen > 0 && greatest(weights[chosen]) == 0) --chosen;  // rounding
    Vec3 weight = weights[chosen] * (total / greatest(weights[chosen])) * w.coefficients.alpha[i];

    const Vec3 normal = w.points.normal.get(i), viewer = w.points.to_viewer.get(i);
    Way way = Way::diffuse;
    Vec3 direction;
    switch (chosen) {
        case kMirrorWay:
            way = Way::reflection;
            direction = w.bounces.mirror_direction.get(i);
            break;
        case kThroughWay:
            way = Way::transmission;
            direction = w.bounces.transmitted_direction.get(i);
            break;
        case kDiffuseWay:
            direction = around(normal, std::sqrt(1 - w.turn_u[i]), w.turn_v[i]);
            break;
        default: {
            way = Way::reflection;
            const Vec3 half = blinn ? lobe(normal, n, w.turn_u[i], w.turn_v[i]) : normal;
            direction = half * (2 * half.dot(viewer)) - viewer;
            if (blinn)
                weight = weight * std::max(half.dot(viewer), 0.0f);
            else
                direction = lobe(direction, n, w.turn_u[i], w.turn_v[i]);
        }
    }
    const bool scattered = chosen == kDiffuseWay || chosen == kGlossWay;
    if (scattered && !(direction.dot(normal) > 0 && direction.dot(w.points.geometric_normal.get(i)) > 0)) return;
    if (parent.depth() >= kSureWays) {
        const float survives = std::min(greatest(parent.weight * weight), 1.0f);
        if (!(w.survival[i] < survives)) return;
        weight /= survives;
    }
    const size_t before = w.stack.size();
    push(parent, i, way, direction, weight, w);
    if (!scattered || w.stack.size() == before) return;
    PathRay& ray = w.stack.back();
    ray.lamps_sampled = true;
    ray.world_sampled = chosen == kDiffuseWay;  // highlights are of lights that have a place
    ray.spread = std::max(ray.spread, 0.5f * std::sqrt(2 / ((chosen == kDiffuseWay ? 1 : n) + 1)));
}

}  // namespace trp
