#include "raster/line_drawing.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "film/surface_passes.h"
#include "raster/edge_classes.h"
#include "raster/line_tile.h"
#include "raster/line_visibility.h"
#include "raster/seen_points.h"

namespace trp {
namespace {

constexpr uint32_t kTileSide = 128;   // pixels: a tile's lines fit a core's cache
constexpr float kFaint = 0.75f;       // the share of the paper in faint lines
constexpr float kDash = 4, kGap = 4;  // pixels, times the width of lines that are wider than one

// What a thread works with at a tile.
struct Workspace {
    Workspace(bool plain, const DrawList& triangles, const Projection& projection)
        : lines(plain), line_visibility(triangles, projection) {}
    LineTile lines;
    VisibilityTile visibility;
    LineVisibility line_visibility;
    ClusterVertices vertices;
    std::vector<DrawnLine> drawn;
    std::vector<DrawnLine> whole;  // of a cluster, where faces hide
    LaneVec3 origins, directions;
};

// A render's constants.
struct LineDrawing {
    const RenderJob& job;
    const Snapshot& snapshot;
    const LineSettings& settings;
    bool hides;  // what lies behind faces
    View view;
    Projection projection;
    LineProfile profile;
    EdgeClasses classes;
    DrawList edges{}, triangles{};  // `triangles`: where faces hide
    TileLists edge_tiles{}, triangle_tiles{};
    DepthCue cue{};
    bool plain = false;
    mutable tbb::enumerable_thread_specific<std::unique_ptr<Workspace>> workspaces{};

