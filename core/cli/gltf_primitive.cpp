// One primitive of a glTF mesh. SPDX-License-Identifier: Apache-2.0
#include "gltf_primitive.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "gltf_fields.h"

namespace triptych::cli {
namespace {

// The index of every corner as the file lists them: its indices, or 0, 1, 2, …
NumberArray read_corners(const GltfFile& file, const tinygltf::Primitive& primitive, uint64_t vertex_count,
                         const std::string& where) {
    if (primitive.indices >= 0) return read_integers(file, primitive.indices, where + ".indices");
    std::vector<uint32_t> counting(vertex_count);
    std::iota(counting.begin(), counting.end(), 0u);
    return NumberArray::of(std::move(counting));
}

// Strips and fans as triangles of their own (glTF 2.0 specification, 3.7.2.1). Triangles that use a vertex twice only
// join one strip to the next.
NumberArray triangles_of(const NumberArray& corners, bool fan) {
    std::vector<uint32_t> triangles;
    const uint64_t count = corners.count < 3 ? 0 : corners.count - 2;
    triangles.reserve(count * 3);
    for (uint64_t i = 0; i < count; ++i) {
        const uint32_t a = corners.integer(fan ? i + 1 : i);
        const uint32_t b = corners.integer(fan ? i + 2 : i + 1 + i % 2);
        const uint32_t c = corners.integer(fan ? 0 : i + 2 - i % 2);
        if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
    }
    return NumberArray::of(std::move(triangles));
}

// FB_ngon_encoding: triangles one after the other that start with the same vertex are the fan of one n-gon.
void join_ngons(PrimitiveData& data) {
    std::vector<uint32_t> corners;
    corners.reserve(data.corners.count);
    for (uint64_t i = 0; i + 2 < data.corners.count; i += 3) {
        const uint32_t a = data.corners.integer(i), b = data.corners.integer(i + 1), c = data.corners.integer(i + 2);
        const bool continues =
            !data.face_offsets.empty() && corners[data.face_offsets.back()] == a && corners.back() == b;
        if (continues) {
            corners.push_back(c);
        } else {
            data.face_offsets.push_back(static_cast<uint32_t>(corners.size()));
            corners.insert(corners.end(), {a, b, c});
        }
    }
    data.face_offsets.push_back(static_cast<uint32_t>(corners.size()));
    data.corners = NumberArray::of(std::move(corners));
}

std::vector<uint32_t> edges_of(const NumberArray& corners, int mode) {
    std::vector<uint32_t> edges;
    const uint64_t step = mode == TINYGLTF_MODE_LINE ? 2 : 1;
    for (uint64_t i = 0; i + 1 < corners.count; i += step) {
        edges.insert(edges.end(), {corners.integer(i), corners.integer(i + 1)});
    }
    if (mode == TINYGLTF_MODE_LINE_LOOP && corners.count > 2) {
        edges.insert(edges.end(), {corners.integer(corners.count - 1), corners.integer(0)});
    }
    return edges;
}

// glTF's v runs down the picture, the core's up.
NumberArray with_v_up(const NumberArray& uvs) {
    std::vector<float> values(uvs.count * 2);
    for (uint64_t i = 0; i < uvs.count; ++i) {
        values[2 * i] = uvs.real(i, 0);
        values[2 * i + 1] = 1.0f - uvs.real(i, 1);
    }
    return NumberArray::of(std::move(values), 2);
}

void check_count(const NumberArray& array, uint64_t vertex_count, const std::string& where) {
    if (array.count != vertex_count) {
        throw Error(fmt::format("{}: {} elements for {} vertices", where, array.count, vertex_count));
    }
}

// Adds the mesh's default weights of the morph targets to an attribute; in rest they are 0.
void apply_morph(const GltfFile& file, const tinygltf::Mesh& mesh, const tinygltf::Primitive& primitive,
                 const char* attribute, const std::string& where, NumberArray& array) {
    for (size_t k = 0; k < primitive.targets.size() && k < mesh.weights.size(); ++k) {
        const float weight = static_cast<float>(mesh.weights[k]);
        const auto found = primitive.targets[k].find(attribute);
        if (weight == 0.0f || found == primitive.targets[k].end()) continue;
        const std::string place = fmt::format("{}.targets[{}].{}", where, k, attribute);
        const NumberArray offsets = read_floats(file, found->second, 3, 3, place);
        check_count(offsets, array.count, place);
        std::vector<float> moved(array.count * 3);
        for (uint64_t i = 0; i < array.count; ++i) {
            for (int c = 0; c < 3; ++c) {
                moved[3 * i + static_cast<size_t>(c)] = array.real(i, c) + weight * offsets.real(i, c);
            }
        }
        array = NumberArray::of(std::move(moved), 3);
    }
}

void read_attributes(const GltfFile& file, const tinygltf::Mesh& mesh, const tinygltf::Primitive& primitive,
                     const std::string& where, PrimitiveData& out) {
    const auto find = [&](const std::string& name) {
        const auto found = primitive.attributes.find(name);
        return found == primitive.attributes.end() ? -1 : found->second;
    };
    out.positions = read_floats(file, find("POSITION"), 3, 3, where + ".POSITION");
    const uint64_t vertex_count = out.positions.count;
    if (vertex_count > UINT32_MAX) throw Error(where + ".POSITION: more than 2^32 vertices");
    if (find("NORMAL") >= 0) {
        out.normals = read_floats(file, find("NORMAL"), 3, 3, where + ".NORMAL");
        check_count(out.normals, vertex_count, where + ".NORMAL");
        apply_morph(file, mesh, primitive, "NORMAL", where, out.normals);
    }
    apply_morph(file, mesh, primitive, "POSITION", where, out.positions);
    for (int set = 0; find(fmt::format("TEXCOORD_{}", set)) >= 0; ++set) {
        const std::string name = fmt::format("TEXCOORD_{}", set);
        const NumberArray uvs = read_floats(file, find(name), 2, 2, where + "." + name);
        check_count(uvs, vertex_count, where + "." + name);
        out.uv_sets.push_back(with_v_up(uvs));
    }
    if (find("COLOR_0") >= 0) {
        out.colors = read_floats(file, find("COLOR_0"), 3, 4, where + ".COLOR_0");
        check_count(out.colors, vertex_count, where + ".COLOR_0");
    }
}

}  // namespace

bool read_primitive(const GltfFile& file, const tinygltf::Mesh& mesh, size_t index, const std::string& where,
                    Warnings& warnings, PrimitiveData& out) {
    const tinygltf::Primitive& primitive = mesh.primitives[index];
    const int mode = primitive.mode;
    if (mode == TINYGLTF_MODE_POINTS) {
        warnings.add(where + ": points are not rendered");
        return false;
    }
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) throw Error(fmt::format("{}.mode: {} is not one of glTF's", where, mode));
    if (primitive.attributes.count("POSITION") == 0) {
        warnings.add(where + ": it has no POSITION and is left out");
        return false;
    }
    if (!primitive.targets.empty()) {
        warnings.add(where + ": morph targets stay at their default weights");
    }
    read_attributes(file, mesh, primitive, where, out);
    out.material = primitive.material;
    NumberArray corners = read_corners(file, primitive, out.positions.count, where);
    if (mode == TINYGLTF_MODE_LINE || mode == TINYGLTF_MODE_LINE_LOOP || mode == TINYGLTF_MODE_LINE_STRIP) {
        out.edges = edges_of(corners, mode);
        return !out.edges.empty();
    }
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        if (corners.count % 3 != 0) {
            warnings.add(
                fmt::format("{}: {} corners are not whole triangles; the rest is left out", where, corners.count));
            corners.count -= corners.count % 3;
        }
        out.corners = std::move(corners);
        if (has_extension(primitive.extensions, "FB_ngon_encoding")) join_ngons(out);
    } else {
        out.corners = triangles_of(corners, mode == TINYGLTF_MODE_TRIANGLE_FAN);
    }
    return out.corners.count > 0;
}

}  // namespace triptych::cli
