#include "trace/ray_casting.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "trace/rays.h"
#include "trace/shadow_rays.h"

namespace trp {
namespace {

using Clock = std::chrono::steady_clock;

constexpr uint32_t kFirstLightPair = 4;  // of the random sequence
constexpr int kGreatestLayers = 64;      // of surfaces with holes in a row along one ray
constexpr float kLeastThroughput = 1e-3f;
constexpr float kNothingSeen = 1e10f;  // depth, as Blender has it

uint64_t nanoseconds(Clock::time_point from, Clock::time_point to) {
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(to - from).count());
}

bool is_world(const ReadyLight& light) {
    return light.kind == ReadyLight::Kind::world || light.kind == ReadyLight::Kind::world_map;
}

// What a thread works with; large, so made once for a tile.
struct Workspace {
    explicit Workspace(const PassList& passes) : sums(passes) { prepare(rays, kSeenByCamera); }
    BlockRays rays;
    Points points;
    Coefficients coefficients;
    LightSamples samples;
    LaneVec3 radiance, background;
    ArrivingLight arriving;
    alignas(64) Lanes u, v, visibility, throughput;
    uint8_t active[kBatch], missed[kBatch];
    ShadowScratch shadow;
    ProgramScratch program;
    BlockSums sums;
};

// A render's constants.
struct Caster {
    const RenderJob& job;
    const Snapshot& snapshot;
    RayMaker maker;
    bool wants_shadow_pass, sees_lights;

    void tile(const TileWork& work) const;
    void block(uint32_t block_x, uint32_t block_y, const TileWork& work, Workspace& w) const;
    void layers(uint32_t block_x, uint32_t block_y, uint32_t sample, bool first_sample, Workspace& w) const;
    void shade(uint32_t block_x, uint32_t block_y, uint32_t sample, Coherence coherence, Workspace& w) const;
    void add_background(Workspace& w) const;
    void add_seen_lights(Workspace& w) const;
    void write_surface(bool first_sample, uint8_t* seen, Workspace& w) const;
};

// The equation at all points of the batch, into w.radiance.
void Caster::shade(uint32_t block_x, uint32_t block_y, uint32_t sample, Coherence coherence, Workspace& w) const {
    const auto start = Clock::now();
    locate(snapshot, job.settings.normals, w.points);
    if (snapshot.needs_footprint) make_footprints(maker, w.rays, w.points);
    evaluate(snapshot, w.points, w.coefficients, w.program);
    add_ambient(w.points, w.coefficients, job.settings.ambient, w.radiance);
    if (wants_shadow_pass)
        for (int c = 0; c < 3; ++c) {
            std::fill_n(w.arriving.unblocked[c], kBatch, 0.0f);
            std::fill_n(w.arriving.blocked[c], kBatch, 0.0f);
        }
    uint64_t shadow_time = 0, shadow_rays = 0;
    for (size_t l = 0; l < snapshot.lights.size(); ++l) {
        const ReadyLight& light = snapshot.lights[l];
        if (light.is_sampled())
            random_pair(block_x, block_y, job.settings.seed, sample, kFirstLightPair + static_cast<uint32_t>(l), w.u,
                        w.v);
        sample_light(snapshot, light, job.settings.falloff, w.points, w.u, w.v, w.samples, w.program);
        if (job.settings.shadows && light.cast_shadow) {
            const auto before = Clock::now();
            shadow_rays +=
                trace_shadows(snapshot, w.points, w.samples, is_world(light) ? Coherence::incoherent : coherence,
                              w.visibility, w.shadow, w.program);
            shadow_time += nanoseconds(before, Clock::now());
        } else {
            std::fill_n(w.visibility, kBatch, 1.0f);
        }
        // The highlight stands for lights that have a place; the world shows in mirrors.
        add_light(is_world(light) ? Specular::none : job.settings.specular, w.points, w.coefficients, w.samples,
                  w.visibility, w.radiance, wants_shadow_pass ? &w.arriving : nullptr);
    }
    job.counts->shadow_rays += shadow_rays;
    job.counts->shadow_time += shadow_time;
    job.counts->shading_time += nanoseconds(start, Clock::now()) - shadow_time;
}

// Passes of the lanes that see a surface, weighed by what reaches them through holes before.
void Caster::write_surface(bool first_sample, uint8_t* seen, Workspace& w) const {
    const PassList& passes = job.film->passes();
    const std::array<float*, 4> rgba = w.sums.combined();
    // Without branches, for the compiler to make vectors of; radiance is 0 where nothing was hit.
    Lanes weights;
    for (int i = 0; i < kBatch; ++i)
        weights[i] = w.points.slot[i] == kNoSlot ? 0 : w.throughput[i] * w.coefficients.alpha[i];
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kBatch; ++i) rgba[c][i] += weights[i] * w.radiance[c][i];
    for (int i = 0; i < kBatch; ++i) rgba[3][i] += weights[i];
    if (passes.order().size() == 1) return;

