#include "raster/cluster_vertices.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/cluster_vertices.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void project_vertex_lanes(const PlacedCluster& c, int32_t origin_x, int32_t origin_y, ClusterVertices& out) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    using VI = hn::Vec<decltype(di)>;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const Cluster& cluster = c.cluster();
    out.any_cut = false;
    const V zero = hn::Zero(d), guard = hn::Set(d, -kGuardBand);
    const V right = hn::Set(d, static_cast<float>(c.projection.width()) + kGuardBand),
            top = hn::Set(d, static_cast<float>(c.projection.height()) + kGuardBand);
    for (uint32_t k = 0; k < cluster.vertex_count; k += static_cast<uint32_t>(lanes)) {
        alignas(64) int32_t index[HWY_MAX_BYTES / sizeof(int32_t)] = {};
        const uint32_t here = std::min(cluster.vertex_count - k, static_cast<uint32_t>(lanes));
        std::copy_n(&c.set.vertices[cluster.first_vertex + k], here, index);
        const VI at = hn::Mul(hn::Load(di, index), hn::Set(di, 3));
        const float* positions = &c.positions[0].x;
        const V px = hn::GatherIndex(d, positions, at), py = hn::GatherIndex(d, positions + 1, at),
                pz = hn::GatherIndex(d, positions + 2, at);
        auto row = [&](int r) {
            const float* m = c.transform.rows[r];
            return hn::MulAdd(hn::Set(d, m[0]), px,
                              hn::MulAdd(hn::Set(d, m[1]), py, hn::MulAdd(hn::Set(d, m[2]), pz, hn::Set(d, m[3]))));
        };
        const V depth = row(2);
        V film_x = row(0), film_y = row(1), nearness = hn::Neg(depth);
        if (c.projection.perspective()) {
            nearness = hn::Div(hn::Set(d, 1.0f), depth);
            film_x = hn::Mul(film_x, nearness), film_y = hn::Mul(film_y, nearness);
        }
        const auto whole = hn::And(hn::And(hn::Ge(depth, hn::Set(d, c.projection.clip_start())),
                                           hn::And(hn::Gt(film_x, guard), hn::Gt(film_y, guard))),
                                   hn::And(hn::Lt(film_x, right), hn::Lt(film_y, top)));
        out.any_cut |= !hn::AllTrue(d, whole);
        auto grid = [&](V film, int32_t origin) {
            const V scaled = hn::IfThenElse(whole, hn::Mul(film, hn::Set(d, float{kSubpixels})), zero);
            return hn::Sub(hn::NearestInt(scaled), hn::Set(di, origin));
        };
        hn::Store(grid(film_x, origin_x), di, out.x + k);
        hn::Store(grid(film_y, origin_y), di, out.y + k);
        hn::Store(nearness, d, out.near + k);
        hn::Store(hn::IfThenElseZero(hn::RebindMask(di, hn::Not(whole)), hn::Set(di, -1)), di, out.is_cut + k);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(project_vertex_lanes);

void project_vertices(const PlacedCluster& cluster, int32_t origin_x, int32_t origin_y, ClusterVertices& out) {
    HWY_DYNAMIC_DISPATCH(project_vertex_lanes)(cluster, origin_x, origin_y, out);
}

}  // namespace trp
#endif
