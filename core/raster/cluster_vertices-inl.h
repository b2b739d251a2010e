// A cluster's vertices on the film's grid. Included once for each instruction set.
#if defined(TRIPTYCH_CLUSTER_VERTICES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIPTYCH_CLUSTER_VERTICES_INL
#undef TRIPTYCH_CLUSTER_VERTICES_INL
#else
#define TRIPTYCH_CLUSTER_VERTICES_INL
#endif

#include <algorithm>

#include "hwy/highway.h"
#include "raster/placed_cluster.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMostLanes = HWY_MAX_BYTES / sizeof(float);

// By their place in the cluster: film positions in 1/256 pixel from an origin, nearness, and −1 where a vertex is
// behind the eye or farther outside of the film than the grid reaches; its place means nothing then.
struct ClusterVertices {
    static constexpr size_t kRoom = Cluster::kMostVertices + kMostLanes;
    alignas(64) int32_t x[kRoom], y[kRoom], is_cut[kRoom];
    alignas(64) float near[kRoom];
    bool any_cut = false;
};

HWY_INLINE void project_vertices(const PlacedCluster& c, int32_t origin_x, int32_t origin_y, ClusterVertices& out) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    using VI = hn::Vec<decltype(di)>;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const Cluster& cluster = c.cluster();
    const V zero = hn::Zero(d), guard = hn::Set(d, -kGuardBand);
    const V right = hn::Set(d, static_cast<float>(c.projection.width()) + kGuardBand),
            top = hn::Set(d, static_cast<float>(c.projection.height()) + kGuardBand);
    for (uint32_t k = 0; k < cluster.vertex_count; k += static_cast<uint32_t>(lanes)) {
        alignas(64) int32_t index[kMostLanes] = {};
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

#endif
