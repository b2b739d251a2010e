// Making the list of lights. How each is sampled: light_samples.cpp.
#include "shading/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shading/snapshot.h"

namespace trp {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
    const float length = v.length();
    return length > 0 ? v / length : otherwise;
}

LightFrame frame_of(const Affine& m) {
    return {m.column(3), unit_or(m.column(0), {1, 0, 0}), unit_or(m.column(1), {0, 1, 0}),
            unit_or(m.column(2), {0, 0, 1})};
}

ReadyLight make_lamp(const Light& lamp) {
    ReadyLight light;
    const Affine& m = lamp.world_from_light[0];
    static_cast<LightFrame&>(light) = frame_of(m);
    if (lamp.world_from_light.size() > 1)
        std::transform(lamp.world_from_light.begin(), lamp.world_from_light.end(), std::back_inserter(light.motion),
                       frame_of);
    light.emission = lamp.emission;
    light.cast_shadow = lamp.cast_shadow;
    light.visible_camera = lamp.visible_camera && lamp.type == TRP_LIGHT_AREA;
    light.falloff = lamp.falloff;
    light.group = lamp.group;
    light.radius = lamp.radius;
    switch (lamp.type) {
        case TRP_LIGHT_POINT:
            light.kind = ReadyLight::Kind::point;
            break;
        case TRP_LIGHT_SPOT:
            light.kind = ReadyLight::Kind::spot;
            light.cos_half_angle = std::cos(lamp.angle / 2);
            light.blend_range = (1 - light.cos_half_angle) * lamp.blend;
            break;
        case TRP_LIGHT_SUN:
            light.kind = ReadyLight::Kind::sun;
            light.sin_half_angle = std::sin(lamp.angle / 2);
            break;
        default: {
            light.kind = ReadyLight::Kind::area;
            light.half_size[0] = lamp.size[0] / 2 * m.column(0).length();
            light.half_size[1] = lamp.size[1] / 2 * m.column(1).length();
            light.ellipse = lamp.shape == TRP_SHAPE_ELLIPSE;
            light.area = light.half_size[0] * light.half_size[1] * (light.ellipse ? kPi : 4);
            if (lamp.angle < kPi) {
                // Falls linearly in the tangent to 0 at half the spread, keeping the power: the integral of
                // cos x (1 − tan x / tan h) sin x over 0 … h is (tan h − h) / (2 tan h).
                const float half = std::max(lamp.angle / 2, 1e-3f);
                light.spread_tangent = std::tan(half);
                light.spread_scale = 1 / (light.spread_tangent - half);
            }
        }
    }
    return light;
}

// The emitting triangles of one placed surface; none where nothing emits.
ReadyLight make_surface_light(const Snapshot& snapshot, uint32_t slot) {
    ReadyLight light;
    light.kind = ReadyLight::Kind::surface;
    light.slot = slot;
    const PlacedSurface& surface = snapshot.surfaces[slot];
    std::vector<float> weights;
    for (uint32_t t = 0; t < surface.surface->triangle_count(); ++t) {
        const CompiledMaterial& material = snapshot.materials[surface.material(t)];
        if (!material.emits) continue;
        const uint32_t* v = surface.vertices + 3 * static_cast<size_t>(t);
        // The mean over the time samples; what is sampled has the area of its time.
        const size_t steps = std::max<size_t>(surface.position_steps, std::max<size_t>(surface.motion.size(), 1));
        float area = 0;
        for (size_t step = 0; step < steps; ++step) {
            const float time = steps > 1 ? static_cast<float>(step) / static_cast<float>(steps - 1) : 0;
            const Vec3 p = surface.world_position(v[0], time);
            const Vec3 plane = (surface.world_position(v[1], time) - p).cross(surface.world_position(v[2], time) - p);
            area += plane.length() / (2 * static_cast<float>(steps));
        }
        if (!(area > 0)) continue;
        light.triangles.push_back(t);
        light.areas.push_back(area);
        weights.push_back(area * luminance({material.constants[kEmission], material.constants[kEmission + 1],
                                            material.constants[kEmission + 2]}));
    }
    light.choice = Distribution(weights);
    return light;
}

