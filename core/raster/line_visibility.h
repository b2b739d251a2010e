// Which parts of edges are seen: points along them are tested, and the ends of seen parts found by halving. Short edges
// are tested at their vertices, each once for all edges that end there, and between them.
#pragma once

#include <span>

#include "raster/line_tile.h"
#include "raster/seen_planes.h"

namespace trp {

// Part of a segment, from 0 to 1 along it.
struct Run {
    float begin, end;
    bool seen;
};

class LineVisibility {
  public:
    // How many pixels farther than lines reach the visibility around a tile must be known, but for the film's end.
    static constexpr uint32_t kAround = 8;

    // `triangles`: those whose keys the visibility tiles hold.
    LineVisibility(const DrawList& triangles, const Projection& projection) : planes_(triangles, projection) {
        vertices_.owners = SurfacePoints::Owners::vertices;
        between_.between_seen = true;
    }

    // Begins a tile of lines, whose surroundings `visibility` holds.
    void begin(const TileReach& tile, const VisibilityTile& visibility);
    // Parts lines of one cluster of edges, as far as they reach the tile. `vertices`: the cluster's, from the centre of
    // the tile's first pixel.
    void split(uint32_t slot, const PlacedCluster& cluster, const ClusterVertices& vertices,
               std::span<const DrawnLine> lines);
    // Those of a line, by its place among the last ones.
    std::span<const Run> runs(size_t line) const {
        return {runs_.data() + first_run_[line], runs_.data() + first_run_[line + 1]};
    }

  private:
    // Where a line is tested: the middles of the parts [first, last] of `count` equal ones, none where last < first;
    // or, where `has_ends`, all places between those parts, and the ends.
    struct Parts {
        double count;
        int first, last;
        bool has_ends, first_is_seen;

        double place(int k) const { return (has_ends ? k : k + 0.5) / count; }
    };
    // Between two points of a line, one seen and one not.
    struct Change {
        size_t line;
        double low, high;
        bool low_is_seen;
    };
    Parts parts_of(const Segment& segment) const;
    void need_vertex(const PlacedCluster& cluster, const ClusterVertices& vertices, uint8_t number);
    void add_point(const PlacedCluster& cluster, const DrawnLine& line, double at, SurfacePoints& points);
    bool end_is_seen(const DrawnLine& line, int end) const {
        return seen_vertices_[static_cast<size_t>(vertex_place_[line.segment.ends[end]])] != 0;
    }
    bool ends_are_seen(const Parts& parts, const DrawnLine& line) const {
        return parts.has_ends && end_is_seen(line, 0) && end_is_seen(line, 1);
    }
    void test_lines(const PlacedCluster& cluster, const ClusterVertices& vertices, std::span<const DrawnLine> lines);
    void find_changes(const PlacedCluster& cluster, std::span<const DrawnLine> lines);

    TileReach tile_{};
    SeenPlanes planes_;
    SurfacePoints vertices_, between_, points_;     // `between_`: on lines whose ends are seen
    int16_t vertex_place_[Cluster::kMostVertices];  // of the cluster's vertices in `vertices_`; −1: not there
    std::vector<Parts> parts_;
    std::vector<uint8_t> seen_vertices_, seen_between_, seen_points_;
    std::vector<Change> changes_;
    std::vector<Run> runs_;
    std::vector<size_t> first_run_;
};

}  // namespace trp
