// Which parts of an edge are seen, by a visibility buffer.
//
// A point of an edge is hidden where a triangle that is seen in one of the four pixels around it covers the point and
// lies before it, unless it is of a face that the edge belongs to, known by its number. Where no seen triangle covers
// the point, as where faces are smaller than pixels, it is seen with its faces, or where nothing is seen, or before the
// triangle of the nearest pixel. Before means by more than a step of the grid and a millionth, so that surfaces which
// touch keep their edges. The ends of seen parts are found by halving.
#pragma once

#include <vector>

#include "raster/cluster_vertices.h"
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
    // How many pixels farther than lines reach the visibility around a tile must be known, but for the film's end.
    static constexpr uint32_t kAround = 4;

    // `triangles`: those whose keys the visibility tiles hold.
    LineVisibility(const DrawList& triangles, const Projection& projection);

    // Begins a tile of lines, whose surroundings `visibility` holds.
    void begin(const TileReach& tile, const VisibilityTile& visibility);
    // The parts of a segment of a surface's edge, as far as they reach the tile.
    void split(const Segment& segment, uint32_t slot, const Edge& edge, std::vector<Run>& runs);

  private:
    // A point of an edge: in 1/256 pixel from the centre of the tile's first pixel.
    struct Place {
        double x, y, nearness;
        uint32_t slot;
        const uint32_t* faces;
    };
    // What a triangle is to a point: whether it covers it, and its plane's nearness there, times and beside a weight.
    struct Cover {
        bool covers;
        double weighted_nearness, weight;
        double slack;  // the change of the weighted nearness over a step of the grid
        bool is_before(double nearness) const {
            return weight > 0 ? weighted_nearness - slack > nearness * weight
                              : weighted_nearness + slack < nearness * weight;
        }
    };

    // A cluster that this tile has needed, each of its vertices and triangles in one place.
    struct Needed {
        struct Vertex {
            float x, y, near;
            bool is_cut;
        };
        uint32_t slot;
        const uint32_t* primitives;
        uint8_t corners[Cluster::kMostPrimitives][4];
        Vertex vertices[Cluster::kMostVertices];
    };

    bool sees(const Place& place);
    bool is_own(const Place& place, uint32_t key);
    Cover cover(const Place& place, uint32_t key);
    Cover cover_cut(const Place& place, uint32_t key) const;
    const Needed& cluster_of(uint32_t key);

    const DrawList& triangles_;
    const Projection& projection_;
    TileReach tile_{};
    const VisibilityTile* visibility_ = nullptr;
    std::vector<Needed*> needed_by_;  // by cluster; null where this tile has not needed it
    std::vector<uint32_t> numbers_;   // of the clusters needed, whose memory comes first in `memory_`
    std::vector<std::unique_ptr<Needed>> memory_;
};

}  // namespace trp
