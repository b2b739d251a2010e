// Scenes with little in them, and meshes that modelling programs leave behind: rendered as far as they make sense, with
// a warning that names the item.
#include "abi/expect.h"

using namespace trp_test;

namespace {

std::vector<TrpWarning> warnings_of(TrpScene* scene) {
    std::vector<TrpWarning> out(trp_scene_warning_count(scene));
    for (uint32_t i = 0; i < out.size(); ++i) {
        out[i].struct_size = sizeof(TrpWarning);
        check(trp_scene_warning(scene, i, &out[i]));
        EXPECT_STRNE(out[i].text, "");
        EXPECT_EQ(std::string(out[i].text).find('\n'), std::string::npos);
    }
    return out;
}

TEST(Geometry, EmptyScene) {
    Scene scene;
    scene.camera_above(4);
    scene.commit();
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    check(trp_scene_info(scene, &info));
    EXPECT_EQ(info.triangle_count, 0u);
    EXPECT_GT(info.bounds_min[0], info.bounds_max[0]);
    EXPECT_TRUE(warnings_of(scene).empty());
    const Image black = Render(scene, 16, 16, kFewSamples).run().read();
    for (uint32_t y = 0; y < 16; ++y)
        for (uint32_t x = 0; x < 16; ++x) EXPECT_EQ(black.at(x, y)[0], 0);
    scene.world({0.25f, 0.5f, 1});
    const Image sky = render(scene, 16, 16, kFewSamples);
    EXPECT_NEAR(sky.at(8, 8)[0], 0.25, 1e-6);
    EXPECT_NEAR(sky.at(8, 8)[2], 1, 1e-6);
}

// Nothing of the mesh is seen, and nothing else is lost.
void expect_invisible(const MeshData& data, const std::function<void(TrpMeshDesc&)>& change, bool warned) {
    SmallScene scene;
    const Image before = scene.picture();
    const uint32_t mesh = scene.mesh(data, change);
    scene.instance(mesh);
    scene.instance(mesh, translation({0, 0, 1}));
    EXPECT_TRUE(same(scene.picture(), before));
    const auto warnings = warnings_of(scene);
    ASSERT_EQ(warnings.size(), warned ? 1u : 0u);
    if (!warned) return;
    EXPECT_EQ(warnings[0].code, TRP_WARNING_MESH);
    EXPECT_EQ(warnings[0].item, mesh);
    EXPECT_NE(std::string(warnings[0].text).find("mesh " + std::to_string(mesh)), std::string::npos);
}

TEST(Geometry, MeshOfNothing) {
    expect_invisible({}, {}, false);
}

TEST(Geometry, MeshWithoutFaces) {
    MeshData data = floor_square(1, 0.5f);
    data.offsets.clear();
    data.corners.clear();
    data.uvs.clear();
    expect_invisible(data, {}, false);
    data.offsets = {0};
    expect_invisible(data, {}, false);
}

TEST(Geometry, LooseEdgesOnly) {
    MeshData data = floor_square(1, 0.5f);
    data.offsets.clear();
    data.corners.clear();
    data.uvs.clear();
    const std::vector<uint32_t> edges = {0, 1, 1, 2, 2, 2};
    expect_invisible(
        data, [&](TrpMeshDesc& d) { d.edges = indices(edges, 2); }, false);
}

TEST(Geometry, FacesWithoutArea) {
    MeshData data;
    data.positions = {0, 0, 1, 1, 0, 1, 2, 0, 1, 3, 0, 1};
    data.corners = {0, 1, 2, 1, 2, 3};
    expect_invisible(data, {}, true);  // triangles on a line
    data.offsets = {0, 3, 7};
    data.corners = {0, 1, 2, 0, 1, 2, 3};
    expect_invisible(data, {}, true);  // a quad too
    data.offsets = {0, 2, 3, 3, 7};
    data.corners = {0, 1, 2, 1, 1, 2, 2};
    expect_invisible(data, {}, true);  // two corners, one, none, and two vertices twice
}

TEST(Geometry, RepeatedVerticesOfAFace) {
    // A quad with a vertex twice is a triangle; the whole one beside it stays.
    Scene scene;
    MeshData data;
    data.positions = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    data.offsets = {0, 4, 8};
    data.corners = {0, 1, 1, 2, 0, 2, 3, 0};
    scene.object(data);
    scene.camera_above(4);
    scene.world({1, 1, 1}, [](TrpWorldDesc& d) { d.visible_camera = 0; });
    scene.commit();
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    check(trp_scene_info(scene, &info));
    EXPECT_EQ(info.triangle_count, 2u);
    EXPECT_TRUE(warnings_of(scene).empty());
    Render render(scene, 32, 32, {{"samples", "1"}, {"film.filter_width", "0"}}, {"Albedo"});
    EXPECT_NEAR(mean(render.run().read("Albedo")), 0.8 / 4, 1e-6) << "a square of a quarter of the film";
}

TEST(Geometry, DeletedMaterialSlots) {
    Scene scene;
    const uint32_t red = scene.diffuse(0.5f, 0, 0);
    MeshData data = floor_square(1);
    const MeshData right = quad({1, -1, 0}, {3, -1, 0}, {3, 1, 0}, {1, 1, 0});
    data.positions.insert(data.positions.end(), right.positions.begin(), right.positions.end());
    data.uvs.clear();
    data.offsets = {0, 4, 8};
    data.corners = {0, 1, 2, 3, 4, 5, 6, 7};
    data.materials = {red};
    data.face_materials = {0, 7};
    const uint32_t instance = scene.object(data);
    scene.camera_above(8);
    scene.commit();
    const auto warnings = warnings_of(scene);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].code, TRP_WARNING_MATERIAL);
    EXPECT_EQ(warnings[0].item, instance);
    EXPECT_NE(std::string(warnings[0].text).find("slot 7"), std::string::npos) << warnings[0].text;
    const Image albedo = Render(scene, 32, 32, kFewSamples, {"Albedo"}).run().read("Albedo");
    EXPECT_NEAR(albedo.at(16, 16)[0], 0.5, 1e-6);
    EXPECT_EQ(albedo.at(16, 16)[1], 0);
    EXPECT_NEAR(albedo.at(24, 16)[0], 0.8, 1e-6) << "grey stands in";
    EXPECT_NEAR(albedo.at(24, 16)[1], 0.8, 1e-6);
}

