#include "raster/rasterizer.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "film/pixel_random.h"
#include "film/surface_passes.h"
#include "raster/face_points.h"
#include "raster/sample_groups.h"
#include "raster/sample_pattern.h"
#include "raster/scan_line.h"
#include "shading/footprints.h"

namespace trp {
namespace {

constexpr uint32_t kTileSide = 256;  // pixels: a tile's buffers fit a core's cache, and few clusters lie in two tiles

enum class Evaluation { ambient, polygon, vertex, pixel, given };

// What a thread evaluates with.
struct Shading {
    Coefficients coefficients;
    LaneVec3 radiance, lit;
    ArrivingLight arriving;
    LightScratch lights;
    ProgramScratch program;
};

// What a thread works with at a tile.
struct Workspace : Shading {
    VisibilityTile visibility;
    // Of all pixels, where surfaces have holes.
    std::vector<LaneVec3> throughput;
    std::vector<uint8_t> first;
    std::vector<uint32_t> keys;    // of all pixels, sample by sample
    std::vector<uint8_t> layered;  // of blocks: they show surfaces that are seen through
    LaneVec3 shares;
    SampleGroup group;

    LaneVec3 origins, directions;
    Points points;
    uint8_t missed[kBatch];
};

// Whether what a batch shows lets through what lies behind it.
bool is_seen_through(const Workspace& w) {
    if (!w.points.any_holes && !w.points.any_transmission) return false;
    for (int i = 0; i < kBatch; ++i)
        if (w.points.slot[i] != kNoSlot &&
            (w.coefficients.alpha[i] < 1 ||
             (w.points.any_transmission && w.coefficients.transmission.get(i) != Vec3(0, 0, 0))))
            return true;
    return false;
}

// The lower left pixel of a block, by its place in a tile that lies within the film.
std::array<uint32_t, 2> corner_of(uint32_t place, const VisibilityTile& tile) {
    const uint32_t across = tile.blocks_across();
    return {static_cast<uint32_t>(tile.x0()) + place % across * kBlockSide,
            static_cast<uint32_t>(tile.y0()) + place / across * kBlockSide};
}

// A render's constants.
struct Rasterizer {
    Rasterizer(const RenderJob& of, Evaluation where, const char* method);

    const RenderJob job;  // samples are those of the rasterizer
    const Snapshot& snapshot;
    Evaluation evaluation;
    View view;
    Projection projection;
    std::vector<SampleOffset> pattern;
    uint32_t light_samples = 1;  // of a pixel
    SampleSequence sequence{0, 1};
    Illumination illumination;
    bool wants_shadow_pass;
    DrawList list;
    SceneColors colors;  // of vertices, where the method evaluates there
    SurfaceRadiance given;
    TileLists tiles;
    mutable tbb::enumerable_thread_specific<std::unique_ptr<Workspace>> workspaces;

    ArrivingLight* arriving(Shading& w) const { return wants_shadow_pass ? &w.arriving : nullptr; }

