// Triangles of a cluster into a tile's buffers.
#pragma once

#include "raster/placed_cluster.h"
#include "raster/visibility_tile.h"

namespace trp {

// The least of the kBatch numbers of a block, which is aligned.
float least_nearness(const float* block);

// Triangle k of the cluster gets the key first_key + k.
void draw_triangles(const PlacedCluster& cluster, uint32_t first_key, const VisibilityTile::Buffers& tile);

}  // namespace trp
