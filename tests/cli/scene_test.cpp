// Nodes, lights, cameras, worlds, and what the whole file says. SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "framing.h"
#include "loading.h"

namespace triptych::test {
namespace {

const Square square;

struct SquareScene : GltfBuilder {
    int mesh;
    explicit SquareScene(json node = json::object()) {
        mesh = add_mesh_node({{"attributes", {{"POSITION", accessor(square.positions, float_type, "VEC3")}}},
                              {"indices", accessor(square.indices, ushort_type, "SCALAR")}},
                             std::move(node));
    }
};

std::array<float, 3> image_of(const std::array<float, 12>& m, float x, float y, float z) {
    std::array<float, 3> result;
    for (size_t row = 0; row < 3; ++row)
        result[row] = m[4 * row] * x + m[4 * row + 1] * y + m[4 * row + 2] * z + m[4 * row + 3];
    return result;
}

void expect_point(const std::array<float, 3>& point, float x, float y, float z) {
    EXPECT_NEAR(point[0], x, 1e-5f);
    EXPECT_NEAR(point[1], y, 1e-5f);
    EXPECT_NEAR(point[2], z, 1e-5f);
}

TEST(Scene, TransformsOfNodes) {
    const double half = std::sqrt(0.5);
    // Turned a quarter about Y (z to x), doubled in x, moved.
    SquareScene builder({{"translation", {1, 2, 3}}, {"rotation", {0, half, 0, half}}, {"scale", {2, 1, -1}}});
    const Loaded loaded = load(builder);
    // (1, 1, 1) → scaled (2, 1, -1) → turned (-1, 1, -2) → moved (0, 3, 1) → Z up (0, -1, 3)
    expect_point(image_of(loaded->instances[0].world, 1, 1, 1), 0, -1, 3);
}

TEST(Scene, MatrixAndHierarchy) {
    GltfBuilder builder;
    SquareScene scene;
    scene.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1};
    scene.add("nodes", {{"name", "parent"}, {"scale", {-1, 1, 1}}, {"children", {0}}});
    scene.root["scenes"][0]["nodes"] = {1};
    const Loaded loaded = load(scene);
    expect_point(image_of(loaded->instances[0].world, 1, 0, 0), -11, -30, 20);
}

TEST(Scene, SharedMeshes) {
    SquareScene builder;
    builder.add_node({{"mesh", builder.mesh}, {"translation", {5, 0, 0}}});
    const Loaded loaded = load(builder);
    EXPECT_EQ(loaded->meshes.size(), 1u);
    EXPECT_EQ(loaded->instances.size(), 2u);
}

TEST(Scene, GpuInstancing) {
    SquareScene builder;
    const std::vector<float> translations = {1, 0, 0, 2, 0, 0, 3, 0, 0};
    const std::vector<float> scales = {1, 1, 1, 2, 2, 2, 3, 3, 3};
    builder.root["extensionsUsed"] = json::array({"EXT_mesh_gpu_instancing"});
    builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", builder.accessor(translations, float_type, "VEC3")},
        {"SCALE", builder.accessor(scales, float_type, "VEC3")}};
    builder.root["nodes"][0]["translation"] = {0, 0, 1};
    const Loaded loaded = load(builder);
    ASSERT_EQ(loaded->instances.size(), 3u);
    expect_point(image_of(loaded->instances[2].world, 1, 0, 0), 6, -1, 0);
}

TEST(Scene, Cycles) {
    {
        SquareScene builder;
        builder.root["nodes"][0]["children"] = {0};
        EXPECT_CONTAINS(error_of(builder), "nodes[0] '': it is reached twice");
    }
    {
        SquareScene builder;
        builder.add("nodes", {{"children", {0}}});
        builder.root["nodes"][0]["children"] = {1};
        builder.root.erase("scenes");
        builder.root.erase("scene");
        EXPECT_CONTAINS(error_of(builder), "cycle");
    }
}

TEST(Scene, DeepHierarchy) {
    SquareScene builder;
    for (int i = 0; i < 50000; ++i) builder.add("nodes", {{"children", {i}}});
    builder.root["scenes"][0]["nodes"] = {50000};
    EXPECT_EQ(load(builder)->instances.size(), 1u);
}

