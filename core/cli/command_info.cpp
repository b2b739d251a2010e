// `triptych info`: what is in a glTF file, what was left out and why. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "gltf_scene.h"
#include "report.h"

namespace triptych::cli {
namespace {

using nlohmann::ordered_json;

struct Options {
    std::string scene;
    bool as_json = false;
    uint32_t threads = 0;
};

ordered_json bounds_of(const TrpSceneInfo& info) {
    if (info.bounds_min[0] > info.bounds_max[0]) return {};
    return {{"min", info.bounds_min}, {"max", info.bounds_max}};
}

ordered_json describe(const LoadedScene& loaded, const std::string& path) {
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    check(trp_scene_info(loaded.scene.get(), &info));
    ordered_json cameras = ordered_json::array();
    for (const CameraEntry& camera : loaded.cameras) cameras.push_back(camera.name);
    ordered_json film;
    if (loaded.film_width > 0 || loaded.film_height > 0) {
        film = {{"width", loaded.film_width}, {"height", loaded.film_height}};
    }
    ordered_json settings = ordered_json::object();
    for (const auto& [name, value] : loaded.settings) settings[name] = value;
    return {
        {"file", path},
        {"version", loaded.version},
        {"generator", loaded.generator},
        {"extensions_used", loaded.extensions_used},
        {"extensions_required", loaded.extensions_required},
        {"meshes", info.mesh_count},
        {"instances", info.instance_count},
        {"faces", info.face_count},
        {"triangles", info.triangle_count},
        {"vertices", info.vertex_count},
        {"materials", info.material_count},
        {"textures", info.texture_count},
        {"lights", info.light_count},
        {"cameras", cameras},
        {"camera", loaded.needs_camera ? ordered_json() : ordered_json(loaded.camera_name)},
        {"film", film},
        {"settings", settings},
        {"bounds", bounds_of(info)},
        {"memory", {{"mesh_bytes", info.mesh_bytes}, {"held_bytes", info.held_bytes}, {"bvh_bytes", info.bvh_bytes}}},
        {"seconds", {{"load", loaded.load_seconds}, {"commit", info.commit_seconds}, {"bvh", info.bvh_seconds}}},
        {"warnings", all_warnings(loaded)}};
}

std::string shown(const ordered_json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_null()) return "none";
    if (value.is_array()) {
        std::string text;
        for (const ordered_json& entry : value) text += (text.empty() ? "" : ", ") + shown(entry);
        return text.empty() ? "none" : text;
    }
    if (value.is_object()) {
        std::string text;
        for (const auto& [key, entry] : value.items())
            text += fmt::format("{}{} {}", text.empty() ? "" : "; ", key, shown(entry));
        return text.empty() ? "none" : text;
    }
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    return value.dump();
}

void print_text(const ordered_json& info) {
    for (const auto& [key, value] : info.items()) {
        if (key == "warnings") continue;
        fmt::print("{:<20} {}\n", key, one_line(shown(value)));
    }
    for (const ordered_json& warning : info["warnings"]) {
        fmt::print("{:<20} {}\n", "warning", warning.get<std::string>());
    }
}

int run(const Options& options) {
    const LoadedScene loaded = load_gltf(std::filesystem::u8path(options.scene), "", options.threads);
    const ordered_json info = describe(loaded, options.scene);
    if (options.as_json) {
        // Names in a file may hold bytes that are not UTF-8.
        fmt::print("{}\n", info.dump(2, ' ', false, ordered_json::error_handler_t::replace));
    } else {
        print_text(info);
    }
    return 0;
}

}  // namespace

Command add_info_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("info", "Say what is in a glTF file, what was left out and why");
    const auto options = std::make_shared<Options>();
    app->add_option("SCENE", options->scene, "A .glb or .gltf file")->required();
    app->add_flag("--json", options->as_json, "As JSON");
    app->add_option("--threads", options->threads, "Threads for the commit; 0: all");
    return {app, [options] { return run(*options); }};
}

}  // namespace triptych::cli
