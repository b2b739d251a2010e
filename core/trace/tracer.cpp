#include "trace/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/clock.h"
#include "film/adaptive.h"
#include "film/pixel_random.h"
#include "shading/footprints.h"

namespace trp {
namespace {

// What a medium leaves of light over a distance; `filling` as Media::filling() gives it.
Vec3 fading(const CompiledMaterial* filling, float distance) {
    if (!filling || filling->absorption == Vec3(0, 0, 0)) return {1, 1, 1};
    Vec3 out;
    for (int c = 0; c < 3; ++c) out[c] = filling->absorption[c] > 0 ? std::exp(-filling->absorption[c] * distance) : 1;
    return out;
}

}  // namespace

void Tracer::record_hit(const PathRay& ray, int i, float distance, TreeWorkspace& w) const {
    RayNode& node = (*w.tree)[static_cast<size_t>(ray.node)];
    node.end = RayNode::End::surface;
    node.distance += distance;
    node.slot = w.points.slot[i];
    node.material = w.points.material[i];
    node.position = w.points.position.get(i);
    node.normal = w.points.normal.get(i);
    node.local += w.light.radiance.get(i) * w.coefficients.alpha[i];
}

// Area lights that the camera sees, in front of what was hit: a lane that meets one is done.
void Tracer::add_seen_lights(TreeWorkspace& w) const {
    if (!see_area_lights(snapshot.lights, true, w.primary, w.active, w.seen)) return;
    for (int i = 0; i < kBatch; ++i) {
        if (!(w.seen.t[i] > 0)) continue;
        const Vec3 throughput = w.throughput.get(i), radiance = w.seen.radiance.get(i);
        add_seen_light(i, throughput, radiance, w.seen.group[i], w.sums);
        if (w.tree) {
            RayNode& root = w.tree->front();
            root.end = RayNode::End::light;
            root.distance = w.seen.t[i];
            root.local += radiance * throughput;
        }
        w.active[i] = 0;
        w.points.slot[i] = kNoSlot;
    }
}

// What absorbs primary rays since the layer before.
void Tracer::fade_primary(TreeWorkspace& w) const {
    for (int i = 0; i < kBatch; ++i) {
        if (!w.active[i]) continue;
        const float reached = w.points.slot[i] == kNoSlot ? std::numeric_limits<float>::infinity()
                                                          : w.points.depth[i] * w.primary.direction.get(i).length();
        const Vec3 faded = fading(w.media.filling(w.media_of[i]), reached - w.travelled[i]);
        w.throughput.set(i, w.throughput.get(i) * faded);
        w.travelled[i] = reached;
    }
}

// The background, to the primary rays that end there.
void Tracer::add_missed(const LaneVec3* throughput, TreeWorkspace& w) const {
    add_background(snapshot, w.primary.direction, w.missed, throughput, job.settings.transparent, w.sums);
    if (!w.tree || !snapshot.world.visible_camera) return;
    sample_background(snapshot, w.primary.direction, w.missed, w.background);
    for (int i = 0; i < kBatch; ++i)
        if (w.missed[i]) w.tree->front().local += w.background.get(i) * w.throughput.get(i);
}

// The first branches, from the surfaces that primary rays have met.
void Tracer::spawn_primary(uint32_t sample, TreeWorkspace& w) const {
    for (int i = 0; i < kBatch; ++i) {
        if (w.points.slot[i] == kNoSlot) continue;
        const Vec3 direction = w.primary.direction.get(i);
        const float length = direction.length(), distance = w.points.depth[i] * length;
        PathRay ray;
        ray.origin = w.primary.origin.get(i);
        ray.direction = direction / length;
        ray.weight = w.throughput.get(i);
        ray.key = w.primary.keys[i];
        ray.index = w.primary.indices[i] + sample;
        ray.medium = w.media_of[i];
        ray.time = w.points.time[i];
        ray.lane = static_cast<uint16_t>(i);
        (maker.view.perspective ? ray.spread : ray.width) = pixel_step / (maker.view.perspective ? length : 1);
        if (w.tree) {
            const Vec3 before = w.tree->front().local;
            record_hit(ray, i, 0, w);
            RayNode& root = w.tree->front();
            root.local = before + (root.local - before) * ray.weight;
            root.distance = distance;
        }
        spawn(i, ray, distance, w);
    }
}

// Primary rays go on behind the surfaces that let them through. Returns whether any does.
bool Tracer::pass_primary(TreeWorkspace& w) const {
    if (!w.points.any_holes && !(straight() && w.points.any_transmission)) return false;
    bool any_left = false;
    for (int i = 0; i < kBatch; ++i) {
        w.active[i] = 0;
        if (w.points.slot[i] == kNoSlot) continue;
        w.throughput.set(i, throughput_behind(w.points, w.coefficients, i, w.throughput.get(i), straight()));
        if (w.throughput.get(i) == Vec3(0, 0, 0)) continue;
        w.active[i] = 1;
        any_left = true;
        if (w.coefficients.alpha[i] == 0 && !w.crosses[i]) w.media_of[i] = w.beyond[i];
        pass_surface(w.primary, i, w.points, maker.view.clip_end);
    }
    return any_left;
}

// One sample of the active pixels of a block: the nearest surfaces, and where they have holes, those behind. Returns
// the packets that see an edge.
uint32_t Tracer::primary(uint32_t block_x, uint32_t block_y, uint32_t sample, TreeWorkspace& w) const {
    auto start = Clock::now();
    float* const ray_count = w.sums.channel(kRayCount, 0);
    make_primary_rays(maker, block_x, block_y, sample, w.primary);
    for (int c = 0; c < 3; ++c) std::fill_n(w.throughput[c], kBatch, 1.0f);
    std::fill_n(w.media_of, kBatch, w.start);
    std::fill_n(w.travelled, kBatch, 0.0f);
    std::fill_n(w.lamps_sampled, kBatch, uint8_t{0});
    std::fill_n(w.scattered, kBatch, uint8_t{0});
    const bool starts_inside = w.start != Media::kOutside;
    uint8_t first[kBatch] = {};
    uint64_t primary_rays = 0, primary_time = 0;
    uint32_t edges = 0;
    // Packets are whole and their lanes fixed to the film in the first layer alone.
    Coherence coherence = Coherence::coherent;
    for (int layer = 0; layer < kGreatestLayers; ++layer) {
        if (layer > 0) start = Clock::now();
        primary_rays += static_cast<uint64_t>(std::count(w.active, w.active + kBatch, 1));
        for (int i = 0; i < kBatch && ray_count; ++i) ray_count[i] += w.active[i];
        trace_primary(snapshot.rays->embree(), w.active, coherence, w.primary);
        read_hits(w.primary, w.active, w.points);
        if (sees_lights) add_seen_lights(w);
        primary_time += nanoseconds(start, Clock::now());
        const Found found = find_missed(w.active, w.points, w.missed);
        if (starts_inside) fade_primary(w);
        const LaneVec3* const throughput = layer > 0 || starts_inside ? &w.throughput : nullptr;
        if (found.any_missed) add_missed(throughput, w);
        if (!found.any_hit) break;
        const auto shading = Clock::now();
        locate(snapshot, job.settings.normals(), w.points);
        if (snapshot.needs_footprint)
            make_footprints(
                {w.primary.direction, maker.view.perspective, maker.view.x * (maker.view.step_x * maker.footprint),
                 maker.view.y * (maker.view.step_y * maker.footprint)},
                w.points);
        shade(
            coherence,
            [&](uint32_t pair, float* u, float* v) {
                random_pair(block_x, block_y, maker.sequence, sample, pair, u, v);
            },
            w);
        if (layer == 0 && job.settings.adaptive.threshold > 0) edges = packets_at_edges(w.points);
        add_surfaces({snapshot, w.points, w.coefficients, w.light.sums, throughput, illumination.ambient, straight()},
                     sample == 0 ? first : nullptr, w.sums);
        const bool bounces = one_way() || w.points.any_mirror || w.points.any_transmission;
        if (!straight() && (bounces || w.tree)) spawn_primary(sample, w);
        job.counts->shading_time += nanoseconds(shading, Clock::now()) - w.shadow_time;
        if (!pass_primary(w)) break;
        coherence = Coherence::incoherent;
    }
    if (sample == 0) finish_depth(first, w.sums);
    job.counts->primary_rays += primary_rays;
    job.counts->primary_time += primary_time;
    return edges;
}

// The last rays of the stack, as many as a batch holds, are traced. Returns their number.
int Tracer::take_rays(TreeWorkspace& w) const {
    const auto count = static_cast<int>(std::min<size_t>(w.stack.size(), kBatch));
    std::copy(w.stack.end() - count, w.stack.end(), w.rays);
    w.stack.resize(w.stack.size() - static_cast<size_t>(count));
    for (int i = 0; i < kBatch; ++i) {
        const PathRay& ray = w.rays[i < count ? i : 0];
        w.active[i] = i < count;
        w.keys[i] = ray.key;
        w.indices[i] = ray.index;
        w.media_of[i] = ray.medium;
        w.secondary.origin.set(i, ray.origin);
        w.secondary.direction.set(i, ray.direction);
        RTCRay16& out = w.secondary.packets[i >> 4].ray;
        const int k = i & 15;
        out.org_x[k] = ray.origin.x, out.org_y[k] = ray.origin.y, out.org_z[k] = ray.origin.z;
        out.dir_x[k] = ray.direction.x, out.dir_y[k] = ray.direction.y, out.dir_z[k] = ray.direction.z;
        out.time[k] = ray.time;
        out.tnear[k] = 0;
        out.tfar[k] = std::numeric_limits<float>::infinity();
    }
    trace_primary(snapshot.rays->embree(), w.active, Coherence::incoherent, w.secondary);
    read_hits(w.secondary, w.active, w.points);
    return count;
}

void Tracer::gain(const PathRay& ray, const Vec3& value, TreeWorkspace& w) const {
    const Vec3 gained = ray.weight * value;
    w.sums.add(kCombined, ray.lane, gained);
    w.sums.add(ray.part, ray.lane, gained);
}

// What absorbs the rays on their way, and the lights and the background that some of them end at.
Found Tracer::end_rays(int count, TreeWorkspace& w) const {
    const bool any_seen = any_area_lights && see_area_lights(snapshot.lights, false, w.secondary, w.active, w.seen);
    for (int i = 0; i < count; ++i) {
        PathRay& ray = w.rays[i];
        // A ray that counts nothing of lamps goes on behind them: they are light, not bodies.
        const bool at_light = any_seen && w.seen.t[i] > 0 && !ray.lamps_sampled;
        const float distance = at_light                      ? w.seen.t[i]
                               : w.points.slot[i] == kNoSlot ? std::numeric_limits<float>::infinity()
                                                             : w.points.depth[i];
        const Vec3 faded = fading(w.media.filling(ray.medium), distance + ray.skipped);
        ray.weight = ray.weight * faded;
        if (RayNode* const node = w.node_of(ray)) node->weight = node->weight * faded;
        if (!at_light) continue;
        const Vec3 radiance = w.seen.radiance.get(i);
        gain(ray, radiance, w);
        add_to_group(w.seen.group[i], ray.lane, ray.weight * radiance, w.sums);
        w.points.slot[i] = kNoSlot;
        w.active[i] = 0;
        if (RayNode* const node = w.node_of(ray)) {
            node->end = RayNode::End::light;
            node->distance += distance;
            node->local = radiance;
        }
    }
    const Found found = find_missed(w.active, w.points, w.missed);
    if (found.any_missed && snapshot.world.radiance != Vec3(0, 0, 0)) {
        sample_background(snapshot, w.secondary.direction, w.missed, w.background);
        for (int i = 0; i < count; ++i) {
            if (!w.missed[i] || w.rays[i].world_sampled) continue;
            gain(w.rays[i], w.background.get(i), w);
            if (RayNode* const node = w.node_of(w.rays[i])) node->local = w.background.get(i);
        }
    }
    return found;
}

// Where the surface has a hole, the same ray goes on behind it.
void Tracer::pass_hole(int i, const PathRay& ray, TreeWorkspace& w) const {
    const float alpha = w.coefficients.alpha[i];
    if (alpha >= 1 || ray.holes >= kGreatestLayers) return;
    PathRay behind = ray;
    behind.weight = ray.weight * (1 - alpha);
    behind.width += ray.spread * w.points.depth[i];
    ++behind.holes;
    const Vec3 normal = w.points.geometric_normal.get(i);
    behind.origin = w.points.position.get(i) - normal * w.points.offset[i];
    behind.skipped = std::abs(normal.dot(ray.direction)) * w.points.offset[i];
    if (alpha == 0 && !w.crosses[i]) behind.medium = w.beyond[i];
    if (w.tree) {
        RayNode node;
        node.kind = RayNode::Kind::transmission;
        node.parent = ray.node;
        node.origin = behind.origin;
        node.direction = behind.direction;
        node.weight = Vec3(1, 1, 1) * (1 - alpha);
        behind.node = static_cast<int32_t>(w.tree->size());
        w.tree->push_back(node);
    }
    const float weight = greatest(behind.weight);
    if (weight > 0 && (one_way() || weight >= job.settings.trace.least_weight)) w.stack.push_back(behind);
}

void Tracer::secondary(TreeWorkspace& w) const {
    const auto start = Clock::now();
    const int count = take_rays(w);
    const auto traced = Clock::now();
    job.counts->primary_time += nanoseconds(start, traced);
    w.shadow_time = 0;
    if (float* const rays = w.sums.channel(kRayCount, 0))
        for (int i = 0; i < count; ++i) ++rays[w.rays[i].lane];
    if (float* const depth = w.sums.channel(kTreeDepth, 0))
        for (int i = 0; i < count; ++i)
            depth[w.rays[i].lane] = std::max(depth[w.rays[i].lane], static_cast<float>(w.rays[i].depth()));
    if (end_rays(count, w).any_hit) {
        locate(snapshot, job.settings.normals(), w.points);
        if (snapshot.needs_footprint) {
            for (int i = 0; i < count; ++i) {
                const Vec3 d = w.rays[i].direction;
                const float width = w.rays[i].width + w.rays[i].spread * w.points.depth[i];
                const Vec3 s = perpendicular_to(d);
                w.steps[0].set(i, s * width);
                w.steps[1].set(i, d.cross(s) * width);
            }
            make_footprints({w.secondary.direction, false, Vec3(0, 0, 0), Vec3(0, 0, 0), w.steps}, w.points);
        }
        for (int i = 0; i < count; ++i) {
            w.lamps_sampled[i] = w.rays[i].lamps_sampled;
            w.scattered[i] = w.rays[i].lamps_sampled || w.rays[i].ways[static_cast<int>(Way::diffuse)] > 0;
        }
        shade(
            Coherence::incoherent,
            [&](uint32_t pair, float* u, float* v) { random_pair_of(w.keys, w.indices, pair, u, v); }, w);
        const GroupLight* const groups = w.light.sums.groups;
        for (int i = 0; i < count; ++i) {
            if (w.points.slot[i] == kNoSlot) continue;
            gain(w.rays[i], w.light.radiance.get(i) * w.coefficients.alpha[i], w);
            for (uint32_t group = 1; group <= kLightGroups && groups; ++group)
                add_to_group(group, w.rays[i].lane,
                             w.rays[i].weight * groups->of[group - 1].get(i) * w.coefficients.alpha[i], w.sums);
            if (w.tree) record_hit(w.rays[i], i, w.points.depth[i], w);
            pass_hole(i, w.rays[i], w);
            spawn(i, w.rays[i], w.points.depth[i], w);
        }
    }
    job.counts->shading_time += nanoseconds(traced, Clock::now()) - w.shadow_time;
}

void Tracer::drain(size_t least, TreeWorkspace& w) const {
    while (!w.stack.empty() && w.stack.size() >= least) {
        if (*job.cancelled) return w.stack.clear();
        secondary(w);
    }
}

void Tracer::begin_block(uint32_t block_x, uint32_t block_y, TreeWorkspace& w) const {
    w.sums = job.film->block(block_x, block_y);
    prepare_block(maker, block_x, block_y, w.primary);
    w.media.clear();
    w.start = Media::kOutside;
    for (const auto& [slot, material] : around_eye) w.start = w.media.enter(w.start, slot, material);
}

void Tracer::block(uint32_t block_x, uint32_t block_y, const TileWork& work, TreeWorkspace& w) const {
    begin_block(block_x, block_y, w);
    take_samples(
        job, work, block_x, block_y, w.active,
        [&](uint32_t sample) {
            const uint32_t edges = primary(block_x, block_y, sample, w);
            drain(kBatch, w);
            return edges;
        },
        [&] { drain(1, w); });
}

void Tracer::tile(const TileWork& work) const {
    const auto w = std::make_unique<TreeWorkspace>(snapshot, job.film->passes());
    for (uint32_t y = work.block_y0; y < work.block_y1; ++y)
        for (uint32_t x = work.block_x0; x < work.block_x1; ++x) block(x, y, work, *w);
    job.counts->reflection_rays += w->rays_of[static_cast<int>(Way::reflection)];
    job.counts->transmission_rays += w->rays_of[static_cast<int>(Way::transmission)];
    job.counts->diffuse_rays += w->rays_of[static_cast<int>(Way::diffuse)];
}

}  // namespace trp
