#include "raster/vertex_colors.h"

#include <algorithm>

#include "base/parallel.h"

namespace trp {
namespace {

// Whether all faces around a vertex agree on all that is evaluated there.
bool shares_vertices(const Snapshot& snapshot, const PlacedSurface& surface, NormalChoice normals) {
    if (surface.surface->normals(normals).domain != NormalLayer::Domain::vertex || surface.face_materials ||
        surface.face_smooth)
        return false;
    const bool by_program = snapshot.materials[surface.slot_materials[0]].has_program();
    const Mesh& mesh = *surface.mesh;
    const auto by_corner = [](const Attribute& layer) { return layer.domain == TRP_DOMAIN_CORNER; };
    return !by_program || (std::none_of(mesh.uv_sets.begin(), mesh.uv_sets.end(), by_corner) &&
                           std::none_of(mesh.colors.begin(), mesh.colors.end(), by_corner));
}

// A triangle that has the vertex or corner, times 4, plus which of its three it is; ~0 where no triangle has it.
std::vector<uint32_t> find_triangles(const PlacedSurface& surface, bool by_corner) {
    const Mesh& mesh = *surface.mesh;
    std::vector<uint32_t> out(by_corner ? mesh.corner_vertices.size() : mesh.vertex_count, ~0u);
    for (uint32_t t = 0; t < surface.surface->triangle_count(); ++t)
        for (int k = 0; k < 3; ++k)
            out[by_corner ? surface.corner(t, k) : surface.vertices[3 * size_t{t} + k]] =
                4 * t + static_cast<uint32_t>(k);
    return out;
}

}  // namespace

SceneColors shade_vertices(const Snapshot& snapshot, const std::vector<uint8_t>& wanted, NormalChoice normals,
                           const Vec3* eye, const Vec3& axis, const PointShader& shade) {
    SceneColors colors(snapshot.surfaces.size());
    for (uint32_t slot = 0; slot < colors.size(); ++slot) {
        if (!wanted[slot]) continue;
        const PlacedSurface& surface = snapshot.surfaces[slot];
        VertexColors& out = colors[slot];
        out.by_corner = !shares_vertices(snapshot, surface, normals);
        const std::vector<uint32_t> triangles = find_triangles(surface, out.by_corner);
        for (auto& side : out.sides) side.resize(triangles.size());
        const size_t batches = (triangles.size() + kBatch - 1) / kBatch;
        parallel_ranges(2 * batches, 1, [&](size_t begin, size_t end) {
            const auto points = std::make_unique<Points>();
            const auto radiance = std::make_unique<LaneVec3>();
            for (size_t b = begin; b < end; ++b) {
                const size_t first = b / 2 * kBatch;
                const bool behind = b % 2;
                points->clear_footprints();
                for (int i = 0; i < kBatch; ++i) {
                    points->slot[i] = kNoSlot;
                    points->triangle[i] = 0;
                    points->b1[i] = points->b2[i] = points->time[i] = points->depth[i] = 0;
                    points->to_viewer.set(i, axis);
                    const size_t element = first + static_cast<size_t>(i);
                    if (element >= triangles.size() || triangles[element] == ~0u) continue;
                    const uint32_t triangle = triangles[element] / 4, k = triangles[element] % 4;
                    points->slot[i] = slot;
                    points->triangle[i] = triangle;
                    (k == 1 ? points->b1[i] : points->b2[i]) = k == 0 ? 0 : 1;
                    points->b1_dx[i] = points->b2_dy[i] = 1;
                    if (!eye) continue;
                    const Vec3 at = surface.world_position(surface.vertices[3 * size_t{triangle} + k]);
                    points->to_viewer.set(i, (*eye - at).normalized());
                }
                shade(slot, static_cast<uint32_t>(b / 2), behind, *points, *radiance);
                const size_t last = std::min(triangles.size() - first, static_cast<size_t>(kBatch));
                for (size_t i = 0; i < last; ++i) out.sides[behind][first + i] = radiance->get(static_cast<int>(i));
            }
        });
    }
    return colors;
}

void interpolate_colors(const Snapshot& snapshot, const SceneColors& colors, const Points& points, LaneVec3& radiance) {
    for (int i = 0; i < kBatch; ++i) {
        if (points.slot[i] == kNoSlot) {
            radiance.set(i, {0, 0, 0});
            continue;
        }
        const PlacedSurface& surface = snapshot.surfaces[points.slot[i]];
        const VertexColors& of = colors[points.slot[i]];
        const std::vector<Vec3>& side = of.sides[points.behind[i]];
        const uint32_t triangle = points.triangle[i];
        Vec3 at[3];
        for (int k = 0; k < 3; ++k)
            at[k] = side[of.by_corner ? surface.corner(triangle, k)
                                      : surface.vertices[3 * size_t{triangle} + static_cast<size_t>(k)]];
        radiance.set(i, at[0] + (at[1] - at[0]) * points.b1[i] + (at[2] - at[0]) * points.b2[i]);
    }
}

}  // namespace trp
