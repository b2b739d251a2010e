// Which parts of edges are seen: points along them are tested, and the ends of seen parts found by halving.
#pragma once

#include <span>

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
    LineVisibility(const DrawList& triangles, const Projection& projection) : planes_(triangles, projection) {}

    // Begins a tile of lines, whose surroundings `visibility` holds.
    void begin(const TileReach& tile, const VisibilityTile& visibility);
    // A segment of an edge.
    struct Line {
        const Segment* segment;
        const Edge* edge;
    };
    // Parts lines of one surface, as far as they reach the tile.
    void split(uint32_t slot, std::span<const Line> lines);
    // Those of a line, by its place among the last ones.
    std::span<const Run> runs(size_t line) const {
        return {runs_.data() + first_run_[line], runs_.data() + first_run_[line + 1]};
    }

  private:
    // Points of a line that are tested first: the middles of the parts [first, last] of `count` equal ones.
    struct Parts {
        double count;
        int first, last;  // none: last < first
    };
    // Between two points of a line, one seen and one not.
    struct Change {
        size_t line;
        double low, high;
        bool low_is_seen;
    };
    Parts parts_of(const Segment& segment) const;
    void add_point(const Line& line, double at);

    TileReach tile_{};
    SeenPlanes planes_;
    EdgePoints points_;
    std::vector<Parts> parts_;
    std::vector<uint8_t> seen_, seen_between_;
    std::vector<Change> changes_;
    std::vector<Run> runs_;
    std::vector<size_t> first_run_;
};

}  // namespace trp
