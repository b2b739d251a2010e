// Writes glTF files for the tests: accessors from numbers, the rest as JSON. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace triptych::test {

using nlohmann::json;

constexpr int byte_type = 5120, ubyte_type = 5121, short_type = 5122, ushort_type = 5123, uint_type = 5125,
              float_type = 5126;

class GltfBuilder {
  public:
    json root = {{"asset", {{"version", "2.0"}, {"generator", "triptych tests"}}}};
    std::vector<unsigned char> binary;

    // A buffer view of these bytes, aligned to 4; gives its index.
    int view(const void* bytes, size_t size, int stride = 0);
    template <typename T>
    int view(const std::vector<T>& values, int stride = 0) {
        return view(values.data(), values.size() * sizeof(T), stride);
    }

    // An accessor on all of a new, packed view.
    template <typename T>
    int accessor(const std::vector<T>& values, int component_type, const char* type, bool normalized = false) {
        const int index = accessor_at(view(values), 0, values.size() / components(type), component_type, type);
        if (normalized) root["accessors"].back()["normalized"] = true;
        return index;
    }
    int accessor_at(int view, size_t offset, size_t count, int component_type, const char* type);

    // Appends to a top-level array; gives the index.
    int add(const char* section, json item);

    // A mesh of one primitive, on a node of scene 0. Gives the mesh.
    int add_mesh_node(json primitive, json node = json::object());
    // A node of scene 0.
    int add_node(json node);

    std::vector<unsigned char> glb() const;
    // Writes `name` (.glb, or .gltf with its buffer in a data URI) into `folder`; gives the path.
    std::filesystem::path write(const std::filesystem::path& folder, const std::string& name) const;

    static size_t components(const std::string& type);

  private:
    json finished() const;
};

// A unit square in XY with indices {0, 1, 2, 0, 2, 3}; UV (0,0) at its lower left in glTF's v-down terms.
struct Square {
    std::vector<float> positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    std::vector<float> uvs = {0, 0, 1, 0, 1, 1, 0, 0.75f};
    std::vector<uint16_t> indices = {0, 1, 2, 0, 2, 3};
};

void write_bytes(const std::filesystem::path& path, const std::vector<unsigned char>& bytes);
std::vector<unsigned char> read_bytes(const std::filesystem::path& path);
std::string base64(const std::vector<unsigned char>& bytes);

// A folder for the files of one test, emptied and made.
std::filesystem::path test_folder(const std::string& name);

}  // namespace triptych::test
