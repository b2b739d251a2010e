#include "raster/visibility_tile.h"

#include <algorithm>
#include <cmath>

#include "raster/draw_triangles.h"

namespace trp {

void VisibilityTile::place(int32_t x0, int32_t y0, uint32_t blocks_across, uint32_t blocks_up) {
    x0_ = x0;
    y0_ = y0;
    blocks_across_ = blocks_across;
    blocks_up_ = blocks_up;
    farthest_.resize(size_t{blocks_across} * blocks_up);
    touched_.resize(farthest_.size());
    if (pixels() <= room_) return;
    room_ = pixels();
    keys_ = hwy::AllocateAligned<uint32_t>(room_);
    nearness_ = hwy::AllocateAligned<float>(room_);
    last_keys_.reset();
    last_nearness_.reset();
}

void VisibilityTile::begin(const Projection& projection, int32_t offset_x, int32_t offset_y, bool behind) {
    if (behind) {
        if (!last_keys_) {
            last_keys_ = hwy::AllocateAligned<uint32_t>(room_);
            last_nearness_ = hwy::AllocateAligned<float>(room_);
        }
        last_keys_.swap(keys_);
        last_nearness_.swap(nearness_);
    }
    std::fill_n(keys_.get(), pixels(), kNothing);
    std::fill_n(nearness_.get(), pixels(), projection.farthest());
    std::fill(farthest_.begin(), farthest_.end(), projection.farthest());
    std::fill(touched_.begin(), touched_.end(), uint8_t{0});
    buffers_ = {keys_.get(),
                nearness_.get(),
                behind ? last_keys_.get() : nullptr,
                behind ? last_nearness_.get() : nullptr,
                blocks_across_,
                blocks_across_ * kBlockSide,
                blocks_up_ * kBlockSide,
                grid_centre(x0_) + offset_x,
                grid_centre(y0_) + offset_y};
}

// The blocks that the cluster may cover: [0] to [1] across, [2] to [3] up.
bool VisibilityTile::block_range(const DrawnCluster& c, uint32_t range[4]) const {
    const auto reach = [](int32_t begin, int32_t end, int32_t first, uint32_t blocks, uint32_t* out) {
        const int64_t low = int64_t{begin} - first, high = int64_t{end} - first;
        if (high <= 0 || low >= int64_t{blocks} * kBlockSide) return false;
        out[0] = static_cast<uint32_t>(std::max<int64_t>(low, 0) / kBlockSide);
        out[1] = static_cast<uint32_t>(std::min<int64_t>((high - 1) / kBlockSide, blocks - 1));
        return true;
    };
    return reach(c.x0, c.x1, x0_, blocks_across_, range) && reach(c.y0, c.y1, y0_, blocks_up_, range + 2);
}

bool VisibilityTile::hidden(const DrawnCluster& cluster, float nearness) {
    uint32_t range[4];
    if (!block_range(cluster, range)) return true;
    for (uint32_t y = range[2]; y <= range[3]; ++y)
        for (uint32_t x = range[0]; x <= range[1]; ++x) {
            const size_t block = size_t{y} * blocks_across_ + x;
            if (touched_[block]) {
                farthest_[block] = least_nearness(&nearness_[block * kBatch]);
                touched_[block] = 0;
            }
            if (nearness > farthest_[block]) return false;
        }
    return true;
}

bool VisibilityTile::hides(const DrawnCluster& cluster) {
    return hidden(cluster, cluster.nearness + 1e-3f * std::abs(cluster.nearness));
}

void VisibilityTile::touch(const DrawnCluster& cluster) {
    uint32_t range[4];
    if (!block_range(cluster, range)) return;
    for (uint32_t y = range[2]; y <= range[3]; ++y)
        std::fill(&touched_[size_t{y} * blocks_across_ + range[0]],
                  &touched_[size_t{y} * blocks_across_ + range[1]] + 1, uint8_t{1});
}

void VisibilityTile::draw(const Projection& projection, const DrawList& list, uint32_t number) {
    const DrawnCluster& cluster = list.clusters[number];
    if (hidden(cluster, cluster.nearness)) return;
    draw_triangles(list.placed(cluster, projection), number * Cluster::kMostPrimitives, buffers_);
    touch(cluster);
}

}  // namespace trp
