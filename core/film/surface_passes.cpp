#include "film/surface_passes.h"

namespace trp {
namespace {

constexpr float kNothingSeen = 1e10f;  // depth, as Blender has it

void add_first(const SeenSurfaces& seen, int i, const BlockSums& sums) {
    const Points& points = seen.points;
    const PlacedSurface& surface = seen.snapshot.surfaces[points.slot[i]];
    if (float* depth = sums.channel(kDepth, 0)) depth[i] = points.depth[i];
    sums.add(kPosition, i, points.position.get(i) + Vec3(seen.snapshot.origin));
    if (sums.channel(kUv, 0)) {
        const Vec2 uv = first_uv(surface, points, i);
        sums.add(kUv, i, {uv.x, uv.y, 1});
    }
    if (float* index = sums.channel(kObjectIndex, 0)) index[i] = static_cast<float>(surface.index);
    if (float* index = sums.channel(kMaterialIndex, 0))
        index[i] = static_cast<float>(seen.snapshot.materials[points.material[i]].index);
}

}  // namespace

void add_surfaces(const SeenSurfaces& seen, uint8_t* first, const BlockSums& sums) {
    const Points& points = seen.points;
    const std::array<float*, 4> rgba = sums.combined();
    // Without branches, for the compiler to make vectors of.
    Lanes weights;
    for (int i = 0; i < kBatch; ++i)
        weights[i] = points.slot[i] == kNoSlot ? 0 : seen.throughput[i] * seen.coefficients.alpha[i];
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kBatch; ++i) rgba[c][i] += weights[i] * seen.radiance[c][i];
    for (int i = 0; i < kBatch; ++i) rgba[3][i] += weights[i];
    if (sums.passes().order().size() == 1) return;

    for (int i = 0; i < kBatch; ++i) {
        if (!(weights[i] > 0)) continue;
        sums.add(kNormal, i, points.normal.get(i) * weights[i]);
        sums.add(kAlbedo, i, seen.coefficients.diffuse.get(i) * weights[i]);
        sums.add(kEmit, i, seen.coefficients.emission.get(i) * weights[i]);
        Vec3 share(1, 1, 1);
        for (int c = 0; c < 3 && seen.arriving; ++c)
            if (seen.arriving->unblocked[c][i] > 0)
                share[c] = seen.arriving->blocked[c][i] / seen.arriving->unblocked[c][i];
        sums.add(kShadow, i, share * weights[i]);
        if (!first || first[i]) continue;
        first[i] = 1;
        add_first(seen, i, sums);
    }
}

void add_background(const Snapshot& snapshot, const LaneVec3& directions, const uint8_t* missed,
                    const float* throughput, bool transparent, const BlockSums& sums) {
    Lanes weights;
    for (int i = 0; i < kBatch; ++i) weights[i] = missed[i] ? throughput[i] : 0;
    for (int c = 0; c < 3; ++c)
        if (float* shadow = sums.channel(kShadow, c))
            for (int i = 0; i < kBatch; ++i) shadow[i] += weights[i];
    if (transparent) return;
    const std::array<float*, 4> rgba = sums.combined();
    for (int i = 0; i < kBatch; ++i) rgba[3][i] += weights[i];
    if (snapshot.world.radiance == Vec3(0, 0, 0) || !snapshot.world.visible_camera) return;
    static thread_local LaneVec3 radiance;
    sample_background(snapshot, directions, missed, radiance);
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kBatch; ++i) rgba[c][i] += weights[i] * radiance[c][i];
}

void finish_depth(const uint8_t* first, const BlockSums& sums) {
    if (float* depth = sums.channel(kDepth, 0))
        for (int i = 0; i < kBatch; ++i)
            if (!first[i]) depth[i] = kNothingSeen;
}

}  // namespace trp
