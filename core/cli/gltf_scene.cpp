// A glTF file as a scene of the core. SPDX-License-Identifier: Apache-2.0
#include "gltf_scene.h"

#include <fmt/format.h>

#include <chrono>

#include "gltf_fields.h"
#include "gltf_material.h"
#include "gltf_world.h"

namespace triptych::cli {
namespace {

constexpr int extras_version = 1;

// The scene to show: the file's default, or its first; -1 where it has none.
int scene_index(const tinygltf::Model& model) {
    if (model.defaultScene >= 0) return model.defaultScene;
    return model.scenes.empty() ? -1 : 0;
}

void check_extras_version(const tinygltf::Model& model, Warnings& warnings) {
    int32_t version = extras_version;
    triptych_extras(model.asset.extras, "asset").read("version", version);
    if (version > extras_version) {
        warnings.add(
            fmt::format("asset.extras.triptych.version: {} is newer than this program's {}; some of it may be lost",
                        version, extras_version));
    }
}

const CameraEntry* find_camera(const std::vector<CameraEntry>& cameras, const std::string& name) {
    for (const CameraEntry& camera : cameras) {
        if (camera.name == name) return &camera;
    }
    for (const CameraEntry& camera : cameras) {
        if (camera.camera_name == name) return &camera;
    }
    std::string names;
    for (const CameraEntry& camera : cameras) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", camera.name);
    throw Error(
        fmt::format("there is no camera '{}'; the file has {}", one_line(name), names.empty() ? "none" : names));
}

const CameraEntry* choose_camera(const std::vector<CameraEntry>& cameras, const std::string& wanted, int extras_node) {
    if (!wanted.empty()) return find_camera(cameras, wanted);
    for (const CameraEntry& camera : cameras) {
        if (camera.node == extras_node) return &camera;
    }
    return cameras.empty() ? nullptr : &cameras.front();
}

LoadedScene load(const std::filesystem::path& path, const std::string& wanted_camera) {
    LoadedScene loaded;
    const GltfFile file = open_gltf(path, loaded.warnings);
    const tinygltf::Model& model = file.model;
    loaded.generator = model.asset.generator;
    loaded.version = model.asset.version;
    loaded.extensions_used = model.extensionsUsed;
    loaded.extensions_required = model.extensionsRequired;
    check_extras_version(model, loaded.warnings);

    loaded.scene = make_scene();
    TrpScene* scene = loaded.scene.get();
    MaterialLoader materials(file, scene, loaded.warnings);
    MeshLoader meshes(file, scene, materials, loaded.warnings);
    const int index = scene_index(model);
    SceneExtras extras = read_scene_extras(file, index, materials.textures(), scene, loaded.warnings);
    NodeCounts counts = add_nodes(file, index, scene, meshes, materials, loaded.warnings);

    loaded.cameras = std::move(counts.cameras);
    loaded.settings = std::move(extras.settings);
    loaded.film_width = extras.film_width;
    loaded.film_height = extras.film_height;
    if (const CameraEntry* camera = choose_camera(loaded.cameras, wanted_camera, extras.camera_node)) {
        loaded.camera_name = camera->name;
        loaded.world_from_camera = camera->world_from_camera;
        check(trp_scene_set_camera(scene, camera->id));
    } else {
        loaded.needs_camera = true;
        loaded.warnings.add("the file has no camera: the whole scene is framed");
    }
    if (counts.lights == 0 && !materials.any_light() && !extras.has_world) {
        loaded.needs_light = true;
        loaded.warnings.add("the file has no light: a headlight is used");
    }
    return loaded;
}

}  // namespace

void commit(LoadedScene& loaded, uint32_t threads) {
    check(trp_scene_commit(loaded.scene.get(), threads));
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    check(trp_scene_info(loaded.scene.get(), &info));
    loaded.commit_seconds += info.commit_seconds;
    loaded.bvh_seconds += info.bvh_seconds;
}

LoadedScene load_gltf(const std::filesystem::path& path, const std::string& camera, uint32_t threads) {
    const auto start = std::chrono::steady_clock::now();
    try {
        LoadedScene loaded = load(path, camera);
        loaded.load_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        commit(loaded, threads);
        return loaded;
    } catch (const std::bad_alloc&) {
        throw Error(fmt::format("{}: there is not enough memory for it", path.string()));
    } catch (const std::exception& error) {
        throw Error(fmt::format("{}: {}", path.string(), one_line(error.what())));
    }
}

}  // namespace triptych::cli
