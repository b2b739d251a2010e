// The arrays of a mesh: counts, strides, formats, indices and values, each refused by name.
#include "abi/kinds.h"

using namespace trp_test;

namespace {

// A quad with every array there is.
struct FullMesh {
    std::vector<float> positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    std::vector<uint32_t> offsets = {0, 4}, corners = {0, 1, 2, 3}, slots = {0}, materials = {TRP_NO_ID};
    std::vector<uint32_t> edges = {0, 1, 1, 2, 2, 3, 3, 0};
    std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    std::vector<float> uv = {0, 0, 1, 0, 1, 1, 0, 1}, color = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    std::vector<uint8_t> smooth = {1}, flags = {0, 1, 2, 3};
    std::vector<float> edge_creases = {0, 0.5f, 1, 0}, vertex_creases = {0, 0, 0, 1};
    TrpAttribute uv_set = {"UVMap", floats(uv, 2), TRP_DOMAIN_CORNER, 2};
    TrpAttribute color_layer = {"Col", floats(color, 4), TRP_DOMAIN_VERTEX, 4};
    TrpMeshDesc desc{};

    FullMesh() {
        check(trp_mesh_desc_init(&desc, sizeof desc));
        desc.name = "Culprit";
        desc.positions = floats(positions, 3);
        desc.face_offsets = indices(offsets);
        desc.corner_vertices = indices(corners);
        desc.normals = floats(normals, 3);
        desc.normal_domain = TRP_DOMAIN_CORNER;
        desc.uv_sets = &uv_set;
        desc.uv_set_count = 1;
        desc.colors = &color_layer;
        desc.color_count = 1;
        desc.materials = materials.data();
        desc.material_count = 1;
        desc.face_materials = indices(slots);
        desc.face_smooth = {smooth.data(), smooth.size(), 0, TRP_FORMAT_UINT8};
        desc.edges = indices(edges, 2);
        desc.edge_flags = {flags.data(), flags.size(), 0, TRP_FORMAT_UINT8};
        desc.edge_creases = floats(edge_creases, 1);
        desc.vertex_creases = floats(vertex_creases, 1);
    }
    FullMesh(const FullMesh&) = delete;
    FullMesh& operator=(const FullMesh&) = delete;
};

using Change = std::function<void(FullMesh&)>;

testing::AssertionResult refused(const Change& change, std::vector<std::string> words,
                                 TrpStatus status = TRP_ERROR_ARGUMENT) {
    FullMesh mesh;
    change(mesh);
    Scene scene;
    uint32_t id = 77;
    words.emplace_back("mesh \"Culprit\"");
    const auto added = fails(trp_mesh_add(scene, &mesh.desc, &id), status, words);
    if (!added || id != 77) return added;
    // A refused exchange leaves the mesh as it was.
    id = add_valid<MeshKind>(scene);
    words.back() = "mesh " + std::to_string(id) + " \"Culprit\"";
    const auto replaced = fails(trp_mesh_replace(scene, id, &mesh.desc), status, words);
    if (!replaced) return replaced;
    scene.instance(id);
    scene.commit();
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    check(trp_scene_info(scene, &info));
    if (info.vertex_count != 3) return testing::AssertionFailure() << "the mesh was changed";
    return testing::AssertionSuccess();
}

struct ArrayField {
    const char* name;
    TrpArray& (*of)(FullMesh&);
    uint32_t packed;  // bytes of an element
};
const ArrayField kArrays[] = {
    {"positions", [](FullMesh& m) -> TrpArray& { return m.desc.positions; }, 12},
    {"face_offsets", [](FullMesh& m) -> TrpArray& { return m.desc.face_offsets; }, 4},
    {"corner_vertices", [](FullMesh& m) -> TrpArray& { return m.desc.corner_vertices; }, 4},
    {"normals", [](FullMesh& m) -> TrpArray& { return m.desc.normals; }, 12},
    {"uv_sets[0]", [](FullMesh& m) -> TrpArray& { return m.uv_set.values; }, 8},
    {"colors[0]", [](FullMesh& m) -> TrpArray& { return m.color_layer.values; }, 16},
    {"face_materials", [](FullMesh& m) -> TrpArray& { return m.desc.face_materials; }, 4},
    {"face_smooth", [](FullMesh& m) -> TrpArray& { return m.desc.face_smooth; }, 1},
    {"edges", [](FullMesh& m) -> TrpArray& { return m.desc.edges; }, 8},
    {"edge_flags", [](FullMesh& m) -> TrpArray& { return m.desc.edge_flags; }, 1},
    {"edge_creases", [](FullMesh& m) -> TrpArray& { return m.desc.edge_creases; }, 4},
    {"vertex_creases", [](FullMesh& m) -> TrpArray& { return m.desc.vertex_creases; }, 4},
};

TEST(Mesh, WholeIsTaken) {
    FullMesh mesh;
    Scene scene;
    uint32_t id = 0;
    ASSERT_EQ(trp_mesh_add(scene, &mesh.desc, &id), TRP_OK) << trp_error_message();
    scene.instance(id);
    scene.commit();
    EXPECT_EQ(trp_scene_warning_count(scene), 0u);
}

TEST(Mesh, EveryArray) {
    for (const ArrayField& field : kArrays) {
        SCOPED_TRACE(field.name);
        EXPECT_TRUE(refused([&](FullMesh& m) { field.of(m).data = nullptr; }, {field.name, "null"}));
        if (field.packed > 1) {
            EXPECT_TRUE(refused([&](FullMesh& m) { field.of(m).stride = field.packed - 1; },
                                {field.name, "stride is " + std::to_string(field.packed - 1)}));
        }
        for (const int32_t format : {-1, 5, 1 << 30})
            EXPECT_TRUE(refused([&](FullMesh& m) { field.of(m).format = format; },
                                {field.name, "format", std::to_string(format)}));
        EXPECT_TRUE(refused([&](FullMesh& m) { field.of(m).count = uint64_t{1} << 33; }, {field.name, "8589934592"},
                            TRP_ERROR_MEMORY));
    }
}

TEST(Mesh, WrongFormats) {
    const auto give = [](const char* name, int32_t format) {
        return refused(
            [&](FullMesh& m) {
                for (const ArrayField& field : kArrays)
                    if (std::string(field.name) == name) {
                        TrpArray& array = field.of(m);
                        // As many bytes as the wrong format could ask for.
                        static const std::vector<float> zeros(64);
                        array.data = zeros.data();
                        array.format = format;
                    }
            },
            {name});
    };
    for (const char* floating : {"positions", "normals", "uv_sets[0]", "colors[0]", "edge_creases", "vertex_creases"})
        for (const int32_t format : {TRP_FORMAT_UINT8, TRP_FORMAT_UINT16, TRP_FORMAT_UINT32, TRP_FORMAT_INT32})
            EXPECT_TRUE(give(floating, format)) << floating << " as " << format;
    for (const char* whole : {"face_offsets", "corner_vertices", "face_materials", "edges"})
        EXPECT_TRUE(give(whole, TRP_FORMAT_FLOAT32)) << whole;
    for (const char* bytes : {"face_smooth", "edge_flags"})
        for (const int32_t format : {TRP_FORMAT_FLOAT32, TRP_FORMAT_UINT16, TRP_FORMAT_INT32})
            EXPECT_TRUE(give(bytes, format)) << bytes << " as " << format;
}

TEST(Mesh, WrongCounts) {
    // One too few: with one too many the test itself would have to own more.
    for (const char* name : {"normals", "uv_sets[0]", "colors[0]", "edge_flags", "edge_creases", "vertex_creases"})
        for (const ArrayField& field : kArrays)
            if (std::string(field.name) == name) {
                EXPECT_TRUE(refused([&](FullMesh& m) { --field.of(m).count; }, {name, "3 elements", "4"}));
            }
    EXPECT_TRUE(refused(
        [](FullMesh& m) {
            m.slots = {0, 0}, m.desc.face_materials = indices(m.slots);
        },
        {"face_materials", "2 elements", "1"}));
    EXPECT_TRUE(refused(
        [](FullMesh& m) {
            m.smooth = {0, 0}, m.desc.face_smooth = {m.smooth.data(), 2, 0, 1};
        },
        {"face_smooth", "2 elements", "1"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.edges.count = 0; }, {"edge_flags", "4 elements", "0"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.normal_domain = TRP_DOMAIN_VERTEX, m.desc.normals.count = 2; },
                        {"normals", "2 elements", "4"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.time_count = 3; }, {"positions", "4", "3"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.time_count = 0; }, {"time_count is 0"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.time_count = ~0u; }, {"time_count", "4294967295"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.face_offsets = {}; }, {"4 corner_vertices", "triangles"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.uv_sets = nullptr; }, {"uv_sets is null", "1"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.colors = nullptr; }, {"colors is null", "1"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.materials = nullptr; }, {"materials is null", "1"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.material_count = 70000; }, {"material_count", "70000"}));
}

TEST(Mesh, IndicesOutOfRange) {
    EXPECT_TRUE(refused([](FullMesh& m) { m.corners[2] = 4; }, {"corner_vertices[2] is 4", "4 vertices"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.corners[0] = ~0u; }, {"corner_vertices[0] is 4294967295"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.edges[5] = 9; }, {"edges[2] is 9"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.offsets[1] = 5; }, {"face_offsets[1] is 5"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.offsets[1] = 3; }, {"face_offsets", "from 0 to 3", "4 corners"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.offsets[0] = 1; }, {"face_offsets", "from 1 to 4"}));
    EXPECT_TRUE(refused(
        [](FullMesh& m) {
            m.offsets = {0, 3, 1, 4};
            m.desc.face_offsets = indices(m.offsets);
        },
        {"face_offsets[2] is 1"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.slots[0] = 65535; }, {"face_materials[0] is 65535"}));
    static const int32_t negative[] = {0, -1, 2, 3};
    EXPECT_TRUE(refused(
        [](FullMesh& m) {
            m.desc.corner_vertices = {negative, 4, 0, TRP_FORMAT_INT32};
        },
        {"corner_vertices[1] is -1"}));
    EXPECT_TRUE(refused(
        [](FullMesh& m) {
            m.desc.face_materials = {negative + 1, 1, 0, TRP_FORMAT_INT32};
        },
        {"face_materials[0] is -1"}));
    static const uint8_t bytes[] = {0, 1, 2, 200};
    EXPECT_TRUE(refused(
        [](FullMesh& m) {
            m.desc.corner_vertices = {bytes, 4, 0, TRP_FORMAT_UINT8};
        },
        {"corner_vertices[3] is 200"}));
    static const uint16_t shorts[] = {0, 1, 40000, 3};
    EXPECT_TRUE(refused(
        [](FullMesh& m) {
            m.desc.corner_vertices = {shorts, 4, 0, TRP_FORMAT_UINT16};
        },
        {"corner_vertices[2] is 40000"}));
}

TEST(Mesh, NotNumbers) {
    const auto spoil = [](std::vector<float> FullMesh::*array, size_t at, const char* word) {
        for (const float bad : {kNaN, kInfinity, -kInfinity})
            EXPECT_TRUE(refused([&](FullMesh& m) { (m.*array)[at] = bad; }, {word, std::isnan(bad) ? "nan" : "inf"}));
    };
    spoil(&FullMesh::positions, 11, "positions[3]");
    spoil(&FullMesh::normals, 0, "normals[0]");
    spoil(&FullMesh::uv, 3, "uv_sets[0][1]");
    spoil(&FullMesh::color, 15, "colors[0][3]");
    spoil(&FullMesh::edge_creases, 1, "edge_creases[1]");
    spoil(&FullMesh::vertex_creases, 2, "vertex_creases[2]");
}

TEST(Mesh, Layers) {
    EXPECT_TRUE(refused([](FullMesh& m) { m.uv_set.components = 3; }, {"uv_sets[0].components is 3"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.color_layer.components = 2; }, {"colors[0].components is 2"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.color_layer.components = -1; }, {"colors[0].components is -1"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.uv_set.domain = 2; }, {"uv_sets[0].domain is 2"}));
    EXPECT_TRUE(refused([](FullMesh& m) { m.desc.normal_domain = -1; }, {"normal_domain is -1"}));
    FullMesh mesh;
    mesh.uv_set.name = mesh.color_layer.name = mesh.desc.name = nullptr;
    Scene scene;
    uint32_t id = 0;
    EXPECT_EQ(trp_mesh_add(scene, &mesh.desc, &id), TRP_OK) << "names are optional";
}

// The same mesh in every layout that clients keep.
TEST(Mesh, StridesAndFormatsAgree) {
    SmallScene scene;
    const MeshData data = SmallScene::with_material(box(0.5f), scene.red);
    const Image expected = scene.picture();
    const auto shown_as = [&](const std::function<void(TrpMeshDesc&)>& change) {
        TrpMeshDesc desc = Scene::mesh_desc(data);
        change(desc);
        check(trp_mesh_replace(scene, scene.box_mesh, &desc));
        return same(scene.picture(), expected);
    };
    std::vector<float> padded(8 * 5, kNaN);
    for (size_t v = 0; v < 8; ++v) std::copy_n(&data.positions[3 * v], 3, &padded[5 * v]);
    EXPECT_TRUE(shown_as([&](TrpMeshDesc& d) { d.positions = {padded.data(), 8, 20, TRP_FORMAT_FLOAT32}; }));
    const std::vector<uint8_t> bytes(data.corners.begin(), data.corners.end());
    EXPECT_TRUE(shown_as([&](TrpMeshDesc& d) { d.corner_vertices = {bytes.data(), 24, 0, TRP_FORMAT_UINT8}; }));
    const std::vector<uint16_t> shorts(data.corners.begin(), data.corners.end());
    EXPECT_TRUE(shown_as([&](TrpMeshDesc& d) { d.corner_vertices = {shorts.data(), 24, 0, TRP_FORMAT_UINT16}; }));
    std::vector<int32_t> strided(48, -1);
    for (size_t i = 0; i < 24; ++i) strided[2 * i] = static_cast<int32_t>(data.corners[i]);
    EXPECT_TRUE(shown_as([&](TrpMeshDesc& d) { d.corner_vertices = {strided.data(), 24, 8, TRP_FORMAT_INT32}; }));
    // The caller's arrays are not kept.
    MeshData gone = data;
    TrpMeshDesc desc = Scene::mesh_desc(gone);
    check(trp_mesh_replace(scene, scene.box_mesh, &desc));
    std::fill(gone.positions.begin(), gone.positions.end(), kNaN);
    std::fill(gone.corners.begin(), gone.corners.end(), 12345u);
    EXPECT_TRUE(same(scene.picture(), expected));
}

}  // namespace
