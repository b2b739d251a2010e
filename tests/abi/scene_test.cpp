// Scenes: references between items, what a commit says of them, and what it keeps when it fails.
#include "abi/kinds.h"

using namespace trp_test;

namespace {

TEST(SceneCalls, NullArguments) {
    EXPECT_TRUE(fails(trp_scene_create(nullptr), TRP_ERROR_ARGUMENT, {"scene"}));
    trp_scene_destroy(nullptr);
    EXPECT_TRUE(fails(trp_scene_commit(nullptr, 1), TRP_ERROR_ARGUMENT, {"scene"}));
    EXPECT_EQ(trp_scene_warning_count(nullptr), 0u);
    TrpWarning warning{};
    warning.struct_size = sizeof warning;
    EXPECT_TRUE(fails(trp_scene_warning(nullptr, 0, &warning), TRP_ERROR_ARGUMENT, {"scene"}));
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    EXPECT_TRUE(fails(trp_scene_info(nullptr, &info), TRP_ERROR_ARGUMENT, {"scene"}));
    EXPECT_TRUE(fails(trp_scene_set_camera(nullptr, TRP_NO_ID), TRP_ERROR_ARGUMENT, {"scene"}));
}

TEST(SceneCalls, InfoAndWarnings) {
    SmallScene scene;
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    EXPECT_TRUE(fails(trp_scene_info(scene, &info), TRP_ERROR_STATE, {"committed"}));
    EXPECT_EQ(trp_scene_warning_count(scene), 0u);
    EXPECT_TRUE(fails(trp_scene_commit(scene, 100000), TRP_ERROR_ARGUMENT, {"threads is 100000"}));
    MeshData flat = floor_square(1);
    flat.face_materials = {3};
    scene.object(flat);
    scene.commit(1);
    EXPECT_TRUE(fails(trp_scene_info(scene, nullptr), TRP_ERROR_ARGUMENT, {"info"}));
    info.struct_size = 4;
    EXPECT_TRUE(fails(trp_scene_info(scene, &info), TRP_ERROR_ARGUMENT, {"struct_size is 4"}));
    info.struct_size = sizeof info;
    ASSERT_EQ(trp_scene_info(scene, &info), TRP_OK);
    EXPECT_EQ(info.mesh_count, 3u);
    EXPECT_EQ(info.instance_count, 3u);
    EXPECT_EQ(info.material_count, 1u);
    EXPECT_EQ(info.light_count, 1u);
    EXPECT_EQ(info.camera_count, 1u);
    EXPECT_EQ(info.face_count, 8u);
    EXPECT_EQ(info.triangle_count, 16u);
    EXPECT_EQ(info.vertex_count, 16u);
    EXPECT_EQ(info.bounds_min[0], -3);
    EXPECT_EQ(info.bounds_max[2], 1);
    EXPECT_GT(info.mesh_bytes, 0u);
    EXPECT_GE(info.held_bytes, info.mesh_bytes);

    // What is made when it is first needed counts from the next commit on.
    const uint64_t before = info.held_bytes;
    Render(scene, 8, 8, {}, {}, "wireframe").run();
    ASSERT_EQ(trp_scene_commit(scene, 1), TRP_OK);
    ASSERT_EQ(trp_scene_info(scene, &info), TRP_OK);
    EXPECT_GT(info.held_bytes, before + 16 * sizeof(float));

    ASSERT_EQ(trp_scene_warning_count(scene), 1u);
    TrpWarning warning{};
    EXPECT_TRUE(fails(trp_scene_warning(scene, 0, nullptr), TRP_ERROR_ARGUMENT, {"warning"}));
    EXPECT_TRUE(fails(trp_scene_warning(scene, 0, &warning), TRP_ERROR_ARGUMENT, {"struct_size is 0"}));
    warning.struct_size = sizeof warning;
    EXPECT_TRUE(fails(trp_scene_warning(scene, 1, &warning), TRP_ERROR_ARGUMENT, {"1"}));
    ASSERT_EQ(trp_scene_warning(scene, 0, &warning), TRP_OK);
    EXPECT_EQ(warning.code, TRP_WARNING_MATERIAL);
}

// An edit that leaves a reference to nothing: the commit names both ends, and the last snapshot still renders.
void expect_dangling(SmallScene& scene, const std::vector<std::string>& words) {
    const Image before = Render(scene, 40, 24, kFewSamples).run().read();
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    check(trp_scene_info(scene, &info));
    EXPECT_TRUE(fails(trp_scene_commit(scene, 0), TRP_ERROR_ID, words));
    EXPECT_TRUE(fails(trp_scene_commit(scene, 0), TRP_ERROR_ID, words)) << "and again";
    EXPECT_TRUE(same(Render(scene, 40, 24, kFewSamples).run().read(), before));
    TrpSceneInfo after{};
    after.struct_size = sizeof after;
    check(trp_scene_info(scene, &after));
    EXPECT_EQ(after.instance_count, info.instance_count);
}

std::string text(const char* kind, uint32_t id) {
    return std::string(kind) + " " + std::to_string(id);
}

TEST(Dangling, InstanceOfARemovedMesh) {
    SmallScene scene;
    const Image whole = scene.picture();
    ASSERT_EQ(trp_mesh_remove(scene, scene.box_mesh), TRP_OK);
    expect_dangling(scene, {text("instance", scene.box_instance), text("mesh", scene.box_mesh)});
    ASSERT_EQ(trp_instance_remove(scene, scene.box_instance), TRP_OK);
    EXPECT_FALSE(same(scene.picture(), whole));
}

TEST(Dangling, InstanceOfNoMesh) {
    SmallScene scene;
    scene.commit();
    // Not a mesh, and never one.
    const uint32_t lost = scene.instance(scene.red);
    expect_dangling(scene, {text("instance", lost), text("mesh", scene.red)});
}

TEST(Dangling, ImageNodeOfARemovedTexture) {
    SmallScene scene;
    const uint32_t texture = add_valid<TextureKind>(scene);
    TrpNode node;
    check(trp_node_init(&node, TRP_NODE_IMAGE));
    node.texture = texture;
    const uint32_t material = scene.material([&](TrpMaterialDesc& d) {
        d.name = "Painted";
        d.nodes = &node;
        d.node_count = 1;
        d.diffuse.node = 0;
    });
    scene.object(floor_square(1, 0.1f), material);
    scene.commit();
    ASSERT_EQ(trp_texture_remove(scene, texture), TRP_OK);
    expect_dangling(scene, {text("material", material), "\"Painted\"", "nodes[0]", text("texture", texture)});
    ASSERT_EQ(trp_material_remove(scene, material), TRP_OK);
    EXPECT_EQ(trp_scene_commit(scene, 0), TRP_OK) << "a removed material is a warning";
    EXPECT_EQ(trp_scene_warning_count(scene), 1u);
}

TEST(Dangling, WorldOfARemovedTexture) {
    SmallScene scene;
    const uint32_t texture = add_valid<TextureKind>(scene);
    scene.world({1, 1, 1}, [&](TrpWorldDesc& d) { d.texture = texture; });
    scene.commit();
    ASSERT_EQ(trp_texture_remove(scene, texture), TRP_OK);
    expect_dangling(scene, {"world", text("texture", texture)});
}

TEST(Dangling, RemovedCamera) {
    SmallScene scene;
    scene.commit();
    ASSERT_EQ(trp_camera_remove(scene, scene.eye), TRP_OK);
    expect_dangling(scene, {"camera", std::to_string(scene.eye)});
    for (const uint32_t bad : {scene.eye, scene.sun, 12345u})
        EXPECT_TRUE(fails(trp_scene_set_camera(scene, bad), TRP_ERROR_ID, {text("camera", bad)}));
    ASSERT_EQ(trp_scene_set_camera(scene, TRP_NO_ID), TRP_OK);
    EXPECT_EQ(trp_scene_commit(scene, 0), TRP_OK);
}

TEST(Dangling, RemovedMaterialIsGreyWithAWarning) {
    SmallScene scene;
    scene.commit();
    ASSERT_EQ(trp_material_remove(scene, scene.red), TRP_OK);
    scene.commit();
    ASSERT_EQ(trp_scene_warning_count(scene), 1u);
    TrpWarning warning{};
    warning.struct_size = sizeof warning;
    check(trp_scene_warning(scene, 0, &warning));
    EXPECT_EQ(warning.code, TRP_WARNING_MATERIAL);
    EXPECT_EQ(warning.item, scene.box_instance);
    EXPECT_NE(std::string(warning.text).find(text("material", scene.red)), std::string::npos) << warning.text;
    const Image albedo = Render(scene, 40, 24, kFewSamples, {"Albedo"}).run().read("Albedo");
    for (size_t i = 0; i < albedo.values.size(); i += 3) EXPECT_EQ(albedo.values[i], albedo.values[i + 1]);
}

}  // namespace
