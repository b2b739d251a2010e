// What rays see that hit nothing.
#include <cmath>
#include <numbers>

#include "shading/snapshot.h"

namespace trp {

void sample_background(const Snapshot& snapshot, const LaneVec3& directions, const uint8_t* wanted,
                       LaneVec3& radiance) {
    constexpr float kPi = std::numbers::pi_v<float>;
    const World& world = snapshot.world;
    for (int i = 0; i < kBatch; ++i) radiance.set(i, world.radiance);
    if (world.texture == TRP_NO_ID || world.radiance == Vec3(0, 0, 0)) return;

    const auto it = snapshot.textures.find(world.texture);
    const OpenTexture* texture = it == snapshot.textures.end() ? nullptr : it->second.get();
    const Affine texture_from_world = world.texture_from_world();
    Lanes u, v, zero = {}, r, g, b, a;
    int lanes[kBatch], count = 0;
    for (int i = 0; i < kBatch; ++i) {
        if (!wanted[i]) continue;
        const Vec3 d = texture_from_world.vector(directions.get(i));
        u[count] = 0.5f - std::atan2(d.y, d.x) / (2 * kPi);
        v[count] = 0.5f + std::atan2(d.z, std::hypot(d.x, d.y)) / kPi;
        lanes[count++] = i;
    }
    float* const rgba[4] = {r, g, b, a};
    sample_or_magenta(texture, count, {u, v, zero, zero, zero, zero}, rgba);
    for (int j = 0; j < count; ++j) radiance.set(lanes[j], Vec3(r[j], g[j], b[j]) * world.radiance);
}

}  // namespace trp