    for (int i = 0; i < kBatch; ++i) {
        const float alpha = w.points.slot[i] == kNoSlot ? 0 : w.coefficients.alpha[i];
        if (!(alpha > 0)) continue;
        const float weight = w.throughput[i] * alpha;
        w.sums.add(kNormal, i, w.points.normal.get(i) * weight);
        w.sums.add(kAlbedo, i, w.coefficients.diffuse.get(i) * weight);
        w.sums.add(kEmit, i, w.coefficients.emission.get(i) * weight);
        if (wants_shadow_pass) {
            Vec3 share(1, 1, 1);
            for (int c = 0; c < 3; ++c)
                if (w.arriving.unblocked[c][i] > 0) share[c] = w.arriving.blocked[c][i] / w.arriving.unblocked[c][i];
            w.sums.add(kShadow, i, share * weight);
        }
        if (!first_sample || seen[i]) continue;
        seen[i] = 1;
        const PlacedSurface& surface = snapshot.surfaces[w.points.slot[i]];
        if (float* depth = w.sums.channel(kDepth, 0)) depth[i] = hit_depth(w.rays, i);
        w.sums.add(kPosition, i, w.points.position.get(i) + Vec3(snapshot.origin));
        if (passes.has(kUv)) {
            const Vec2 uv = first_uv(surface, w.points, i);
            w.sums.add(kUv, i, {uv.x, uv.y, 1});
        }
        if (float* index = w.sums.channel(kObjectIndex, 0)) index[i] = static_cast<float>(surface.index);
        if (float* index = w.sums.channel(kMaterialIndex, 0))
            index[i] = static_cast<float>(snapshot.materials[w.points.material[i]].index);
    }
}

// Area lights that the camera sees, in front of what was hit: a lane that meets one is done.
void Caster::add_seen_lights(Workspace& w) const {
    const std::array<float*, 4> rgba = w.sums.combined();
    for (int i = 0; i < kBatch; ++i) {
        if (!w.active[i]) continue;
        const RTCRay16& ray = w.rays.packets[i >> 4].ray;
        SeenLight nearest{ray.tfar[i & 15], {}};
        bool any = false;
        for (const ReadyLight& light : snapshot.lights) {
            if (!light.visible_camera) continue;
            const SeenLight seen = see_area_light(light, w.rays.origin.get(i), w.rays.direction.get(i));
            if (!(seen.t > ray.tnear[i & 15] && seen.t < nearest.t)) continue;
            nearest = seen;
            any = true;
        }
        if (!any) continue;
        for (int c = 0; c < 3; ++c) rgba[c][i] += w.throughput[i] * nearest.radiance[c];
        rgba[3][i] += w.throughput[i];
        w.sums.add(kShadow, i, Vec3(1, 1, 1) * w.throughput[i]);
        w.active[i] = 0;
        w.points.slot[i] = kNoSlot;
    }
}

void Caster::add_background(Workspace& w) const {
    sample_background(snapshot, w.rays.direction, w.missed, w.background);
    const std::array<float*, 4> rgba = w.sums.combined();
    for (int i = 0; i < kBatch; ++i) {
        if (!w.missed[i]) continue;
        const float weight = w.throughput[i];
        if (!job.settings.transparent) {
            for (int c = 0; c < 3; ++c) rgba[c][i] += weight * w.background[c][i];
            rgba[3][i] += weight;
        }
        w.sums.add(kShadow, i, Vec3(weight, weight, weight));
    }
}

