// What `triptych render` is asked to do. SPDX-License-Identifier: Apache-2.0
#include "render_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "report.h"

namespace triptych::cli {
namespace {

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::u8path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

Tile parse_tile(const std::string& text) {
    uint32_t numbers[4] = {};
    if (!parse_numbers(text, numbers, 4) || numbers[2] == 0 || numbers[3] == 0) {
        throw UsageError(fmt::format("--tile: '{}' is not X,Y,W,H with W and H above 0", text));
    }
    return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

void check_passes(const std::vector<std::string>& passes, const std::string& method) {
    const SceneHandle scene = make_scene();
    check(trp_scene_commit(scene.get(), 1));
    const RenderHandle render = make_render(scene.get(), method);
    for (const std::string& pass : passes) {
        if (trp_render_add_pass(render.get(), pass.c_str()) != TRP_OK) {
            throw UsageError(fmt::format("--pass {}: {}", pass, trp_error_message()));
        }
    }
}

}  // namespace

void check_job(RenderJob& job) {
    const std::string extension = extension_of(job.output);
    if (extension != ".exr" && extension != ".png") {
        throw UsageError(fmt::format("--output: '{}' does not end in .exr or .png", job.output));
    }
    if (!job.tile_text.empty()) {
        job.tile = parse_tile(job.tile_text);
        if (extension != ".exr") throw UsageError("--tile: only an .exr can hold a part of a picture");
    }
    if (!job.samples.empty()) job.set.push_back("samples=" + job.samples);
    if (!job.seed.empty()) job.set.push_back("seed=" + job.seed);
    check_picture(job);
    check_passes(job.passes, job.method);
    check_writable(job.output);
    if (!job.stats.empty()) check_writable(job.stats);
}

void check_tile(const RenderJob& job, uint32_t width, uint32_t height) {
    const Tile& tile = job.tile;
    if (tile.given() &&
        (tile.x >= width || tile.y >= height || tile.width > width - tile.x || tile.height > height - tile.y)) {
        throw UsageError(fmt::format("--tile: {} lies outside the picture of {} x {}", job.tile_text, width, height));
    }
}

void set_tile(TrpRender* render, const RenderJob& job, uint32_t width, uint32_t height) {
    const Tile& tile = job.tile;
    // The core counts rows from the bottom.
    check(trp_render_set_film(render, width, height, tile.x, height - tile.y - tile.height, tile.width, tile.height),
          "film");
}

}  // namespace triptych::cli