// The world's picture at a size that keeps a sun's disk, filtered from the texture.
std::shared_ptr<const WorldMap> make_world_map(const OpenTexture* texture, const Vec3& factor) {
    auto map = std::make_shared<WorldMap>();
    map->width = 1024;
    map->height = 512;
    map->radiance.resize(3 * static_cast<size_t>(map->width) * map->height);
    const size_t n = map->width;
    std::vector<float> u(n), v(n), dudx(n, 1.0f / map->width), zero(n, 0.0f), dvdy(n, 1.0f / map->height), r(n), g(n),
        b(n), a(n);
    std::vector<float> row_weights, weights(n);
    for (uint32_t y = 0; y < map->height; ++y) {
        for (uint32_t x = 0; x < map->width; ++x) {
            u[x] = (static_cast<float>(x) + 0.5f) / map->width;
            v[x] = (static_cast<float>(y) + 0.5f) / map->height;
        }
        float* const rgba[4] = {r.data(), g.data(), b.data(), a.data()};
        sample_or_magenta(texture, n, {u.data(), v.data(), dudx.data(), zero.data(), zero.data(), dvdy.data()}, rgba);
        const float sine = std::cos((v[0] - 0.5f) * kPi);
        for (uint32_t x = 0; x < map->width; ++x) {
            const Vec3 c = Vec3(std::max(r[x], 0.0f), std::max(g[x], 0.0f), std::max(b[x], 0.0f)) * factor;
            for (int k = 0; k < 3; ++k) map->radiance[3 * (y * n + x) + k] = c[k];
            weights[x] = luminance(c) * sine;
        }
        map->columns.emplace_back(weights);
        row_weights.push_back(static_cast<float>(map->columns.back().total()));
    }
    map->rows = Distribution(row_weights);
    return map;
}

}  // namespace

Distribution::Distribution(const std::vector<float>& weights) {
    for (const float w : weights) total_ += w;
    if (!(total_ > 0)) return;
    cdf_.reserve(weights.size() + 1);
    cdf_.push_back(0);
    double sum = 0;
    for (const float w : weights) cdf_.push_back(static_cast<float>((sum += w) / total_));
    cdf_.back() = 1;
}

uint32_t Distribution::sample(float& u) const {
    const auto it = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, u);
    const auto entry = static_cast<uint32_t>(it - cdf_.begin() - 1);
    u = std::clamp((u - cdf_[entry]) / std::max(probability(entry), 1e-30f), 0.0f, 0x1.fffffep-1f);
    return entry;
}

LightList make_lights(const Snapshot& snapshot) {
    LightList list;
    for (const Light& lamp : snapshot.lamps)
        if (lamp.emission != Vec3(0, 0, 0)) list.push_back(make_lamp(lamp));
    // By instance, not by slot: slots remember the order of edits.
    std::vector<uint32_t> slots;
    for (uint32_t slot = 0; slot < snapshot.surfaces.size(); ++slot)
        if (snapshot.surfaces[slot].mesh) slots.push_back(slot);
    std::sort(slots.begin(), slots.end(),
              [&](uint32_t a, uint32_t b) { return snapshot.surfaces[a].instance < snapshot.surfaces[b].instance; });
    for (const uint32_t slot : slots) {
        const PlacedSurface& surface = snapshot.surfaces[slot];
        if (std::none_of(surface.slot_materials.begin(), surface.slot_materials.end(),
                         [&](uint32_t m) { return snapshot.materials[m].emits; }))
            continue;
        ReadyLight light = make_surface_light(snapshot, slot);
        if (!light.choice.empty()) list.push_back(std::move(light));
    }
    const World& world = snapshot.world;
    if (world.light && world.radiance != Vec3(0, 0, 0)) {
        ReadyLight light;
        light.kind = ReadyLight::Kind::world;
        light.emission = world.radiance;
        if (world.texture != TRP_NO_ID) {
            const auto it = snapshot.textures.find(world.texture);
            light.map = make_world_map(it == snapshot.textures.end() ? nullptr : it->second.get(), world.radiance);
            light.kind = ReadyLight::Kind::world_map;
            light.texture_from_world = world.texture_from_world();
            if (light.map->rows.empty()) return list;
        }
        list.push_back(std::move(light));
    }
    return list;
}

}  // namespace trp
