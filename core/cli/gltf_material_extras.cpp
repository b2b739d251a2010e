// `extras.triptych` of a material. SPDX-License-Identifier: Apache-2.0
#include "gltf_material_extras.h"

#include <fmt/format.h>

namespace triptych::cli {
namespace {

int32_t node_type(const std::string& name, const std::string& where) {
    for (uint32_t i = 0; i < trp_node_count(); ++i) {
        TrpNodeInfo info{};
        info.struct_size = sizeof info;
        check(trp_node_info(i, &info));
        if (name == info.name) return info.type;
    }
    throw Error(fmt::format("{}: there is no node '{}'", where, one_line(name)));
}

void read_node(const Fields& fields, size_t index, TextureLoader& textures, size_t texture_count, NodeProgram& program,
               Warnings& warnings) {
    std::string type;
    if (!fields.read("type", type)) throw Error(fields.where() + ": 'type' is missing");
    TrpNode& node = program.add(node_type(type, fields.where()));
    const std::vector<int> inputs = fields.read_indices("inputs", index, true);
    if (inputs.size() > TRP_NODE_INPUTS) {
        throw Error(fmt::format("{}: more than {} inputs", fields.place("inputs"), TRP_NODE_INPUTS));
    }
    for (size_t i = 0; i < inputs.size(); ++i) node.inputs[i] = inputs[i];
    fields.read("value", node.value, 1, 4);
    fields.read("value2", node.value2, 1, 4);
    fields.read("value3", node.value3, 1, 4);
    int texture = -1;
    if (fields.read_index("texture", texture, texture_count)) {
        node.texture = textures.id(texture, TRP_COLOR_SPACE_LINEAR);
    }
    std::string name;
    if (fields.read("name", name)) node.name = program.keep(name);
    fields.warn_unknown(warnings);
}

// A coefficient: numbers alone, or {"value", "node"}. `node_count`: the nodes of extras that it may name.
bool read_coefficient(const Fields& extras, const char* key, bool scalar, size_t node_count, TrpCoefficient& out,
                      Warnings& warnings) {
    const tinygltf::Value* value = extras.value(key);
    if (value == nullptr) return false;
    TrpCoefficient coefficient = {{1.0f, 1.0f, 1.0f}, TRP_NO_NODE};
    const auto numbers = [&](const Fields& fields, const char* name) {
        int count = 0;
        const tinygltf::Value* given = fields.value(name);
        if (given != nullptr && given->IsNumber()) {
            count = fields.read(name, coefficient.value, 1, 1);
        } else if (!scalar) {
            count = fields.read(name, coefficient.value, 3, 3);
        } else if (given != nullptr) {
            throw Error(fields.place(name) + ": expected a number");
        }
        if (count == 1) coefficient.value[1] = coefficient.value[2] = coefficient.value[0];
    };
    if (value->IsObject()) {
        const Fields fields = extras.object(key);
        numbers(fields, "value");
        fields.read_index("node", coefficient.node, node_count, true);
        fields.warn_unknown(warnings);
    } else {
        numbers(extras, key);
    }
    out = coefficient;
    return true;
}

}  // namespace

void apply_material_extras(const Fields& extras, TextureLoader& textures, size_t texture_count, NodeProgram& program,
                           TrpMaterialDesc& desc, Warnings& warnings) {
    const std::vector<Fields> nodes = extras.objects("nodes");
    for (size_t i = 0; i < nodes.size(); ++i) read_node(nodes[i], i, textures, texture_count, program, warnings);

    struct Entry {
        const char* key;
        bool scalar;
        TrpCoefficient* coefficient;
    };
    const Entry entries[] = {
        {"emission", false, &desc.emission},
        {"diffuse", false, &desc.diffuse},
        {"specular", false, &desc.specular},
        {"shininess", true, &desc.shininess},
        {"transmission", false, &desc.transmission},
        {"ior", true, &desc.ior},
        {"alpha", true, &desc.alpha},
    };
    for (const Entry& entry : entries) {
        read_coefficient(extras, entry.key, entry.scalar, nodes.size(), *entry.coefficient, warnings);
    }
    // What the PBR fields made of mirrors goes with the coefficients that stand in their place.
    if (extras.has("specular")) desc.mirror_is_specular = 1;
    if (extras.has("specular") || extras.has("mirror") || extras.has("transmission")) desc.fresnel = 0;
    if (read_coefficient(extras, "ambient", false, nodes.size(), desc.ambient, warnings)) desc.ambient_is_diffuse = 0;
    if (read_coefficient(extras, "mirror", false, nodes.size(), desc.mirror, warnings)) desc.mirror_is_specular = 0;
    extras.read_index("normal", desc.normal, nodes.size(), true);
    extras.read("thin", desc.thin);
    extras.read("double_sided", desc.double_sided);
    extras.read("index", desc.index);
    extras.read("fresnel", desc.fresnel);
    extras.read("priority", desc.priority);
    extras.read("absorption", desc.absorption, 3, 3);
    extras.warn_unknown(warnings);
}

}  // namespace triptych::cli
