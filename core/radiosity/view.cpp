#include "radiosity/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/view.h"
#include "radiosity/element_rays.h"
#include "radiosity/leaf_lanes.h"
#include "radiosity/legend.h"
#include "raster/rasterizer.h"

namespace trp {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// What a view in false colours counts in; W/m² to one of it.
struct Unit {
    const char* name;
    float per_watt;
};
Unit unit_of(RadiositySettings::View view) {
    using View = RadiositySettings::View;
    return view == View::illuminance ? Unit{"lux", 683} : view == View::form_factors ? Unit{"F", 1} : Unit{"W/m²", 1};
}

// How near a place lies to a side of its element, in pixels: the footprint says what a pixel is there.
// `shift`: from the points' origin to the solution's.
float pixels_from_side(const Elements& elements, uint32_t leaf, const Vec3& shift, const Points& points, int lane) {
    const Vec3 here = points.position.get(lane) + shift, e1 = points.edge1.get(lane), e2 = points.edge2.get(lane);
    const Vec3 dx = e1 * points.b1_dx[lane] + e2 * points.b2_dx[lane],
               dy = e1 * points.b1_dy[lane] + e2 * points.b2_dy[lane];
    const Vec3 n = points.geometric_normal.get(lane);
    static thread_local std::vector<Vec3d> corners;
    elements.corners(leaf, corners);
    float nearest = 1e30f;
    for (size_t k = 0; k < corners.size(); ++k) {
        const Vec3 a(corners[k]), way = Vec3(corners[(k + 1) % corners.size()]) - a;
        const Vec3 across = n.cross(way);
        const float length = across.length();
        if (!(length > 0)) continue;
        const float distance = std::abs((here - a).dot(across)) / length;
        const float pixel = std::hypot(dx.dot(across), dy.dot(across)) / length;
        nearest = std::min(nearest, distance / std::max(pixel, 1e-30f));
    }
    return nearest;
}

}  // namespace

uint64_t ShownSolution::leaf_count() const {
    uint64_t count = 0;
    for (uint32_t i = 0; i < elements->size(); ++i) count += (*elements)[i].leaf();
    return count;
}

bool radiosity_view(RenderJob& job, const RenderEvents& events) {
    const ShownSolution& solution = *job.solution;
    const RadiositySettings& settings = job.settings.radiosity;
    const Vec3 shift(job.snapshot->origin - solution.elements->snapshot().origin);
    using View = RadiositySettings::View;
    const bool false_colors = settings.view >= View::false_color, shaded = settings.view == View::shaded;
    // The elements' own, where each has a form factor.
    const bool smooth = settings.smooth && settings.view != View::form_factors;
    const Unit unit = unit_of(settings.view);
    float scale = settings.view_scale / unit.per_watt;
    if (false_colors && !(scale > 0))
        for (const Vec3& value : solution.leaves) scale = std::max(scale, luminance(value));
    const bool whole = draw_radiance(
        job, events, "radiosity", [&](const Points& points, const Coefficients& coefficients, LaneVec3& radiance) {
            LeafLanes places;
            find_leaves(*solution.elements, points, places);
            if (smooth)
                interpolate(*solution.vertices, places, solution.at_vertices, solution.leaves, radiance);
            else
                for (int i = 0; i < kBatch; ++i)
                    radiance.set(i, places.leaf[i] == kNoElement ? Vec3(0, 0, 0) : solution.leaves[places.leaf[i]]);
            if (false_colors)
                for (int i = 0; i < kBatch; ++i)
                    radiance.set(i, places.leaf[i] != kNoElement && places.leaf[i] == solution.chosen
                                        ? Vec3(1, 1, 1)
                                        : false_color(scale > 0 ? luminance(radiance.get(i)) / scale : 0));
            else
                for (int c = 0; c < 3; ++c)
                    for (int i = 0; i < kBatch; ++i) {
                        const float shown = radiance[c][i] / kPi;
                        radiance[c][i] =
                            shaded ? coefficients.emission[c][i] + coefficients.diffuse[c][i] * shown : shown;
                    }
            if (settings.mesh)
                for (int i = 0; i < kBatch; ++i) {
                    if (places.leaf[i] == kNoElement) continue;
                    const float from_side = pixels_from_side(*solution.elements, places.leaf[i], shift, points, i);
                    radiance.set(i, radiance.get(i) * std::clamp(from_side - 0.5f, 0.0f, 1.0f));
                }
        });
    if (!whole || !false_colors || !settings.legend) return whole;
    // The legend is a tile more.
    TrpTile tile{};
    tile.struct_size = sizeof tile;
    if (!draw_legend(*job.film, scale * unit.per_watt, unit.name, tile)) return true;
    return !events.tile || events.tile(tile);
}

uint32_t element_at(const Snapshot& snapshot, const Window& window, const Elements& elements, uint32_t x, uint32_t y) {
    if (!snapshot.camera) fail(TRP_ERROR_STATE, "the scene has no camera to look from");
    const View view = make_view(*snapshot.camera, snapshot.origin, window.width, window.height);
    const Vec3 on_film = view.x * (view.left + (static_cast<float>(x) + 0.5f) * view.step_x) +
                         view.y * (view.bottom + (static_cast<float>(y) + 0.5f) * view.step_y);
    const Vec3 direction = view.perspective ? (on_film - view.z).normalized() : -view.z,
               origin = view.perspective ? view.position : view.position + on_film;
    const Vec3 shift(snapshot.origin - elements.snapshot().origin);
    std::vector<ElementRay> rays = {
        {origin + shift + direction * (view.clip_start / -view.z.dot(direction)), direction}};
    std::vector<ElementHit> hits;
    std::make_unique<ElementTracer>(elements, kMostTurns, true)->trace(rays, hits);
    uint32_t out = kNoElement;
    float most = 0;
    for (const ElementHit& hit : hits)
        if (hit.element != kNoElement && luminance(hit.weight) > most) most = luminance(hit.weight), out = hit.element;
    return out;
}

}  // namespace trp
