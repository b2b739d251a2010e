// A radiosity solution baked into a scene of its own, and looked at again. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "framing.h"
#include "gltf_scene.h"

namespace triptych::test {
namespace {

using cli::check;

constexpr uint32_t kSide = 128;

std::vector<float> picture_of(cli::LoadedScene& loaded, const char* method, TrpRadiosity* radiosity) {
    cli::complete_scene(loaded, kSide, kSide, 0);
    const auto render = cli::make_render(loaded.scene.get(), method);
    check(trp_render_set_film(render.get(), kSide, kSide, 0, 0, 0, 0));
    check(trp_render_set(render.get(), "raster.samples", "1"));
    if (radiosity != nullptr) check(trp_render_set_radiosity(render.get(), radiosity));
    check(trp_render_run(render.get(), nullptr));
    std::vector<float> out(size_t{4} * kSide * kSide);
    check(trp_render_read(render.get(), "Combined", 0, 0, kSide, kSide, out.data(), out.size()));
    return out;
}

TEST(Bake, LooksLikeTheSolution) {
    const std::filesystem::path scene = std::filesystem::path(TRIPTYCH_SCENES) / "cornell_box.glb",
                                baked = std::filesystem::temp_directory_path() /
                                        ("triptych_baked_" + std::to_string(getpid()) + ".glb");
    const char* const settings[][2] = {{"radiosity.solver", "hierarchical"}, {"radiosity.tolerance", "0.5"}};
    std::string command =
        std::string(TRIPTYCH_COMMAND) + " radiosity '" + scene.string() + "' --quiet --bake '" + baked.string() + "'";
    for (const auto& [name, value] : settings) command += std::string(" --set ") + name + "=" + value;
    ASSERT_EQ(std::system(command.c_str()), 0);

    cli::LoadedScene loaded = cli::load_gltf(scene, {}, 0), again = cli::load_gltf(baked, {}, 0);
    std::filesystem::remove(baked);
    for (const std::string& line : again.warnings.lines()) EXPECT_NE(line.find("light"), std::string::npos) << line;
    EXPECT_EQ(again.camera_name, loaded.camera_name);
    EXPECT_EQ(again.film_width, loaded.film_width);
    TrpRadiosity* made = nullptr;
    check(trp_radiosity_create(loaded.scene.get(), &made));
    const cli::RadiosityHandle radiosity(made);
    for (const auto& [name, value] : settings) check(trp_radiosity_set(made, name, value));
    check(trp_radiosity_solve(made, nullptr));

    const std::vector<float> known = picture_of(loaded, "radiosity", made),
                             found = picture_of(again, "visible_surface", nullptr);
    double error = 0, sum = 0;
    uint32_t cracks = 0;
    for (size_t k = 0; k < known.size(); k += 4) {
        cracks += known[k + 3] > 0.5f && found[k + 3] < 0.5f;
        for (size_t c = 0; c < 3; ++c) {
            error += static_cast<double>(std::abs(known[k + c] - found[k + c]));
            sum += static_cast<double>(known[k + c]);
        }
    }
    EXPECT_EQ(cracks, 0u);
    EXPECT_GT(sum, 0);
    // Between corners the one is bilinear in quads and the other linear in triangles about the middle; and at the edges
    // of bodies a pixel may see another side.
    EXPECT_LT(error / sum, 0.02);
}

}  // namespace
}  // namespace triptych::test
