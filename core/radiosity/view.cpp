#include "radiosity/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raster/rasterizer.h"

namespace trp {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Blue, cyan, green, yellow and red in equal steps.
Vec3 false_color(float share) {
    static constexpr float kStops[5][3] = {{0, 0, 1}, {0, 1, 1}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
    const float at = 4 * std::clamp(share, 0.0f, 1.0f);
    const int step = std::min(static_cast<int>(at), 3);
    Vec3 out;
    for (int c = 0; c < 3; ++c) out[c] = std::lerp(kStops[step][c], kStops[step + 1][c], at - static_cast<float>(step));
    return out;
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
    float scale = settings.view_scale;
    if (!(scale > 0))
        for (const Vec3& value : solution.leaves) scale = std::max(scale, luminance(value));
    return draw_radiance(
        job, events, "radiosity", [&](const Points& points, const Coefficients& coefficients, LaneVec3& radiance) {
            for (int i = 0; i < kBatch; ++i) {
                radiance.set(i, {0, 0, 0});
                if (points.slot[i] == kNoSlot) continue;
                const auto place = solution.elements->find(points.slot[i], points.triangle[i], points.b1[i],
                                                           points.b2[i], points.behind[i] != 0);
                Vec3 value(0, 0, 0);
                if (place.element != kNoElement)
                    value = settings.smooth ? solution.vertices->interpolate(*solution.elements, place,
                                                                             solution.at_vertices, solution.leaves)
                                            : solution.leaves[place.element];
                Vec3 shown = value / kPi;
                if (settings.view == RadiositySettings::View::shaded)
                    shown = coefficients.emission.get(i) + coefficients.diffuse.get(i) * shown;
                else if (settings.view == RadiositySettings::View::false_color)
                    shown = false_color(scale > 0 ? luminance(value) / scale : 0);
                if (settings.mesh && place.element != kNoElement) {
                    const float from_side = pixels_from_side(solution, place, shift, points, i);
                    shown *= std::clamp(from_side - 0.5f, 0.0f, 1.0f);
                }
                radiance.set(i, shown);
            }
        });
}

}  // namespace trp