TEST(Scene, InstanceExtras) {
    SquareScene builder;
    builder.add("materials", {{"name", "other"}});
    builder.root["nodes"][0]["extras"]["triptych"]["instance"] = {{"index", 7},
                                                                  {"color", {1, 0, 0}},
                                                                  {"visible_camera", false},
                                                                  {"visible_shadow", true},
                                                                  {"materials", {-1, 0}}};
    const Loaded loaded = load(builder);
    const RecordedInstance& instance = loaded->instances[0];
    EXPECT_EQ(instance.desc.index, 7);
    EXPECT_EQ(instance.desc.color[1], 0.0f);
    EXPECT_EQ(instance.desc.visible_camera, 0);
    EXPECT_EQ(instance.desc.visible_shadow, 1);
    EXPECT_EQ(instance.materials, (std::vector<uint32_t>{TRP_NO_ID, 1}));
}

TEST(Scene, PunctualLights) {
    SquareScene builder;
    builder.root["extensionsUsed"] = json::array({"KHR_lights_punctual"});
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array(
        {{{"type", "point"}, {"intensity", 683}, {"color", {1, 0.5, 0}}},
         {{"type", "spot"}, {"intensity", 1366}, {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.4}}}},
         {{"type", "directional"}, {"intensity", 2049}},
         {{"type", "spot"}}});
    for (int i = 0; i < 4; ++i) {
        builder.add_node({{"translation", {0, 5, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    }
    const Loaded loaded = load(builder);
    ASSERT_EQ(loaded->lights.size(), 4u);
    const auto& lights = loaded->lights;
    EXPECT_EQ(lights[0].desc.type, TRP_LIGHT_POINT);
    EXPECT_NEAR(lights[0].desc.emission[1], 0.5f, 1e-6f);
    EXPECT_EQ(lights[1].desc.type, TRP_LIGHT_SPOT);
    EXPECT_NEAR(lights[1].desc.emission[0], 2.0f, 1e-6f);
    EXPECT_NEAR(lights[1].desc.angle, 0.8f, 1e-6f);
    EXPECT_NEAR(lights[1].desc.blend, 0.25f, 1e-6f);
    EXPECT_EQ(lights[2].desc.type, TRP_LIGHT_SUN);
    EXPECT_NEAR(lights[2].desc.emission[2], 3.0f, 1e-6f);
    EXPECT_NEAR(lights[3].desc.angle, std::numbers::pi / 2, 1e-6f);
    EXPECT_NEAR(lights[3].desc.blend, 1.0f, 1e-6f);
    expect_point(image_of(lights[0].world, 0, 0, 0), 0, 0, 5);
    EXPECT_FALSE(loaded.scene.needs_light);
}

TEST(Scene, LightExtras) {
    SquareScene builder;
    builder.add_node({{"name", "Area"},
                      {"extras",
                       {{"triptych",
                         {{"light",
                           {{"type", "area"},
                            {"emission", {3, 2, 1}},
                            {"size", {2, 0.5}},
                            {"shape", "ellipse"},
                            {"angle", 1.5},
                            {"falloff", "linear"},
                            {"cast_shadow", false},
                            {"visible_camera", true},
                            {"group", 3}}}}}}}});
    const Loaded loaded = load(builder);
    ASSERT_EQ(loaded->lights.size(), 1u);
    const TrpLightDesc& light = loaded->lights[0].desc;
    EXPECT_EQ(loaded->lights[0].name, "Area");
    EXPECT_EQ(light.type, TRP_LIGHT_AREA);
    EXPECT_EQ(light.emission[0], 3.0f);
    EXPECT_EQ(light.size[1], 0.5f);
    EXPECT_EQ(light.shape, TRP_SHAPE_ELLIPSE);
    EXPECT_EQ(light.falloff, TRP_FALLOFF_LINEAR);
    EXPECT_EQ(light.cast_shadow, 0);
    EXPECT_EQ(light.visible_camera, 1);
    EXPECT_EQ(light.group, 3u);
}

TEST(Scene, Cameras) {
    SquareScene builder;
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"zfar", 50}}}});
    builder.add("cameras", {{"type", "orthographic"},
                            {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 10}}},
                            {"extras", {{"triptych", {{"shift", {0.25, 0.5}}, {"aperture_radius", 0.1}}}}}});
    builder.add("cameras", {{"type", "perspective"},
                            {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}},
                            {"extras", {{"triptych", {{"field_of_view", 1.25}}}}}});
    for (int i = 0; i < 3; ++i)
        builder.add_node({{"name", "camera " + std::to_string(i)}, {"camera", i}, {"translation", {0, 0, 9}}});
    const std::filesystem::path path = builder.write(test_folder("Scene.Cameras"), "scene.glb");
    const Loaded loaded = load(path);
    ASSERT_EQ(loaded->cameras.size(), 3u);
    const auto& cameras = loaded->cameras;
    EXPECT_EQ(loaded->camera, 1u);
    EXPECT_EQ(cameras[0].desc.fit, TRP_FIT_VERTICAL);
    EXPECT_FLOAT_EQ(cameras[0].desc.field_of_view, 0.8f);
    EXPECT_FLOAT_EQ(cameras[0].desc.clip_end, 50.0f);
    expect_point(image_of(cameras[0].world, 0, 0, 0), 0, -9, 0);
    expect_point(image_of(cameras[0].world, 0, 0, -1), 0, -8, 0);
    EXPECT_EQ(cameras[1].desc.type, TRP_CAMERA_ORTHOGRAPHIC);
    EXPECT_FLOAT_EQ(cameras[1].desc.width, 4.0f);
    EXPECT_FLOAT_EQ(cameras[1].desc.shift[1], 0.5f);
    EXPECT_EQ(cameras[1].desc.fit, TRP_FIT_VERTICAL);
    EXPECT_FLOAT_EQ(cameras[2].desc.field_of_view, 1.25f);
    EXPECT_EQ(cameras[2].desc.fit, TRP_FIT_AUTO);
    EXPECT_EQ(load(path, "camera 1")->camera, 2u);
    try {
        load(path, "nobody");
        FAIL() << "an unknown camera is an error";
    } catch (const cli::Error& error) {
        EXPECT_CONTAINS(error.what(), "there is no camera 'nobody'; the file has 'camera 0', 'camera 1', 'camera 2'");
    }
}