// Transforms that flatten, alone and beside an instance that is whole.
TEST(Geometry, FlattenedInstances) {
    SmallScene scene;
    scene.light(TRP_LIGHT_AREA, {1, 1, 1}, translation({0, 0, 4}));
    const uint32_t ball = scene.mesh(sphere({0, 0, 0}, 0.5f, 96));  // large, so that it is instanced and not copied
    const Transform point{}, sheet = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1}, line = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2};
    for (const Transform& flat : {point, sheet, line}) {
        const uint32_t a = scene.instance(ball, flat);
        for (const float value : scene.picture().values) ASSERT_TRUE(std::isfinite(value));
        const uint32_t b = scene.instance(ball, translation({1, 1, 1}));
        for (const float value : scene.picture().values) ASSERT_TRUE(std::isfinite(value));
        check(trp_instance_remove(scene, a));
        check(trp_instance_remove(scene, b));
    }
}

// Nothing but objects without extent, several of them in one place.
TEST(Geometry, CollapsedObjects) {
    Scene scene;
    scene.camera_above(4);
    scene.light(TRP_LIGHT_SUN, {1, 1, 1}, translation({0, 0, 4}));
    const Transform point = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    MeshData heap = box(1);
    std::fill(heap.positions.begin(), heap.positions.end(), 0.5f);
    const uint32_t shared = scene.mesh(box(1));
    for (int i = 0; i < 3; ++i) {
        scene.object(box(1), TRP_NO_ID, point);
        scene.object(heap);
        scene.instance(shared, point);
    }
    for (const float value : render(scene, 16, 16, kFewSamples).values) ASSERT_TRUE(value == 0 || value == 1);
}

// Coordinates whose squares overflow: whatever is seen, it is seen in finite numbers.
TEST(Geometry, HugeAndTinyMeshes) {
    for (const float size : {1e-30f, 1e-12f, 1e12f, 1e20f, 1e30f, 3e38f}) {
        SmallScene scene;
        scene.object(floor_square(size, 0.25f), scene.red);
        scene.object(box(size), scene.red, translation({2, 2, 0}));
        for (const float value : scene.picture().values) ASSERT_TRUE(std::isfinite(value)) << size;
    }
}

}  // namespace
