// Flat shading: the points of a batch moved to where their polygons are evaluated.
#pragma once

#include "shading/snapshot.h"

namespace trp {

// Before locate(): each lane to the mean of its polygon's vertices, on the polygon's first triangle, with a footprint
// of the triangle's size. `eye`: where the camera is, relative to the origin; null where it is orthographic.
void move_to_faces(const Snapshot& snapshot, const Vec3* eye, Points& points);

// After locate(): the normals of the polygons (Newell's), on the viewer's side, so that they do not depend on how a
// polygon was cut into triangles.
void take_face_normals(const Snapshot& snapshot, Points& points);

}  // namespace trp