TEST(Scene, WorldFilmAndSettings) {
    SquareScene builder;
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}});
    builder.add_node({{"camera", 0}});
    const int second = builder.add_node({{"camera", 0}, {"name", "wanted"}});
    const std::vector<unsigned char> bytes = {1, 2, 3};
    builder.add("images", {{"bufferView", builder.view(bytes)}});
    builder.add("textures", {{"source", 0}});
    builder.root["scenes"][0]["extras"]["triptych"] = {
        {"world",
         {{"radiance", {1, 2, 3}}, {"texture", 0}, {"rotation", std::numbers::pi / 2}, {"visible_camera", false}}},
        {"camera", second},
        {"film", {{"width", 320}, {"height", 200}}},
        {"settings", {{"samples", "16"}, {"shadows", false}, {"shading.ambient", {0.1, 0.2, 0.3}}}}};
    const Loaded loaded = load(builder);
    EXPECT_TRUE(loaded->has_world);
    EXPECT_EQ(loaded->world.radiance[2], 3.0f);
    EXPECT_EQ(loaded->world.texture, 1u);
    EXPECT_EQ(loaded->world.visible_camera, 0);
    EXPECT_EQ(loaded->textures[0].desc.color_space, TRP_COLOR_SPACE_AUTO);
    expect_point(image_of(loaded->world_rows, 1, 0, 0), 0, 1, 0);
    EXPECT_EQ(loaded.scene.camera_name, "wanted");
    EXPECT_EQ(loaded.scene.film_width, 320u);
    EXPECT_EQ(loaded.scene.film_height, 200u);
    const auto& settings = loaded.scene.settings;
    ASSERT_EQ(settings.size(), 3u);
    EXPECT_EQ(settings[0], (std::pair<std::string, std::string>("samples", "16")));
    EXPECT_EQ(settings[1].second, "0.1,0.2,0.3");
    EXPECT_EQ(settings[2].second, "off");
    EXPECT_FALSE(loaded.scene.needs_light);
}

TEST(Scene, WorldTurnedAboutAnyAxis) {
    SquareScene builder;
    json& world = builder.root["scenes"][0]["extras"]["triptych"]["world"];
    world = {{"rotation", {1, 0, 0, 0, 0, -1, 0, 1, 0}}};  // a quarter about X
    const Loaded loaded = load(builder);
    expect_point(image_of(loaded->world_rows, 0, 1, 0), 0, 0, 1);
    world = {{"rotation", {1, 0, 0}}};
    EXPECT_CONTAINS(error_of(builder), "'rotation' has neither 1 nor 9 numbers");
}

