// Whether points of edges and vertices are seen, by a visibility buffer.
//
// A point is hidden where a triangle that is seen in one of the four pixels around it covers the point and
// lies before it, unless it is of a face that the point's edge or vertex belongs to, known by its number. Where no seen
// triangle covers the point, as where faces are smaller than pixels, it is seen with its faces, or where nothing is
// seen, or before the triangle of the nearest pixel. Before means by more than a step of the grid and a millionth, so
// that surfaces which touch keep their edges.
#pragma once

#include <vector>

#include "raster/cluster_vertices.h"
#include "raster/segments.h"
#include "raster/visibility_tile.h"

namespace trp {

// Points of one surface, on its edges or at its vertices.
struct SurfacePoints {
    enum class Owners { edges, vertices } owners = Owners::edges;
    uint32_t slot = 0;
    std::vector<float> x, y, nearness;  // x and y in 1/256 pixel from the centre of the tile's first pixel
    std::vector<uint32_t> owner;        // the edge of the surface's EdgeSet, or the mesh's vertex
    // Between others that are seen, not far away: what is of the surface itself hides them only where it is before them
    // by several pixels' size.
    bool between_seen = false;

    size_t size() const { return owner.size(); }
    void clear() { x.clear(), y.clear(), nearness.clear(), owner.clear(); }
    void add(float at_x, float at_y, float near, uint32_t of) {
        x.push_back(at_x), y.push_back(at_y), nearness.push_back(near), owner.push_back(of);
    }
};

// A triangle on the grid, its corners in a positive turn: the first, and from there to the others. Corners have whole
// numbers, so that neighbours agree about each vertex.
struct SeenPlane {
    float x, y, x1, y1, x2, y2;
    float near, near_x, near_y;  // at the first corner, and its slopes. NaN: a corner is behind the eye, or farther
                                 // outside than the grid reaches
};

class SeenPlanes {
  public:
    // `triangles`: those whose keys the visibility tiles hold.
    SeenPlanes(const DrawList& triangles, const Projection& projection);

    // Begins a tile of lines, whose surroundings `visibility` holds, as far as any point's pixels.
    void begin(const TileReach& tile, const VisibilityTile& visibility);
    // For each point, 1 where it is seen.
    void test(const SurfacePoints& points, std::vector<uint8_t>& seen);

    // For the functions that test points in lanes.
    struct Lookup {
        const uint32_t* keys;  // of the visibility tile
        const float* nearness;
        int32_t blocks_across;
        int32_t to_x, to_y;  // from the pixels of the tile of lines to those of the visibility tile
        int32_t first_x, first_y, last_x, last_y;  // the film's pixels, in those of the tile of lines
        const uint32_t* slots;                     // of the clusters, one to each DrawnCluster
        const int32_t* place_of;                   // of each cluster's first plane, or −1
        const float* planes;
    };
    Lookup lookup() const;
    const Projection& projection() const { return projection_; }
    // Makes the planes of the key's cluster.
    void need(uint32_t key);
    struct Cover {
        bool covers;
        bool is_before, is_far_before;  // its plane, also where it does not cover the point
    };
    Cover cover_cut(float x, float y, float limit, uint32_t key) const;
    bool is_own(const SurfacePoints& points, size_t i, uint32_t key) const;

  private:
    const DrawList& triangles_;
    const Projection& projection_;
    TileReach tile_{};
    const VisibilityTile* visibility_ = nullptr;
    std::vector<int32_t> place_of_;  // by cluster, in `planes_`; −1 where this tile has not needed it
    std::vector<uint32_t> needed_;   // the clusters that are there
    std::vector<SeenPlane> planes_;
};

}  // namespace trp