    uint32_t padding() const {  // of visibility around a tile, in blocks
        return (static_cast<uint32_t>(profile.radius) + LineVisibility::kAround + kBlockSide) / kBlockSide;
    }
    void prepare();
    void tile(const TileWork& work) const;
    void see_faces(const TileWork& work, VisibilityTile& visibility) const;
    void add_edges(uint32_t number, const TileReach& reach, Workspace& w) const;
    bool cut_far(DrawnLine& line) const;
    void add_runs(const DrawnLine& line, std::span<const Run> runs, const TileReach& reach, Workspace& w) const;
    // The edge of a line's key; `number` becomes its own in the surface's set.
    const PlacedSurface& edge_of(uint32_t key, uint32_t& number) const;
    uint32_t material_of(const PlacedSurface& surface, uint32_t edge) const;
    Vec3 color_of(const PlacedSurface& surface, uint32_t edge) const;
    void resolve(uint32_t block_x, uint32_t block_y, size_t place, Workspace& w) const;
};

// Runs in the current arena.
void LineDrawing::prepare() {
    const Window& window = job.film->window();
    const auto reach = static_cast<int32_t>(std::ceil(profile.radius));
    edges = make_draw_list(snapshot, projection, Primitives::edges, reach);
    edge_tiles = TileLists(edges, window, job.settings.tile_size);
    if (hides) {
        triangles =
            make_draw_list(snapshot, projection, Primitives::triangles, static_cast<int32_t>(padding() * kBlockSide));
        triangle_tiles = TileLists(triangles, window, job.settings.tile_size);
    }
    float near = -1e38f, far = 1e38f;
    for (const DrawnCluster& cluster : edges.clusters) {
        near = std::max(near, cluster.nearness);
        far = std::min(far, std::max(cluster.farness, projection.farthest()));
    }
    const auto depth = [&](float nearness) { return view.perspective ? 1 / nearness : -nearness; };
    if (near > far && depth(near) < depth(far))
        cue = {settings.depth_cue, depth(near), depth(far), view.perspective, settings.paper};
    plain = settings.color_by == LineSettings::ColorBy::line && cue.strength == 0 &&
            (!hides || settings.hidden != LineSettings::Hidden::faint) && job.film->passes().order().size() == 1;
}

void LineDrawing::see_faces(const TileWork& work, VisibilityTile& visibility) const {
    const uint32_t around = padding();
    const auto corner = [&](uint32_t block) {
        return (static_cast<int32_t>(block) - static_cast<int32_t>(around)) * static_cast<int32_t>(kBlockSide);
    };
    visibility.place(corner(work.block_x0), corner(work.block_y0), work.block_x1 - work.block_x0 + 2 * around,
                     work.block_y1 - work.block_y0 + 2 * around);
    visibility.begin(projection, 0, 0, false);
    for (const uint32_t cluster : triangle_tiles.of(work)) {
        if (*job.cancelled) return;
        visibility.draw(projection, triangles, cluster);
    }
}

const PlacedSurface& LineDrawing::edge_of(uint32_t key, uint32_t& number) const {
    const DrawnCluster& drawn = edges.clusters[key / Cluster::kMostPrimitives];
    const ClusterSet& set = *edges.sets[drawn.slot];
    number = set.primitives[set.clusters[drawn.cluster].first + key % Cluster::kMostPrimitives];
    return *edges.surfaces[drawn.slot];
}

uint32_t LineDrawing::material_of(const PlacedSurface& surface, uint32_t edge) const {
    const uint32_t face = surface.surface->edges().edges[edge].faces[0];
    return face == kNoFace ? surface.slot_materials[0] : surface.face_material(face);
}

Vec3 LineDrawing::color_of(const PlacedSurface& surface, uint32_t edge) const {
    if (settings.color_by == LineSettings::ColorBy::line) return settings.color;
    if (settings.color_by == LineSettings::ColorBy::object) return surface.color;
    const auto& constants = snapshot.materials[material_of(surface, edge)].constants;
    return {constants[kDiffuse], constants[kDiffuse + 1], constants[kDiffuse + 2]};
}

// A line as the parts of it that are seen, and those that are hidden as the settings say.
void LineDrawing::add_runs(const DrawnLine& line, std::span<const Run> runs, const TileReach& reach,
                           Workspace& w) const {
    const Segment& s = line.segment;
    const auto add = [&](float begin, float end, const Vec3& color) {
        begin = std::max(begin, line.begin), end = std::min(end, line.end);
        if (!(begin < end)) return;
        w.drawn.push_back(line);
        w.drawn.back().begin = begin, w.drawn.back().end = end;
        w.drawn.back().color = color;
    };
    for (const Run& run : runs) {
        if (run.seen) {
            add(run.begin, run.end, line.color);
        } else if (settings.hidden == LineSettings::Hidden::faint) {
            add(run.begin, run.end, line.color + (settings.paper - line.color) * kFaint);
        } else if (settings.hidden == LineSettings::Hidden::dashed) {
            // Dashes lie on a grid of the film, across or up as the line goes, so that they run on over vertices.
            const bool across = std::abs(s.x[1] - s.x[0]) > std::abs(s.y[1] - s.y[0]);
            const float scale = std::max(settings.width, 1.0f), period = (kDash + kGap) * scale;
            const float* const places = across ? s.x : s.y;
            const float step = places[1] - places[0],
                        first = places[0] + static_cast<float>(across ? reach.x0 : reach.y0);
            const auto [low, high] = std::minmax({first + step * run.begin, first + step * run.end});
            for (int k = static_cast<int>(std::floor(low / period)); static_cast<float>(k) * period < high; ++k) {
                const float at = static_cast<float>(k) * period - first;
                float begin = at / step, end = (at + kDash * scale) / step;
                if (begin > end) std::swap(begin, end);
                add(std::max(begin, run.begin), std::min(end, run.end), line.color);
            }
        }
    }
}

// Cuts off what lies beyond the camera's far end. Returns false where nothing is left.
bool LineDrawing::cut_far(DrawnLine& line) const {
    const float *const near = line.segment.near, farthest = projection.farthest();
    if (near[0] >= farthest && near[1] >= farthest) return true;
    if (near[0] <= farthest && near[1] <= farthest) return false;
    (near[0] < farthest ? line.begin : line.end) = (farthest - near[0]) / (near[1] - near[0]);
    return true;
}

// The lines of a cluster of edges into w.drawn.
void LineDrawing::add_edges(uint32_t number, const TileReach& reach, Workspace& w) const {
    Segment segments[Cluster::kMostPrimitives];
    const DrawnCluster& drawn = edges.clusters[number];
    const PlacedCluster cluster = edges.placed(drawn, projection);
    const PlacedSurface& surface = *edges.surfaces[drawn.slot];
    const uint32_t* const own = &cluster.set.primitives[cluster.cluster().first];
    const uint32_t count = find_segments(cluster, reach, w.vertices, segments);
    std::vector<DrawnLine>& lines = hides ? w.whole : w.drawn;
    lines.clear();
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t edge = own[segments[k].number];
        if (!classes.has(surface, edge)) continue;
        DrawnLine& line = lines.emplace_back();
        line.segment = segments[k];
        line.color = color_of(surface, edge);
        line.key = number * Cluster::kMostPrimitives + segments[k].number;
        if (!cut_far(line)) lines.pop_back();
    }
    if (!hides) return;
    w.line_visibility.split(drawn.slot, cluster, w.vertices, lines);
    w.drawn.clear();
    for (size_t n = 0; n < lines.size(); ++n) add_runs(lines[n], w.line_visibility.runs(n), reach, w);
}

// A block's lines onto the paper.
void LineDrawing::resolve(uint32_t block_x, uint32_t block_y, size_t place, Workspace& w) const {
    const BlockSums sums = job.film->block(block_x, block_y);
    const float* const coverage = w.lines.coverage(place);
    const std::array<float*, 4> rgba = sums.combined();
    const bool transparent = job.settings.transparent;
    for (int c = 0; c < 3; ++c) {
        const float paper = transparent ? 0 : settings.paper[c];
        for (int i = 0; i < kBatch; ++i) {
            const float line = plain ? settings.color[c] * coverage[i] : w.lines.color(c, place)[i];
            rgba[c][i] = line + (1 - coverage[i]) * paper;
        }
    }
    for (int i = 0; i < kBatch; ++i) rgba[3][i] = transparent ? coverage[i] : 1;
    job.film->add_samples(block_x, block_y, 1);
    if (plain) return;

    if (sums.channel(kPosition, 0))
        make_directions(view, BlockSamples(block_x * kBlockSide, block_y * kBlockSide), w.origins, w.directions);
    const uint32_t* const keys = w.lines.keys(place);
    for (int i = 0; i < kBatch; ++i) {
        const bool any = keys[i] != kNothing;
        const float nearness = w.lines.nearness(place)[i], depth = view.perspective ? 1 / nearness : -nearness;
        if (float* out = sums.channel(kDepth, 0)) out[i] = any ? depth : kNothingSeen;
        if (!any) continue;
        uint32_t edge = 0;
        const PlacedSurface& surface = edge_of(keys[i], edge);
        if (float* out = sums.channel(kObjectIndex, 0)) out[i] = static_cast<float>(surface.index);
        if (float* out = sums.channel(kMaterialIndex, 0))
            out[i] = static_cast<float>(snapshot.materials[material_of(surface, edge)].index);
        sums.add(kPosition, i,
                 (view.perspective ? view.position : w.origins.get(i)) + w.directions.get(i) * depth +
                     Vec3(snapshot.origin));
    }
}

void LineDrawing::tile(const TileWork& work) const {
    std::unique_ptr<Workspace>& own = workspaces.local();
    if (!own) own = std::make_unique<Workspace>(plain, triangles, projection);
    Workspace& w = *own;
    const uint32_t across = work.block_x1 - work.block_x0, up = work.block_y1 - work.block_y0;
    const TileReach reach{work.block_x0 * kBlockSide, work.block_y0 * kBlockSide, across * kBlockSide, up * kBlockSide,
                          profile.radius};
    const auto start = Clock::now();
    w.lines.begin(across, up);
    if (hides) {
        see_faces(work, w.visibility);
        w.line_visibility.begin(reach, w.visibility);
    }
    for (const uint32_t number : edge_tiles.of(work)) {
        if (*job.cancelled) return;
        if (hides && settings.hidden == LineSettings::Hidden::none && w.visibility.hides(edges.clusters[number]))
            continue;
        add_edges(number, reach, w);
        w.lines.draw(w.drawn, profile, cue);
    }
    const auto drawn = Clock::now();
    for (uint32_t place = 0; place < across * up; ++place)
        resolve(work.block_x0 + place % across, work.block_y0 + place / across, place, w);
    job.counts->primary_time += nanoseconds(start, drawn);
    job.counts->shading_time += nanoseconds(drawn, Clock::now());
}

bool draw_edges(RenderJob& job, const RenderEvents& events, bool hides, const char* method) {
    const Window& window = job.film->window();
    const View view = make_raster_view(*job.snapshot, window, method);
    RenderJob tiled = job;
    tiled.settings.samples = 1;
    tiled.settings.tile_size = std::max(job.settings.tile_size, kTileSide);
    const LineSettings& settings = tiled.settings.lines;
    LineDrawing drawing{tiled,
                        *job.snapshot,
                        settings,
                        hides,
                        view,
                        Projection(view, window.width, window.height),
                        LineProfile(PixelFilter(job.settings.filter, job.settings.filter_width), settings.width),
                        EdgeClasses(settings, view)};
    if (events.log) events.log(fmt::format("{} x {} pixels, lines {} pixels wide", window.w, window.h, settings.width));
    return run_tiles(
        tiled, events, [&](const TileWork& work) { drawing.tile(work); }, [&] { drawing.prepare(); });
}

}  // namespace

bool wireframe(RenderJob& job, const RenderEvents& events) {
    return draw_edges(job, events, false, "wireframe");
}
bool hidden_line(RenderJob& job, const RenderEvents& events) {
    return draw_edges(job, events, true, "hidden_line");
}

}  // namespace trp
