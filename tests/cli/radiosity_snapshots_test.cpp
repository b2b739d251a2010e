// Progressive refinement of the Cornell box on its way to the solution: the errors of its pictures are in the order
// that Cohen, Chen, Wallace and Greenberg show ("A Progressive Refinement Approach to Fast Radiosity Image Generation",
// 1988). SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "framing.h"
#include "gltf_scene.h"
#include "support/radiosity.h"

namespace triptych::test {
namespace {

using cli::check;
using trp_test::Solution;

constexpr uint32_t kSide = 96;

// Radiance, and that of the lamp alone.
struct Picture {
    std::vector<float> combined, emission;
};
Picture picture_of(const cli::LoadedScene& loaded, TrpRadiosity* solution, const char* ambient) {
    const auto render = cli::make_render(loaded.scene.get(), "radiosity");
    check(trp_render_set_film(render.get(), kSide, kSide, 0, 0, 0, 0));
    check(trp_render_set(render.get(), "radiosity.ambient", ambient));
    check(trp_render_add_pass(render.get(), "Emission"));
    check(trp_render_set_radiosity(render.get(), solution));
    check(trp_render_run(render.get(), nullptr));
    Picture out{std::vector<float>(size_t{4} * kSide * kSide), std::vector<float>(size_t{3} * kSide * kSide)};
    check(trp_render_read(render.get(), "Combined", 0, 0, kSide, kSide, out.combined.data(), out.combined.size()));
    check(trp_render_read(render.get(), "Emission", 0, 0, kSide, kSide, out.emission.data(), out.emission.size()));
    return out;
}

// Of all that is no lamp: the RMS of the difference over that of the known.
double error_of(const Picture& picture, const Picture& known) {
    double squares = 0, all = 0;
    for (size_t i = 0; i < picture.combined.size(); ++i) {
        if (known.emission[3 * (i / 4)] > 0) continue;
        squares += std::pow(picture.combined[i] - known.combined[i], 2);
        all += std::pow(known.combined[i], 2);
    }
    return std::sqrt(squares / all);
}

TEST(RadiositySnapshots, HaveTheOrderOfErrorsOfTheirKinds) {
    cli::LoadedScene loaded = cli::load_gltf(std::filesystem::path(TRIPTYCH_SCENES) / "cornell_box.glb", {}, 0);
    cli::complete_scene(loaded, kSide, kSide, 0);
    const auto settings = [](const char* order) {
        return Solution::Settings{{"radiosity.solver", "progressive"},
                                  {"radiosity.form_factors", "hemisphere"},
                                  {"radiosity.element_size", "0.06"},
                                  {"radiosity.order", order}};
    };
    Solution solved(loaded.scene.get(), settings("sorted"));
    solved.solve();
    const Picture known = picture_of(loaded, solved, "off");
    Solution sorted(loaded.scene.get(), settings("sorted")), unsorted(loaded.scene.get(), settings("unsorted")),
        gathering(loaded.scene.get(), settings("gathering"));
    uint32_t done = 0;
    double before = 1;
    for (const uint32_t steps : {1u, 2u, 24u, 100u}) {
        for (Solution* solution : {&sorted, &unsorted, &gathering}) solution->step(steps - done);
        done = steps;
        const double ambient = error_of(picture_of(loaded, sorted, "on"), known),
                     plain = error_of(picture_of(loaded, sorted, "off"), known);
        EXPECT_LT(ambient, plain) << steps;
        EXPECT_LT(plain, error_of(picture_of(loaded, unsorted, "off"), known)) << steps;
        EXPECT_LT(plain, error_of(picture_of(loaded, gathering, "off"), known)) << steps;
        EXPECT_LT(plain, before) << steps;
        before = plain;
    }
}

}  // namespace
}  // namespace triptych::test
