// Scenes: every call names its item, is checked and handed on.
#include "api/guard.h"
#include "api/handles.h"
#include "base/parallel.h"
#include "scene/describe.h"

using namespace trp;

namespace {

// Defaults, as the header states them.
TrpMeshDesc mesh_defaults() {
    TrpMeshDesc d{};
    d.time_count = 1;
    return d;
}
TrpInstanceDesc instance_defaults() {
    TrpInstanceDesc d{};
    d.time_count = 1;
    d.color[0] = d.color[1] = d.color[2] = 1;
    d.visible_camera = d.visible_shadow = 1;
    return d;
}
TrpTextureDesc texture_defaults() {
    return {};
}
TrpMaterialDesc material_defaults() {
    TrpMaterialDesc d{};
    auto constant = [](float v) { return TrpCoefficient{{v, v, v}, TRP_NO_NODE}; };
    d.emission = d.specular = d.mirror = d.transmission = constant(0);
    d.ambient = d.diffuse = constant(0.8f);
    d.shininess = constant(30);
    d.ior = constant(1.5f);
    d.alpha = constant(1);
    d.normal = TRP_NO_NODE;
    d.ambient_is_diffuse = d.mirror_is_specular = d.double_sided = 1;
    return d;
}
TrpLightDesc light_defaults() {
    TrpLightDesc d{};
    d.time_count = 1;
    d.emission[0] = d.emission[1] = d.emission[2] = 1;
    d.angle = -1;
    d.blend = 0.15f;
    d.size[0] = d.size[1] = 1;
    d.cast_shadow = 1;
    return d;
}
TrpWorldDesc world_defaults() {
    TrpWorldDesc d{};
    d.visible_camera = d.light = 1;
    return d;
}
TrpCameraDesc camera_defaults() {
    TrpCameraDesc d{};
    d.time_count = 1;
    d.field_of_view = 0.69f;
    d.width = 6;
    d.clip_start = 0.01f;
    d.clip_end = 1000;
    d.focus_distance = 10;
    d.shutter[1] = 1;
    d.pixel_aspect = 1;
    return d;
}

template <class Item, class Desc>
TrpStatus add(TrpScene* scene, Table<Item> Scene::*table, const Desc* desc, const Desc& defaults, uint32_t* id) {
    return guard([&] {
        check_pointer(scene, "scene");
        check_pointer(id, "id");
        (scene->data.*table).add(scene->data.next_id, describe(read_struct(desc, defaults, "desc"), TRP_NO_ID));
        *id = scene->data.next_id++;
        return TRP_OK;
    });
}

template <class Item, class Desc>
TrpStatus replace(TrpScene* scene, Table<Item> Scene::*table, uint32_t id, const Desc* desc, const Desc& defaults) {
    return guard([&] {
        check_pointer(scene, "scene");
        (scene->data.*table).require(id);
        (scene->data.*table).replace(id, describe(read_struct(desc, defaults, "desc"), id));
        return TRP_OK;
    });
}

template <class Item>
TrpStatus remove(TrpScene* scene, Table<Item> Scene::*table, uint32_t id) {
    return guard([&] {
        check_pointer(scene, "scene");
        (scene->data.*table).remove(id);
        return TRP_OK;
    });
}

}  // namespace

