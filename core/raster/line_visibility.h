// Which parts of an edge are seen, by a visibility buffer.
//
// A point of an edge is hidden where a triangle that is seen in one of the four pixels around it covers the point and
// lies before it; the faces that the edge belongs to, known by their numbers, never hide it. Where no seen triangle
// covers the point, as where faces are smaller than pixels, it is seen with its faces, or where nothing is seen, or
// before the triangle of the nearest pixel. The ends of seen parts are found by halving.
#pragma once

#include <vector>

#include "raster/segments.h"
#include "raster/visibility_tile.h"

namespace trp {

// Part of a segment, from 0 to 1 along it.
struct Run {
    float begin, end;
    bool seen;
};

class LineVisibility {
  public:
    // `list`: of the triangles whose keys the tiles hold.
    LineVisibility(const DrawList& list, const Projection& projection);

    // The parts of a segment of a surface's edge as far as they lie within `tile.reach` of the tile; `visibility` must
    // reach kAround pixels farther, or to the film's end.
    static constexpr uint32_t kAround = 3;
    void split(const Segment& segment, uint32_t slot, const Edge& edge, const TileReach& tile,
               const VisibilityTile& visibility, std::vector<Run>& runs);

  private:
    // A triangle on the film, for points (x, y, 1) in pixels: inside where all of `sides`, in pixels, are positive.
    struct Occluder {
        uint32_t key = kNothing, slot = 0, face = 0;
        double sides[3][3], nearness[3];
        bool covers(double x, double y) const;
        double nearness_at(double x, double y) const { return nearness[0] * x + nearness[1] * y + nearness[2]; }
    };
    struct Place {
        double x, y, nearness;
        uint32_t slot;
        const uint32_t* faces;
    };

    const Occluder& occluder(uint32_t key);
    bool sees(const Place& place, const VisibilityTile& visibility);

    const DrawList& list_;
    const Projection& projection_;
    std::vector<Occluder> occluders_;  // the last of each remainder of keys
};

}  // namespace trp
