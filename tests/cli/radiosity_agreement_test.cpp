// All solvers of radiosity against path tracing of the scenes that come with the project, without what is not diffuse:
// means over 8 x 8 pixels. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>

#include "framing.h"
#include "gltf_builder.h"
#include "gltf_scene.h"

namespace triptych::test {
namespace {

using cli::check;

constexpr uint32_t kWidth = 160, kHeight = 96, kBlock = 8;

using Settings = std::vector<std::pair<const char*, std::string>>;

// The scene of a .glb file with its highlights and mirrors taken away. Such a file is a header of 12 bytes and two
// chunks, of JSON and of the buffer, each after its length and its kind.
cli::LoadedScene load_diffuse(const std::string& name) {
    const std::vector<unsigned char> bytes = read_bytes(std::filesystem::path(TRIPTYCH_SCENES) / name);
    constexpr ptrdiff_t kLengthAt = 12, kJsonAt = 20, kChunkHeader = 8;
    uint32_t length = 0;
    std::memcpy(&length, &bytes.at(kLengthAt), sizeof length);
    const auto begin = bytes.begin() + kJsonAt, end = begin + length;
    GltfBuilder file;
    file.root = json::parse(begin, end);
    file.binary.assign(end + kChunkHeader, bytes.end());
    for (json& material : file.root["materials"])
        for (const char* coefficient : {"specular", "mirror"}) material["extras"]["triptych"][coefficient] = {0, 0, 0};
    cli::LoadedScene loaded = cli::load_gltf(file.write(test_folder("radiosity_agreement_" + name), name), {}, 0);
    cli::complete_scene(loaded, kWidth, kHeight, 0);
    return loaded;
}

cli::RenderHandle start(const cli::LoadedScene& loaded, const char* method, const Settings& settings) {
    cli::RenderHandle render = cli::make_render(loaded.scene.get(), method);
    check(trp_render_set_film(render.get(), kWidth, kHeight, 0, 0, 0, 0));
    for (const auto& [name, value] : {std::pair{"film.filter", "box"}, {"film.filter_width", "1"}})
        check(trp_render_set(render.get(), name, value));
    for (const auto& [name, value] : settings) check(trp_render_set(render.get(), name, value.c_str()));
    return render;
}

std::vector<float> read(const cli::RenderHandle& render, const char* pass, size_t channels) {
    std::vector<float> out(channels * kWidth * kHeight);
    check(trp_render_read(render.get(), pass, 0, 0, kWidth, kHeight, out.data(), out.size()));
    return out;
}

// Radiance over blocks, by colour.
using Blocks = std::vector<double>;

double mean_of(const Blocks& blocks) {
    double sum = 0;
    for (const double value : blocks) sum += value;
    return sum / static_cast<double>(blocks.size());
}
// The root mean square of what they differ by, over the mean of the second.
double difference(const Blocks& a, const Blocks& b) {
    double squares = 0;
    for (size_t k = 0; k < a.size(); ++k) squares += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(squares / static_cast<double>(a.size())) / mean_of(b);
}

// Path tracing of a scene, and the pictures of its solutions in the same blocks. What glows counts for nothing, nor the
// pixels around it.
class Comparison {
  public:
    Comparison(const char* scene, const char* samples) : loaded_(load_diffuse(scene)) {
        const cli::RenderHandle render = start(loaded_, "path_tracing", {{"samples", samples}});
        check(trp_render_add_pass(render.get(), "Emission"));
        check(trp_render_run(render.get(), nullptr));
        const std::vector<float> emission = read(render, "Emission", 3);
        counts_.assign(size_t{kWidth} * kHeight, true);
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x)
                for (uint32_t i = std::max(y, 1u) - 1; i < std::min(y + 2, kHeight); ++i)
                    for (uint32_t j = std::max(x, 1u) - 1; j < std::min(x + 2, kWidth); ++j)
                        if (emission[3 * (size_t{i} * kWidth + j)] > 0) counts_[size_t{y} * kWidth + x] = false;
        truth_ = blocks_of(read(render, "Combined", 4));
    }

