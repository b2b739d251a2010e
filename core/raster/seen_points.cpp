#include "raster/seen_points.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/seen_points.cpp"
#include "hwy/foreach_target.h"

#include "film/pixel_random-inl.h"
#include "shading/equation-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

void make_direction_lanes(const View& view, const BlockSamples& samples, LaneVec3& origins, LaneVec3& directions) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        auto px = hn::Zero(du), py = hn::Zero(du);
        pixel_of(d, samples.x / kBlockSide, samples.y / kBlockSide, i, px, py);
        auto place = [&](auto pixel, const float* offset, float step, float begin) {
            const V at = hn::Add(hn::ConvertTo(d, hn::BitCast(di, pixel)), hn::Load(d, offset + i));
            return hn::MulAdd(at, hn::Set(d, step), hn::Set(d, begin));
        };
        const V x = place(px, samples.offset_x, view.step_x, view.left),
                y = place(py, samples.offset_y, view.step_y, view.bottom);
        const Vector3<V> eye = broadcast(d, view.position), axis = broadcast(d, -view.z);
        const Vector3<V> across = broadcast(d, view.x) * x + broadcast(d, view.y) * y;
        if (!view.perspective) store3(d, eye + across, origins, i);
        store3(d, view.perspective ? axis + across : axis, directions, i);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(make_direction_lanes);

void make_directions(const View& view, const BlockSamples& samples, LaneVec3& origins, LaneVec3& directions) {
    HWY_DYNAMIC_DISPATCH(make_direction_lanes)(view, samples, origins, directions);
}

void read_keys(const DrawList& list, const uint32_t* keys, Points& points) {
    uint32_t number = kNothing, slot = 0;
    const uint32_t* triangles = nullptr;
    for (int i = 0; i < kBatch; ++i) {
        points.slot[i] = kNoSlot;
        points.triangle[i] = 0;
        if (keys[i] == kNothing) continue;
        if (!triangles || keys[i] / Cluster::kMostPrimitives != number) {
            number = keys[i] / Cluster::kMostPrimitives;
            const DrawnCluster& drawn = list.clusters[number];
            const ClusterSet& set = *list.sets[drawn.slot];
            slot = drawn.slot;
            triangles = &set.primitives[set.clusters[drawn.cluster].first];
        }
        points.slot[i] = slot;
        points.triangle[i] = triangles[keys[i] % Cluster::kMostPrimitives];
    }
}

}  // namespace trp
#endif
