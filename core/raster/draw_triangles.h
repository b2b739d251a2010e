// Triangles of a cluster into a tile's buffers.
#pragma once

#include "raster/visibility_tile.h"

namespace trp {

struct ClusterToDraw {
    const Vec3* positions;
    const uint32_t* vertices;  // three to a triangle of the surface
    const ClusterSet& set;
    uint32_t cluster;
    FilmTransform transform;
    uint32_t first_key;
};

// The least of the kBatch numbers of a block, which is aligned.
float least_nearness(const float* block);

void draw_cluster(const ClusterToDraw& cluster, const Projection& projection, const VisibilityTile::Buffers& tile);

}  // namespace trp
