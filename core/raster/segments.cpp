#include "raster/segments.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/segments.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMostLanes = HWY_MAX_BYTES / sizeof(float);

// An edge with an end behind the eye or far outside. False where nothing is left of it.
bool cut_segment(const PlacedCluster& c, uint32_t k, const TileReach& tile, Segment& out) {
    const Projection& projection = c.projection;
    const FilmPoint a = on_film(c.transform, c.positions[c.vertex(k, 0)]),
                    b = on_film(c.transform, c.positions[c.vertex(k, 1)]);
    double from = 0, to = 1;
    for (int bound = 0; bound < kBoundCount; ++bound) {
        const double at_a = within_bound(projection, bound, a), at_b = within_bound(projection, bound, b);
        if (!(at_a >= 0 || at_b >= 0)) return false;
        if (at_a < 0) from = std::max(from, at_a / (at_a - at_b));
        if (at_b < 0) to = std::min(to, at_a / (at_a - at_b));
    }
    if (!(from < to)) return false;
    for (int end = 0; end < 2; ++end) {
        const double t = end ? to : from;
        FilmPoint q;
        for (int r = 0; r < 3; ++r) q[r] = a[r] + (b[r] - a[r]) * t;
        const double depth = projection.perspective() ? q[2] : 1, x = q[0] / depth, y = q[1] / depth;
        if (!(std::abs(x) < 1e6 && std::abs(y) < 1e6)) return false;  // what rounding makes of ends at 1e30
        const auto grid = [](double film, uint32_t first) {
            return static_cast<float>(std::round((film - 0.5) * kSubpixels) / kSubpixels - first);
        };
        out.x[end] = grid(x, tile.x0);
        out.y[end] = grid(y, tile.y0);
        out.near[end] = projection.nearness(static_cast<float>(q[2]));
    }
    return true;
}

uint32_t find_segment_lanes(const PlacedCluster& c, const TileReach& tile, ClusterVertices& vertices, Segment* out) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::Rebind<uint8_t, decltype(di)> d8;
    using VI = hn::Vec<decltype(di)>;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const Cluster& cluster = c.cluster();
    project_vertices(c, grid_centre(static_cast<int32_t>(tile.x0)), grid_centre(static_cast<int32_t>(tile.y0)),
                     vertices);

    const auto reach = static_cast<int32_t>(std::ceil(tile.reach * kSubpixels));
    const auto last = [&](uint32_t pixels) { return static_cast<int32_t>(pixels - 1) * kSubpixels + reach; };
    const VI least = hn::Set(di, -reach), most_x = hn::Set(di, last(tile.width)),
             most_y = hn::Set(di, last(tile.height));
    uint32_t count = 0;
    for (uint32_t k = 0; k < cluster.count; k += static_cast<uint32_t>(lanes)) {
        auto corner = [&](int m) { return hn::PromoteTo(di, hn::LoadU(d8, &c.set.corners[m][cluster.first + k])); };
        const VI c0 = corner(0), c1 = corner(1);
        auto misses = [&](const int32_t* values, VI most) {
            const VI a = hn::GatherIndex(di, values, c0), b = hn::GatherIndex(di, values, c1);
            return hn::Or(hn::Lt(hn::Max(a, b), least), hn::Gt(hn::Min(a, b), most));
        };
        auto wanted = hn::Not(hn::Or(misses(vertices.x, most_x), misses(vertices.y, most_y)));
        if (vertices.any_cut)
            wanted = hn::Or(wanted, hn::Ne(hn::Or(hn::GatherIndex(di, vertices.is_cut, c0),
                                                  hn::GatherIndex(di, vertices.is_cut, c1)),
                                           hn::Zero(di)));
        alignas(64) int32_t is_wanted[kMostLanes];
        hn::Store(hn::VecFromMask(di, wanted), di, is_wanted);
        const uint32_t here = std::min(cluster.count - k, static_cast<uint32_t>(lanes));
        for (uint32_t m = 0; m < here; ++m) {
            if (!is_wanted[m]) continue;
            Segment& segment = out[count];
            const uint32_t at = cluster.first + k + m;
            segment.number = static_cast<uint8_t>(k + m);
            const uint8_t ends[2] = {c.set.corners[0][at], c.set.corners[1][at]};
            std::copy_n(ends, 2, segment.ends);
            segment.is_cut = vertices.is_cut[ends[0]] || vertices.is_cut[ends[1]];
            if (segment.is_cut) {
                count += cut_segment(c, k + m, tile, segment);
                continue;
            }
            for (int end = 0; end < 2; ++end) {
                segment.x[end] = static_cast<float>(vertices.x[ends[end]]) / kSubpixels;
                segment.y[end] = static_cast<float>(vertices.y[ends[end]]) / kSubpixels;
                segment.near[end] = vertices.near[ends[end]];
            }
            ++count;
        }
    }
    return count;
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(find_segment_lanes);

uint32_t find_segments(const PlacedCluster& cluster, const TileReach& tile, ClusterVertices& vertices, Segment* out) {
    return HWY_DYNAMIC_DISPATCH(find_segment_lanes)(cluster, tile, vertices, out);
}

}  // namespace trp
#endif