// All corners of the box must be in the picture, and some near its edge.
TEST(Scene, FramingAndHeadlight) {
    for (const auto& [width, height] : {std::pair<uint32_t, uint32_t>{960, 540}, {200, 400}}) {
        SquareScene builder({{"scale", {4, 1, 1}}, {"translation", {100, 0, 0}}});
        Loaded loaded = load(builder);
        EXPECT_TRUE(loaded.scene.needs_camera);
        EXPECT_TRUE(loaded.scene.needs_light);
        EXPECT_TRUE(loaded.warns("the file has no camera"));
        EXPECT_TRUE(loaded.warns("the file has no light"));
        cli::complete_scene(loaded.scene, width, height, 1);
        ASSERT_EQ(loaded->cameras.size(), 1u);
        ASSERT_EQ(loaded->lights.size(), 1u);
        EXPECT_EQ(loaded->lights[0].desc.type, TRP_LIGHT_SUN);
        EXPECT_EQ(loaded->lights[0].world, loaded->cameras[0].world);
        EXPECT_EQ(loaded->commits, 2u);
        const RecordedCamera& camera = loaded->cameras[0];
        const float tan_long = std::tan(0.5f * camera.desc.field_of_view);
        const float longer = static_cast<float>(std::max(width, height));
        float greatest = 0.0f;
        for (const float x : {100.0f, 104.0f}) {
            for (const float z : {0.0f, 1.0f}) {
                float local[3];
                const float offset[3] = {x - camera.world[3], 0 - camera.world[7], z - camera.world[11]};
                for (size_t axis = 0; axis < 3; ++axis) {
                    local[axis] = 0;
                    for (size_t k = 0; k < 3; ++k) local[axis] += camera.world[4 * k + axis] * offset[k];
                }
                EXPECT_GT(-local[2], camera.desc.clip_start);
                EXPECT_LT(-local[2], camera.desc.clip_end);
                const float sx = std::fabs(local[0] / -local[2]) / (tan_long * static_cast<float>(width) / longer);
                const float sy = std::fabs(local[1] / -local[2]) / (tan_long * static_cast<float>(height) / longer);
                greatest = std::max({greatest, sx, sy});
            }
        }
        EXPECT_LT(greatest, 1.0f);
        EXPECT_GT(greatest, 0.7f);
    }
}

TEST(Scene, EmptyFileIsFramed) {
    GltfBuilder builder;
    Loaded loaded = load(builder);
    cli::complete_scene(loaded.scene, 960, 540, 1);
    EXPECT_EQ(loaded->cameras.size(), 1u);
}

