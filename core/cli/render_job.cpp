// What `triptych render` is asked to do. SPDX-License-Identifier: Apache-2.0
#include "render_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "report.h"
#include "tables.h"

namespace triptych::cli {
namespace {

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::u8path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

bool parse_number(const std::string& text, uint32_t& out) {
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, out);
    return result.ec == std::errc() && result.ptr == end && !text.empty();
}

Tile parse_tile(const std::string& text) {
    uint32_t numbers[4] = {};
    size_t count = 0, begin = 0;
    bool good = true;
    while (good && count < 4 && begin <= text.size()) {
        const size_t comma = std::min(text.find(',', begin), text.size());
        good = parse_number(text.substr(begin, comma - begin), numbers[count++]);
        begin = comma + 1;
    }
    if (!good || count != 4 || begin != text.size() + 1 || numbers[2] == 0 || numbers[3] == 0) {
        throw UsageError(fmt::format("--tile: '{}' is not X,Y,W,H with W and H above 0", text));
    }
    return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

// The core checks names and values itself: an empty scene is enough to ask it.
void check_settings(const RenderJob& job) {
    const SceneHandle scene = make_scene();
    check(trp_scene_commit(scene.get(), 1));
    const RenderHandle render = make_render(scene.get(), job.method);
    for (const auto& [name, value] : job.settings) {
        if (trp_render_set(render.get(), name.c_str(), value.c_str()) != TRP_OK) {
            throw UsageError(fmt::format("--set {}={}: {}", name, value, trp_error_message()));
        }
    }
    for (const std::string& pass : job.passes) {
        if (trp_render_add_pass(render.get(), pass.c_str()) != TRP_OK) {
            throw UsageError(fmt::format("--pass {}: {}", pass, trp_error_message()));
        }
    }
}

}  // namespace

uint32_t RenderJob::thread_count() const {
    uint32_t count = 0;
    for (const auto& [name, value] : settings) {
        if (name == "threads" && !parse_number(value, count)) count = 0;
    }
    return count;
}

void check_job(RenderJob& job) {
    const std::vector<TrpMethodInfo> methods = all_methods();
    if (std::none_of(methods.begin(), methods.end(), [&](const TrpMethodInfo& m) { return job.method == m.name; })) {
        throw UsageError(fmt::format("--method: there is no method '{}'; there are {}", job.method, method_names()));
    }
    const std::string extension = extension_of(job.output);
    if (extension != ".exr" && extension != ".png") {
        throw UsageError(fmt::format("--output: '{}' does not end in .exr or .png", job.output));
    }
    if (!job.tile_text.empty()) {
        job.tile = parse_tile(job.tile_text);
        if (extension != ".exr") throw UsageError("--tile: only an .exr can hold a part of a picture");
    }
    for (const std::string& text : job.set) {
        const size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0) {
            throw UsageError(fmt::format("--set: '{}' is not NAME=VALUE", text));
        }
        job.settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    const std::pair<const char*, const std::string&> shortcuts[] = {
        {"samples", job.samples}, {"seed", job.seed}, {"threads", job.threads}};
    for (const auto& [name, value] : shortcuts) {
        if (!value.empty()) job.settings.emplace_back(name, value);
    }
    check_settings(job);
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

void set_film(TrpRender* render, const RenderJob& job, uint32_t width, uint32_t height) {
    const Tile& tile = job.tile;
    // The core counts rows from the bottom, and takes 0 x 0 for the whole picture.
    const uint32_t bottom = tile.given() ? height - tile.y - tile.height : 0;
    check(trp_render_set_film(render, width, height, tile.x, bottom, tile.width, tile.height), "film");
}

}  // namespace triptych::cli
