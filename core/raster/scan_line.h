// The books' interpolation (Gouraud 1971; Bui Tuong Phong 1975): values go bilinearly down the sides of a polygon on
// the film and across the scan line between them,
//
//   A = α I1 + (1 − α) I2,  B = β I3 + (1 − β) I4,  I = (1 − γ) A + γ B
//
// with I1 and I3 at the upper ends of the sides on the left and on the right of the point, I2 and I4 at their lower
// ends (in a triangle two of the four are one). The polygon is taken as a whole, so that its triangulation does not
// matter; but a picture that is turned has other values, and a perspective view is not accounted for.
#pragma once

#include <vector>

#include "raster/draw_list.h"
#include "raster/seen_points.h"
#include "raster/vertex_colors.h"

namespace trp {

// A corner of a polygon, or where the near plane cuts a side, a point between two of them.
struct PolygonPoint {
    uint32_t corner = 0, other = 0;  // of the mesh
    float share = 0;                 // of `other`
    double x = 0, y = 0;             // on the film, in pixels
    bool is_corner() const { return share == 0; }
};

struct ScanLine {
    PolygonPoint ends[4];  // where I1 … I4 are
    float alpha = 0, beta = 0, gamma = 0;
};

// A face of a placed surface on the film, on the same grid as its triangles.
class ScanPolygon {
  public:
    ScanPolygon(const PlacedSurface& surface, uint32_t face, const FilmTransform& transform,
                const Projection& projection);
    // At a point of the film in pixels, which the polygon covers.
    ScanLine at(double x, double y);

  private:
    // Where a scan line crosses a side.
    struct Crossing {
        double x;
        float share;  // of the upper end
        const PolygonPoint *upper, *lower;
    };
    struct Row {
        double y;
        std::vector<Crossing> crossings;  // from left to right
    };
    const Row& row(double y);
    const PolygonPoint& nearest(double x, double y) const;

    std::vector<PolygonPoint> points_;
    double low_ = 1e30, high_ = -1e30;
    std::vector<Row> rows_;  // the last ones asked for, so that large polygons are not searched pixel by pixel
    size_t next_row_ = 0;
};

// What a scan line makes of values at a mesh's corners: I1 … I4, A, B and I.
struct ScanValues {
    Vec3 ends[4], a, b, value;
};
template <class Value>
ScanValues interpolate(const ScanLine& line, Value&& value_at) {
    ScanValues out;
    for (int k = 0; k < 4; ++k) {
        const PolygonPoint& end = line.ends[k];
        out.ends[k] = value_at(end.corner);
        if (!end.is_corner()) out.ends[k] += (value_at(end.other) - out.ends[k]) * end.share;
    }
    out.a = out.ends[0] * line.alpha + out.ends[1] * (1 - line.alpha);
    out.b = out.ends[2] * line.beta + out.ends[3] * (1 - line.beta);
    out.value = out.a * (1 - line.gamma) + out.b * line.gamma;
    return out;
}

// Instead of interpolate_colors() and of the normals that locate() found: those of scan lines through the samples of a
// block's pixels.
struct ScanLines {
    const Snapshot& snapshot;
    const DrawList& list;
    const Projection& projection;
    const BlockSamples& samples;
};
void scan_colors(const ScanLines& lines, const SceneColors& colors, const Points& points, LaneVec3& radiance);
void scan_normals(const ScanLines& lines, NormalChoice choice, Points& points);

// The normal at a corner of a placed surface, in world space on the surface's front; false where its face is flat.
bool corner_normal(const PlacedSurface& surface, NormalChoice choice, uint32_t face, uint32_t corner, Vec3& out);

}  // namespace trp