TEST(Scene, MeshExtras) {
    GltfBuilder builder;
    builder.add("materials", {{"name", "a"}});
    // Plain glTF for others: two triangles. Blender's own: one quad, a loose edge, split normals.
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 5, 5, 5};
    const std::vector<uint32_t> corners = {0, 1, 2, 3}, offsets = {0, 4}, edges = {0, 1, 1, 2, 2, 3, 3, 0, 0, 4};
    const std::vector<uint16_t> slots = {1};
    const std::vector<uint8_t> smooth = {1}, flags = {1, 0, 2, 3, 0};
    const std::vector<float> creases = {0, 0.5f, 1, 0, 0}, uvs = {0, 0.25f, 1, 0, 1, 1, 0, 1};
    const std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    const std::vector<float> colors = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0, 1};
    const int mesh =
        builder.add_mesh_node({{"attributes", {{"POSITION", builder.accessor(square.positions, float_type, "VEC3")}}}});
    builder.root["meshes"][static_cast<size_t>(mesh)]["extras"]["triptych"] = {
        {"positions", builder.accessor(positions, float_type, "VEC3")},
        {"face_offsets", builder.accessor(offsets, uint_type, "SCALAR")},
        {"corner_vertices", builder.accessor(corners, uint_type, "SCALAR")},
        {"corner_normals", builder.accessor(normals, float_type, "VEC3")},
        {"uv_sets",
         {{{"name", "UVMap"}, {"accessor", builder.accessor(uvs, float_type, "VEC2")}, {"domain", "corner"}}}},
        {"colors",
         {{{"name", "Col"}, {"accessor", builder.accessor(colors, float_type, "VEC4")}, {"domain", "vertex"}}}},
        {"materials", {-1, 0}},
        {"face_materials", builder.accessor(slots, ushort_type, "SCALAR")},
        {"face_smooth", builder.accessor(smooth, ubyte_type, "SCALAR")},
        {"edges", builder.accessor(edges, uint_type, "SCALAR")},
        {"edge_flags", builder.accessor(flags, ubyte_type, "SCALAR")},
        {"edge_creases", builder.accessor(creases, float_type, "SCALAR")},
        {"vertex_creases", builder.accessor(creases, float_type, "SCALAR")}};
    const Loaded loaded = load(builder);
    ASSERT_EQ(loaded->meshes.size(), 1u);
    const RecordedMesh& read = loaded->meshes[0];
    EXPECT_EQ(read.positions, positions);
    EXPECT_EQ(read.face_offsets, offsets);
    EXPECT_EQ(read.corners, corners);
    EXPECT_EQ(read.normals, normals);
    EXPECT_EQ(read.normal_domain, TRP_DOMAIN_CORNER);
    ASSERT_EQ(read.uv_sets.size(), 1u);
    EXPECT_EQ(read.uv_sets[0].name, "UVMap");
    EXPECT_EQ(read.uv_sets[0].values, uvs) << "v is up in the extras already";
    EXPECT_EQ(read.uv_sets[0].domain, TRP_DOMAIN_CORNER);
    EXPECT_EQ(read.colors[0].components, 4);
    EXPECT_EQ(read.colors[0].domain, TRP_DOMAIN_VERTEX);
    EXPECT_EQ(read.materials, (std::vector<uint32_t>{TRP_NO_ID, 1}));
    EXPECT_EQ(read.face_materials, std::vector<uint32_t>{1});
    EXPECT_EQ(read.face_smooth, std::vector<uint32_t>{1});
    EXPECT_EQ(read.edges, edges);
    EXPECT_EQ(read.edge_flags, (std::vector<uint32_t>{1, 0, 2, 3, 0}));
    EXPECT_EQ(read.edge_creases, creases);
    EXPECT_EQ(read.vertex_creases, creases);
    EXPECT_TRUE(loaded.scene.warnings.lines().size() <= 2) << "only the missing camera and light";
}

TEST(Scene, Extensions) {
    SquareScene optional;
    optional.root["extensionsUsed"] = json::array({"EXT_something_new"});
    EXPECT_TRUE(load(optional).warns("extension EXT_something_new is not supported"));
    for (const char* name :
         {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_texture_basisu", "EXT_something_new"}) {
        SquareScene required;
        required.root["extensionsUsed"] = required.root["extensionsRequired"] = json::array({name});
        EXPECT_CONTAINS(error_of(required), name);
    }
}

TEST(Scene, VersionsAndContainers) {
    SquareScene old;
    old.root["asset"]["version"] = "1.0";
    EXPECT_CONTAINS(error_of(old), "glTF 1.0 is not supported");
    SquareScene next;
    next.root["asset"]["version"] = "3.0";
    EXPECT_CONTAINS(error_of(next), "'3.0' is not glTF 2.0");
    SquareScene newer;
    newer.root["asset"]["extras"]["triptych"]["version"] = 2;
    EXPECT_TRUE(load(newer).warns("is newer than this program's"));
    const std::filesystem::path folder = test_folder("Scene.VersionsAndContainers");
    const std::pair<const char*, const char*> texts[] = {
        {"", "empty"},
        {"hello", "JSON: parse error"},
        {"[]", "expected an object"},
        {"{\"asset\":{}}", "asset.version is missing"},
        {"{\"asset\":{\"version\":\"2.0\"},\"nodes\":{}}", "nodes: expected an array"}};
    for (const auto& [text, part] : texts) {
        write_bytes(folder / "bad.gltf", {text, text + std::strlen(text)});
        try {
            load(folder / "bad.gltf");
            ADD_FAILURE() << text;
        } catch (const cli::Error& error) {
            EXPECT_CONTAINS(error.what(), part);
            EXPECT_CONTAINS(error.what(), "bad.gltf: ");
        }
    }
    std::string deep = "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(100000, '[');
    write_bytes(folder / "deep.gltf", {deep.begin(), deep.end()});
    EXPECT_THROW(load(folder / "deep.gltf"), cli::Error);
    EXPECT_THROW(load(folder / "missing.glb"), cli::Error);
    EXPECT_THROW(load(folder), cli::Error);
}

}  // namespace
}  // namespace triptych::test
