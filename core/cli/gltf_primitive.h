// One primitive of a glTF mesh as faces (or loose edges) of a TrpMeshDesc. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gltf_accessor.h"

namespace triptych::cli {

struct PrimitiveData {
    NumberArray positions;
    NumberArray normals;               // by vertex; not given: the faces are flat
    std::vector<NumberArray> uv_sets;  // by vertex, v up
    NumberArray colors;                // by vertex
    NumberArray corners;               // three to a face, unless there are offsets
    std::vector<uint32_t> face_offsets;
    std::vector<uint32_t> edges;  // pairs, of a primitive of lines
    int material = -1;

    uint64_t face_count() const { return face_offsets.empty() ? corners.count / 3 : face_offsets.size() - 1; }
};

// Reads primitive `index` of `mesh`. False, with a warning, where there is nothing in it to render.
bool read_primitive(const GltfFile& file, const tinygltf::Mesh& mesh, size_t index, const std::string& where,
                    Warnings& warnings, PrimitiveData& out);

}  // namespace triptych::cli
