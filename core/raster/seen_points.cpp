#include "raster/seen_points.h"

#include <bit>

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

bool read_key_lanes(const DrawList& list, const uint32_t* keys, Points& points) {
    const hn::ScalableTag<uint32_t> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    constexpr int kShift = std::countr_zero(Cluster::kMostPrimitives);
    bool any_seen = false;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const V key = hn::Load(d, keys + i), number = hn::ShiftRight<kShift>(key);
        auto left = hn::Ne(key, hn::Set(d, kNothing));
        any_seen |= !hn::AllFalse(d, left);
        V slot = hn::Set(d, kNoSlot), triangle = hn::Zero(d);
        alignas(64) uint32_t numbers[HWY_MAX_BYTES / sizeof(uint32_t)];
        hn::Store(number, d, numbers);
        while (!hn::AllFalse(d, left)) {
            const uint32_t one = numbers[hn::FindFirstTrue(d, left)];
            const auto here = hn::And(left, hn::Eq(number, hn::Set(d, one)));
            const DrawnCluster& drawn = list.clusters[one];
            const ClusterSet& set = *list.sets[drawn.slot];
            const V place = hn::IfThenElseZero(here, hn::And(key, hn::Set(d, Cluster::kMostPrimitives - 1)));
            const V of = hn::GatherIndex(d, &set.primitives[set.clusters[drawn.cluster].first], hn::BitCast(di, place));
            triangle = hn::IfThenElse(here, of, triangle);
            slot = hn::IfThenElse(here, hn::Set(d, drawn.slot), slot);
            left = hn::AndNot(here, left);
        }
        hn::Store(slot, d, points.slot + i);
        hn::Store(triangle, d, points.triangle + i);
    }
    return any_seen;
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(make_direction_lanes);
HWY_EXPORT(read_key_lanes);

void make_directions(const View& view, const BlockSamples& samples, LaneVec3& origins, LaneVec3& directions) {
    HWY_DYNAMIC_DISPATCH(make_direction_lanes)(view, samples, origins, directions);
}

bool read_keys(const DrawList& list, const uint32_t* keys, Points& points) {
    return HWY_DYNAMIC_DISPATCH(read_key_lanes)(list, keys, points);
}

}  // namespace trp
#endif
