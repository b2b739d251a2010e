// The node tree of a glTF scene. SPDX-License-Identifier: Apache-2.0
#include "gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>

#include "gltf_accessor.h"
#include "gltf_camera.h"
#include "gltf_fields.h"
#include "gltf_light.h"

namespace triptych::cli {
namespace {

struct Place {
    int node;
    Imath::M44d world_from_parent;
};

// The nodes that a scene names, or those that no other names.
std::vector<int> roots_of(const tinygltf::Model& model, int scene_index) {
    if (scene_index >= 0) return model.scenes[static_cast<size_t>(scene_index)].nodes;
    std::vector<bool> has_parent(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) has_parent[static_cast<size_t>(child)] = true;
    }
    std::vector<int> roots;
    for (size_t i = 0; i < model.nodes.size(); ++i) {
        if (!has_parent[i]) roots.push_back(static_cast<int>(i));
    }
    return roots;
}

// EXT_mesh_gpu_instancing: node_from_instance of each.
std::vector<Imath::M44d> instance_transforms(const GltfFile& file, const tinygltf::Node& node,
                                             const std::string& where) {
    const char* const name = "EXT_mesh_gpu_instancing";
    if (!has_extension(node.extensions, name)) return {Imath::M44d()};
    const Fields attributes = extension(node.extensions, name, where).object("attributes");
    const auto read = [&](const char* key, int components) {
        int accessor = -1;
        if (!attributes.read_index(key, accessor, file.model.accessors.size())) return NumberArray();
        return read_floats(file, accessor, components, components, attributes.place(key));
    };
    const NumberArray translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4), scales = read("SCALE", 3);
    const uint64_t count = std::max({translations.count, rotations.count, scales.count});
    for (const NumberArray* array : {&translations, &rotations, &scales}) {
        if (array->given() && array->count != count) throw Error(attributes.where() + ": their counts differ");
    }
    std::vector<Imath::M44d> transforms;
    transforms.reserve(count);
    for (uint64_t i = 0; i < count; ++i) {
        const auto vector_of = [i](const NumberArray& array, double missing) {
            return array.given() ? Imath::V3d(array.real(i, 0), array.real(i, 1), array.real(i, 2))
                                 : Imath::V3d(missing);
        };
        double rotation[4] = {0, 0, 0, 1};
        for (int k = 0; k < 4 && rotations.given(); ++k) rotation[k] = rotations.real(i, k);
        transforms.push_back(transform_of(vector_of(translations, 0.0), rotation, vector_of(scales, 1.0)));
    }
    return transforms;
}

void add_instances(const GltfFile& file, const tinygltf::Node& node, const std::string& where,
                   const Imath::M44d& world_from_node, TrpScene* scene, MeshLoader& meshes, MaterialLoader& materials,
                   Warnings& warnings) {
    const std::string name = node.name.empty() ? where : node.name;
    TrpInstanceDesc desc;
    check(trp_instance_desc_init(&desc, sizeof desc));
    desc.name = name.c_str();
    const Fields extras = triptych_extras(node.extras, where).object("instance");
    extras.read("index", desc.index);
    extras.read("color", desc.color, 3, 3);
    extras.read("visible_camera", desc.visible_camera);
    extras.read("visible_shadow", desc.visible_shadow);
    std::vector<uint32_t> slots;
    for (const int material : extras.read_indices("materials", file.model.materials.size(), true)) {
        slots.push_back(materials.id(material));
    }
    extras.warn_unknown(warnings);
    desc.materials = slots.data();
    desc.material_count = static_cast<uint32_t>(slots.size());
    if (node.skin >= 0) warnings.add(fmt::format("{} '{}': its skin stays in the rest pose", where, one_line(name)));

    for (const Imath::M44d& node_from_instance : instance_transforms(file, node, where)) {
        const std::array<float, 12> rows = rows_of(node_from_instance * world_from_node);
        desc.world_from_object = rows.data();
        for (const uint32_t mesh : meshes.ids(node.mesh)) {
            desc.mesh = mesh;
            uint32_t id = TRP_NO_ID;
            check(trp_instance_add(scene, &desc, &id), fmt::format("{} '{}'", where, one_line(name)));
        }
    }
}

}  // namespace

NodeCounts add_nodes(const GltfFile& file, int scene_index, TrpScene* scene, MeshLoader& meshes,
                     MaterialLoader& materials, Warnings& warnings) {
    const tinygltf::Model& model = file.model;
    NodeCounts counts;
    std::vector<bool> seen(model.nodes.size(), false);
    std::vector<Place> stack;
    // Last first, so that nodes are taken in the file's order.
    const auto push = [&](const std::vector<int>& nodes, const Imath::M44d& world_from_parent) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) stack.push_back({*node, world_from_parent});
    };
    push(roots_of(model, scene_index), z_up_from_y_up());
    if (stack.empty() && !model.nodes.empty() && scene_index < 0) {
        throw Error("nodes: every node has a parent: the tree has a cycle");
    }
    while (!stack.empty()) {
        const Place place = stack.back();
        stack.pop_back();
        const std::string where = fmt::format("nodes[{}]", place.node);
        const tinygltf::Node& node = model.nodes[static_cast<size_t>(place.node)];
        if (seen[static_cast<size_t>(place.node)]) {
            throw Error(fmt::format("{} '{}': it is reached twice: it has two parents, or is its own ancestor", where,
                                    one_line(node.name)));
        }
        seen[static_cast<size_t>(place.node)] = true;
        const Imath::M44d world_from_node = local_transform(node) * place.world_from_parent;
        if (node.mesh >= 0) add_instances(file, node, where, world_from_node, scene, meshes, materials, warnings);
        if (add_light(file, node, where, world_from_node, scene, warnings)) ++counts.lights;
        if (node.camera >= 0) {
            const std::string& camera_name = model.cameras[static_cast<size_t>(node.camera)].name;
            const std::string name = !node.name.empty() ? node.name : !camera_name.empty() ? camera_name : where;
            const uint32_t id = add_camera(file, node, name, world_from_node, scene, warnings);
            counts.cameras.push_back({id, place.node, name, camera_name, rows_of(world_from_node)});
        }
        push(node.children, world_from_node);
    }
    return counts;
}

}  // namespace triptych::cli
