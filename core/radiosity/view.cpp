#include "radiosity/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/view.h"
#include "radiosity/element_rays.h"
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
float pixels_from_side(const ShownSolution& solution, const Elements::Place& place, const Vec3& shift,
                       const Points& points, int lane) {
    const Elements& elements = *solution.elements;
    const Vec3 here = points.position.get(lane) + shift, e1 = points.edge1.get(lane), e2 = points.edge2.get(lane);
    const Vec3 dx = e1 * points.b1_dx[lane] + e2 * points.b2_dx[lane],
               dy = e1 * points.b1_dy[lane] + e2 * points.b2_dy[lane];
    const Vec3 n = points.geometric_normal.get(lane);
    static thread_local std::vector<Vec3d> corners;
    elements.corners(place.element, corners);
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
    const bool false_colors = settings.view >= View::false_color;
    // The elements' own, where each has a form factor.
    const bool smooth = settings.smooth && settings.view != View::form_factors;
    const Unit unit = unit_of(settings.view);
    float scale = settings.view_scale / unit.per_watt;
    if (!(scale > 0))
        for (const Vec3& value : solution.leaves) scale = std::max(scale, luminance(value));
    const bool whole = draw_radiance(
        job, events, "radiosity", [&](const Points& points, const Coefficients& coefficients, LaneVec3& radiance) {
            for (int i = 0; i < kBatch; ++i) {
                radiance.set(i, {0, 0, 0});
                if (points.slot[i] == kNoSlot) continue;
                const auto place = solution.elements->find(points.slot[i], points.triangle[i], points.b1[i],
                                                           points.b2[i], points.behind[i] != 0);
                Vec3 value(0, 0, 0);
                if (place.element != kNoElement)
                    value = smooth ? solution.vertices->interpolate(*solution.elements, place, solution.at_vertices,
                                                                    solution.leaves)
                                   : solution.leaves[place.element];
                Vec3 shown = value / kPi;
                if (settings.view == View::shaded)
                    shown = coefficients.emission.get(i) + coefficients.diffuse.get(i) * shown;
                else if (false_colors)
                    shown = false_color(scale > 0 ? luminance(value) / scale : 0);
                if (false_colors && solution.chosen != kNoElement && place.element == solution.chosen)
                    shown = {1, 1, 1};
                if (settings.mesh && place.element != kNoElement) {
                    const float from_side = pixels_from_side(solution, place, shift, points, i);
                    shown *= std::clamp(from_side - 0.5f, 0.0f, 1.0f);
                }
                radiance.set(i, shown);
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
    std::make_unique<ElementTracer>(elements)->trace(rays, hits);
    uint32_t out = kNoElement;
    float most = 0;
    for (const ElementHit& hit : hits)
        if (hit.element != kNoElement && luminance(hit.weight) > most) most = luminance(hit.weight), out = hit.element;
    return out;
}

}  // namespace trp
