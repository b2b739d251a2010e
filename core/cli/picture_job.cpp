// What commands that show a scene by a method have in common. SPDX-License-Identifier: Apache-2.0
#include "picture_job.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "framing.h"
#include "report.h"
#include "tables.h"

namespace triptych::cli {
namespace {

constexpr uint32_t default_width = 960;
constexpr uint32_t default_height = 540;

bool parse_number(const std::string& text, uint32_t& out) {
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, out);
    return result.ec == std::errc() && result.ptr == end && !text.empty();
}

}  // namespace

bool parse_numbers(const std::string& text, uint32_t* out, size_t count) {
    size_t begin = 0;
    for (size_t k = 0; k < count; ++k) {
        const size_t comma = std::min(text.find(',', begin), text.size());
        if (begin > text.size() || !parse_number(text.substr(begin, comma - begin), out[k])) return false;
        begin = comma + 1;
    }
    return begin == text.size() + 1;
}

std::string setting_of(const PictureJob& job, const LoadedPicture& picture, const std::string& name) {
    std::string out;
    for (const TrpSettingInfo& setting : all_settings())
        if (name == setting.name) out = setting.default_value;
    for (const auto* settings : {&picture.loaded.settings, &job.settings})
        for (const auto& [given, value] : *settings)
            if (given == name) out = value;
    return out;
}

uint32_t PictureJob::thread_count() const {
    uint32_t count = 0;
    for (const auto& [name, value] : settings) {
        if (name == "threads" && !parse_number(value, count)) count = 0;
    }
    return count;
}

void add_scene_options(CLI::App& app, PictureJob& job) {
    app.add_option("SCENE", job.scene, "A .glb or .gltf file")->required();
    app.add_option("--threads", job.threads, "Threads; 0: one to a core");
    app.add_option("--set", job.set, "NAME=VALUE: a setting of `triptych settings`")
        ->take_all()
        ->allow_extra_args(false);
    app.add_flag("--quiet", job.quiet, "No warnings, and no progress, which is for terminals");
}

void add_picture_options(CLI::App& app, PictureJob& job) {
    add_scene_options(app, job);
    app.add_option("--camera", job.camera, "Name of the camera; without it the scene's own, or its first");
    app.add_option("--width", job.width, "Pixels; without it as the scene says, or 960")->check(CLI::Range(1u, 65536u));
    app.add_option("--height", job.height, "Pixels; without it as the scene says, or 540")
        ->check(CLI::Range(1u, 65536u));
}

CLI::Option* add_pixel_option(CLI::App& app, PictureJob& job) {
    return app.add_option_function<std::string>(
        "--pixel",
        [&job](const std::string& text) {
            if (!parse_numbers(text, job.pixel, 2)) {
                throw UsageError(fmt::format("--pixel: '{}' is not X,Y", text));
            }
            job.has_pixel = true;
        },
        "X,Y of the pixel, from the top left");
}

void check_pixel(const PictureJob& job, const LoadedPicture& picture) {
    if (job.pixel[0] >= picture.width || job.pixel[1] >= picture.height) {
        throw UsageError(fmt::format("--pixel: {},{} lies outside the picture of {} x {}", job.pixel[0], job.pixel[1],
                                     picture.width, picture.height));
    }
}

void check_picture(PictureJob& job) {
    const std::vector<TrpMethodInfo> methods = all_methods();
    if (std::none_of(methods.begin(), methods.end(), [&](const TrpMethodInfo& m) { return job.method == m.name; })) {
        throw UsageError(fmt::format("--method: there is no method '{}'; there are {}", job.method, method_names()));
    }
    for (const std::string& text : job.set) {
        const size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0) {
            throw UsageError(fmt::format("--set: '{}' is not NAME=VALUE", text));
        }
        job.settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    if (!job.threads.empty()) job.settings.emplace_back("threads", job.threads);
    // The core checks names and values itself: an empty scene is enough to ask it.
    const SceneHandle scene = make_scene();
    check(trp_scene_commit(scene.get(), 1));
    const RenderHandle render = make_render(scene.get(), job.method);
    for (const auto& [name, value] : job.settings) {
        if (trp_render_set(render.get(), name.c_str(), value.c_str()) != TRP_OK) {
            throw UsageError(fmt::format("--set {}={}: {}", name, value, trp_error_message()));
        }
    }
}

LoadedPicture load_picture(const PictureJob& job) {
    LoadedPicture picture{load_gltf(std::filesystem::u8path(job.scene), job.camera, job.thread_count()), 0, 0};
    const auto choose = [](uint32_t wanted, uint32_t of_file, uint32_t usual) {
        return wanted > 0 ? wanted : of_file > 0 ? of_file : usual;
    };
    picture.width = choose(job.width, picture.loaded.film_width, default_width);
    picture.height = choose(job.height, picture.loaded.film_height, default_height);
    return picture;
}

RenderHandle make_picture(const PictureJob& job, LoadedPicture& picture) {
    LoadedScene& loaded = picture.loaded;
    complete_scene(loaded, picture.width, picture.height, job.thread_count());
    if (!job.quiet) print_warnings(all_warnings(loaded));
    RenderHandle render = make_render(loaded.scene.get(), job.method);
    check(trp_render_set_film(render.get(), picture.width, picture.height, 0, 0, 0, 0), "film");
    for (const auto& [name, value] : loaded.settings) {
        check(trp_render_set(render.get(), name.c_str(), value.c_str()),
              fmt::format("{}: extras.triptych.settings.{}", job.scene, one_line(name)));
    }
    for (const auto& [name, value] : job.settings) check(trp_render_set(render.get(), name.c_str(), value.c_str()));
    return render;
}

}  // namespace triptych::cli
