// The command as others call it: exit codes, the error line, and files that are left alone when something fails.
// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include "command.h"
#include "samples.h"

namespace triptych::test {
namespace {

TEST_F(Command, HelpAndVersion) {
    const Outcome help = run({"--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.out.find("render"), std::string::npos);
    const Outcome more = run({"render", "--help"});
    EXPECT_EQ(more.code, 0);
    EXPECT_NE(more.out.find("--tile"), std::string::npos);
    EXPECT_NE(more.out.find("ray_casting"), std::string::npos) << "the methods of the core's table";
    const Outcome version = run({"--version"});
    EXPECT_EQ(version.code, 0);
    EXPECT_EQ(version.out.rfind("triptych ", 0), 0u);
}

TEST_F(Command, Misuse) {
    const std::pair<std::vector<std::string>, const char*> calls[] = {
        {{}, "required"},
        {{"paint"}, "paint"},
        {{"render"}, "SCENE"},
        {{"render", scene}, "--method"},
        {{"render", scene, "--method", "ray_casting"}, "--output"},
        {{"info"}, "SCENE"},
        {{"info", scene, "--speed"}, "--speed"},
        {{"methods", "all"}, "all"},
        {{"pick", scene}, "--pixel"},
        {{"pick", scene, "--pixel", "3"}, "is not X,Y"},
        {{"pick", scene, "--pixel", "3,4,5"}, "is not X,Y"},
        {{"pick", scene, "--pixel", "3,4,"}, "is not X,Y"},
        {{"pick", scene, "--pixel", "64,3", "--width", "64", "--height", "32"}, "outside the picture of 64 x 32"},
        {{"pick", scene, "--pixel", "3,4", "--set", "samples"}, "is not NAME=VALUE"},
        {{"pick", scene, "--pixel", "3,4", "--method", "magic"}, "there is no method 'magic'"},
        {{"render", scene, "--method", "magic", "--output", picture}, "there is no method 'magic'"},
        {{"render", scene, "--method", "ray_casting", "--output", (folder / "a.jpg").string()},
         "does not end in .exr or .png"},
        {render({"--width", "0"}), "--width"},
        {render({"--height", "ten"}), "--height"},
        {render({"--tile", "1,2,3"}), "is not X,Y,W,H"},
        {render({"--tile", "0,0,0,5"}), "is not X,Y,W,H"},
        {render({"--tile", "0,0,5,5,"}), "is not X,Y,W,H"},
        {render({"--tile", "60,0,5,5"}), "outside the picture of 64 x 32"},
        {render({"--set", "samples"}), "is not NAME=VALUE"},
        {render({"--set", "sample=4"}), "--set sample=4"},
        {render({"--samples", "none"}), "--set samples=none"},
        {render({"--pass", "Nothing"}), "--pass Nothing"},
        {{"render", scene, "--output", picture, "--method", "wireframe", "--pass", "Normal"}, "wireframe has no pass"},
        {render({"--frobnicate"}), "--frobnicate"},
        {render({"another.glb"}), "another.glb"},
    };
    for (const auto& [arguments, part] : calls) expect_error(run(arguments), 2, part);
    EXPECT_TRUE(files().empty());
}

TEST_F(Command, Failures) {
    const std::string missing = (folder / "missing.glb").string();
    expect_error(run({"info", missing}), 1, missing + ": no such file");
    std::vector<std::string> arguments = render();
    arguments[1] = missing;
    expect_error(run(arguments), 1, missing + ": no such file");
    arguments = render();
    arguments[5] = (folder / "nowhere" / "picture.exr").string();
    expect_error(run(arguments), 1, "there is no folder");
    expect_error(run(render({"--camera", "nobody"})), 1, "there is no camera 'nobody'");
    expect_error(run(render({"--stats", (folder / "nowhere" / "stats.json").string()})), 1, "there is no folder");
    EXPECT_TRUE(files().empty());
}

TEST_F(Command, ExistingOutputSurvivesAFailure) {
    write_bytes(picture, {'o', 'l', 'd'});
    std::vector<unsigned char> bytes = read_bytes(scene);
    bytes.resize(bytes.size() / 2);
    write_bytes(scene, bytes);
    expect_error(run(render()), 1, "it was cut off");
    EXPECT_EQ(text_of(picture), "old");
    EXPECT_EQ(files(), std::vector<std::string>{"picture.exr"});
}

TEST_F(Command, RenderWithStatistics) {
    const std::string stats = (folder / "stats.json").string();
    const Outcome outcome = run(render({"--samples", "2", "--stats", stats, "--threads", "1", "--pass", "Normal"}));
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_NE(outcome.error.find("triptych: warning: the file has no camera: the whole scene is framed"),
              std::string::npos);
    EXPECT_NE(outcome.error.find("triptych: warning: the file has no light: a headlight is used"), std::string::npos);
    EXPECT_EQ(outcome.error.find('\r'), std::string::npos) << "progress is for terminals";
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(files(), (std::vector<std::string>{"picture.exr", "stats.json"}));
    const json json = json::parse(text_of(stats));
    for (const char* key : {"method", "seconds", "rays", "triangles", "elements", "links", "iterations", "residual",
                            "peak_memory_bytes", "threads"}) {
        EXPECT_TRUE(json.contains(key)) << key;
    }
    for (const char* key : {"load", "commit", "solve", "render", "write"})
        EXPECT_TRUE(json["seconds"].contains(key)) << key;
    EXPECT_EQ(run(render({"--quiet"})).error, "");
}

TEST_F(Command, Info) {
    const Outcome outcome = run({"info", scene, "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    const json info = json::parse(outcome.out);
    EXPECT_EQ(info["meshes"], 1);
    EXPECT_EQ(info["instances"], 1);
    EXPECT_EQ(info["faces"], 2);
    EXPECT_EQ(info["vertices"], 4);
    EXPECT_EQ(info["generator"], "triptych tests");
    EXPECT_EQ(info["bounds"]["max"], (json::array({1.0, 0.0, 1.0})));
    EXPECT_EQ(info["cameras"], json::array());
    EXPECT_EQ(info["warnings"].size(), 2u);
    const Outcome text = run({"info", scene});
    EXPECT_EQ(text.code, 0);
    EXPECT_NE(text.out.find("triptych tests"), std::string::npos);
}

TEST_F(Command, PickShowsTheScanLineOfAPixel) {
    const Outcome outcome =
        run({"pick", scene, "--pixel", "32,16", "--width", "64", "--height", "32", "--json", "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    const json line = json::parse(outcome.out);
    EXPECT_EQ(line["seen"], true);
    EXPECT_EQ(line["quantity"], "radiance");
    const double alpha = line["alpha"], gamma = line["gamma"];
    for (size_t k = 0; k < 3; ++k) {
        const double i1 = line["left"]["values"][0][k], i2 = line["left"]["values"][1][k], a = line["A"][k],
                     b = line["B"][k], i = line["I"][k];
        EXPECT_NEAR(a, alpha * i1 + (1 - alpha) * i2, 1e-5);
        EXPECT_NEAR(i, (1 - gamma) * a + gamma * b, 1e-5);
    }
    const json empty = json::parse(
        run({"pick", scene, "--pixel", "0,0", "--width", "640", "--height", "32", "--json", "--quiet"}).out);
    EXPECT_EQ(empty["seen"], false);
    const Outcome text =
        run({"pick", scene, "--pixel", "32,16", "--width", "64", "--height", "32", "--method", "phong"});
    EXPECT_NE(text.out.find("normals interpolated over face"), std::string::npos);
    expect_error(run({"pick", scene, "--pixel", "0,0", "--method", "flat", "--quiet"}), 2, "gouraud and phong");
}

TEST_F(Command, RayTreeShowsThePixel) {
    const Square square;
    GltfBuilder builder;
    builder.add("materials", {{"extras", {{"triptych", {{"specular", 0.04}}}}}});
    builder.add_mesh_node({{"attributes", {{"POSITION", builder.accessor(square.positions, float_type, "VEC3")}}},
                           {"indices", builder.accessor(square.indices, ushort_type, "SCALAR")},
                           {"material", 0}});
    scene = builder.write(folder, "scene.glb").string();
    const std::string svg = (folder / "tree.svg").string();
    const Outcome outcome = run({"ray-tree", scene, "--pixel", "32,16", "--width", "64", "--height", "32", "--json",
                                 "--quiet", "--svg", svg, "--set", "trace.depth=2"});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    const json root = json::parse(outcome.out);
    EXPECT_EQ(root["kind"], "primary");
    EXPECT_EQ(root["end"], "surface");
    ASSERT_EQ(root["children"].size(), 1u) << "what is mirrored";
    const json& child = root["children"][0];
    EXPECT_EQ(child["kind"], "reflection");
    EXPECT_EQ(child["end"], "background");
    for (size_t c = 0; c < 3; ++c) {
        const double sum = double{root["local"][c]} + double{child["weight"][c]} * double{child["intensity"][c]};
        EXPECT_NEAR(root["intensity"][c], sum, 1e-6);
    }
    std::ifstream stream(svg);
    const std::string drawing((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    for (const char* word : {"<svg", "I_pixel", "I_back", "R 0.04", "</svg>"})
        EXPECT_NE(drawing.find(word), std::string::npos) << word;
    const Outcome text = run({"ray-tree", scene, "--pixel", "32,16", "--width", "64", "--height", "32"});
    EXPECT_NE(text.out.find("reflection to background"), std::string::npos);
    expect_error(run({"ray-tree", scene, "--pixel", "64,3", "--width", "64", "--height", "32"}), 2,
                 "outside the picture");
    expect_error(run({"ray-tree", scene, "--pixel", "1,1", "--svg", (folder / "no/tree.svg").string()}), 1,
                 "no folder");
}

TEST_F(Command, Tables) {
    for (const char* table : {"methods", "settings", "passes"}) {
        const Outcome outcome = run({table, "--json"});
        ASSERT_EQ(outcome.code, 0) << outcome.error;
        const json list = json::parse(outcome.out);
        ASSERT_TRUE(list.is_array() && !list.empty());
        EXPECT_TRUE(list[0].contains("name"));
        const Outcome text = run({table});
        EXPECT_NE(text.out.find(list[0]["name"].get<std::string>()), std::string::npos);
    }
}

// With the core behind it: what the reader hands over must be what the core takes.
TEST_F(Command, FilesByOthers) {
    if (!std::filesystem::is_directory(models / "glTF2")) GTEST_SKIP() << "the package assimp-testmodels is not there";
    for (const std::filesystem::path& file : files_in(models / "glTF2")) {
        const std::string name = std::filesystem::relative(file, models / "glTF2").string();
        const auto expected = expected_errors.find(name);
        const Outcome outcome = run({"info", file.string(), "--json"});
        if (expected != expected_errors.end()) {
            expect_error(outcome, 1, expected->second);
        } else {
            EXPECT_EQ(outcome.code, 0) << outcome.error;
            EXPECT_TRUE(json::accept(outcome.out)) << name;
        }
    }
}

// A mesh of loose edges alone, and pictures that are no pictures.
TEST_F(Command, OddScenesRender) {
    const Square square;
    GltfBuilder builder;
    const json attributes = {{"POSITION", builder.accessor(square.positions, float_type, "VEC3")},
                             {"TEXCOORD_0", builder.accessor(square.uvs, float_type, "VEC2")}};
    const std::vector<unsigned char> noise = {1, 2, 3, 4, 5, 6, 7, 8};
    builder.add("images", {{"bufferView", builder.view(noise)}, {"mimeType", "image/png"}});
    builder.add("textures", {{"source", 0}});
    builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    builder.add_mesh_node({{"attributes", attributes}, {"mode", 2}});
    builder.add_mesh_node({{"attributes", attributes},
                           {"indices", builder.accessor(square.indices, ushort_type, "SCALAR")},
                           {"material", 0}});
    scene = builder.write(folder, "scene.glb").string();
    const Outcome outcome = run(render());
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    scene = GltfBuilder().write(folder, "scene.glb").string();
    const Outcome empty = run(render());
    EXPECT_EQ(empty.code, 0) << empty.error;
}

// The file's film and settings hold where the command line says nothing.
TEST_F(Command, FilmAndSettingsOfTheFile) {
    GltfBuilder builder;
    builder.add_node(json::object());
    builder.root["scenes"][0]["extras"]["triptych"] = {{"film", {{"width", 40}, {"height", 30}}},
                                                       {"settings", {{"samples", "2"}}}};
    scene = builder.write(folder, "scene.glb").string();
    const std::string stats = (folder / "stats.json").string();
    const Outcome outcome =
        run({"render", scene, "--method", "ray_casting", "--output", picture, "--stats", stats, "--width", "50"});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    const json costs = json::parse(text_of(stats));
    EXPECT_EQ(costs["width"], 50);
    EXPECT_EQ(costs["height"], 30);
    builder.root["scenes"][0]["extras"]["triptych"]["settings"] = {{"sampels", "2"}};
    builder.write(folder, "scene.glb");
    expect_error(run({"render", scene, "--method", "ray_casting", "--output", picture, "--quiet"}), 1,
                 scene + ": extras.triptych.settings.sampels: ");
}

TEST_F(Command, InterruptedRenderLeavesItsPasses) {
    const std::string stats = (folder / "stats.json").string();
    std::vector<std::string> arguments = render({"--samples", "64000", "--quiet", "--stats", stats});
    arguments[7] = arguments[9] = "128";
    expect_error(interrupt_late(arguments), 130, " of 1000 passes: the picture shows them");
    EXPECT_EQ(text_of(picture).substr(0, 4), "\x76\x2f\x31\x01");
    EXPECT_EQ(files(), (std::vector<std::string>{"picture.exr", "stats.json"}));
}

TEST_F(Command, InterruptedBeforeAPassIsDoneLeavesNothing) {
    write_bytes(picture, {'o', 'l', 'd'});
    std::vector<std::string> arguments = render({"--samples", "64", "--quiet"});
    arguments[7] = arguments[9] = "4096";
    expect_error(interrupt(arguments, 700), 130, "interrupted");
    EXPECT_EQ(text_of(picture), "old");
    EXPECT_EQ(files(), std::vector<std::string>{"picture.exr"});
}

}  // namespace
}  // namespace triptych::test
