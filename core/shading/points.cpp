// locate(): from a triangle and barycentrics to position, normals and material.
//
// Fetching is a scalar loop (every lane may sit on another mesh); what can be done for all lanes at once follows on
// vectors. Positions are interpolated from the triangle's vertices, which bounds their error by a few units in the last
// place of the greatest coordinate (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., sec. 6.8.4) and so
// gives the offset that clears a ray of the surface it leaves at every scale.
#include <algorithm>
#include <cmath>

#include "shading/equation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/points.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lengths, sides and offsets of what the fetch left in `points`: normals of any length, `offset` the greatest
// coordinate.
void finish_points(Points& points) {
    const hn::ScalableTag<float> d;
    using V = hn::Vec<decltype(d)>;
    const V tiny = hn::Set(d, 1e-37f), one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const V offset_scale = hn::Set(d, 0x1p-19f);
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        V gx = hn::Load(d, points.geometric_normal.x + i), gy = hn::Load(d, points.geometric_normal.y + i),
          gz = hn::Load(d, points.geometric_normal.z + i);
        const V vx = hn::Load(d, points.to_viewer.x + i), vy = hn::Load(d, points.to_viewer.y + i),
                vz = hn::Load(d, points.to_viewer.z + i);
        // Scale before squaring, so that the smallest triangles keep a length.
        const V greatest = hn::Max(hn::Max(hn::Abs(gx), hn::Abs(gy)), hn::Max(hn::Abs(gz), tiny));
        const V scale = hn::Div(one, greatest);
        gx = hn::Mul(gx, scale), gy = hn::Mul(gy, scale), gz = hn::Mul(gz, scale);
        const V length2 = hn::MulAdd(gx, gx, hn::MulAdd(gy, gy, hn::Mul(gz, gz)));
        const V facing = hn::MulAdd(gx, vx, hn::MulAdd(gy, vy, hn::Mul(gz, vz)));
        const auto behind = hn::Lt(facing, zero);
        const V side = hn::IfThenElse(behind, hn::Neg(one), one);
        const V g = hn::Div(side, hn::Sqrt(hn::Max(length2, tiny)));
        hn::Store(hn::Mul(gx, g), d, points.geometric_normal.x + i);
        hn::Store(hn::Mul(gy, g), d, points.geometric_normal.y + i);
        hn::Store(hn::Mul(gz, g), d, points.geometric_normal.z + i);
        V nx = hn::Load(d, points.normal.x + i), ny = hn::Load(d, points.normal.y + i),
          nz = hn::Load(d, points.normal.z + i);
        const V most = hn::Max(hn::Max(hn::Abs(nx), hn::Abs(ny)), hn::Max(hn::Abs(nz), tiny));
        const V shrink = hn::Div(one, most);
        nx = hn::Mul(nx, shrink), ny = hn::Mul(ny, shrink), nz = hn::Mul(nz, shrink);
        const V n = hn::Div(side, hn::Sqrt(hn::Max(hn::MulAdd(nx, nx, hn::MulAdd(ny, ny, hn::Mul(nz, nz))), tiny)));
        hn::Store(hn::Mul(nx, n), d, points.normal.x + i);
        hn::Store(hn::Mul(ny, n), d, points.normal.y + i);
        hn::Store(hn::Mul(nz, n), d, points.normal.z + i);
        hn::Store(hn::Mul(hn::Load(d, points.offset + i), offset_scale), d, points.offset + i);
        alignas(64) float flags[HWY_MAX_BYTES / sizeof(float)];
        hn::Store(hn::IfThenElseZero(behind, one), d, flags);
        for (size_t k = 0; k < hn::Lanes(d); ++k) points.behind[i + k] = flags[k] != 0;
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(finish_points);

namespace {

float greatest_coordinate(const Vec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// A bound of all numbers that a transform adds up for a point.
float greatest_term(const Affine& m, const Vec3& p) {
    float most = 0;
    for (const auto& row : m.rows)
        most =
            std::max(most, std::abs(row[0] * p.x) + std::abs(row[1] * p.y) + std::abs(row[2] * p.z) + std::abs(row[3]));
    return most;
}

}  // namespace

void locate(const Snapshot& snapshot, NormalChoice choice, Points& points) {
    uint8_t flags = 0;
    for (int i = 0; i < kBatch; ++i) {
        if (points.slot[i] == kNoSlot) {
            points.position.set(i, {0, 0, 0});
            points.geometric_normal.set(i, {0, 0, 1});
            points.normal.set(i, {0, 0, 1});
            points.offset[i] = 0;
            points.material[i] = 0;
            continue;
        }
        const PlacedSurface& surface = snapshot.surfaces[points.slot[i]];
        const uint32_t triangle = points.triangle[i];
        const uint32_t* v = surface.vertices + 3 * static_cast<size_t>(triangle);
        Vec3 p0 = surface.positions[v[0]], p1 = surface.positions[v[1]], p2 = surface.positions[v[2]];
        float greatest;
        if (surface.baked) {
            greatest = std::max({greatest_coordinate(p0), greatest_coordinate(p1), greatest_coordinate(p2)});
        } else {
            const Affine& m = surface.world_from_object;
            greatest = std::max({greatest_term(m, p0), greatest_term(m, p1), greatest_term(m, p2)});
            p0 = m.point(p0), p1 = m.point(p1), p2 = m.point(p2);
        }
        const float b1 = points.b1[i], b2 = points.b2[i], b0 = 1 - b1 - b2;
        const Vec3 geometric = (p1 - p0).cross(p2 - p0) * surface.normal_sign;
        points.position.set(i, p0 * b0 + p1 * b1 + p2 * b2);
        points.geometric_normal.set(i, geometric);
        points.offset[i] = greatest;

        const NormalLayer& layer =
            choice == NormalChoice::averaged ? surface.surface->averaged_normals() : surface.normals;
        Vec3 normal = geometric;
        const bool flat =
            layer.domain == NormalLayer::Domain::flat ||
            (choice == NormalChoice::mesh && surface.face_smooth && !surface.face_smooth[surface.face(triangle)]);
        if (!flat) {
            if (layer.domain == NormalLayer::Domain::vertex)
                normal = layer.values[v[0]] * b0 + layer.values[v[1]] * b1 + layer.values[v[2]] * b2;
            else
                normal = layer.values[surface.corner(triangle, 0)] * b0 +
                         layer.values[surface.corner(triangle, 1)] * b1 +
                         layer.values[surface.corner(triangle, 2)] * b2;
            if (!surface.identity) normal = surface.world_from_object.normal(normal) * surface.normal_sign;
        }
        points.normal.set(i, normal);
        const uint32_t material = surface.material(triangle);
        points.material[i] = material;
        flags |= snapshot.material_flags[material];
    }
    points.any_program = flags & kHasProgram;
    points.any_holes = flags & kMayHaveHoles;
    HWY_DYNAMIC_DISPATCH(finish_points)(points);
}

}  // namespace trp
#endif
