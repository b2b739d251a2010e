// Meshes of a glTF file. SPDX-License-Identifier: Apache-2.0
#include "gltf_mesh.h"

#include <fmt/format.h>

#include "gltf_fields.h"
#include "gltf_mesh_extras.h"
#include "gltf_mesh_merge.h"
#include "gltf_primitive.h"

namespace triptych::cli {
namespace {

// Points the descriptor at the arrays of `data`, which must outlive it, as must `uv_sets` and `colors`.
void describe(const PrimitiveData& data, std::vector<TrpAttribute>& uv_sets, std::vector<std::string>& names,
              TrpAttribute& colors, TrpMeshDesc& desc) {
    desc.positions = data.positions.array();
    desc.corner_vertices = data.corners.array();
    if (!data.face_offsets.empty()) {
        desc.face_offsets = {data.face_offsets.data(), data.face_offsets.size(), 4, TRP_FORMAT_UINT32};
    }
    if (data.normals.given()) {
        desc.normals = data.normals.array();
        desc.normal_domain = TRP_DOMAIN_VERTEX;
    }
    for (size_t set = 0; set < data.uv_sets.size(); ++set) names.push_back(fmt::format("TEXCOORD_{}", set));
    for (size_t set = 0; set < data.uv_sets.size(); ++set) {
        uv_sets.push_back({names[set].c_str(), data.uv_sets[set].array(), TRP_DOMAIN_VERTEX, 2});
    }
    desc.uv_sets = uv_sets.data();
    desc.uv_set_count = static_cast<uint32_t>(uv_sets.size());
    if (data.colors.given()) {
        colors = {"COLOR_0", data.colors.array(), TRP_DOMAIN_VERTEX, data.colors.components};
        desc.colors = &colors;
        desc.color_count = 1;
    }
}

}  // namespace

const std::vector<uint32_t>& MeshLoader::ids(int index) {
    const auto found = ids_.find(index);
    if (found != ids_.end()) return found->second;
    return ids_.emplace(index, load(index)).first->second;
}

std::vector<uint32_t> MeshLoader::load(int index) {
    const tinygltf::Mesh& mesh = file_.model.meshes[static_cast<size_t>(index)];
    const std::string where = fmt::format("meshes[{}]", index);
    const std::string name = mesh.name.empty() ? where : mesh.name;
    const Fields extras = triptych_extras(mesh.extras, where);
    std::vector<uint32_t> ids;
    if (extras.has("corner_vertices") || (extras.has("positions") && extras.has("edges"))) {
        ids.push_back(add_mesh_of_extras(file_, extras, name, scene_, materials_, warnings_));
        return ids;
    }
    std::vector<PrimitiveData> faces, lines;
    for (size_t i = 0; i < mesh.primitives.size(); ++i) {
        PrimitiveData data;
        const std::string place = fmt::format("{}.primitives[{}]", where, i);
        if (!read_primitive(file_, mesh, i, place, warnings_, data)) continue;
        (data.edges.empty() ? faces : lines).push_back(std::move(data));
    }
    if (!faces.empty()) load_faces(name, where, faces, ids);
    if (!lines.empty()) load_lines(faces.empty() ? name : name + " (lines)", where, lines, ids);
    return ids;
}

void MeshLoader::load_faces(const std::string& name, const std::string& where, std::vector<PrimitiveData>& primitives,
                            std::vector<uint32_t>& ids) {
    TrpMeshDesc desc;
    check(trp_mesh_desc_init(&desc, sizeof desc));
    desc.name = name.c_str();
    std::vector<uint32_t> slots;
    for (const PrimitiveData& primitive : primitives) slots.push_back(materials_.id(primitive.material));
    desc.materials = slots.data();
    desc.material_count = static_cast<uint32_t>(slots.size());

    std::vector<TrpAttribute> uv_sets;
    std::vector<std::string> names;
    TrpAttribute colors{};
    MergedFaces merged;
    if (primitives.size() == 1) {
        // The common case: the core reads the file's own bytes.
        describe(primitives.front(), uv_sets, names, colors, desc);
    } else {
        merged = merge_faces(primitives, where);
        describe(merged.data, uv_sets, names, colors, desc);
        desc.face_materials = {merged.face_slots.data(), merged.face_slots.size(), 4, TRP_FORMAT_UINT32};
        if (!merged.face_smooth.empty()) {
            desc.face_smooth = {merged.face_smooth.data(), merged.face_smooth.size(), 1, TRP_FORMAT_UINT8};
        }
    }
    uint32_t id = TRP_NO_ID;
    check(trp_mesh_add(scene_, &desc, &id), where);
    ids.push_back(id);
}

void MeshLoader::load_lines(const std::string& name, const std::string& where, std::vector<PrimitiveData>& primitives,
                            std::vector<uint32_t>& ids) {
    const PrimitiveData merged = merge_lines(primitives, where);
    TrpMeshDesc desc;
    check(trp_mesh_desc_init(&desc, sizeof desc));
    desc.name = name.c_str();
    desc.positions = merged.positions.array();
    desc.edges = {merged.edges.data(), merged.edges.size() / 2, 8, TRP_FORMAT_UINT32};
    const uint32_t material = materials_.id(merged.material);
    desc.materials = &material;
    desc.material_count = 1;
    uint32_t id = TRP_NO_ID;
    check(trp_mesh_add(scene_, &desc, &id), where);
    ids.push_back(id);
}

}  // namespace triptych::cli
