// `extras.triptych` of a mesh. SPDX-License-Identifier: Apache-2.0
#include "gltf_mesh_extras.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "gltf_accessor.h"

namespace triptych::cli {
namespace {

// The arrays of one mesh and what keeps them alive until the core has copied them.
class Arrays {
  public:
    Arrays(const GltfFile& file, const Fields& extras) : file_(file), extras_(extras) {}

    bool floats(const char* key, int components, TrpArray& out) {
        int accessor = -1;
        if (!extras_.read_index(key, accessor, file_.model.accessors.size())) return false;
        held_.push_back(read_floats(file_, accessor, components, components, extras_.place(key)));
        out = held_.back().array();
        return true;
    }

    bool integers(const char* key, TrpArray& out) {
        int accessor = -1;
        if (!extras_.read_index(key, accessor, file_.model.accessors.size())) return false;
        held_.push_back(read_integers(file_, accessor, extras_.place(key)));
        out = held_.back().array();
        return true;
    }

    // Flags of one byte, whatever the integer type they are stored in.
    bool flags(const char* key, TrpArray& out) {
        if (!integers(key, out)) return false;
        if (out.format == TRP_FORMAT_UINT8) return true;
        std::vector<uint8_t>& bytes = flags_.emplace_back(out.count);
        for (uint64_t i = 0; i < out.count; ++i) bytes[i] = static_cast<uint8_t>(held_.back().integer(i));
        out = {bytes.data(), bytes.size(), 1, TRP_FORMAT_UINT8};
        return true;
    }

    // A list of {"name", "accessor", "domain"}.
    std::vector<TrpAttribute> attributes(const char* key, int least, int most, Warnings& warnings) {
        std::vector<TrpAttribute> list;
        for (const Fields& fields : extras_.objects(key)) {
            int accessor = -1;
            if (!fields.read_index("accessor", accessor, file_.model.accessors.size())) {
                throw Error(fields.where() + ": 'accessor' is missing");
            }
            held_.push_back(read_floats(file_, accessor, least, most, fields.place("accessor")));
            TrpAttribute attribute{};
            std::string& name = names_.emplace_back();
            fields.read("name", name);
            attribute.name = name.c_str();
            attribute.values = held_.back().array();
            attribute.components = held_.back().components;
            attribute.domain = TRP_DOMAIN_CORNER;
            fields.read_enum("domain", attribute.domain,
                             {{"vertex", TRP_DOMAIN_VERTEX}, {"corner", TRP_DOMAIN_CORNER}});
            fields.warn_unknown(warnings);
            list.push_back(attribute);
        }
        return list;
    }

    const char* keep(std::string name) { return names_.emplace_back(std::move(name)).c_str(); }

  private:
    const GltfFile& file_;
    const Fields& extras_;
    std::deque<NumberArray> held_;
    std::deque<std::vector<uint8_t>> flags_;
    std::deque<std::string> names_;
};

// Materials without nodes name a second UV set as glTF does, by number: the sets answer to those names as well.
void add_numbered_names(std::vector<TrpAttribute>& uv_sets, int highest, Arrays& arrays) {
    const size_t count = uv_sets.size();
    for (size_t set = 1; set < count && set <= static_cast<size_t>(std::max(highest, 0)); ++set) {
        TrpAttribute numbered = uv_sets[set];
        numbered.name = arrays.keep(fmt::format("TEXCOORD_{}", set));
        uv_sets.push_back(numbered);
    }
}

}  // namespace

uint32_t add_mesh_of_extras(const GltfFile& file, const Fields& extras, const std::string& name, TrpScene* scene,
                            MaterialLoader& materials, Warnings& warnings) {
    TrpMeshDesc desc;
    check(trp_mesh_desc_init(&desc, sizeof desc));
    Arrays arrays(file, extras);
    desc.name = name.c_str();
    if (!arrays.floats("positions", 3, desc.positions)) throw Error(extras.where() + ": 'positions' is missing");
    arrays.integers("face_offsets", desc.face_offsets);
    arrays.integers("corner_vertices", desc.corner_vertices);
    if (arrays.floats("corner_normals", 3, desc.normals)) {
        desc.normal_domain = TRP_DOMAIN_CORNER;
    } else if (arrays.floats("vertex_normals", 3, desc.normals)) {
        desc.normal_domain = TRP_DOMAIN_VERTEX;
    }
    std::vector<TrpAttribute> uv_sets = arrays.attributes("uv_sets", 2, 2, warnings);
    const std::vector<TrpAttribute> colors = arrays.attributes("colors", 3, 4, warnings);
    desc.colors = colors.data();
    desc.color_count = static_cast<uint32_t>(colors.size());

    std::vector<uint32_t> slots;
    int highest_uv_set = 0;
    for (const int material : extras.read_indices("materials", file.model.materials.size(), true)) {
        slots.push_back(materials.id(material));
        highest_uv_set = std::max(highest_uv_set, materials.highest_uv_set(material));
    }
    add_numbered_names(uv_sets, highest_uv_set, arrays);
    desc.uv_sets = uv_sets.data();
    desc.uv_set_count = static_cast<uint32_t>(uv_sets.size());
    desc.materials = slots.data();
    desc.material_count = static_cast<uint32_t>(slots.size());
    arrays.integers("face_materials", desc.face_materials);
    arrays.flags("face_smooth", desc.face_smooth);
    if (arrays.integers("edges", desc.edges)) {
        // Two numbers of the accessor are one element of the core's.
        if (desc.edges.count % 2 != 0) throw Error(extras.place("edges") + ": an odd number of vertices");
        if (desc.edges.stride != 4 && desc.edges.stride != 2 && desc.edges.stride != 1) {
            throw Error(extras.place("edges") + ": expected a packed accessor");
        }
        desc.edges.count /= 2;
        desc.edges.stride *= 2;
    }
    arrays.flags("edge_flags", desc.edge_flags);
    arrays.floats("edge_creases", 1, desc.edge_creases);
    arrays.floats("vertex_creases", 1, desc.vertex_creases);
    extras.warn_unknown(warnings);

    uint32_t id = TRP_NO_ID;
    check(trp_mesh_add(scene, &desc, &id), extras.where());
    return id;
}

}  // namespace triptych::cli
