// A cluster's vertices on the film's grid.
#pragma once

#include "raster/placed_cluster.h"

namespace trp {

// By their place in the cluster: film positions in 1/256 pixel from an origin, nearness, and −1 where a vertex is
// behind the eye or farther outside of the film than the grid reaches; its place means nothing then. Padded, to be
// read in whole vectors.
struct ClusterVertices {
    static constexpr size_t kRoom = Cluster::kMostVertices + 64;
    alignas(64) int32_t x[kRoom], y[kRoom], is_cut[kRoom];
    alignas(64) float near[kRoom];
    bool any_cut;
};

// `origin_x`, `origin_y`: in 1/256 pixel from the film's lower left corner.
void project_vertices(const PlacedCluster& cluster, int32_t origin_x, int32_t origin_y, ClusterVertices& out);

}  // namespace trp
