#include "raster/draw_list.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/parallel.h"

namespace trp {
namespace {

// Bounds the cluster's box on the film; false where it is outside. All of the film where it reaches behind the eye.
bool bound(const FilmTransform& m, const Projection& projection, const Bounds& box, int32_t reach, DrawnCluster& out) {
    float low[2] = {1e30f, 1e30f}, high[2] = {-1e30f, -1e30f}, nearest = 1e30f, farthest = -1e30f;
    for (int corner = 0; corner < 8; ++corner) {
        const float p[3] = {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                            corner & 4 ? box.max.z : box.min.z};
        float q[3];
        for (int r = 0; r < 3; ++r)
            q[r] = m.rows[r][0] * p[0] + m.rows[r][1] * p[1] + m.rows[r][2] * p[2] + m.rows[r][3];
        nearest = std::min(nearest, q[2]);
        farthest = std::max(farthest, q[2]);
        for (int k = 0; k < 2; ++k) {
            const float at = projection.perspective() ? q[k] / q[2] : q[k];
            low[k] = std::min(low[k], at);
            high[k] = std::max(high[k], at);
        }
    }
    if (!(farthest >= projection.clip_start())) return false;
    const float sides[2] = {static_cast<float>(projection.width()), static_cast<float>(projection.height())};
    out.nearness = projection.nearness(std::max(nearest, projection.clip_start()));
    if (out.nearness < projection.farthest()) return false;
    out.farness = projection.nearness(farthest);
    int32_t* const begins[2] = {&out.x0, &out.y0};
    int32_t* const ends[2] = {&out.x1, &out.y1};
    for (int k = 0; k < 2; ++k) {
        const float margin = 1 + static_cast<float>(reach);  // a pixel for rounding
        const bool cut = nearest < projection.clip_start();
        *begins[k] = cut ? 0 : static_cast<int32_t>(std::clamp(std::floor(low[k]) - margin, 0.0f, sides[k]));
        *ends[k] = static_cast<int32_t>(cut ? sides[k] : std::clamp(std::ceil(high[k]) + margin, 0.0f, sides[k]));
        if (*begins[k] >= *ends[k]) return false;
    }
    return true;
}

}  // namespace

DrawList make_draw_list(const Snapshot& snapshot, const Projection& projection, Primitives primitives, int32_t reach) {
    DrawList list;
    for (uint32_t slot = 0; slot < snapshot.surfaces.size(); ++slot) {
        const bool seen = snapshot.surfaces[slot].mesh && (snapshot.rays->placement(slot)->mask & kSeenByCamera);
        list.surfaces.push_back(seen ? &snapshot.surfaces[slot] : nullptr);
    }
    for (const PlacedSurface& wire : snapshot.wires) list.surfaces.push_back(&wire);
    list.transforms.resize(list.surfaces.size());
    list.sets.resize(list.surfaces.size());
    for (uint32_t slot = 0; slot < list.surfaces.size(); ++slot) {
        if (!list.surfaces[slot]) continue;
        const PlacedSurface& surface = *list.surfaces[slot];
        list.transforms[slot] = projection.transform(surface.baked ? Affine{} : surface.world_from_object);
        const FilmTransform of_object = projection.transform(surface.world_from_object);
        list.sets[slot] =
            primitives == Primitives::edges ? &surface.surface->edges().clusters : &surface.surface->clusters();
        const std::vector<Cluster>& clusters = list.sets[slot]->clusters;
        const size_t begin = list.clusters.size();
        list.clusters.resize(begin + clusters.size());
        parallel_ranges(clusters.size(), 256, [&](size_t first, size_t end) {
            for (size_t c = first; c < end; ++c) {
                DrawnCluster& drawn = list.clusters[begin + c];
                drawn.slot = slot;
                drawn.cluster = static_cast<uint32_t>(c);
                if (!bound(of_object, projection, clusters[c].bounds, reach, drawn)) drawn.x1 = drawn.x0;
            }
        });
        list.clusters.erase(std::remove_if(list.clusters.begin() + static_cast<ptrdiff_t>(begin), list.clusters.end(),
                                           [](const DrawnCluster& c) { return c.x0 >= c.x1; }),
                            list.clusters.end());
    }
    if (list.clusters.size() >= (uint64_t{1} << 31) / Cluster::kMostPrimitives)
        fail(TRP_ERROR_MEMORY, "{} groups of triangles or edges are before the camera; at most {} can be drawn",
             list.clusters.size(), (uint64_t{1} << 31) / Cluster::kMostPrimitives);
    parallel_sort(list.clusters, [](const DrawnCluster& a, const DrawnCluster& b) {
        return std::tuple(-a.nearness, a.slot, a.cluster) < std::tuple(-b.nearness, b.slot, b.cluster);
    });
    return list;
}

TileLists::TileLists(const DrawList& list, const Window& window, uint32_t tile_size)
    : side_(std::max(1u, tile_size / kBlockSide)),
      first_x_(window.x / kBlockSide / side_),
      first_y_(window.y / kBlockSide / side_) {
    const auto last = [&](uint32_t begin, uint32_t size) { return (begin + size - 1) / kBlockSide / side_; };
    const uint32_t last_x = last(window.x, window.w), last_y = last(window.y, window.h);
    across_ = last_x - first_x_ + 1;
    lists_.resize(size_t{across_} * (last_y - first_y_ + 1));
    const auto clamped = [&](int32_t pixel, uint32_t low, uint32_t high) {
        return std::clamp(static_cast<uint32_t>(pixel) / kBlockSide / side_, low, high);
    };
    for (uint32_t number = 0; number < list.clusters.size(); ++number) {
        const DrawnCluster& c = list.clusters[number];
        const auto pixels = static_cast<int32_t>(side_ * kBlockSide);
        if (c.x1 <= static_cast<int32_t>(first_x_) * pixels || c.x0 >= static_cast<int32_t>(last_x + 1) * pixels ||
            c.y1 <= static_cast<int32_t>(first_y_) * pixels || c.y0 >= static_cast<int32_t>(last_y + 1) * pixels)
            continue;
        for (uint32_t y = clamped(c.y0, first_y_, last_y); y <= clamped(c.y1 - 1, first_y_, last_y); ++y)
            for (uint32_t x = clamped(c.x0, first_x_, last_x); x <= clamped(c.x1 - 1, first_x_, last_x); ++x)
                lists_[size_t{y - first_y_} * across_ + x - first_x_].push_back(number);
    }
}

const std::vector<uint32_t>& TileLists::of(const TileWork& work) const {
    return lists_[size_t{work.block_y0 / side_ - first_y_} * across_ + work.block_x0 / side_ - first_x_];
}

}  // namespace trp
