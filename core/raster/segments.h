// Edges of a cluster as segments on a tile.
#pragma once

#include "raster/cluster_vertices.h"

namespace trp {

// From one end to the other: in pixels from the centre of the tile's first pixel, multiples of 1/256, and nearness.
struct Segment {
    float x[2], y[2], near[2];
    uint8_t number;   // of the edge among the cluster's
    uint8_t ends[2];  // which of the cluster's vertices
    bool is_cut;      // and the ends here are not those vertices
};

// The pixels of a tile and how far around their centres lines may reach, in pixels.
struct TileReach {
    uint32_t x0, y0, width, height;
    float reach;
};

// Writes the edges of the cluster that may reach a pixel of the tile, cut where they go behind the eye or far outside
// of the film, and returns their number, at most Cluster::kMostPrimitives. `vertices`: all of the cluster's, from the
// centre of the tile's first pixel.
uint32_t find_segments(const PlacedCluster& cluster, const TileReach& tile, ClusterVertices& vertices, Segment* out);

}  // namespace trp
