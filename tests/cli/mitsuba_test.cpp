// Path tracing of Mitsuba's Cornell box against what Mitsuba 3.9.1 makes of it: its `path` integrator at max_depth 16,
// 16384 samples, 256 × 256 pixels, box filter; means over 64 × 64 pixels, rows from above. Noise of the figures: 2e-5
// relative. SPDX-License-Identifier: Apache-2.0
#include "support/mitsuba.h"

#include <filesystem>

#include "framing.h"
#include "gltf_scene.h"

namespace triptych::test {
namespace {

using cli::check;

constexpr uint32_t kSide = 256;
constexpr trp_test::BlockMeans kMitsuba = {{
    {0.118088, 0.0191189, 0.00746111},
    {1.0248, 0.707361, 0.335532},
    {0.988379, 0.707693, 0.332958},
    {0.0512935, 0.0410883, 0.00776315},
    {0.198083, 0.0194391, 0.00859446},
    {0.301234, 0.132086, 0.0562161},
    {0.297364, 0.160201, 0.0642262},
    {0.0550297, 0.0825448, 0.011288},
    {0.125933, 0.0108802, 0.0047567},
    {0.12482, 0.0448407, 0.0179058},
    {0.192397, 0.104906, 0.0413031},
    {0.0442615, 0.0646081, 0.00888876},
    {0.121151, 0.0331668, 0.0145668},
    {0.180327, 0.0752599, 0.0328029},
    {0.0317981, 0.0121815, 0.00468755},
    {0.0536794, 0.0476701, 0.0111867},
}};

std::vector<float> picture(const cli::LoadedScene& loaded, const char* seed) {
    const auto render = cli::make_render(loaded.scene.get(), "path_tracing");
    check(trp_render_set_film(render.get(), kSide, kSide, 0, 0, 0, 0));
    // Mitsuba's depth counts the rays of a path, with those to the eye and to the light.
    for (const auto& [name, value] : {std::pair{"samples", "32"},
                                      {"film.filter", "box"},
                                      {"film.filter_width", "1"},
                                      {"trace.depth", "14"},
                                      {"shading.specular", "none"},
                                      {"seed", seed}})
        check(trp_render_set(render.get(), name, value));
    check(trp_render_run(render.get(), nullptr));
    std::vector<float> values(size_t{4} * kSide * kSide);
    check(trp_render_read(render.get(), "Combined", 0, 0, kSide, kSide, values.data(), values.size()));
    return values;
}

TEST(Mitsuba, SeesTheSameCornellBox) {
    cli::LoadedScene loaded = cli::load_gltf(std::filesystem::path(TRIPTYCH_SCENES) / "cornell_mitsuba.glb", {}, 0);
    cli::complete_scene(loaded, kSide, kSide, 0);
    trp_test::expect_block_means(picture(loaded, "1"), picture(loaded, "2"), kSide, kSide, kMitsuba, 2e-5);
}

}  // namespace
}  // namespace triptych::test
