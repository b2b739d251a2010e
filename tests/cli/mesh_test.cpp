// Meshes: every way in which glTF can store vertices and faces. SPDX-License-Identifier: Apache-2.0
#include "loading.h"

namespace triptych::test {
namespace {

const Square square;

json square_attributes(GltfBuilder& builder) {
    return {{"POSITION", builder.accessor(square.positions, float_type, "VEC3")}};
}

TEST(Mesh, PlainIndexed) {
    for (const char* name : {"scene.glb", "scene.gltf"}) {
        GltfBuilder builder;
        json attributes = square_attributes(builder);
        attributes["NORMAL"] = builder.accessor(square.normals, float_type, "VEC3");
        builder.add_mesh_node(
            {{"attributes", attributes}, {"indices", builder.accessor(square.indices, ushort_type, "SCALAR")}});
        const Loaded loaded = load(builder, name);
        ASSERT_EQ(loaded->meshes.size(), 1u);
        const RecordedMesh& mesh = loaded->meshes[0];
        EXPECT_EQ(mesh.positions, square.positions);
        EXPECT_EQ(mesh.normals, square.normals);
        EXPECT_EQ(mesh.normal_domain, TRP_DOMAIN_VERTEX);
        EXPECT_EQ(mesh.corners, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
        EXPECT_EQ(mesh.corner_format, TRP_FORMAT_UINT16) << "indices are handed on in place";
        EXPECT_TRUE(mesh.face_offsets.empty());
        EXPECT_EQ(mesh.materials, std::vector<uint32_t>{TRP_NO_ID});
        ASSERT_EQ(loaded->instances.size(), 1u);
        // Y up becomes Z up on the transform.
        EXPECT_EQ(loaded->instances[0].world, (std::array<float, 12>{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0}));
    }
}

TEST(Mesh, IndexTypes) {
    const std::vector<uint8_t> bytes(square.indices.begin(), square.indices.end());
    const std::vector<uint32_t> words(square.indices.begin(), square.indices.end());
    for (const int type : {ubyte_type, uint_type}) {
        GltfBuilder builder;
        const int indices =
            type == ubyte_type ? builder.accessor(bytes, type, "SCALAR") : builder.accessor(words, type, "SCALAR");
        builder.add_mesh_node({{"attributes", square_attributes(builder)}, {"indices", indices}});
        EXPECT_EQ(load(builder)->meshes[0].corners, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    }
    GltfBuilder builder;
    const std::vector<float> two = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1};
    builder.add_mesh_node({{"attributes", {{"POSITION", builder.accessor(two, float_type, "VEC3")}}}});
    const Loaded loaded = load(builder);
    EXPECT_EQ(loaded->meshes[0].corners, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
    EXPECT_TRUE(loaded->meshes[0].normals.empty()) << "a mesh without normals is flat";
    EXPECT_TRUE(loaded->meshes[0].face_smooth.empty());
}

TEST(Mesh, InterleavedWithStride) {
    GltfBuilder builder;
    std::vector<float> interleaved;
    for (size_t i = 0; i < 4; ++i) {
        for (size_t k = 0; k < 3; ++k) interleaved.push_back(square.positions[3 * i + k]);
        for (size_t k = 0; k < 3; ++k) interleaved.push_back(square.normals[3 * i + k]);
        for (size_t k = 0; k < 2; ++k) interleaved.push_back(square.uvs[2 * i + k]);
    }
    const int view = builder.view(interleaved, 32);
    builder.add_mesh_node({{"attributes",
                            {{"POSITION", builder.accessor_at(view, 0, 4, float_type, "VEC3")},
                             {"NORMAL", builder.accessor_at(view, 12, 4, float_type, "VEC3")},
                             {"TEXCOORD_0", builder.accessor_at(view, 24, 4, float_type, "VEC2")}}},
                           {"indices", builder.accessor(square.indices, ushort_type, "SCALAR")}});
    const Loaded loaded = load(builder);
    const RecordedMesh& mesh = loaded->meshes[0];
    EXPECT_EQ(mesh.positions, square.positions);
    EXPECT_EQ(mesh.normals, square.normals);
    ASSERT_EQ(mesh.uv_sets.size(), 1u);
    EXPECT_EQ(mesh.uv_sets[0].name, "TEXCOORD_0");
    expect_near(mesh.uv_sets[0].values, {0, 1, 1, 1, 1, 0, 0, 0.25f});
}

TEST(Mesh, Quantized) {
    GltfBuilder builder;
    builder.root["extensionsUsed"] = builder.root["extensionsRequired"] = json::array({"KHR_mesh_quantization"});
    // A short and a byte type, padded to strides of 8 and 4.
    const std::vector<int16_t> positions = {-32767, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, -32768, 0};
    const std::vector<int8_t> normals = {0, 0, 127, 0, 0, 0, -128, 0, 127, 0, 0, 0};
    const std::vector<uint16_t> uvs = {0, 0, 65535, 0, 0, 65535};
    const int position = builder.accessor_at(builder.view(positions, 8), 0, 3, short_type, "VEC3");
    const int normal = builder.accessor_at(builder.view(normals, 4), 0, 3, byte_type, "VEC3");
    builder.root["accessors"][static_cast<size_t>(position)]["normalized"] = true;
    builder.root["accessors"][static_cast<size_t>(normal)]["normalized"] = true;
    builder.add_mesh_node({{"attributes",
                            {{"POSITION", position},
                             {"NORMAL", normal},
                             {"TEXCOORD_0", builder.accessor(uvs, ushort_type, "VEC2", true)}}}});
    const Loaded loaded = load(builder);
    expect_near(loaded->meshes[0].positions, {-1, 0, 0, 1, 0, 0, 0, 1, -1});
    expect_near(loaded->meshes[0].normals, {0, 0, 1, 0, 0, -1, 1, 0, 0});
    expect_near(loaded->meshes[0].uv_sets[0].values, {0, 1, 1, 1, 0, 0});
}

TEST(Mesh, QuantizedWithoutNormalizing) {
    GltfBuilder builder;
    const std::vector<uint8_t> positions = {0, 0, 0, 0, 200, 0, 0, 0, 0, 3, 255, 0};
    builder.add_mesh_node(
        {{"attributes", {{"POSITION", builder.accessor_at(builder.view(positions, 4), 0, 3, ubyte_type, "VEC3")}}}});
    expect_near(load(builder)->meshes[0].positions, {0, 0, 0, 200, 0, 0, 0, 3, 255});
}

TEST(Mesh, Sparse) {
    GltfBuilder builder;
    const int position = builder.accessor(square.positions, float_type, "VEC3");
    const std::vector<uint16_t> indices = {1, 3};
    const std::vector<float> values = {5, 6, 7, 8, 9, 10};
    const json sparse = {{"count", 2},
                         {"indices", {{"bufferView", builder.view(indices)}, {"componentType", ushort_type}}},
                         {"values", {{"bufferView", builder.view(values)}}}};
    builder.root["accessors"][static_cast<size_t>(position)]["sparse"] = sparse;
    // Normals from nothing but substitutes: the rest is zero.
    const int normal =
        builder.add("accessors", {{"count", 4}, {"componentType", float_type}, {"type", "VEC3"}, {"sparse", sparse}});
    builder.add_mesh_node({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                           {"indices", builder.accessor(square.indices, ushort_type, "SCALAR")}});
    const Loaded loaded = load(builder);
    expect_near(loaded->meshes[0].positions, {0, 0, 0, 5, 6, 7, 1, 1, 0, 8, 9, 10});
    expect_near(loaded->meshes[0].normals, {0, 0, 0, 5, 6, 7, 0, 0, 0, 8, 9, 10});
}

TEST(Mesh, StripAndFan) {
    GltfBuilder builder;
    const json attributes = square_attributes(builder);
    const std::vector<uint16_t> order = {0, 1, 2, 3, 3};
    const int indices = builder.accessor(order, ushort_type, "SCALAR");
    builder.add_mesh_node({{"attributes", attributes}, {"indices", indices}, {"mode", 5}});
    builder.add_mesh_node({{"attributes", attributes}, {"indices", indices}, {"mode", 6}});
    const Loaded loaded = load(builder);
    // The triangles with a vertex twice join strips, and are no faces.
    EXPECT_EQ(loaded->meshes[0].corners, (std::vector<uint32_t>{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(loaded->meshes[1].corners, (std::vector<uint32_t>{1, 2, 0, 2, 3, 0}));
}

TEST(Mesh, LinesAndPoints) {
    GltfBuilder builder;
    const json attributes = square_attributes(builder);
    builder.add_mesh_node({{"attributes", attributes}, {"mode", 1}});
    builder.add_mesh_node({{"attributes", attributes}, {"mode", 2}});
    builder.add_mesh_node({{"attributes", attributes}, {"mode", 3}});
    builder.add_mesh_node({{"attributes", attributes}, {"mode", 0}});
    const Loaded loaded = load(builder);
    ASSERT_EQ(loaded->meshes.size(), 3u);
    EXPECT_EQ(loaded->meshes[0].edges, (std::vector<uint32_t>{0, 1, 2, 3}));
    EXPECT_EQ(loaded->meshes[1].edges, (std::vector<uint32_t>{0, 1, 1, 2, 2, 3, 3, 0}));
    EXPECT_EQ(loaded->meshes[2].edges, (std::vector<uint32_t>{0, 1, 1, 2, 2, 3}));
    EXPECT_TRUE(loaded->meshes[0].corners.empty());
    EXPECT_TRUE(loaded.warns("meshes[3].primitives[0]: points are not rendered"));
}

TEST(Mesh, NgonsAreJoined) {
    GltfBuilder builder;
    builder.root["extensionsUsed"] = json::array({"FB_ngon_encoding"});
    std::vector<float> positions;
    for (int i = 0; i < 9; ++i)
        positions.insert(positions.end(), {static_cast<float>(i % 3), static_cast<float>(i / 3), 0.0f});
    // A quad, a pentagon, a triangle.
    const std::vector<uint16_t> indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 8, 1, 8, 4, 3, 4, 6};
    builder.add_mesh_node({{"attributes", {{"POSITION", builder.accessor(positions, float_type, "VEC3")}}},
                           {"indices", builder.accessor(indices, ushort_type, "SCALAR")},
                           {"extensions", {{"FB_ngon_encoding", json::object()}}}});
    const Loaded loaded = load(builder);
    EXPECT_EQ(loaded->meshes[0].face_offsets, (std::vector<uint32_t>{0, 4, 9, 12}));
    EXPECT_EQ(loaded->meshes[0].corners, (std::vector<uint32_t>{0, 1, 4, 3, 1, 2, 5, 8, 4, 3, 4, 6}));
}

TEST(Mesh, PrimitivesBecomeSlots) {
    GltfBuilder builder;
    builder.add("materials", {{"name", "first"}});
    builder.add("materials", {{"name", "second"}});
    json with_normals = square_attributes(builder);
    with_normals["NORMAL"] = builder.accessor(square.normals, float_type, "VEC3");
    with_normals["TEXCOORD_0"] = builder.accessor(square.uvs, float_type, "VEC2");
    const int indices = builder.accessor(square.indices, ushort_type, "SCALAR");
    const json primitives =
        json::array({{{"attributes", with_normals}, {"indices", indices}, {"material", 1}},
                     {{"attributes", square_attributes(builder)}, {"indices", indices}, {"material", 0}}});
    const int mesh = builder.add("meshes", {{"name", "two"}, {"primitives", primitives}});
    builder.add_node({{"mesh", mesh}});
    const Loaded loaded = load(builder);
    ASSERT_EQ(loaded->meshes.size(), 1u);
    const RecordedMesh& merged = loaded->meshes[0];
    EXPECT_EQ(merged.corners, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}));
    EXPECT_EQ(merged.face_materials, (std::vector<uint32_t>{0, 0, 1, 1}));
    EXPECT_EQ(merged.face_smooth, (std::vector<uint32_t>{1, 1, 0, 0})) << "faces without normals stay flat";
    EXPECT_EQ(loaded->materials[merged.materials[0] - 1].name, "second");
    EXPECT_EQ(loaded->materials[merged.materials[1] - 1].name, "first");
    expect_near(merged.uv_sets[0].values, {0, 1, 1, 1, 1, 0, 0, 0.25f, 0, 0, 0, 0, 0, 0, 0, 0});
}

TEST(Mesh, MergedIndicesStayInTheirPrimitive) {
    GltfBuilder builder;
    const json good = {{"attributes", square_attributes(builder)}};
    const std::vector<uint16_t> beyond = {0, 1, 4};
    const json bad = {{"attributes", square_attributes(builder)},
                      {"indices", builder.accessor(beyond, ushort_type, "SCALAR")}};
    builder.add_node({{"mesh", builder.add("meshes", {{"primitives", json::array({bad, good})}})}});
    EXPECT_CONTAINS(error_of(builder), "index 4 is not below 4");
}

TEST(Mesh, VertexColors) {
    for (const int type : {float_type, ubyte_type, ushort_type}) {
        GltfBuilder builder;
        json attributes = square_attributes(builder);
        if (type == float_type) {
            attributes["COLOR_0"] = builder.accessor(std::vector<float>(12, 0.5f), type, "VEC3");
        } else if (type == ubyte_type) {
            attributes["COLOR_0"] = builder.accessor(std::vector<uint8_t>(16, 51), type, "VEC4", true);
        } else {
            attributes["COLOR_0"] = builder.accessor(std::vector<uint16_t>(16, 13107), type, "VEC4", true);
        }
        builder.add_mesh_node(
            {{"attributes", attributes}, {"indices", builder.accessor(square.indices, ushort_type, "SCALAR")}});
        const Loaded loaded = load(builder);
        ASSERT_EQ(loaded->meshes[0].colors.size(), 1u);
        EXPECT_EQ(loaded->meshes[0].colors[0].name, "COLOR_0");
        EXPECT_EQ(loaded->meshes[0].colors[0].components, type == float_type ? 3 : 4);
        for (const float value : loaded->meshes[0].colors[0].values)
            EXPECT_NEAR(value, type == float_type ? 0.5 : 0.2, 1e-6);
    }
}

TEST(Mesh, MorphDefaultsAndSkin) {
    GltfBuilder builder;
    json primitive = {{"attributes", square_attributes(builder)},
                      {"indices", builder.accessor(square.indices, ushort_type, "SCALAR")}};
    const std::vector<float> offsets = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    primitive["targets"] = json::array({{{"POSITION", builder.accessor(offsets, float_type, "VEC3")}}});
    const int mesh = builder.add("meshes", {{"primitives", json::array({primitive})}, {"weights", {0.5}}});
    builder.add_node({{"mesh", mesh}, {"skin", builder.add("skins", {{"joints", {0}}})}});
    const Loaded loaded = load(builder);
    EXPECT_NEAR(loaded->meshes[0].positions[2], 1.0f, 1e-6f);
    EXPECT_TRUE(loaded.warns("morph targets stay at their default weights"));
    EXPECT_TRUE(loaded.warns("its skin stays in the rest pose"));
}

TEST(Mesh, Mistakes) {
    {
        GltfBuilder builder;
        const json attributes = square_attributes(builder);
        builder.root["accessors"][0]["count"] = 5;
        builder.add_mesh_node({{"attributes", attributes}});
        EXPECT_CONTAINS(error_of(builder), "meshes[0].primitives[0].POSITION (accessors[0]): 5 elements reach beyond");
    }
    {
        GltfBuilder builder;
        builder.add("accessors", {{"count", 4000000000u}, {"componentType", float_type}, {"type", "VEC3"}});
        builder.add_mesh_node({{"attributes", {{"POSITION", 0}}}});
        EXPECT_CONTAINS(error_of(builder), "4000000000 elements without a bufferView");
    }
    {
        GltfBuilder builder;
        const json attributes = square_attributes(builder);
        builder.root["bufferViews"][0]["byteLength"] = 1u << 30;
        builder.add_mesh_node({{"attributes", attributes}});
        EXPECT_CONTAINS(error_of(builder), "bufferViews[0] reaches beyond the end of buffers[0]");
    }
    {
        GltfBuilder builder;
        builder.add_mesh_node({{"attributes", {{"POSITION", 7}}}});
        EXPECT_CONTAINS(error_of(builder), "meshes[0].primitives[0].attributes.POSITION: there is no accessors[7]");
    }
    {
        GltfBuilder builder;
        json attributes = square_attributes(builder);
        attributes["NORMAL"] = builder.accessor(std::vector<float>(9), float_type, "VEC3");
        builder.add_mesh_node({{"attributes", attributes}});
        EXPECT_CONTAINS(error_of(builder), "3 elements for 4 vertices");
    }
}

}  // namespace
}  // namespace triptych::test
