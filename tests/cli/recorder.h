// A stand-in for the core, which keeps what the command line's reader of glTF hands to it: the tests look at arrays,
// coefficients and transforms that the real core does not give back. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <triptych/triptych.h>

#include <array>
#include <string>
#include <vector>

namespace triptych::test {

struct RecordedAttribute {
    std::string name;
    int domain = 0, components = 0;
    std::vector<float> values;
};

struct RecordedMesh {
    std::string name;
    std::vector<float> positions, normals;
    std::vector<uint32_t> face_offsets, corners, face_materials, face_smooth, edges, edge_flags, materials;
    std::vector<float> edge_creases, vertex_creases;
    int normal_domain = 0;
    std::vector<RecordedAttribute> uv_sets, colors;
    const void* positions_source = nullptr;
    int corner_format = 0;

    size_t face_count() const { return face_offsets.empty() ? corners.size() / 3 : face_offsets.size() - 1; }
};

struct RecordedInstance {
    TrpInstanceDesc desc;
    std::string name;
    std::array<float, 12> world;
    std::vector<uint32_t> materials;
};

struct RecordedTexture {
    TrpTextureDesc desc;
    std::string name, path;
    std::vector<unsigned char> bytes;
    std::vector<float> pixels;
};

struct RecordedNode : TrpNode {
    std::string text;  // TrpNode.name
};

struct RecordedMaterial {
    TrpMaterialDesc desc;
    std::string name;
    std::vector<RecordedNode> nodes;
};

struct RecordedLight {
    TrpLightDesc desc;
    std::string name;
    std::array<float, 12> world;
};

struct RecordedCamera {
    TrpCameraDesc desc;
    std::string name;
    std::array<float, 12> world;
};

// Everything of one scene, in the order in which it was added. The id of an item is its place in its list, from 1.
struct Recording {
    std::vector<RecordedMesh> meshes;
    std::vector<RecordedInstance> instances;
    std::vector<RecordedTexture> textures;
    std::vector<RecordedMaterial> materials;
    std::vector<RecordedLight> lights;
    std::vector<RecordedCamera> cameras;
    TrpWorldDesc world{};
    std::array<float, 12> world_rows{};
    bool has_world = false;
    uint32_t camera = TRP_NO_ID;
    uint32_t commits = 0;
};

const Recording& recording_of(const TrpScene* scene);

// A material's coefficient evaluated as the header says, with `image` for each texture's colour, `uv` as the first UV
// set, and `color` as the vertex colour.
std::array<float, 4> evaluate(const RecordedMaterial& material, const TrpCoefficient& coefficient,
                              std::array<float, 4> image = {1, 1, 1, 1}, std::array<float, 4> color = {1, 1, 1, 1},
                              std::array<float, 2> uv = {0, 0});
// The value of one node.
std::array<float, 4> evaluate_node(const RecordedMaterial& material, int node,
                                   std::array<float, 4> image = {1, 1, 1, 1}, std::array<float, 4> color = {1, 1, 1, 1},
                                   std::array<float, 2> uv = {0, 0});

}  // namespace triptych::test
