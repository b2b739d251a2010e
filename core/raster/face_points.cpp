#include "raster/face_points.h"

#include <cmath>

namespace trp {
namespace {

// A polygon of a placed surface, in world space.
struct Face {
    Vec3 centre{0, 0, 0}, normal{0, 0, 0};
    uint32_t triangle = 0;               // its first
    float b1 = 1 / 3.0f, b2 = 1 / 3.0f;  // of the centre, in the plane of that triangle
};

Face make_face(const PlacedSurface& surface, uint32_t triangle) {
    Face out;
    const uint32_t face = surface.face(triangle);
    out.triangle = triangle;
    while (out.triangle > 0 && surface.faces && surface.faces[out.triangle - 1] == face) --out.triangle;
    const Mesh& mesh = *surface.mesh;
    const uint32_t begin = mesh.face_begin(face), end = mesh.face_end(face);
    auto corner = [&](uint32_t c) { return surface.world_position(mesh.corner_vertices[c]); };
    const Vec3 origin = corner(begin);
    for (uint32_t c = begin; c < end; ++c) {
        const Vec3 a = corner(c) - origin, b = corner(c + 1 < end ? c + 1 : begin) - origin;
        out.centre += a;
        out.normal += a.cross(b);
    }
    out.centre = out.centre / static_cast<float>(end - begin) + origin;
    out.normal *= surface.normal_sign;
    if (end - begin == 3) return out;

    const uint32_t* v = surface.vertices + 3 * size_t{out.triangle};
    const Vec3 p0 = surface.world_position(v[0]), e1 = surface.world_position(v[1]) - p0,
               e2 = surface.world_position(v[2]) - p0, plane = e1.cross(e2), to_centre = out.centre - p0;
    const float area2 = plane.length2();
    if (area2 > 0) {
        out.b1 = to_centre.cross(e2).dot(plane) / area2;
        out.b2 = e1.cross(to_centre).dot(plane) / area2;
    }
    return out;
}

// Calls take(lane, face) for all lanes with a slot; neighbours mostly show one face.
template <class Take>
void for_each_face(const Snapshot& snapshot, const Points& points, Take&& take) {
    uint32_t slot = kNoSlot, triangle = 0;
    Face face;
    for (int i = 0; i < kBatch; ++i) {
        if (points.slot[i] == kNoSlot) continue;
        if (points.slot[i] != slot || points.triangle[i] != triangle) {
            slot = points.slot[i];
            triangle = points.triangle[i];
            face = make_face(snapshot.surfaces[slot], triangle);
        }
        take(i, face);
    }
}

}  // namespace

void move_to_faces(const Snapshot& snapshot, const Vec3* eye, Points& points) {
    points.clear_footprints();
    for_each_face(snapshot, points, [&](int i, const Face& face) {
        points.triangle[i] = face.triangle;
        points.b1[i] = face.b1;
        points.b2[i] = face.b2;
        points.b1_dx[i] = points.b2_dy[i] = 1;
        if (eye) points.to_viewer.set(i, (*eye - face.centre).normalized());
    });
}

void take_face_normals(const Snapshot& snapshot, Points& points) {
    for_each_face(snapshot, points, [&](int i, const Face& face) {
        if (face.normal == Vec3(0, 0, 0)) return;
        Vec3 n = face.normal.normalized();
        points.behind[i] = n.dot(points.to_viewer.get(i)) < 0;
        if (points.behind[i]) n = -n;
        points.position.set(i, face.centre);
        points.normal.set(i, n);
        points.geometric_normal.set(i, n);
    });
}

}  // namespace trp