    void prepare();
    void shade_all_vertices(const std::vector<uint8_t>& wanted);
    void tile(const TileWork& work) const;
    bool see(const TileWork& work, uint32_t number, int layer, Workspace& w) const;
    // Surfaces once for all samples of a pixel that they cover.
    void once(const TileWork& work, Workspace& w) const;
    bool merge(uint32_t place, Workspace& w) const;
    // Layers of surfaces, sample by sample.
    void sample(const TileWork& work, uint32_t number, Workspace& w) const;
    bool block(uint32_t place, BlockSamples& samples, uint32_t sample, int layer, Workspace& w) const;
    struct LightShare {
        uint32_t first, count;  // of the pixel's light samples
        Coherence coherence;
    };
    void shade(const BlockSamples& samples, float footprint, const LightShare& lights, Workspace& w) const;
    void illuminate(uint32_t block_x, uint32_t block_y, const LightShare& lights, const Points& points,
                    Shading& w) const;
    PickedScanLine pick(uint32_t x, uint32_t y);
    PickedScanLine scan(uint32_t slot, uint32_t face, bool behind, double x, double y) const;
};

RenderJob of_rasterizer(RenderJob job) {
    job.settings.samples = job.settings.raster_samples;
    job.settings.tile_size = std::max(job.settings.tile_size, kTileSide);
    return job;
}

Rasterizer::Rasterizer(const RenderJob& of, Evaluation where, const char* method)
    : job(of_rasterizer(of)),
      snapshot(*of.snapshot),
      evaluation(where),
      view(make_raster_view(snapshot, of.film->window(), method)),
      projection(view, of.film->window().width, of.film->window().height),
      pattern(sample_pattern(of.settings)),
      illumination(of.settings.illumination),
      wants_shadow_pass((where == Evaluation::polygon || where == Evaluation::pixel) &&
                        of.film->passes().has(kShadow)) {
    if (evaluation == Evaluation::ambient && illumination.ambient == Vec3(0, 0, 0))
        illumination.ambient = Vec3(1, 1, 1);
    if (evaluation != Evaluation::given && std::any_of(snapshot.lights.begin(), snapshot.lights.end(),
                                                       [](const ReadyLight& light) { return light.is_sampled(); }))
        light_samples = of.settings.samples;
    // Each edge sample takes as many light samples as another.
    const auto edge_samples = static_cast<uint32_t>(pattern.size());
    sequence = SampleSequence(of.settings.seed, (light_samples + edge_samples - 1) / edge_samples * edge_samples);
}

// Runs in the current arena.
void Rasterizer::prepare() {
    list = make_draw_list(snapshot, projection, Primitives::triangles, reach_of(pattern));
    tiles = TileLists(list, job.film->window(), job.settings.tile_size);
    if (evaluation != Evaluation::vertex) return;
    std::vector<uint8_t> wanted(snapshot.surfaces.size(), 0);
    for (const DrawnCluster& cluster : list.clusters) wanted[cluster.slot] = 1;
    shade_all_vertices(wanted);
}

// The terms of the equation at points whose coefficients are known.
void Rasterizer::illuminate(uint32_t block_x, uint32_t block_y, const LightShare& lights, const Points& points,
                            Shading& w) const {
    add_ambient(points, w.coefficients, illumination.ambient, w.radiance);
    if (evaluation == Evaluation::ambient) return;
    const bool one = lights.count == 1;
    for (int c = 0; c < 3 && !one; ++c) std::fill_n(w.lit[c], kBatch, 0.0f);
    if (wants_shadow_pass) w.arriving.clear();
    ShadowCounts shadows;
    for (uint32_t s = lights.first; s < lights.first + lights.count && !*job.cancelled; ++s)
        add_lights(
            snapshot, illumination, lights.coherence,
            [&](uint32_t pair, float* u, float* v) { random_pair(block_x, block_y, sequence, s, pair, u, v); }, points,
            w.coefficients, {one ? w.radiance : w.lit, arriving(w)}, w.lights, w.program, shadows);
    const float share = 1 / static_cast<float>(lights.count);
    for (int c = 0; c < 3 && !one; ++c)
        for (int i = 0; i < kBatch; ++i) w.radiance[c][i] += share * w.lit[c][i];
    job.counts->shadow_rays += shadows.rays;
    job.counts->shadow_time += shadows.nanoseconds;
}

// What the method shows at the points of a block, into w.radiance. `footprint`: the side of what a sample stands for,
// in pixels.
void Rasterizer::shade(const BlockSamples& samples, float footprint, const LightShare& lights, Workspace& w) const {
    const ScanLines lines{snapshot, list, projection, samples};
    const bool flat = evaluation == Evaluation::polygon;
    locate_seen(snapshot, flat ? NormalChoice::flat : job.settings.normals(),
                {view.position, view.perspective ? nullptr : &w.origins, w.directions}, w.points);
    if (flat) {
        move_to_faces(snapshot, view.perspective ? &view.position : nullptr, w.points);
        locate(snapshot, NormalChoice::flat, w.points);
        take_face_normals(snapshot, w.points);
    } else if (snapshot.needs_footprint || (evaluation == Evaluation::given && job.settings.radiosity.mesh)) {
        make_footprints(
            {w.directions, view.perspective, view.x * (view.step_x * footprint), view.y * (view.step_y * footprint)},
            w.points);
    }
    if (job.settings.scan_line && evaluation == Evaluation::pixel)
        scan_normals(lines, job.settings.normals(), w.points);
    evaluate(snapshot, w.points, w.coefficients, w.program);
    if (evaluation == Evaluation::vertex)
        return job.settings.scan_line ? scan_colors(lines, colors, w.points, w.radiance)
                                      : interpolate_colors(snapshot, colors, w.points, w.radiance);
    if (evaluation == Evaluation::given) return given(w.points, w.coefficients, w.radiance);
    illuminate(samples.x / kBlockSide, samples.y / kBlockSide, lights, w.points, w);
}

// Draws what a sample sees, or what lies behind that. Returns false where the render was cancelled.
bool Rasterizer::see(const TileWork& work, uint32_t number, int layer, Workspace& w) const {
    const auto start = Clock::now();
    w.visibility.begin(projection, pattern[number].x, pattern[number].y, layer > 0);
    for (const uint32_t cluster : tiles.of(work)) {
        if (*job.cancelled) return false;
        w.visibility.draw(projection, list, cluster);
    }
    job.counts->primary_time += nanoseconds(start, Clock::now());
    return true;
}

// A block whose samples' keys are known, each surface of a pixel shaded once: at the pixel's centre where it shows in
// all of the pixel, else at its sample that is nearest to there. Returns false, with nothing added, where a surface is
// seen through.
bool Rasterizer::merge(uint32_t place, Workspace& w) const {
    const auto samples = static_cast<uint32_t>(pattern.size());
    const BlockKeys keys{&w.keys[size_t{place} * kBatch], w.visibility.pixels(), samples};
    const SampleGroups groups(list, evaluation == Evaluation::polygon);
    const auto [x, y] = corner_of(place, w.visibility);
    BlockSamples at(x, y);
    const BlockSums sums = job.film->block(x / kBlockSide, y / kBlockSide);
    alignas(64) uint32_t left[kBatch];  // samples that are not yet shown, by their bits
    std::fill_n(left, kBatch, samples == 32 ? ~0u : (1u << samples) - 1);
    uint8_t first[kBatch] = {};
    bool any_left = true;
    for (uint32_t round = 0; any_left; ++round) {
        SampleGroup& group = w.group;
        any_left = groups.take(keys, left, group);
        for (int i = 0; i < kBatch; ++i) {
            const bool whole = group.count[i] == static_cast<float>(samples);
            const SampleOffset offset = whole ? SampleOffset{} : pattern[group.first[i]];
            at.set(i, offset.x, offset.y);
        }
        uint8_t any_missed = 0;
        for (int i = 0; i < kBatch; ++i) any_missed |= w.missed[i] = (group.key[i] == kNothing) & (group.count[i] > 0);
        for (int c = 0; c < 3; ++c) std::copy_n(group.count, kBatch, w.shares[c]);
        const bool any_seen = read_keys(list, group.key, w.points);
        if (any_seen || snapshot.world.texture != TRP_NO_ID) make_directions(view, at, w.origins, w.directions);
        if (any_missed) add_background(snapshot, w.directions, w.missed, &w.shares, job.settings.transparent, sums);
        if (any_seen) {
            uint32_t lights = 1;
            if (light_samples > 1) {  // as many as the surface with the most samples needs
                const auto most = static_cast<uint32_t>(*std::max_element(group.count, group.count + kBatch));
                lights = (light_samples * most + samples - 1) / samples;
            }
            shade(at, 1, {0, lights, Coherence::incoherent}, w);
            if (is_seen_through(w)) {
                sums.clear();
                return false;
            }
            add_surfaces({snapshot, w.points, w.coefficients, {w.radiance, arriving(w)}, &w.shares},
                         round == 0 ? first : nullptr, sums);
        }
        if (round == 0) finish_depth(first, sums);
    }
    job.film->add_samples(x / kBlockSide, y / kBlockSide, samples);
    return true;
}

void Rasterizer::once(const TileWork& work, Workspace& w) const {
    const uint32_t blocks = w.visibility.blocks_across() * w.visibility.blocks_up();
    w.keys.resize(pattern.size() * w.visibility.pixels());
    for (uint32_t s = 0; s < pattern.size(); ++s) {
        if (!see(work, s, 0, w)) return;
        std::copy_n(w.visibility.keys(0), w.visibility.pixels(), &w.keys[s * w.visibility.pixels()]);
    }
    const auto start = Clock::now();
    for (uint32_t place = 0; place < blocks && !*job.cancelled; ++place) w.layered[place] = !merge(place, w);
    job.counts->shading_time += nanoseconds(start, Clock::now());
}

// One layer of a sample at a block; `samples` are moved there. Returns whether something may be seen behind it.
bool Rasterizer::block(uint32_t place, BlockSamples& samples, uint32_t sample, int layer, Workspace& w) const {
    const auto [x, y] = corner_of(place, w.visibility);
    samples.x = x;
    samples.y = y;
    const uint32_t* keys = w.visibility.keys(place);
    const bool layered = snapshot.seen_through;
    LaneVec3* const throughput = layered ? &w.throughput[place] : nullptr;
    const bool any_seen = read_keys(list, keys, w.points);
    uint8_t any_missed = 0;
    for (int i = 0; i < kBatch; ++i) any_missed |= w.missed[i] = keys[i] == kNothing;
    if (layered) {
        any_missed = 0;
        for (int i = 0; i < kBatch; ++i) any_missed |= w.missed[i] &= throughput->get(i) != Vec3(0, 0, 0);
    }
    if (!any_missed && !any_seen) return false;
    if (any_seen || snapshot.world.texture != TRP_NO_ID) make_directions(view, samples, w.origins, w.directions);
    const BlockSums sums = job.film->block(x / kBlockSide, y / kBlockSide);
    if (any_missed) add_background(snapshot, w.directions, w.missed, throughput, job.settings.transparent, sums);
    bool any_left = false;
    uint8_t own_first[kBatch] = {};
    uint8_t* first = layered ? &w.first[size_t{place} * kBatch] : own_first;
    if (any_seen) {
        const auto count = static_cast<uint32_t>(pattern.size()), lights = (light_samples + count - 1) / count;
        shade(samples, std::max(0.125f, 1 / std::sqrt(static_cast<float>(count))),
              {sample * lights, lights,
               layer == 0 && evaluation != Evaluation::polygon ? Coherence::coherent : Coherence::incoherent},
              w);
        add_surfaces({snapshot, w.points, w.coefficients, {w.radiance, arriving(w)}, throughput},
                     sample == 0 ? first : nullptr, sums);
    }
    if (layered) {
        const bool seen_through = any_seen && is_seen_through(w);
        for (int i = 0; i < kBatch; ++i) {
            const Vec3 left = keys[i] == kNothing || !seen_through
                                  ? Vec3(0, 0, 0)
                                  : throughput_behind(w.points, w.coefficients, i, throughput->get(i));
            throughput->set(i, left);
            if (left == Vec3(0, 0, 0))
                w.visibility.close(place, i);
            else
                any_left = true;
        }
    }
    if (sample == 0 && layer == 0 && !layered) finish_depth(first, sums);
    job.film->add_samples(x / kBlockSide, y / kBlockSide, layer == 0);
    return any_left;
}

void Rasterizer::sample(const TileWork& work, uint32_t number, Workspace& w) const {
    const uint32_t blocks = w.visibility.blocks_across() * w.visibility.blocks_up();
    if (snapshot.seen_through) {
        w.throughput.resize(blocks);
        for (LaneVec3& lanes : w.throughput)
            for (int c = 0; c < 3; ++c) std::fill_n(lanes[c], kBatch, 1.0f);
        if (number == 0) w.first.assign(size_t{blocks} * kBatch, 0);
    }
    BlockSamples samples(0, 0, pattern[number].x, pattern[number].y);
    bool any_left = true;
    for (int layer = 0; layer < kGreatestLayers && any_left; ++layer) {
        if (!see(work, number, layer, w)) return;
        const auto start = Clock::now();
        any_left = false;
        for (uint32_t place = 0; place < blocks; ++place) {
            if (*job.cancelled) return;
            if (w.layered[place]) any_left |= block(place, samples, number, layer, w);
        }
        job.counts->shading_time += nanoseconds(start, Clock::now());
    }
    if (number > 0 || !snapshot.seen_through || !job.film->passes().has(kDepth)) return;
    for (uint32_t place = 0; place < blocks; ++place) {
        if (!w.layered[place]) continue;
        finish_depth(&w.first[size_t{place} * kBatch],
                     job.film->block(work.block_x0 + place % w.visibility.blocks_across(),
                                     work.block_y0 + place / w.visibility.blocks_across()));
    }
}

void Rasterizer::tile(const TileWork& work) const {
    std::unique_ptr<Workspace>& w = workspaces.local();
    if (!w) w = std::make_unique<Workspace>();
    w->visibility.place(static_cast<int32_t>(work.block_x0 * kBlockSide),
                        static_cast<int32_t>(work.block_y0 * kBlockSide), work.block_x1 - work.block_x0,
                        work.block_y1 - work.block_y0);
    w->layered.assign(size_t{w->visibility.blocks_across()} * w->visibility.blocks_up(), 1);
    if (pattern.size() > 1) once(work, *w);
    if (std::find(w->layered.begin(), w->layered.end(), 1) == w->layered.end()) return;
    for (uint32_t s = work.first_sample; s < work.end_sample; ++s) sample(work, s, *w);
}

void Rasterizer::shade_all_vertices(const std::vector<uint8_t>& wanted) {
    colors =
        shade_vertices(snapshot, wanted, job.settings.normals(), view.perspective ? &view.position : nullptr, view.z,
                       [&](uint32_t slot, uint32_t batch, bool behind, Points& points, LaneVec3& radiance) {
                           if (*job.cancelled) return;
                           const auto w = std::make_unique<Shading>();
                           locate(snapshot, job.settings.normals(), points, behind ? Side::back : Side::front);
                           evaluate(snapshot, points, w->coefficients, w->program);
                           // The random sequence of a block far outside of any film.
                           illuminate(batch, ~slot, {0, light_samples, Coherence::incoherent}, points, *w);
                           radiance = w->radiance;
                       });
}

// The nearest surface at the centre of a pixel that is not a hole, and its scan line. Runs in the current arena.
PickedScanLine Rasterizer::pick(uint32_t x, uint32_t y) {
    list = make_draw_list(snapshot, projection, Primitives::triangles, 0);
    const BlockSamples samples(x / kBlockSide * kBlockSide, y / kBlockSide * kBlockSide);
    const auto lane = static_cast<int>(lane_at(x % kBlockSide, y % kBlockSide));
    const auto w = std::make_unique<Workspace>();
    w->visibility.place(static_cast<int32_t>(samples.x), static_cast<int32_t>(samples.y), 1, 1);
    make_directions(view, samples, w->origins, w->directions);
    for (int layer = 0; layer < kGreatestLayers; ++layer) {
        w->visibility.begin(projection, 0, 0, layer > 0);
        for (uint32_t cluster = 0; cluster < list.clusters.size(); ++cluster)
            w->visibility.draw(projection, list, cluster);
        read_keys(list, w->visibility.keys(0), w->points);
        const uint32_t slot = w->points.slot[lane];
        if (slot == kNoSlot) return {};
        locate_seen(snapshot, job.settings.normals(),
                    {view.position, view.perspective ? nullptr : &w->origins, w->directions}, w->points);
        w->points.clear_footprints();
        evaluate(snapshot, w->points, w->coefficients, w->program);
        if (!(w->coefficients.alpha[lane] > 0)) continue;
        if (evaluation == Evaluation::vertex) {
            std::vector<uint8_t> wanted(snapshot.surfaces.size(), 0);
            wanted[slot] = 1;
            shade_all_vertices(wanted);
        }
        return scan(slot, snapshot.surfaces[slot].face(w->points.triangle[lane]), w->points.behind[lane], x + 0.5,
                    y + 0.5);
    }
    return {};
}

PickedScanLine Rasterizer::scan(uint32_t slot, uint32_t face, bool behind, double x, double y) const {
    const PlacedSurface& surface = snapshot.surfaces[slot];
    PickedScanLine out{&surface, face, ScanPolygon(surface, face, list.transforms[slot], projection).at(x, y), {}};
    out.values = interpolate(out.line, [&](uint32_t corner) {
        if (evaluation == Evaluation::vertex) return colors[slot].at(surface, corner, behind);
        Vec3 normal = surface.world_from_object.normal(face_normal(*surface.mesh, face)) * surface.normal_sign;
        corner_normal(surface, job.settings.normals(), face, corner, normal);
        return normal.normalized() * (behind ? -1.0f : 1.0f);
    });
    return out;
}

bool rasterize(RenderJob& job, const RenderEvents& events, Evaluation evaluation, const char* method,
               const SurfaceRadiance& given = {}) {
    Rasterizer rasterizer(job, evaluation, method);
    rasterizer.given = given;
    const Window& window = job.film->window();
    if (events.log)
        events.log(fmt::format("{} x {} pixels, {} samples, {} lights", window.w, window.h,
                               rasterizer.job.settings.samples, job.snapshot->lights.size()));
    RenderJob tiled = rasterizer.job;
    return run_tiles(
        tiled, events, [&](const TileWork& work) { rasterizer.tile(work); }, [&] { rasterizer.prepare(); });
}

}  // namespace

bool visible_surface(RenderJob& job, const RenderEvents& events) {
    return rasterize(job, events, Evaluation::ambient, "visible_surface");
}
bool flat_shading(RenderJob& job, const RenderEvents& events) {
    return rasterize(job, events, Evaluation::polygon, "flat");
}
bool gouraud_shading(RenderJob& job, const RenderEvents& events) {
    return rasterize(job, events, Evaluation::vertex, "gouraud");
}
bool phong_shading(RenderJob& job, const RenderEvents& events) {
    return rasterize(job, events, Evaluation::pixel, "phong");
}

bool draw_radiance(RenderJob& job, const RenderEvents& events, const char* method, const SurfaceRadiance& radiance) {
    return rasterize(job, events, Evaluation::given, method, radiance);
}

PickedScanLine pick_scan_line(const RenderJob& job, ScannedValue value, uint32_t x, uint32_t y) {
    const bool colors = value == ScannedValue::radiance;
    Rasterizer rasterizer(job, colors ? Evaluation::vertex : Evaluation::pixel, colors ? "gouraud" : "phong");
    PickedScanLine out;
    Arena arena(job.settings.threads);
    arena.run([&] { out = rasterizer.pick(x, y); });
    return out;
}

}  // namespace trp