    // `stated`: the error that the hierarchical solver says, as radiance, over the mean of the blocks.
    struct Solved {
        Blocks blocks;
        double stated = 0;
    };
    Solved solve(const Settings& settings) const {
        TrpRadiosity* made = nullptr;
        check(trp_radiosity_create(loaded_.scene.get(), &made));
        const cli::RadiosityHandle radiosity(made);
        for (const auto& [name, value] : settings) check(trp_radiosity_set(made, name, value.c_str()));
        check(trp_radiosity_solve(made, nullptr));
        TrpRadiosityInfo info{};
        info.struct_size = sizeof info;
        check(trp_radiosity_info(made, &info));
        const cli::RenderHandle render = start(loaded_, "radiosity", {{"raster.samples", "32"}});
        check(trp_render_set_radiosity(render.get(), made));
        check(trp_render_run(render.get(), nullptr));
        return {blocks_of(read(render, "Combined", 4)), info.residual / std::numbers::pi / mean_of(truth_)};
    }
    double error_of(const Blocks& blocks) const { return difference(blocks, truth_); }
    double brightness_of(const Blocks& blocks) const { return mean_of(blocks) / mean_of(truth_); }

  private:
    Blocks blocks_of(const std::vector<float>& combined) const {
        Blocks out;
        for (uint32_t y = 0; y < kHeight; y += kBlock)
            for (uint32_t x = 0; x < kWidth; x += kBlock)
                for (size_t c = 0; c < 3; ++c) {
                    double sum = 0, count = 0;
                    for (uint32_t k = 0; k < kBlock * kBlock; ++k) {
                        const size_t i = size_t{y + k / kBlock} * kWidth + x + k % kBlock;
                        if (counts_[i]) sum += static_cast<double>(combined[4 * i + c]), ++count;
                    }
                    out.push_back(count > 0 ? sum / count : 0);
                }
        return out;
    }

    cli::LoadedScene loaded_;
    std::vector<bool> counts_;  // by pixel
    Blocks truth_;
};

Settings uniform(const char* solver, const char* form_factors, const char* size) {
    return {{"radiosity.solver", solver}, {"radiosity.form_factors", form_factors}, {"radiosity.element_size", size}};
}

// Elements of 8 and 4 cm in a box of 55 cm: radiosity changes a lot over them, so that errors are large, but all
// solvers have the same and it falls by more than half.
TEST(RadiosityAgreement, OfTheCornellBox) {
    const Comparison box("cornell_box.glb", "512");
    const auto hierarchical = box.solve({});
    EXPECT_LT(box.error_of(hierarchical.blocks), hierarchical.stated);
    EXPECT_NEAR(box.brightness_of(hierarchical.blocks), 1, 0.01);

    const Blocks coarse = box.solve(uniform("matrix", "analytic", "0.08")).blocks,
                 fine = box.solve(uniform("matrix", "analytic", "0.04")).blocks;
    EXPECT_LT(box.error_of(coarse), 0.16);
    EXPECT_LT(box.error_of(fine), 0.4 * box.error_of(coarse));
    EXPECT_NEAR(box.brightness_of(fine), 1, 0.005);
    // Rays into the hemisphere and pixels of hemicubes miss a part of the small lamp, the less the more there are.
    for (const char* solver : {"matrix", "progressive"})
        for (const auto& [form_factors, rays, allowed] : {std::tuple{"analytic", "1024", 0.01},
                                                          {"hemisphere", "1024", 0.06},
                                                          {"hemisphere", "16384", 0.015},
                                                          {"hemicube", "1024", 0.05}}) {
            Settings settings = uniform(solver, form_factors, "0.08");
            settings.emplace_back("radiosity.rays", rays);
            EXPECT_LT(difference(box.solve(settings).blocks, coarse), allowed)
                << solver << " by " << form_factors << ", " << rays << " rays";
        }
}

// A room with textures, columns, statues and a sky: from 11 to 16 thousand elements.
TEST(RadiosityAgreement, OfTheGallery) {
    const Comparison gallery("gallery_coarse.glb", "96");
    const Blocks coarse = gallery.solve(uniform("progressive", "hemisphere", "2")).blocks,
                 fine = gallery.solve(uniform("progressive", "hemisphere", "0.6")).blocks,
                 matrix = gallery.solve(uniform("matrix", "hemisphere", "2")).blocks;
    EXPECT_LT(gallery.error_of(coarse), 0.17);
    EXPECT_LT(gallery.error_of(fine), 0.6 * gallery.error_of(coarse));
    EXPECT_NEAR(gallery.brightness_of(fine), 1, 0.03);
    EXPECT_LT(difference(matrix, coarse), 0.03);
    // It ends at its limit of links, and says so.
    const auto hierarchical = gallery.solve({});
    EXPECT_LT(gallery.error_of(hierarchical.blocks), hierarchical.stated);
}

}  // namespace
}  // namespace triptych::test