extern "C" {

TrpStatus trp_scene_create(TrpScene** scene) {
    return guard([&] {
        check_pointer(scene, "scene");
        *scene = new TrpScene;
        return TRP_OK;
    });
}

void trp_scene_destroy(TrpScene* scene) {
    delete scene;
}

TrpStatus trp_scene_commit(TrpScene* scene, uint32_t threads) {
    return guard([&] {
        check_pointer(scene, "scene");
        if (threads > 1024) fail(TRP_ERROR_ARGUMENT, "threads is {}; at most 1024", threads);
        Arena arena(threads);
        arena.run([&] { scene->snapshot = make_snapshot(scene->data, scene->snapshot); });
        return TRP_OK;
    });
}

TrpStatus trp_scene_info(const TrpScene* scene, TrpSceneInfo* info) {
    return guard([&] {
        check_pointer(scene, "scene");
        if (!scene->snapshot) fail(TRP_ERROR_STATE, "the scene was never committed");
        write_struct(info, scene->snapshot->info, "info");
        return TRP_OK;
    });
}

uint32_t trp_scene_warning_count(const TrpScene* scene) {
    return scene && scene->snapshot ? static_cast<uint32_t>(scene->snapshot->warnings.size()) : 0;
}

TrpStatus trp_scene_warning(const TrpScene* scene, uint32_t index, TrpWarning* warning) {
    return guard([&] {
        check_pointer(scene, "scene");
        if (index >= trp_scene_warning_count(scene))
            fail(TRP_ERROR_ARGUMENT, "there is no warning {}; there are {}", index, trp_scene_warning_count(scene));
        const Warning& w = scene->snapshot->warnings[index];
        write_struct(warning, {0, w.code, w.item, w.text.c_str()}, "warning");
        return TRP_OK;
    });
}

TrpStatus trp_mesh_desc_init(TrpMeshDesc* desc, size_t size) {
    return init_struct(desc, size, mesh_defaults());
}
TrpStatus trp_mesh_add(TrpScene* scene, const TrpMeshDesc* desc, uint32_t* id) {
    return add(scene, &Scene::meshes, desc, mesh_defaults(), id);
}
TrpStatus trp_mesh_replace(TrpScene* scene, uint32_t id, const TrpMeshDesc* desc) {
    return replace(scene, &Scene::meshes, id, desc, mesh_defaults());
}
TrpStatus trp_mesh_remove(TrpScene* scene, uint32_t id) {
    return remove(scene, &Scene::meshes, id);
}

TrpStatus trp_instance_desc_init(TrpInstanceDesc* desc, size_t size) {
    return init_struct(desc, size, instance_defaults());
}
TrpStatus trp_instance_add(TrpScene* scene, const TrpInstanceDesc* desc, uint32_t* id) {
    return add(scene, &Scene::instances, desc, instance_defaults(), id);
}
TrpStatus trp_instance_replace(TrpScene* scene, uint32_t id, const TrpInstanceDesc* desc) {
    return replace(scene, &Scene::instances, id, desc, instance_defaults());
}
TrpStatus trp_instance_move(TrpScene* scene, uint32_t id, const float* world_from_object, uint32_t time_count) {
    return guard([&] {
        check_pointer(scene, "scene");
        check_pointer(world_from_object, "world_from_object");
        Instance moved = scene->data.instances.get(id);
        moved.world_from_object =
            describe_transforms(world_from_object, time_count, item_name("instance", id, moved.name));
        scene->data.instances.replace(id, std::move(moved));
        return TRP_OK;
    });
}
TrpStatus trp_instance_remove(TrpScene* scene, uint32_t id) {
    return remove(scene, &Scene::instances, id);
}

TrpStatus trp_texture_desc_init(TrpTextureDesc* desc, size_t size) {
    return init_struct(desc, size, texture_defaults());
}
TrpStatus trp_texture_add(TrpScene* scene, const TrpTextureDesc* desc, uint32_t* id) {
    return add(scene, &Scene::textures, desc, texture_defaults(), id);
}
TrpStatus trp_texture_replace(TrpScene* scene, uint32_t id, const TrpTextureDesc* desc) {
    return replace(scene, &Scene::textures, id, desc, texture_defaults());
}
TrpStatus trp_texture_remove(TrpScene* scene, uint32_t id) {
    return remove(scene, &Scene::textures, id);
}

TrpStatus trp_node_init(TrpNode* node, int32_t type) {
    return guard([&] {
        check_pointer(node, "node");
        if (type < TRP_NODE_CONSTANT || type > TRP_NODE_GREATER)
            fail(TRP_ERROR_ARGUMENT, "there is no node type {}", type);
        *node = TrpNode{};
        node->type = type;
        std::fill_n(node->inputs, TRP_NODE_INPUTS, TRP_NO_NODE);
        if (type == TRP_NODE_NORMAL_MAP || type == TRP_NODE_UV_TRANSFORM) node->value[0] = 1;
        if (type == TRP_NODE_UV_TRANSFORM) node->value[1] = 1;
        return TRP_OK;
    });
}
TrpStatus trp_material_desc_init(TrpMaterialDesc* desc, size_t size) {
    return init_struct(desc, size, material_defaults());
}
TrpStatus trp_material_add(TrpScene* scene, const TrpMaterialDesc* desc, uint32_t* id) {
    return add(scene, &Scene::materials, desc, material_defaults(), id);
}
TrpStatus trp_material_replace(TrpScene* scene, uint32_t id, const TrpMaterialDesc* desc) {
    return replace(scene, &Scene::materials, id, desc, material_defaults());
}
TrpStatus trp_material_remove(TrpScene* scene, uint32_t id) {
    return remove(scene, &Scene::materials, id);
}

TrpStatus trp_light_desc_init(TrpLightDesc* desc, size_t size) {
    return init_struct(desc, size, light_defaults());
}
TrpStatus trp_light_add(TrpScene* scene, const TrpLightDesc* desc, uint32_t* id) {
    return add(scene, &Scene::lights, desc, light_defaults(), id);
}
TrpStatus trp_light_replace(TrpScene* scene, uint32_t id, const TrpLightDesc* desc) {
    return replace(scene, &Scene::lights, id, desc, light_defaults());
}
TrpStatus trp_light_remove(TrpScene* scene, uint32_t id) {
    return remove(scene, &Scene::lights, id);
}

TrpStatus trp_world_desc_init(TrpWorldDesc* desc, size_t size) {
    return init_struct(desc, size, world_defaults());
}
TrpStatus trp_scene_set_world(TrpScene* scene, const TrpWorldDesc* desc) {
    return guard([&] {
        check_pointer(scene, "scene");
        scene->data.world = describe(read_struct(desc, world_defaults(), "desc"));
        return TRP_OK;
    });
}

TrpStatus trp_camera_desc_init(TrpCameraDesc* desc, size_t size) {
    return init_struct(desc, size, camera_defaults());
}
TrpStatus trp_camera_add(TrpScene* scene, const TrpCameraDesc* desc, uint32_t* id) {
    return add(scene, &Scene::cameras, desc, camera_defaults(), id);
}
TrpStatus trp_camera_replace(TrpScene* scene, uint32_t id, const TrpCameraDesc* desc) {
    return replace(scene, &Scene::cameras, id, desc, camera_defaults());
}
TrpStatus trp_camera_remove(TrpScene* scene, uint32_t id) {
    return remove(scene, &Scene::cameras, id);
}
TrpStatus trp_scene_set_camera(TrpScene* scene, uint32_t id) {
    return guard([&] {
        check_pointer(scene, "scene");
        if (id != TRP_NO_ID) scene->data.cameras.require(id);
        scene->data.camera = id;
        return TRP_OK;
    });
}

}  // extern "C"
