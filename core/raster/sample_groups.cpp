#include "raster/sample_groups.h"

#include <bit>

#include "raster/visibility_tile.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/sample_groups.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#ifndef TRIPTYCH_SAMPLE_GROUPS_ONCE
#define TRIPTYCH_SAMPLE_GROUPS_ONCE
namespace trp {
// Smooth neighbours are one surface up to this: the cosine of 20°, of normals times 127.
constexpr int32_t kAlike = 15200;
}  // namespace trp
#endif

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DU = hn::ScalableTag<uint32_t>;
using DI = hn::RebindToSigned<DU>;
using VU = hn::Vec<DU>;
using VI = hn::Vec<DI>;
using Mask = hn::Mask<DU>;

// What tells surfaces apart: slots, and normals as ClusterSet has them. Slots are kNoSlot where a lane sees nothing,
// and where its surface has faces of several materials.
struct Looks {
    VU slot;
    VI normal;
};

// Of the lanes in `left`; the others have no slot.
Looks look_up(const DrawList& list, VU key, Mask left) {
    const DU d;
    const DI di;
    constexpr int kShift = std::countr_zero(Cluster::kMostPrimitives);
    const VU number = hn::ShiftRight<kShift>(key), place = hn::And(key, hn::Set(d, Cluster::kMostPrimitives - 1));
    Looks looks{hn::Set(d, kNoSlot), hn::Zero(di)};
    alignas(64) uint32_t numbers[HWY_MAX_BYTES / sizeof(uint32_t)];
    hn::Store(number, d, numbers);
    left = hn::And(left, hn::Ne(key, hn::Set(d, kNothing)));
    while (!hn::AllFalse(d, left)) {
        const uint32_t one = numbers[hn::FindFirstTrue(d, left)];
        const Mask here = hn::And(left, hn::Eq(number, hn::Set(d, one)));
        left = hn::AndNot(here, left);
        const DrawnCluster& drawn = list.clusters[one];
        if (list.surfaces[drawn.slot]->face_materials) continue;
        const ClusterSet& set = *list.sets[drawn.slot];
        const int32_t* normals = reinterpret_cast<const int32_t*>(&set.normals[set.clusters[drawn.cluster].first]);
        const VI of = hn::GatherIndex(di, normals, hn::BitCast(di, hn::IfThenElseZero(here, place)));
        looks.normal = hn::IfThenElse(hn::RebindMask(di, here), of, looks.normal);
        looks.slot = hn::IfThenElse(here, hn::Set(d, drawn.slot), looks.slot);
    }
    return looks;
}

VI dot_bytes(VI a, VI b) {
    const auto byte = [](VI v, auto up) { return hn::ShiftRight<24>(hn::ShiftLeft<decltype(up)::value>(v)); };
    const std::integral_constant<int, 24> x;
    const std::integral_constant<int, 16> y;
    const std::integral_constant<int, 8> z;
    return hn::Add(hn::Add(hn::Mul(byte(a, x), byte(b, x)), hn::Mul(byte(a, y), byte(b, y))),
                   hn::Mul(byte(a, z), byte(b, z)));
}

bool take_lanes(const SampleGroups& groups, const BlockKeys& block, uint32_t* left, SampleGroup& out) {
    const DU d;
    const DI di;
    const hn::RebindToFloat<DU> df;
    bool any_left = false;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const auto keys_of = [&](uint32_t s) { return hn::LoadU(d, block.keys + s * block.stride + i); };
        VU rest = hn::Load(d, left + i);
        VU key = hn::Set(d, kNothing), first = hn::Zero(d);
        for (uint32_t s = block.samples; s-- > 0;) {
            const Mask has = hn::Ne(hn::And(rest, hn::Set(d, 1u << s)), hn::Zero(d));
            key = hn::IfThenElse(has, keys_of(s), key);
            first = hn::IfThenElse(has, hn::Set(d, s), first);
        }
        hn::Store(key, d, out.key + i);
        hn::Store(first, d, out.first + i);

        Looks looks{};
        bool has_looks = groups.by_face();
        VU count = hn::Zero(d);
        for (uint32_t s = 0; s < block.samples; ++s) {
            const VU bit = hn::Set(d, 1u << s), other = keys_of(s);
            const Mask has = hn::Ne(hn::And(rest, bit), hn::Zero(d));
            Mask alike = hn::And(has, hn::Eq(other, key));
            Mask unlike = hn::AndNot(alike, has);
            if (!groups.by_face() && !hn::AllFalse(d, unlike)) {
                if (!has_looks) looks = look_up(groups.list(), key, hn::Ne(rest, hn::Zero(d)));
                has_looks = true;
                const Looks others = look_up(groups.list(), other, unlike);
                const Mask same_slot =
                    hn::And(hn::Eq(others.slot, looks.slot), hn::Ne(looks.slot, hn::Set(d, kNoSlot)));
                const Mask near =
                    hn::RebindMask(d, hn::Gt(dot_bytes(looks.normal, others.normal), hn::Set(di, kAlike)));
                alike = hn::Or(alike, hn::And(unlike, hn::And(same_slot, near)));
                unlike = hn::AndNot(alike, unlike);
            }
            // What is left are borders, and polygons, whose triangles may lie across each other.
            if (!hn::AllFalse(d, unlike)) {
                alignas(64) uint32_t is_alike[HWY_MAX_BYTES / sizeof(uint32_t)];
                hn::Store(hn::IfThenElseZero(unlike, hn::Set(d, 1)), d, is_alike);
                const uint32_t* const others = block.keys + s * block.stride + i;
                for (size_t k = 0; k < hn::Lanes(d); ++k)
                    is_alike[k] = is_alike[k] && groups.is_one_surface(out.key[i + static_cast<int>(k)], others[k]);
                alike = hn::Or(alike, hn::Ne(hn::Load(d, is_alike), hn::Zero(d)));
            }
            rest = hn::Sub(rest, hn::IfThenElseZero(alike, bit));
            count = hn::Add(count, hn::IfThenElseZero(alike, hn::Set(d, 1)));
        }
        hn::Store(rest, d, left + i);
        hn::Store(hn::ConvertTo(df, hn::BitCast(di, count)), df, out.count + i);
        any_left |= !hn::AllTrue(d, hn::Eq(rest, hn::Zero(d)));
    }
    return any_left;
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(take_lanes);

bool SampleGroups::take(const BlockKeys& block, uint32_t* left, SampleGroup& out) const {
    return HWY_DYNAMIC_DISPATCH(take_lanes)(*this, block, left, out);
}

bool SampleGroups::is_one_surface(uint32_t key, uint32_t other) const {
    if (key == kNothing || other == kNothing) return false;
    const DrawnCluster &a = list_.clusters[key / Cluster::kMostPrimitives],
                       &b = list_.clusters[other / Cluster::kMostPrimitives];
    if (a.slot != b.slot) return false;
    const PlacedSurface& surface = *list_.surfaces[a.slot];
    const ClusterSet& set = *list_.sets[a.slot];
    const uint32_t at_a = set.clusters[a.cluster].first + key % Cluster::kMostPrimitives,
                   at_b = set.clusters[b.cluster].first + other % Cluster::kMostPrimitives;
    const uint32_t face_a = surface.face(set.primitives[at_a]), face_b = surface.face(set.primitives[at_b]);
    if (face_a == face_b) return true;
    if (by_face_ || surface.face_material(face_a) != surface.face_material(face_b)) return false;
    const auto &n = set.normals[at_a], &m = set.normals[at_b];
    return n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > kAlike;
}

}  // namespace trp
#endif
