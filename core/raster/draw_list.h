// The clusters that a film may show, from near to far, and those of each tile.
#pragma once

#include <vector>

#include "film/tiles.h"
#include "raster/placed_cluster.h"
#include "shading/snapshot.h"

namespace trp {

// A cluster as it is placed, and the pixels whose samples it may cover: [x0, x1) by [y0, y1).
struct DrawnCluster {
    uint32_t slot = 0, cluster = 0;
    int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    float nearness = 0, farness = 0;  // the nearness of its box's nearest and of its farthest corner
};

enum class Primitives { triangles, edges };

// Slots are those of Snapshot::surfaces, and after them those of Snapshot::wires.
struct DrawList {
    std::vector<DrawnCluster> clusters;
    std::vector<FilmTransform> transforms;       // of the surfaces' positions, by slot
    std::vector<const ClusterSet*> sets;         // by slot; null where nothing is to be drawn
    std::vector<const PlacedSurface*> surfaces;  // by slot

    PlacedCluster placed(const DrawnCluster& cluster, const Projection& projection) const {
        return {surfaces[cluster.slot]->positions, *sets[cluster.slot], cluster.cluster, transforms[cluster.slot],
                projection};
    }
};

// All clusters before the camera of surfaces that it sees, sorted from near to far, ties by slot and cluster. `reach`:
// how far from their pixels samples lie, or lines cover. Runs in the current arena.
DrawList make_draw_list(const Snapshot& snapshot, const Projection& projection, Primitives primitives, int32_t reach);

// For each tile of run_tiles(), the numbers of the clusters that it may show, in the list's order.
class TileLists {
  public:
    TileLists() = default;
    TileLists(const DrawList& list, const Window& window, uint32_t tile_size);
    const std::vector<uint32_t>& of(const TileWork& work) const;

  private:
    uint32_t side_ = 1, first_x_ = 0, first_y_ = 0, across_ = 0;  // in blocks, and in tiles
    std::vector<std::vector<uint32_t>> lists_;
};

}  // namespace trp
