// Writes glTF files for the tests. SPDX-License-Identifier: Apache-2.0
#include "gltf_builder.h"

#include <fstream>
#include <iterator>

namespace triptych::test {
namespace {

void put_uint32(std::vector<unsigned char>& out, uint32_t value) {
    for (int k = 0; k < 4; ++k) out.push_back(static_cast<unsigned char>(value >> (8 * k)));
}

}  // namespace

int GltfBuilder::view(const void* bytes, size_t size, int stride) {
    while (binary.size() % 4 != 0) binary.push_back(0);
    json item = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", size}};
    if (stride > 0) item["byteStride"] = stride;
    const auto* begin = static_cast<const unsigned char*>(bytes);
    binary.insert(binary.end(), begin, begin + size);
    return add("bufferViews", item);
}

int GltfBuilder::accessor_at(int view, size_t offset, size_t count, int component_type, const char* type) {
    return add("accessors", {{"bufferView", view},
                             {"byteOffset", offset},
                             {"count", count},
                             {"componentType", component_type},
                             {"type", type}});
}

int GltfBuilder::add(const char* section, json item) {
    root[section].push_back(std::move(item));
    return static_cast<int>(root[section].size()) - 1;
}

int GltfBuilder::add_node(json node) {
    const int index = add("nodes", std::move(node));
    if (!root.contains("scenes")) root["scenes"] = json::array({json::object()});
    root["scene"] = 0;
    root["scenes"][0]["nodes"].push_back(index);
    return index;
}

int GltfBuilder::add_mesh_node(json primitive, json node) {
    const int mesh = add("meshes", {{"primitives", json::array({std::move(primitive)})}});
    node["mesh"] = mesh;
    add_node(std::move(node));
    return mesh;
}

json GltfBuilder::finished() const {
    json copy = root;
    if (!binary.empty()) copy["buffers"] = json::array({{{"byteLength", binary.size()}}});
    return copy;
}

std::vector<unsigned char> GltfBuilder::glb() const {
    std::string text = finished().dump();
    while (text.size() % 4 != 0) text.push_back(' ');
    std::vector<unsigned char> padded = binary;
    while (padded.size() % 4 != 0) padded.push_back(0);
    std::vector<unsigned char> out = {'g', 'l', 'T', 'F'};
    put_uint32(out, 2);
    put_uint32(out, static_cast<uint32_t>(20 + text.size() + (padded.empty() ? 0 : 8 + padded.size())));
    put_uint32(out, static_cast<uint32_t>(text.size()));
    put_uint32(out, 0x4E4F534A);
    out.insert(out.end(), text.begin(), text.end());
    if (!padded.empty()) {
        put_uint32(out, static_cast<uint32_t>(padded.size()));
        put_uint32(out, 0x004E4942);
        out.insert(out.end(), padded.begin(), padded.end());
    }
    return out;
}

std::filesystem::path GltfBuilder::write(const std::filesystem::path& folder, const std::string& name) const {
    const std::filesystem::path path = folder / name;
    if (path.extension() == ".glb") {
        write_bytes(path, glb());
        return path;
    }
    json copy = finished();
    if (!binary.empty()) copy["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(binary);
    const std::string text = copy.dump(1);
    write_bytes(path, {text.begin(), text.end()});
    return path;
}

size_t GltfBuilder::components(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
}

void write_bytes(const std::filesystem::path& path, const std::vector<unsigned char>& bytes) {
    std::ofstream stream(path, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::vector<unsigned char> read_bytes(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string base64(const std::vector<unsigned char>& bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; ++k) text.push_back(i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=');
    }
    return text;
}

std::filesystem::path test_folder(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "triptych_cli_tests" / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

}  // namespace triptych::test
