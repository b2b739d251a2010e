#include "trace/ray_casting.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "film/adaptive.h"
#include "film/pixel_random.h"
#include "film/surface_passes.h"
#include "shading/footprints.h"
#include "trace/seen_lights.h"

namespace trp {
namespace {

// What a thread works with; large, so made once for a tile.
struct Workspace {
    explicit Workspace(const PassList& passes) : light(passes) { prepare(rays, kSeenByCamera); }
    BlockRays rays;
    Points points;
    Coefficients coefficients;
    LightLanes light;
    LaneVec3 throughput;
    SeenLights seen;
    uint8_t active[kBatch], missed[kBatch];
    LightScratch lights;
    ProgramScratch program;
    BlockSums sums;
};

// A render's constants.
struct Caster {
    const RenderJob& job;
    const Snapshot& snapshot;
    RayMaker maker;
    bool sees_lights;

    void tile(const TileWork& work) const;
    void block(uint32_t block_x, uint32_t block_y, const TileWork& work, Workspace& w) const;
    uint32_t layers(uint32_t block_x, uint32_t block_y, uint32_t sample, Workspace& w) const;
    void shade(uint32_t block_x, uint32_t block_y, uint32_t sample, Coherence coherence, Workspace& w) const;
    void add_seen_lights(Workspace& w) const;
};

// The equation at all points of the batch, into w.light.
void Caster::shade(uint32_t block_x, uint32_t block_y, uint32_t sample, Coherence coherence, Workspace& w) const {
    const auto start = Clock::now();
    const Illumination& illumination = job.settings.illumination;
    locate(snapshot, job.settings.normals(), w.points);
    if (snapshot.needs_footprint)
        make_footprints({w.rays.direction, maker.view.perspective, maker.view.x * (maker.view.step_x * maker.footprint),
                         maker.view.y * (maker.view.step_y * maker.footprint)},
                        w.points);
    evaluate(snapshot, w.points, w.coefficients, w.program);
    add_ambient(w.points, w.coefficients, illumination.ambient, w.light.radiance);
    w.light.clear();
    ShadowCounts shadows;
    add_lights(
        snapshot, illumination, coherence,
        [&](uint32_t pair, float* u, float* v) { random_pair(block_x, block_y, maker.sequence, sample, pair, u, v); },
        w.points, w.coefficients, w.light.sums, w.lights, w.program, shadows);
    job.counts->shadow_rays += shadows.rays;
    job.counts->shadow_time += shadows.nanoseconds;
    job.counts->shading_time += nanoseconds(start, Clock::now()) - shadows.nanoseconds;
}

// Area lights that the camera sees, in front of what was hit: a lane that meets one is done.
void Caster::add_seen_lights(Workspace& w) const {
    if (!see_area_lights(snapshot.lights, true, w.rays, w.active, w.seen)) return;
    for (int i = 0; i < kBatch; ++i) {
        if (!(w.seen.t[i] > 0)) continue;
        add_seen_light(i, w.throughput.get(i), w.seen.radiance.get(i), w.seen.group[i], w.sums);
        w.active[i] = 0;
        w.points.slot[i] = kNoSlot;
    }
}

// One sample of the active pixels of a block: the nearest surfaces, and where they have holes, those behind. Returns
// the packets that see an edge.
uint32_t Caster::layers(uint32_t block_x, uint32_t block_y, uint32_t sample, Workspace& w) const {
    auto start = Clock::now();
    make_primary_rays(maker, block_x, block_y, sample, w.rays);
    for (int c = 0; c < 3; ++c) std::fill_n(w.throughput[c], kBatch, 1.0f);
    uint8_t first[kBatch] = {};
    float* const ray_count = w.sums.channel(kRayCount, 0);
    uint64_t primary_rays = 0, primary_time = 0;
    uint32_t edges = 0;
    // Packets are whole and their lanes fixed to the film in the first layer alone.
    Coherence coherence = Coherence::coherent;
    for (int layer = 0; layer < kGreatestLayers; ++layer) {
        if (layer > 0) start = Clock::now();
        for (int i = 0; i < kBatch && ray_count; ++i) ray_count[i] += w.active[i];
        primary_rays += static_cast<uint64_t>(std::count(w.active, w.active + kBatch, 1));
        trace_primary(snapshot.rays->embree(), w.active, coherence, w.rays);
        read_hits(w.rays, w.active, w.points);
        if (sees_lights) add_seen_lights(w);
        primary_time += nanoseconds(start, Clock::now());
        const Found found = find_missed(w.active, w.points, w.missed);
        if (found.any_missed)
            add_background(snapshot, w.rays.direction, w.missed, layer > 0 ? &w.throughput : nullptr,
                           job.settings.transparent, w.sums);
        if (!found.any_hit) break;
        shade(block_x, block_y, sample, coherence, w);
        if (layer == 0 && job.settings.adaptive.threshold > 0) edges = packets_at_edges(w.points);
        add_surfaces({snapshot, w.points, w.coefficients, w.light.sums, layer > 0 ? &w.throughput : nullptr,
                      job.settings.illumination.ambient},
                     sample == 0 ? first : nullptr, w.sums);
        if (!w.points.any_holes && !w.points.any_transmission) break;

        bool any_left = false;
        for (int i = 0; i < kBatch; ++i) {
            w.active[i] = 0;
            if (w.points.slot[i] == kNoSlot) continue;
            w.throughput.set(i, throughput_behind(w.points, w.coefficients, i, w.throughput.get(i)));
            if (w.throughput.get(i) == Vec3(0, 0, 0)) continue;
            w.active[i] = 1;
            any_left = true;
            pass_surface(w.rays, i, w.points, maker.view.clip_end);
        }
        if (!any_left) break;
        coherence = Coherence::incoherent;
    }
    if (sample == 0) finish_depth(first, w.sums);
    job.counts->primary_rays += primary_rays;
    job.counts->primary_time += primary_time;
    return edges;
}

void Caster::block(uint32_t block_x, uint32_t block_y, const TileWork& work, Workspace& w) const {
    w.sums = job.film->block(block_x, block_y);
    prepare_block(maker, block_x, block_y, w.rays);
    take_samples(
        job, work, block_x, block_y, w.active, [&](uint32_t sample) { return layers(block_x, block_y, sample, w); },
        [] {});
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
    const Caster caster{job, *job.snapshot,
                        make_ray_maker(*job.snapshot, settings, PixelFilter(settings.filter, settings.filter_width),
                                       window.width, window.height),
                        std::any_of(job.snapshot->lights.begin(), job.snapshot->lights.end(),
                                    [](const ReadyLight& l) { return l.visible_camera; })};
    if (events.log)
        events.log(fmt::format("{} x {} pixels, {} samples, {} lights", window.w, window.h, settings.samples,
                               job.snapshot->lights.size()));
    return run_tiles(job, events, [&](const TileWork& work) { caster.tile(work); });
}

}  // namespace trp
