// A radiosity solution as a scene of its own. SPDX-License-Identifier: Apache-2.0
#include "bake_glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "gltf_container.h"
#include "radiosity_job.h"
#include "report.h"

namespace triptych::cli {
namespace {

using nlohmann::json;

constexpr int gltf_float = 5126, gltf_uint32 = 5125, for_vertices = 34962, for_indices = 34963;

// Glows as its vertices do, whatever the light.
struct BakedMesh {
    std::vector<float> positions, normals, colors;  // 3 to each vertex; glTF's axes
    std::vector<uint32_t> triangles;
};

std::vector<float> read_values(TrpRadiosity* radiosity, const char* name, size_t count) {
    std::vector<float> out(3 * count);
    check(trp_radiosity_read(radiosity, name, out.data(), out.size()));
    return out;
}

// Appends vectors of a Z-up world.
void append_turned(std::vector<float>& out, const std::vector<float>& vectors) {
    for (size_t k = 0; k < vectors.size(); k += 3) out.insert(out.end(), {vectors[k], vectors[k + 2], -vectors[k + 1]});
}

// Polygons of more than three corners, some of which are those of smaller neighbours, are cut into triangles about
// their middle, which has the element's own radiosity: as the solution is interpolated.
BakedMesh make_mesh(TrpRadiosity* radiosity) {
    const TrpRadiosityInfo info = info_of(radiosity);
    std::vector<uint32_t> offsets(size_t{info.element_count} + 1), corners(info.corner_count);
    check(trp_radiosity_polygons(radiosity, offsets.data(), offsets.size(), corners.data(), corners.size()));
    BakedMesh mesh;
    append_turned(mesh.positions, read_values(radiosity, "vertex_position", info.vertex_count));
    append_turned(mesh.normals, read_values(radiosity, "vertex_normal", info.vertex_count));
    mesh.colors = read_values(radiosity, "vertex_radiosity", info.vertex_count);
    std::vector<float> middles, colors = read_values(radiosity, "radiosity", info.element_count);
    append_turned(middles, read_values(radiosity, "centre", info.element_count));
    for (size_t k = 0; k < info.element_count; ++k) {
        const uint32_t *polygon = &corners[offsets[k]], count = offsets[k + 1] - offsets[k];
        if (count == 3) {
            mesh.triangles.insert(mesh.triangles.end(), polygon, polygon + 3);
            continue;
        }
        const auto middle = static_cast<uint32_t>(mesh.positions.size() / 3);
        for (uint32_t c = 0; c < count; ++c)
            mesh.triangles.insert(mesh.triangles.end(), {middle, polygon[c], polygon[(c + 1) % count]});
        float normal[3] = {};
        for (size_t c = 0; c < 3; ++c) {
            for (uint32_t v = 0; v < count; ++v) normal[c] += mesh.normals[3 * size_t{polygon[v]} + c];
            mesh.positions.push_back(middles[3 * k + c]);
            mesh.colors.push_back(colors[3 * k + c]);
        }
        const float length = std::hypot(normal[0], normal[1], normal[2]);
        for (const float c : normal) mesh.normals.push_back(length > 0 ? c / length : 0);
    }
    for (float& c : mesh.colors) c /= std::numbers::pi_v<float>;
    return mesh;
}

json read_gltf(const std::string& path) {
    std::ifstream stream(std::filesystem::u8path(path), std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    const GltfChunks chunks = split_gltf({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
    check_json_depth(chunks.json);
    return json::parse(chunks.json);
}

// What of a scene stays: where things are, the cameras, and which of them renders into what film.
json bare_scene(const json& source) {
    json out = {{"asset", {{"version", "2.0"}, {"generator", "Triptych"}}}, {"nodes", json::array()}};
    for (const char* key : {"scene", "scenes", "cameras", "nodes"})
        if (source.contains(key)) out[key] = source[key];
    for (json& node : out["nodes"])
        for (const char* key : {"mesh", "skin", "weights", "extensions", "extras"}) node.erase(key);
    if (!out.contains("scenes") || out["scenes"].empty()) out["scenes"] = json::array({json::object()});
    for (json& scene : out["scenes"]) {
        json kept;
        const json extras = scene.value(json::json_pointer("/extras/triptych"), json::object());
        for (const char* key : {"camera", "film"})
            if (extras.contains(key)) kept[key] = extras[key];
        scene.erase("extras");
        scene.erase("extensions");
        if (!kept.is_null()) scene["extras"]["triptych"] = kept;
    }
    return out;
}

// A file's binary chunk as it grows.
struct Binary {
    json& gltf;
    std::string bytes;
    template <class Number>
    size_t accessor(const std::vector<Number>& numbers, int components, int component_type, int target) {
        gltf["bufferViews"].push_back({{"buffer", 0},
                                       {"byteOffset", bytes.size()},
                                       {"byteLength", numbers.size() * sizeof(Number)},
                                       {"target", target}});
        bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
        gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                     {"componentType", component_type},
                                     {"count", numbers.size() / static_cast<size_t>(components)},
                                     {"type", components == 3 ? "VEC3" : "SCALAR"}});
        return gltf["accessors"].size() - 1;
    }
};

void add_mesh(json& gltf, Binary& binary, const BakedMesh& mesh) {
    const size_t positions = binary.accessor(mesh.positions, 3, gltf_float, for_vertices);
    std::vector<float> low(3), high(3);
    for (size_t c = 0; c < 3; ++c) {
        low[c] = high[c] = mesh.positions[c];
        for (size_t k = c; k < mesh.positions.size(); k += 3) {
            low[c] = std::min(low[c], mesh.positions[k]);
            high[c] = std::max(high[c], mesh.positions[k]);
        }
    }
    gltf["accessors"][positions].update({{"min", low}, {"max", high}});
    const json primitive = {{"attributes",
                             {{"POSITION", positions},
                              {"NORMAL", binary.accessor(mesh.normals, 3, gltf_float, for_vertices)},
                              {"COLOR_0", binary.accessor(mesh.colors, 3, gltf_float, for_vertices)}}},
                            {"indices", binary.accessor(mesh.triangles, 1, gltf_uint32, for_indices)},
                            {"material", 0}};
    const json material = {{"name", "radiosity"}, {"extensions", {{"KHR_materials_unlit", json::object()}}}};
    gltf["materials"] = json::array({material});
    gltf["extensionsUsed"] = json::array({"KHR_materials_unlit"});
    gltf["meshes"] = json::array({{{"name", "radiosity"}, {"primitives", json::array({primitive})}}});
    gltf["nodes"].push_back({{"name", "radiosity"}, {"mesh", 0}});
    for (json& scene : gltf["scenes"]) scene["nodes"].push_back(gltf["nodes"].size() - 1);
}

std::string uint32_bytes(size_t value) {
    static_assert(std::endian::native == std::endian::little);
    if (value > UINT32_MAX) throw Error("a .glb cannot have more than 4 GiB");
    const auto number = static_cast<uint32_t>(value);
    return {reinterpret_cast<const char*>(&number), sizeof number};
}

}  // namespace

void write_baked_glb(const std::string& scene, TrpRadiosity* radiosity, const std::string& path) {
    json gltf = bare_scene(read_gltf(scene));
    Binary binary{gltf, {}};
    const BakedMesh mesh = make_mesh(radiosity);
    if (!mesh.triangles.empty()) {
        add_mesh(gltf, binary, mesh);
        gltf["buffers"] = json::array({{{"byteLength", binary.bytes.size()}}});
    }
    std::string text = gltf.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    std::string out = "glTF" + uint32_bytes(2) + uint32_bytes(20 + text.size() + 8 + binary.bytes.size());
    out += uint32_bytes(text.size()) + "JSON" + text;
    out += uint32_bytes(binary.bytes.size()) + std::string("BIN\0", 4) + binary.bytes;
    write_file(path, out);
}

}  // namespace triptych::cli