// One sample of all pixels of a block: the nearest surfaces, and where they have holes, those behind.
void Caster::layers(uint32_t block_x, uint32_t block_y, uint32_t sample, bool first_sample, Workspace& w) const {
    const auto start = Clock::now();
    make_primary_rays(maker, block_x, block_y, sample, w.rays);
    std::fill_n(w.active, kBatch, uint8_t{1});
    std::fill_n(w.throughput, kBatch, 1.0f);
    uint8_t seen[kBatch] = {};
    uint64_t primary_rays = kBatch, primary_time = nanoseconds(start, Clock::now());
    // Packets are whole and their lanes fixed to the film in the first layer alone.
    Coherence coherence = Coherence::coherent;
    for (int layer = 0; layer < kGreatestLayers; ++layer) {
        const auto before = Clock::now();
        trace_primary(snapshot.rays->embree(), w.active, coherence, w.rays);
        read_hits(w.rays, w.active, w.points);
        if (sees_lights) add_seen_lights(w);
        primary_time += nanoseconds(before, Clock::now());
        bool any_missed = false, any_hit = false;
        for (int i = 0; i < kBatch; ++i) {
            w.missed[i] = w.active[i] && w.points.slot[i] == kNoSlot;
            any_missed |= w.missed[i];
            any_hit |= w.points.slot[i] != kNoSlot;
        }
        if (any_missed) add_background(w);
        if (!any_hit) break;
        shade(block_x, block_y, sample, coherence, w);
        write_surface(first_sample, seen, w);
        if (!w.points.any_holes) break;

        bool any_left = false;
        for (int i = 0; i < kBatch; ++i) {
            w.active[i] = 0;
            if (w.points.slot[i] == kNoSlot) continue;
            w.throughput[i] *= 1 - w.coefficients.alpha[i];
            if (w.throughput[i] < kLeastThroughput) continue;
            w.active[i] = 1;
            any_left = true;
            ++primary_rays;
            RTCRay16& ray = w.rays.packets[i >> 4].ray;
            ray.tnear[i & 15] = ray.tfar[i & 15] * (1 + 4e-7f) + 2 * w.points.offset[i];
            ray.tfar[i & 15] = maker.view.clip_end;
        }
        if (!any_left) break;
        coherence = Coherence::incoherent;
    }
    if (first_sample)
        if (float* depth = w.sums.channel(kDepth, 0))
            for (int i = 0; i < kBatch; ++i)
                if (!seen[i]) depth[i] = kNothingSeen;
    job.counts->primary_rays += primary_rays;
    job.counts->primary_time += primary_time;
}

void Caster::block(uint32_t block_x, uint32_t block_y, const TileWork& work, Workspace& w) const {
    w.sums.clear();
    for (uint32_t sample = work.first_sample; sample < work.end_sample; ++sample) {
        if (*job.cancelled) return;
        layers(block_x, block_y, sample, sample == 0, w);
    }
    job.film->add_block(block_x, block_y, w.sums, work.end_sample - work.first_sample, work.first_sample == 0);
}

void Caster::tile(const TileWork& work) const {
    const auto w = std::make_unique<Workspace>(job.film->passes());
    for (uint32_t y = work.block_y0; y < work.block_y1; ++y)
        for (uint32_t x = work.block_x0; x < work.block_x1; ++x) block(x, y, work, *w);
}

}  // namespace

bool ray_casting(RenderJob& job, const RenderEvents& events) {
    const Window& window = job.film->window();
    const Settings& settings = job.settings;
    if (!job.snapshot->camera) fail(TRP_ERROR_STATE, "the scene has no camera to render from");
    const Caster caster{job, *job.snapshot,
                        RayMaker{make_view(*job.snapshot->camera, job.snapshot->origin, window.width, window.height),
                                 PixelFilter(settings.filter, settings.filter_width), settings.seed,
                                 std::max(0.125f, 1 / std::sqrt(static_cast<float>(settings.samples)))},
                        job.film->passes().has(kShadow),
                        std::any_of(job.snapshot->lights.begin(), job.snapshot->lights.end(),
                                    [](const ReadyLight& l) { return l.visible_camera; })};
    if (events.log)
        events.log(fmt::format("{} x {} pixels, {} samples, {} lights", window.w, window.h, settings.samples,
                               job.snapshot->lights.size()));
    return run_tiles(job, events, [&](const TileWork& work) { caster.tile(work); });
}

}  // namespace trp
