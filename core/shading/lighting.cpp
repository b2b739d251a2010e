#include "shading/lighting.h"

#include <algorithm>

#include "base/clock.h"

namespace trp {

void add_lights(const Snapshot& snapshot, const Illumination& illumination, Coherence coherence,
                const RandomPairs& random, const Points& points, const Coefficients& coefficients,
                const LightSums& sums, LightScratch& scratch, ProgramScratch& program, ShadowCounts& counts) {
    const bool any_mirror = illumination.mirrors && points.any_mirror;
    for (int i = 0; i < kBatch && any_mirror; ++i)
        scratch.weight.set(i,
                           coefficients.mirror.get(i) == Vec3(0, 0, 0) ? coefficients.specular.get(i) : Vec3(0, 0, 0));
    for (size_t l = 0; l < snapshot.lights.size(); ++l) {
        const ReadyLight& light = snapshot.lights[l];
        const bool is_world = light.kind == ReadyLight::Kind::world || light.kind == ReadyLight::Kind::world_map;
        const bool shadows = illumination.shadows && light.cast_shadow;
        scratch.samples.packets =
            reached_packets(light, illumination.falloff, illumination.least_light, shadows, points);
        if (scratch.samples.packets == 0) continue;
        if (light.is_sampled()) random(kFirstLightPair + static_cast<uint32_t>(l), scratch.u, scratch.v);
        sample_light(snapshot, light, illumination.falloff, points, scratch.u, scratch.v, scratch.samples, program);
        if (shadows) {
            const auto before = Clock::now();
            counts.rays +=
                trace_shadows(snapshot, points, scratch.samples, is_world ? Coherence::incoherent : coherence,
                              illumination.transparent_shadows, scratch.visibility, scratch.shadow, program);
            counts.nanoseconds += nanoseconds(before, Clock::now());
        } else {
            for (int c = 0; c < 3; ++c) std::fill_n(scratch.visibility[c], kBatch, 1.0f);
        }
        // The highlight stands for lights that have a place; the world shows in mirrors.
        add_light(is_world ? Specular::none : illumination.specular, points, coefficients,
                  any_mirror && light.is_hit_by_rays() ? scratch.weight : coefficients.specular, scratch.samples,
                  scratch.visibility, sums, light.group);
    }
}

}  // namespace trp
