// Primitives of one mesh joined. SPDX-License-Identifier: Apache-2.0
#include "gltf_mesh_merge.h"

#include <fmt/format.h>

#include <algorithm>

namespace triptych::cli {
namespace {

uint64_t vertex_total(const std::vector<PrimitiveData>& primitives, const std::string& where) {
    uint64_t total = 0;
    for (const PrimitiveData& primitive : primitives) total += primitive.positions.count;
    if (total > UINT32_MAX) throw Error(where + ": more than 2^32 vertices");
    return total;
}

// Joins one attribute; vertices of primitives without it get `missing`.
template <typename Get>
NumberArray joined(const std::vector<PrimitiveData>& primitives, uint64_t total, int components,
                   std::initializer_list<float> missing, Get get) {
    std::vector<float> values;
    values.reserve(total * static_cast<size_t>(components));
    for (const PrimitiveData& primitive : primitives) {
        const NumberArray* array = get(primitive);
        for (uint64_t i = 0; i < primitive.positions.count; ++i) {
            for (int k = 0; k < components; ++k) {
                const bool there = array != nullptr && array->given() && k < array->components;
                values.push_back(there ? array->real(i, k) : missing.begin()[k]);
            }
        }
    }
    return NumberArray::of(std::move(values), components);
}

uint32_t rebased(uint32_t index, uint64_t vertex_count, uint64_t first, const std::string& where) {
    if (index >= vertex_count) {
        throw Error(fmt::format("{}: index {} is not below {}, its number of vertices", where, index, vertex_count));
    }
    return static_cast<uint32_t>(first + index);
}

NumberArray joined_positions(const std::vector<PrimitiveData>& primitives, uint64_t total) {
    return joined(primitives, total, 3, {0, 0, 0}, [](const PrimitiveData& p) { return &p.positions; });
}

void join_corners(const std::vector<PrimitiveData>& primitives, const std::string& where, MergedFaces& merged) {
    const bool polygons = std::any_of(primitives.begin(), primitives.end(),
                                      [](const PrimitiveData& p) { return !p.face_offsets.empty(); });
    std::vector<uint32_t> corners;
    std::vector<uint32_t>& offsets = merged.data.face_offsets;
    uint64_t first = 0;
    for (size_t slot = 0; slot < primitives.size(); ++slot) {
        const PrimitiveData& primitive = primitives[slot];
        const uint64_t base = corners.size();
        for (uint64_t i = 0; i < primitive.corners.count; ++i) {
            corners.push_back(rebased(primitive.corners.integer(i), primitive.positions.count, first,
                                      fmt::format("{} (part {})", where, slot)));
        }
        if (corners.size() > UINT32_MAX) throw Error(where + ": more than 2^32 corners");
        for (uint64_t face = 0; face < primitive.face_count(); ++face) {
            merged.face_slots.push_back(static_cast<uint32_t>(slot));
            if (polygons) {
                offsets.push_back(static_cast<uint32_t>(
                    base + (primitive.face_offsets.empty() ? 3 * face : primitive.face_offsets[face])));
            }
        }
        first += primitive.positions.count;
    }
    if (polygons) offsets.push_back(static_cast<uint32_t>(corners.size()));
    merged.data.corners = NumberArray::of(std::move(corners));
}

}  // namespace

MergedFaces merge_faces(const std::vector<PrimitiveData>& primitives, const std::string& where) {
    MergedFaces merged;
    const uint64_t total = vertex_total(primitives, where);
    merged.data.positions = joined_positions(primitives, total);
    join_corners(primitives, where, merged);

    size_t with_normals = 0, uv_sets = 0;
    int color_components = 0;
    for (const PrimitiveData& primitive : primitives) {
        with_normals += primitive.normals.given() ? 1 : 0;
        uv_sets = std::max(uv_sets, primitive.uv_sets.size());
        color_components = std::max(color_components, primitive.colors.components);
    }
    if (with_normals > 0) {
        merged.data.normals =
            joined(primitives, total, 3, {0, 0, 1}, [](const PrimitiveData& p) { return &p.normals; });
    }
    if (with_normals > 0 && with_normals < primitives.size()) {
        for (const PrimitiveData& primitive : primitives) {
            merged.face_smooth.insert(merged.face_smooth.end(), primitive.face_count(),
                                      primitive.normals.given() ? 1 : 0);
        }
    }
    for (size_t set = 0; set < uv_sets; ++set) {
        merged.data.uv_sets.push_back(joined(primitives, total, 2, {0, 0}, [set](const PrimitiveData& p) {
            return set < p.uv_sets.size() ? &p.uv_sets[set] : nullptr;
        }));
    }
    if (color_components > 0) {
        merged.data.colors =
            joined(primitives, total, color_components, {1, 1, 1, 1}, [](const PrimitiveData& p) { return &p.colors; });
    }
    return merged;
}

PrimitiveData merge_lines(const std::vector<PrimitiveData>& primitives, const std::string& where) {
    PrimitiveData merged;
    merged.positions = joined_positions(primitives, vertex_total(primitives, where));
    uint64_t first = 0;
    for (const PrimitiveData& primitive : primitives) {
        for (const uint32_t index : primitive.edges) {
            merged.edges.push_back(rebased(index, primitive.positions.count, first, where));
        }
        first += primitive.positions.count;
    }
    merged.material = primitives.front().material;
    return merged;
}

}  // namespace triptych::cli
