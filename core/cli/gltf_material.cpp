// Materials of a glTF file: found, named, and handed to the core. SPDX-License-Identifier: Apache-2.0
#include "gltf_material.h"

#include <fmt/format.h>

#include "gltf_fields.h"
#include "gltf_material_extras.h"
#include "gltf_material_pbr.h"

namespace triptych::cli {
namespace {

bool emits(const TrpCoefficient& emission) {
    return emission.value[0] > 0.0f || emission.value[1] > 0.0f || emission.value[2] > 0.0f;
}

}  // namespace

MaterialLoader::MaterialLoader(const GltfFile& file, TrpScene* scene, Warnings& warnings)
    : file_(file), scene_(scene), warnings_(warnings), textures_(file, scene, warnings) {
    for (const tinygltf::Mesh& mesh : file.model.meshes) {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            if (primitive.attributes.count("COLOR_0") > 0) vertex_colored_.insert(primitive.material);
        }
    }
}

uint32_t MaterialLoader::id(int index) {
    if (index < 0) return TRP_NO_ID;
    const auto found = ids_.find(index);
    if (found != ids_.end()) return found->second;
    const uint32_t id = add(index);
    ids_.emplace(index, id);
    return id;
}

uint32_t MaterialLoader::add(int index) {
    const tinygltf::Material& material = file_.model.materials[static_cast<size_t>(index)];
    const std::string where = fmt::format("materials[{}]", index);
    const std::string name = material.name.empty() ? where : material.name;
    TrpMaterialDesc desc;
    check(trp_material_desc_init(&desc, sizeof desc));
    desc.name = name.c_str();

    NodeProgram program;
    const Fields extras = triptych_extras(material.extras, where);
    bool is_light = extras.has("emission");
    if (!extras.has("nodes")) {
        PbrMaterial pbr(file_, textures_, program, warnings_, where);
        pbr.translate(material, vertex_colored_.count(index) > 0, desc);
        is_light = is_light || emits_as_light(material);
    }
    apply_material_extras(extras, textures_, file_.model.textures.size(), program, desc, warnings_);
    desc.nodes = program.nodes().data();
    desc.node_count = static_cast<uint32_t>(program.nodes().size());

    uint32_t id = TRP_NO_ID;
    check(trp_material_add(scene_, &desc, &id), fmt::format("{} '{}'", where, one_line(name)));
    any_light_ = any_light_ || (is_light && emits(desc.emission));
    return id;
}

int MaterialLoader::highest_uv_set(int index) const {
    if (index < 0) return 0;
    return highest_uv_set_of(file_.model.materials[static_cast<size_t>(index)]);
}

}  // namespace triptych::cli
