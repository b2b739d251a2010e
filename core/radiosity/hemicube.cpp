#include "radiosity/hemicube.h"

#include <algorithm>
#include <memory>
#include <numbers>

#include "base/parallel.h"
#include "film/surface_passes.h"
#include "radiosity/element_rays.h"
#include "raster/draw_list.h"
#include "raster/seen_points.h"
#include "shading/equation.h"

namespace trp {
namespace {

// A camera at the element's middle that looks through a face.
View face_view(const Elements& elements, uint32_t i, int face, uint32_t resolution) {
    const Vec3 z = elements.normal(i), x = perpendicular_to(z), y = z.cross(x);
    const Vec3 centre = elements[i].centre;
    const Vec3 sides[4] = {x, y, -x, -y};
    View view;
    view.position = centre + z * (2 * clearance(centre));
    view.z = face == 0 ? -z : -sides[face - 1];
    view.y = face == 0 ? y : z;
    view.x = view.y.cross(view.z);
    view.left = view.bottom = -1;
    view.step_x = view.step_y = 2 / static_cast<float>(resolution);
    view.clip_start = clearance(centre);
    view.clip_end = 1e18f;
    return view;
}

struct FaceScratch {
    VisibilityTile tile;
    Points points;
    Coefficients coefficients;
    ProgramScratch program;
    LaneVec3 origins, directions;
    std::vector<LaneVec3> throughput;  // block by block
};

}  // namespace

double delta_form_factor(int face, uint32_t resolution, uint32_t x, uint32_t y) {
    const double step = 2.0 / resolution, u = (x + 0.5) * step - 1, v = (y + 0.5) * step - 1;
    const double r2 = u * u + v * v + 1;
    return (face == 0 ? 1 : v) * step * step / (std::numbers::pi * r2 * r2);
}

void draw_hemicube_face(const FormFactorJob& job, uint32_t i, int face, std::vector<HemicubePixel>& out) {
    const Elements& elements = job.elements;
    const Snapshot& snapshot = elements.snapshot();
    const uint32_t resolution = job.settings.hemicube_resolution, y0 = face == 0 ? 0 : resolution / 2;
    const View view = face_view(elements, i, face, resolution);
    const Projection projection(view, resolution, resolution);
    const DrawList list = make_draw_list(snapshot, projection, Primitives::triangles, 0);
    const auto w = std::make_unique<FaceScratch>();
    const uint32_t across = resolution / kBlockSide, up = (resolution - y0) / kBlockSide;
    w->tile.place(0, static_cast<int32_t>(y0), across, up);
    const bool layered = snapshot.seen_through;
    if (layered) {
        w->throughput.resize(size_t{across} * up);
        for (LaneVec3& lanes : w->throughput)
            for (int c = 0; c < 3; ++c) std::fill_n(lanes[c], kBatch, 1.0f);
    }
    bool any_left = true;
    for (int layer = 0; layer < kGreatestLayers && any_left && !*job.cancelled; ++layer) {
        any_left = false;
        w->tile.begin(projection, 0, 0, layer > 0);
        for (uint32_t cluster = 0; cluster < list.clusters.size(); ++cluster) w->tile.draw(projection, list, cluster);
        for (uint32_t block = 0; block < across * up; ++block) {
            const uint32_t x = block % across * kBlockSide, y = y0 + block / across * kBlockSide;
            if (!read_keys(list, w->tile.keys(block), w->points)) continue;
            make_directions(view, BlockSamples(x, y), w->origins, w->directions);
            locate_seen(snapshot, NormalChoice::flat, {view.position, nullptr, w->directions}, w->points);
            if (layered) {
                w->points.clear_footprints();
                evaluate(snapshot, w->points, w->coefficients, w->program, kEveryLane.data());
            }
            for (int lane = 0; lane < kBatch; ++lane) {
                const Points& points = w->points;
                if (points.slot[lane] == kNoSlot) continue;
                Vec3 weight(1, 1, 1);
                bool shows = true;
                if (layered) {
                    LaneVec3& throughput = w->throughput[block];
                    weight = throughput.get(lane);
                    shows = w->coefficients.alpha[lane] > 0;
                    const Vec3 left = throughput_behind(points, w->coefficients, lane, weight);
                    throughput.set(lane, left);
                    if (left == Vec3(0, 0, 0))
                        w->tile.close(block, lane);
                    else
                        any_left = true;
                }
                if (!shows) continue;
                const uint32_t element = elements.find(points.slot[lane], points.triangle[lane], points.b1[lane],
                                                       points.b2[lane], w->directions.get(lane));
                const auto [px, py] = pixel_of_lane(lane);
                if (element != kNoElement) out.push_back({x + px, y + py, element, weight});
            }
        }
    }
}

void hemicube_row(const FormFactorJob& job, uint32_t i, uint32_t first, Vec3d* out) {
    std::vector<HemicubePixel> seen[kHemicubeFaces];
    parallel_ranges(kHemicubeFaces, 1, [&](size_t begin, size_t end) {
        for (size_t face = begin; face < end; ++face) draw_hemicube_face(job, i, static_cast<int>(face), seen[face]);
    });
    for (int face = 0; face < kHemicubeFaces; ++face)
        for (const HemicubePixel& pixel : seen[face])
            if (pixel.element >= first)
                out[pixel.element - first] +=
                    Vec3d(pixel.weight) * delta_form_factor(face, job.settings.hemicube_resolution, pixel.x, pixel.y);
}

}  // namespace trp
