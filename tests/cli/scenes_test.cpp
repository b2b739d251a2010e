// The committed scenes by the rasterizer and by rays: the same surfaces through the centres of pixels, and the same
// radiance. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "framing.h"
#include "gltf_scene.h"

namespace triptych::test {
namespace {

using cli::check;

constexpr uint32_t kWidth = 640, kHeight = 360;

struct Picture {
    std::vector<float> combined, depth;
};

// One sample through the centre of each pixel, without shadows.
Picture picture_of(const cli::LoadedScene& loaded, const char* method) {
    const auto render = cli::make_render(loaded.scene.get(), method);
    check(trp_render_set_film(render.get(), kWidth, kHeight, 0, 0, 0, 0));
    for (const auto& [name, value] :
         {std::pair{"samples", "1"}, {"raster.samples", "1"}, {"film.filter_width", "0"}, {"shadows", "off"}})
        check(trp_render_set(render.get(), name, value));
    check(trp_render_add_pass(render.get(), "Depth"));
    check(trp_render_run(render.get(), nullptr));
    Picture out{std::vector<float>(size_t{4} * kWidth * kHeight), std::vector<float>(size_t{kWidth} * kHeight)};
    check(trp_render_read(render.get(), "Combined", 0, 0, kWidth, kHeight, out.combined.data(), out.combined.size()));
    check(trp_render_read(render.get(), "Depth", 0, 0, kWidth, kHeight, out.depth.data(), out.depth.size()));
    return out;
}

class Scenes : public testing::TestWithParam<const char*> {};

TEST_P(Scenes, RasterSeesWhatRaysSee) {
    cli::LoadedScene loaded = cli::load_gltf(std::filesystem::path(TRIPTYCH_SCENES) / GetParam(), {}, 0);
    cli::complete_scene(loaded, kWidth, kHeight, 0);
    const Picture rays = picture_of(loaded, "ray_casting"), raster = picture_of(loaded, "phong");
    const auto same_depth = [](float a, float b) { return std::abs(a - b) <= 5e-4f * std::max(a, b); };
    uint32_t another_surface = 0, unexplained = 0, another_colour = 0;
    for (uint32_t y = 1; y + 1 < kHeight; ++y)
        for (uint32_t x = 1; x + 1 < kWidth; ++x) {
            const size_t i = size_t{y} * kWidth + x;
            if (!same_depth(rays.depth[i], raster.depth[i])) {
                ++another_surface;
                // An edge within a step of the grid: then what the rasterizer shows is what rays see next to it.
                bool near = false;
                for (const ptrdiff_t step : {-1, 1, -static_cast<int>(kWidth), static_cast<int>(kWidth)}) {
                    const float beside = rays.depth[static_cast<size_t>(static_cast<ptrdiff_t>(i) + step)];
                    near |= std::abs(beside - raster.depth[i]) <= 0.05f * raster.depth[i];
                }
                unexplained += !near;
                continue;
            }
            for (size_t c = 0; c < 3; ++c) {
                const float a = rays.combined[4 * i + c], b = raster.combined[4 * i + c];
                if (std::abs(a - b) <= 1e-3f * std::max(1.0f, std::abs(a))) continue;
                ++another_colour;  // a highlight or a fine texture at the edge of a triangle
                break;
            }
        }
    const double pixels = kWidth * kHeight;
    EXPECT_LT(another_surface / pixels, 2e-4);
    EXPECT_LE(unexplained, 3u);
    EXPECT_LT(another_colour / pixels, 1e-3);
    RecordProperty("another_surface", static_cast<int>(another_surface));
    RecordProperty("another_colour", static_cast<int>(another_colour));
}

INSTANTIATE_TEST_SUITE_P(Committed, Scenes,
                         testing::Values("cornell_box.glb", "cornell_mitsuba.glb", "whitted_spheres.glb",
                                         "still_life.glb", "gallery_coarse.glb"));

}  // namespace
}  // namespace triptych::test
