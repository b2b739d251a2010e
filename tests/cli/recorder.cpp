// The stand-in for the core: the scene half of triptych.h. SPDX-License-Identifier: Apache-2.0
#include "recorder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "recorder_arrays.h"

struct TrpScene {
    triptych::test::Recording recording;
};

namespace triptych::test {

const Recording& recording_of(const TrpScene* scene) {
    return scene->recording;
}

}  // namespace triptych::test

using namespace triptych::test;

namespace {

thread_local std::string last_error;

TrpStatus fail(std::string message) {
    last_error = std::move(message);
    return TRP_ERROR_ARGUMENT;
}

std::string text_of(const char* text) {
    return text != nullptr ? text : "";
}

std::array<float, 12> rows_of(const float* rows) {
    std::array<float, 12> copy = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    if (rows != nullptr) std::copy_n(rows, 12, copy.begin());
    return copy;
}

bool finite(const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

std::vector<RecordedAttribute> attributes_of(const TrpAttribute* list, uint32_t count) {
    std::vector<RecordedAttribute> copies;
    for (uint32_t i = 0; i < count; ++i) {
        copies.push_back(
            {text_of(list[i].name), list[i].domain, list[i].components, floats_of(list[i].values, list[i].components)});
    }
    return copies;
}

template <typename Desc>
TrpStatus clear(Desc* desc, size_t size) {
    std::memset(static_cast<void*>(desc), 0, size);
    desc->struct_size = static_cast<uint32_t>(size);
    return TRP_OK;
}

TrpStatus add_mesh(TrpScene* scene, const TrpMeshDesc& desc, uint32_t* id) {
    RecordedMesh mesh;
    mesh.name = text_of(desc.name);
    mesh.positions = floats_of(desc.positions, 3);
    mesh.positions_source = desc.positions.data;
    mesh.normals = floats_of(desc.normals, 3);
    mesh.normal_domain = desc.normal_domain;
    mesh.face_offsets = integers_of(desc.face_offsets, 1);
    mesh.corners = integers_of(desc.corner_vertices, 1);
    mesh.corner_format = desc.corner_vertices.format;
    mesh.face_materials = integers_of(desc.face_materials, 1);
    mesh.face_smooth = integers_of(desc.face_smooth, 1);
    mesh.edges = integers_of(desc.edges, 2);
    mesh.edge_flags = integers_of(desc.edge_flags, 1);
    mesh.edge_creases = floats_of(desc.edge_creases, 1);
    mesh.vertex_creases = floats_of(desc.vertex_creases, 1);
    mesh.uv_sets = attributes_of(desc.uv_sets, desc.uv_set_count);
    mesh.colors = attributes_of(desc.colors, desc.color_count);
    mesh.materials.assign(desc.materials, desc.materials + desc.material_count);
    if (!finite(mesh.positions)) return fail("mesh '" + mesh.name + "': positions are not finite");
    const uint64_t vertices = mesh.positions.size() / 3;
    for (const auto* indices : {&mesh.corners, &mesh.edges}) {
        for (const uint32_t index : *indices) {
            if (index >= vertices) return fail("mesh '" + mesh.name + "': index " + std::to_string(index));
        }
    }
    if (mesh.face_offsets.empty() && mesh.corners.size() % 3 != 0) return fail("corners are not triangles");
    scene->recording.meshes.push_back(std::move(mesh));
    *id = static_cast<uint32_t>(scene->recording.meshes.size());
    return TRP_OK;
}

const char* const node_names[] = {"constant",     "uv",      "color", "object_color", "image",    "normal_map",
                                  "uv_transform", "channel", "add",   "subtract",     "multiply", "divide",
                                  "power",        "mix",     "clamp", "greater"};

}  // namespace

extern "C" {

uint32_t trp_version(void) {
    return TRP_VERSION;
}
const char* trp_error_message(void) {
    return last_error.c_str();
}

TrpStatus trp_scene_create(TrpScene** scene) {
    *scene = new TrpScene;
    return TRP_OK;
}
void trp_scene_destroy(TrpScene* scene) {
    delete scene;
}
TrpStatus trp_scene_commit(TrpScene* scene, uint32_t) {
    ++scene->recording.commits;
    return TRP_OK;
}

TrpStatus trp_scene_info(const TrpScene* scene, TrpSceneInfo* info) {
    const Recording& recording = scene->recording;
    info->mesh_count = static_cast<uint32_t>(recording.meshes.size());
    info->instance_count = static_cast<uint32_t>(recording.instances.size());
    info->material_count = static_cast<uint32_t>(recording.materials.size());
    info->texture_count = static_cast<uint32_t>(recording.textures.size());
    info->light_count = static_cast<uint32_t>(recording.lights.size());
    info->camera_count = static_cast<uint32_t>(recording.cameras.size());
    std::fill_n(info->bounds_min, 3, std::numeric_limits<float>::max());
    std::fill_n(info->bounds_max, 3, std::numeric_limits<float>::lowest());
    for (const RecordedInstance& instance : recording.instances) {
        const RecordedMesh& mesh = recording.meshes[instance.desc.mesh - 1];
        info->face_count += mesh.face_count();
        info->vertex_count += mesh.positions.size() / 3;
        for (size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
            for (size_t row = 0; row < 3; ++row) {
                float value = instance.world[4 * row + 3];
                for (size_t k = 0; k < 3; ++k) value += instance.world[4 * row + k] * mesh.positions[i + k];
                info->bounds_min[row] = std::min(info->bounds_min[row], value);
                info->bounds_max[row] = std::max(info->bounds_max[row], value);
            }
        }
    }
    return TRP_OK;
}

uint32_t trp_scene_warning_count(const TrpScene*) {
    return 0;
}
TrpStatus trp_scene_warning(const TrpScene*, uint32_t, TrpWarning*) {
    return fail("no warning");
}

TrpStatus trp_mesh_desc_init(TrpMeshDesc* desc, size_t size) {
    clear(desc, size);
    desc->time_count = 1;
    return TRP_OK;
}
TrpStatus trp_mesh_add(TrpScene* scene, const TrpMeshDesc* desc, uint32_t* id) {
    return add_mesh(scene, *desc, id);
}

TrpStatus trp_instance_desc_init(TrpInstanceDesc* desc, size_t size) {
    clear(desc, size);
    desc->time_count = 1;
    desc->visible_camera = desc->visible_shadow = 1;
    std::fill_n(desc->color, 3, 1.0f);
    return TRP_OK;
}
TrpStatus trp_instance_add(TrpScene* scene, const TrpInstanceDesc* desc, uint32_t* id) {
    RecordedInstance instance{*desc, text_of(desc->name), rows_of(desc->world_from_object), {}};
    instance.materials.assign(desc->materials, desc->materials + desc->material_count);
    scene->recording.instances.push_back(std::move(instance));
    *id = static_cast<uint32_t>(scene->recording.instances.size());
    return TRP_OK;
}

TrpStatus trp_texture_desc_init(TrpTextureDesc* desc, size_t size) {
    return clear(desc, size);
}
TrpStatus trp_texture_add(TrpScene* scene, const TrpTextureDesc* desc, uint32_t* id) {
    RecordedTexture texture{*desc, text_of(desc->name), text_of(desc->path), {}, {}};
    const auto* bytes = static_cast<const unsigned char*>(desc->file_data);
    texture.bytes.assign(bytes, bytes + desc->file_size);
    if (desc->pixels != nullptr) {
        texture.pixels.assign(desc->pixels,
                              desc->pixels + static_cast<size_t>(desc->width) * desc->height * desc->channels);
    }
    scene->recording.textures.push_back(std::move(texture));
    *id = static_cast<uint32_t>(scene->recording.textures.size());
    return TRP_OK;
}

TrpStatus trp_node_init(TrpNode* node, int32_t type) {
    *node = TrpNode{};
    node->type = type;
    std::fill_n(node->inputs, TRP_NODE_INPUTS, TRP_NO_NODE);
    if (type == TRP_NODE_NORMAL_MAP) node->value[0] = 1.0f;
    if (type == TRP_NODE_UV_TRANSFORM) node->value[0] = node->value[1] = 1.0f;
    return TRP_OK;
}
uint32_t trp_node_count(void) {
    return sizeof node_names / sizeof *node_names;
}
TrpStatus trp_node_info(uint32_t index, TrpNodeInfo* info) {
    *info = {sizeof *info, static_cast<int32_t>(index), node_names[index], "", 0};
    return TRP_OK;
}

TrpStatus trp_material_desc_init(TrpMaterialDesc* desc, size_t size) {
    clear(desc, size);
    for (TrpCoefficient* coefficient :
         {&desc->emission, &desc->ambient, &desc->diffuse, &desc->specular, &desc->shininess, &desc->mirror,
          &desc->transmission, &desc->ior, &desc->alpha}) {
        coefficient->node = TRP_NO_NODE;
    }
    std::fill_n(desc->diffuse.value, 3, 0.8f);
    std::fill_n(desc->shininess.value, 3, 30.0f);
    std::fill_n(desc->ior.value, 3, 1.5f);
    std::fill_n(desc->alpha.value, 3, 1.0f);
    desc->normal = TRP_NO_NODE;
    desc->ambient_is_diffuse = desc->mirror_is_specular = desc->double_sided = 1;
    return TRP_OK;
}
TrpStatus trp_material_add(TrpScene* scene, const TrpMaterialDesc* desc, uint32_t* id) {
    RecordedMaterial material{*desc, text_of(desc->name), {}};
    for (uint32_t i = 0; i < desc->node_count; ++i) {
        RecordedNode node;
        static_cast<TrpNode&>(node) = desc->nodes[i];
        node.text = text_of(desc->nodes[i].name);
        for (const int32_t input : node.inputs) {
            if (input >= static_cast<int32_t>(i)) return fail("a node reads a later one");
        }
        material.nodes.push_back(std::move(node));
    }
    scene->recording.materials.push_back(std::move(material));
    *id = static_cast<uint32_t>(scene->recording.materials.size());
    return TRP_OK;
}

TrpStatus trp_light_desc_init(TrpLightDesc* desc, size_t size) {
    clear(desc, size);
    desc->time_count = 1;
    desc->angle = -1.0f;
    desc->blend = 0.15f;
    desc->size[0] = desc->size[1] = 1.0f;
    desc->cast_shadow = 1;
    std::fill_n(desc->emission, 3, 1.0f);
    return TRP_OK;
}
TrpStatus trp_light_add(TrpScene* scene, const TrpLightDesc* desc, uint32_t* id) {
    scene->recording.lights.push_back({*desc, text_of(desc->name), rows_of(desc->world_from_light)});
    *id = static_cast<uint32_t>(scene->recording.lights.size());
    return TRP_OK;
}

TrpStatus trp_world_desc_init(TrpWorldDesc* desc, size_t size) {
    clear(desc, size);
    desc->visible_camera = desc->light = 1;
    return TRP_OK;
}
TrpStatus trp_scene_set_world(TrpScene* scene, const TrpWorldDesc* desc) {
    scene->recording.world = *desc;
    scene->recording.world_rows = rows_of(desc->world_from_texture);
    scene->recording.has_world = true;
    return TRP_OK;
}

TrpStatus trp_camera_desc_init(TrpCameraDesc* desc, size_t size) {
    clear(desc, size);
    desc->time_count = 1;
    desc->field_of_view = 0.69f;
    desc->width = 6.0f;
    desc->clip_start = 0.01f;
    desc->clip_end = 1000.0f;
    desc->focus_distance = 10.0f;
    desc->shutter[1] = desc->pixel_aspect = 1.0f;
    return TRP_OK;
}
TrpStatus trp_camera_add(TrpScene* scene, const TrpCameraDesc* desc, uint32_t* id) {
    if (!(desc->clip_end > desc->clip_start)) return fail("clip_end is not beyond clip_start");
    scene->recording.cameras.push_back({*desc, text_of(desc->name), rows_of(desc->world_from_camera)});
    *id = static_cast<uint32_t>(scene->recording.cameras.size());
    return TRP_OK;
}
TrpStatus trp_scene_set_camera(TrpScene* scene, uint32_t id) {
    scene->recording.camera = id;
    return TRP_OK;
}

}  // extern "C"
