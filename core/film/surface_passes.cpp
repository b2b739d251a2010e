#include "film/surface_passes.h"

namespace trp {
namespace {

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
    // Without branches, for the compiler to make vectors of. Weights: the part of the pixel that ends here.
    Lanes alpha, weights;
    for (int i = 0; i < kBatch; ++i) alpha[i] = points.slot[i] == kNoSlot ? 0 : seen.coefficients.alpha[i];
    if (seen.throughput || points.any_transmission) {
        std::fill_n(weights, kBatch, 0.0f);
        for (int i = 0; i < kBatch; ++i) {
            if (alpha[i] == 0) continue;
            const Vec3 share = (seen.throughput ? seen.throughput->get(i) : Vec3(1, 1, 1)) * alpha[i];
            for (int c = 0; c < 3; ++c) rgba[c][i] += share[c] * seen.radiance[c][i];
            const Vec3 ends =
                points.any_transmission ? share * (Vec3(1, 1, 1) - seen.coefficients.transmission.get(i)) : share;
            weights[i] = (ends.x + ends.y + ends.z) / 3;
        }
    } else {
        std::copy_n(alpha, kBatch, weights);
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < kBatch; ++i) rgba[c][i] += weights[i] * seen.radiance[c][i];
    }
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

Vec3 throughput_behind(const Points& points, const Coefficients& coefficients, int lane, const Vec3& throughput) {
    constexpr float kLeast = 1e-3f;
    const float alpha = coefficients.alpha[lane];
    Vec3 left = throughput * (1 - alpha);
    if (points.any_transmission) left += throughput * coefficients.transmission.get(lane) * alpha;
    return std::max({left.x, left.y, left.z}) < kLeast ? Vec3(0, 0, 0) : left;
}

void add_background(const Snapshot& snapshot, const LaneVec3& directions, const uint8_t* missed,
                    const LaneVec3* throughput, bool transparent, const BlockSums& sums) {
    const bool shows = snapshot.world.visible_camera && snapshot.world.radiance != Vec3(0, 0, 0);
    static thread_local LaneVec3 radiance;
    if (shows && !transparent) sample_background(snapshot, directions, missed, radiance);
    const std::array<float*, 4> rgba = sums.combined();
    for (int c = 0; c < 3; ++c) {
        Lanes weights;
        for (int i = 0; i < kBatch; ++i) weights[i] = !missed[i] ? 0 : throughput ? (*throughput)[c][i] : 1;
        if (float* shadow = sums.channel(kShadow, c))
            for (int i = 0; i < kBatch; ++i) shadow[i] += weights[i];
        if (transparent) continue;
        if (shows)
            for (int i = 0; i < kBatch; ++i) rgba[c][i] += weights[i] * radiance[c][i];
        if (throughput)
            for (int i = 0; i < kBatch; ++i) rgba[3][i] += weights[i] / 3;
    }
    if (transparent || throughput) return;
    for (int i = 0; i < kBatch; ++i) rgba[3][i] += missed[i] ? 1.0f : 0.0f;
}

void finish_depth(const uint8_t* first, const BlockSums& sums) {
    if (float* depth = sums.channel(kDepth, 0))
        for (int i = 0; i < kBatch; ++i)
            if (!first[i]) depth[i] = kNothingSeen;
}

}  // namespace trp
