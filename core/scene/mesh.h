// A mesh as it was handed in: n-gons with their own edges and layers. Plain data, never changed after its making.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"

namespace trp {

// Named values, one to a vertex or one to a corner; `components` floats each.
struct Attribute {
    std::string name;
    int32_t domain = 0;  // TRP_DOMAIN_…
    uint32_t components = 0;
    std::vector<float> values;
};

// A named layer, or the first where no name is given; null where there is none such.
inline const Attribute* find_layer(const std::vector<Attribute>& layers, const std::string& name) {
    if (name.empty()) return layers.empty() ? nullptr : &layers[0];
    const auto it = std::find_if(layers.begin(), layers.end(), [&](const Attribute& a) { return a.name == name; });
    return it == layers.end() ? nullptr : &*it;
}

inline constexpr uint32_t kMostTimeSamples = 129;  // Embree's limit

struct Mesh {
    std::string name;
    uint32_t time_count = 1;
    uint32_t vertex_count = 0;
    std::vector<Vec3> positions;         // time_count · vertex_count, and one more of padding that Embree may read
    std::vector<uint32_t> face_offsets;  // empty: all faces are triangles
    std::vector<uint32_t> corner_vertices;
    std::vector<Vec3> normals;  // empty: none
    int32_t normal_domain = 0;
    std::vector<Attribute> uv_sets, colors;
    std::vector<uint32_t> materials;       // ids by slot
    std::vector<uint16_t> face_materials;  // slots; empty: 0
    std::vector<uint8_t> face_smooth;      // empty: smooth where there are normals, else flat
    std::vector<uint32_t> edges;           // vertex pairs; empty: the faces' sides
    std::vector<uint8_t> edge_flags;
    std::vector<float> edge_creases, vertex_creases;

    bool triangles_only() const { return face_offsets.empty(); }
    uint32_t face_count() const {
        return static_cast<uint32_t>(triangles_only() ? corner_vertices.size() / 3 : face_offsets.size() - 1);
    }
    uint32_t face_begin(uint32_t face) const { return triangles_only() ? 3 * face : face_offsets[face]; }
    uint32_t face_end(uint32_t face) const { return triangles_only() ? 3 * face + 3 : face_offsets[face + 1]; }
    // Into `out`, the corners of a face without those that repeat the vertex of the one before.
    void distinct_corners(uint32_t face, std::vector<uint32_t>& out) const {
        out.clear();
        for (uint32_t c = face_begin(face); c < face_end(face); ++c)
            if (out.empty() || corner_vertices[out.back()] != corner_vertices[c]) out.push_back(c);
        if (out.size() > 1 && corner_vertices[out.front()] == corner_vertices[out.back()]) out.pop_back();
    }
    uint64_t bytes() const;  // of all arrays
};

}  // namespace trp
