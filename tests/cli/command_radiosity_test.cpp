// The commands about radiosity as others call them. SPDX-License-Identifier: Apache-2.0
#include "command.h"

namespace triptych::test {
namespace {

// Two squares, one above the other, of which the upper one shines with so many W/(m² sr).
std::string two_squares(const std::filesystem::path& folder, double radiance = 1) {
    const Square square;
    GltfBuilder builder;
    json material = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}},
                     {"doubleSided", true}};
    builder.add("materials", material);
    material["emissiveFactor"] = {1, 1, 1};
    material["extensions"] = {{"KHR_materials_emissive_strength", {{"emissiveStrength", radiance}}}};
    builder.add("materials", material);
    const json attributes = {{"POSITION", builder.accessor(square.positions, float_type, "VEC3")}};
    const int indices = builder.accessor(square.indices, ushort_type, "SCALAR");
    for (int k = 0; k < 2; ++k)
        builder.add_mesh_node({{"attributes", attributes}, {"indices", indices}, {"material", k}},
                              {{"translation", {0, 0, k}}});
    return builder.write(folder, "scene.glb").string();
}

TEST_F(Command, RadiosityLeavesItsSnapshots) {
    const std::filesystem::path pictures = folder / "pictures";
    const std::vector<std::string> solve = {
        "radiosity", scene, "--set", "radiosity.solver=progressive", "--quiet", "--width", "32", "--height", "24"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), solve.begin(), solve.end());
        return run(more);
    };
    EXPECT_EQ(with({"--snapshots", "1,2", "--output", pictures.string()}).code, 0);
    for (const char* name : {"iteration_0001.exr", "iteration_0001.png", "iteration_0002.exr", "iteration_0002.png"})
        EXPECT_TRUE(std::filesystem::exists(pictures / name)) << name;
    expect_error(with({"--snapshots", "1,,2", "--output", pictures.string()}), 2, "--snapshots: '1,,2'");
    expect_error(with({"--snapshots", "0", "--output", pictures.string()}), 2, "--snapshots: the first step is 1");
    expect_error(with({"--snapshots", "1"}), 2, "--snapshots requires --output");
    expect_error(with({"--output", (folder / "a.png").string()}), 2, "a.png' is to be the folder of the pictures");
    const Outcome solved = run({"radiosity", scene, "--snapshots", "1,900", "--output", pictures.string()});
    EXPECT_EQ(solved.code, 0);
    EXPECT_NE(solved.error.find("--snapshots: it was solved after 1 steps"), std::string::npos) << solved.error;
}

TEST_F(Command, InterruptedRadiosityShowsWhatItHas) {
    scene = two_squares(folder);
    const std::filesystem::path pictures = folder / "pictures";
    const std::string stats = (folder / "stats.json").string();
    const std::vector<std::string> slow = {"--quiet",
                                           "--width",
                                           "32",
                                           "--height",
                                           "24",
                                           "--stats",
                                           stats,
                                           "--set",
                                           "radiosity.solver=progressive",
                                           "--set",
                                           "radiosity.element_size=0.02",
                                           "--set",
                                           "radiosity.tolerance=1e-9"};
    const auto with = [&](std::vector<std::string> command) {
        command.insert(command.end(), slow.begin(), slow.end());
        return command;
    };
    const auto expect_stopped = [&](const Outcome& outcome) {
        expect_error(outcome, 130, "interrupted after ");
        EXPECT_NE(outcome.error.find(": the picture shows them"), std::string::npos) << outcome.error;
        const json costs = json::parse(text_of(stats));
        EXPECT_GT(costs["iterations"], 0);
        EXPECT_EQ(costs["radiosity"]["solved"], false);
        std::filesystem::remove(stats);
        return costs["iterations"].get<int>();
    };
    expect_stopped(interrupt_late(with({"radiosity", scene, "--output", pictures.string()})));
    EXPECT_EQ(text_of(pictures / "radiosity.png").substr(1, 3), "PNG");
    expect_stopped(interrupt_late(with({"render", scene, "--method", "radiosity", "--output", picture})));
    EXPECT_TRUE(std::filesystem::exists(picture));
    // Of snapshots, those that were due and the last state.
    std::filesystem::remove_all(pictures);
    const int steps = expect_stopped(
        interrupt_late(with({"radiosity", scene, "--output", pictures.string(), "--snapshots", "1,900000000"})));
    EXPECT_TRUE(std::filesystem::exists(pictures / "iteration_0001.png"));
    EXPECT_FALSE(std::filesystem::exists(pictures / "iteration_900000000.png"));
    const auto entries = std::filesystem::directory_iterator(pictures);
    EXPECT_EQ(std::distance(begin(entries), end(entries)), steps > 1 ? 4 : 2);
}

TEST_F(Command, InterruptedBeforeTheFirstStepLeavesNothing) {
    const std::filesystem::path pictures = folder / "pictures";
    const Outcome outcome = interrupt({"radiosity", two_squares(folder), "--quiet", "--output", pictures.string(),
                                       "--set", "radiosity.solver=matrix", "--set", "radiosity.element_size=0.03"},
                                      1500);
    expect_error(outcome, 130, "interrupted");
    EXPECT_TRUE(std::filesystem::is_empty(pictures));
}

TEST_F(Command, ASecondInterruptEndsItAtOnce) {
    // While a large picture of what was found is drawn, once there is something found.
    Outcome outcome;
    for (int milliseconds = 1000; outcome.code != 1000 + SIGINT && milliseconds < 60000; milliseconds *= 2) {
        const pid_t process =
            start({"radiosity", two_squares(folder), "--quiet", "--output", (folder / "pictures").string(), "--width",
                   "12000", "--height", "12000", "--set", "radiosity.solver=progressive", "--set",
                   "radiosity.element_size=0.02", "--set", "radiosity.tolerance=1e-9"},
                  folder);
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        kill(process, SIGINT);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        kill(process, SIGINT);
        outcome = finish(process, folder);
    }
    EXPECT_EQ(outcome.code, 1000 + SIGINT);
}

TEST_F(Command, RadiositySaysWhatItEndedAt) {
    scene = two_squares(folder);
    const auto solve = [&](const char* tolerance) {
        return run({"radiosity", scene, "--stats", (folder / "stats.json").string(), "--set",
                    "radiosity.element_size=0.5", "--set", std::string("radiosity.tolerance=") + tolerance});
    };
    const Outcome limited = solve("1e-7");
    EXPECT_EQ(limited.code, 0);
    EXPECT_NE(limited.out.find(", ended at its limit\n"), std::string::npos) << limited.out;
    EXPECT_NE(limited.error.find("no element may be divided further"), std::string::npos) << limited.error;
    EXPECT_EQ(json::parse(text_of(folder / "stats.json"))["radiosity"]["solved"], false);
    const Outcome whole = solve("100");
    EXPECT_NE(whole.out.find(", solved\n"), std::string::npos) << whole.out;
    EXPECT_EQ(json::parse(text_of(folder / "stats.json"))["radiosity"]["solved"], true);
}

TEST_F(Command, StatisticsOfLampsThatAreTooBrightAreNumbers) {
    const std::string stats = (folder / "stats.json").string();
    const auto result = run({"radiosity", two_squares(folder, 1e30), "--stats", stats});
    EXPECT_EQ(result.code, 0);
    EXPECT_NE(result.error.find("than can be reckoned with"), std::string::npos) << result.error;
    EXPECT_TRUE(json::parse(text_of(stats))["residual"].is_number()) << text_of(stats);
}

TEST_F(Command, RadiositySaysWhichSettingsItDoesWithout) {
    const auto said = [&](const char* solver, const char* setting) {
        return run({"radiosity", scene, "--set", std::string("radiosity.solver=") + solver, "--set", setting}).error;
    };
    EXPECT_NE(said("matrix", "radiosity.order=unsorted").find("--set radiosity.order: the matrix solver does without"),
              std::string::npos);
    EXPECT_NE(said("matrix", "radiosity.view=unshot").find("the matrix solver shoots nothing"), std::string::npos);
    for (const char* setting : {"radiosity.order=unsorted", "radiosity.view=unshot"})
        EXPECT_EQ(said("progressive", setting).find("--set"), std::string::npos) << setting;
}

TEST_F(Command, LinksThatAreNotThereAreAnError) {
    scene = two_squares(folder);
    const std::string links = (folder / "links.svg").string();
    const auto solve = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"radiosity", scene, "--quiet", "--width", "32", "--height", "24"});
        return run(more);
    };
    expect_error(solve({"--links", links, "--set", "radiosity.solver=matrix"}), 2,
                 "--links: the matrix solver has none");
    expect_error(solve({"--links", links, "--level", "20"}), 1,
                 "--level: there are no links of level 20; there are those of ");
    expect_error(solve({"--level", "0"}), 2, "--level requires --links");
    EXPECT_FALSE(std::filesystem::exists(links));
    EXPECT_EQ(solve({"--links", links}).code, 0);
    EXPECT_NE(text_of(links).find("<path"), std::string::npos);
}

TEST_F(Command, RadiosityIsLookedInto) {
    const std::string links = (folder / "links.svg").string(), stats = (folder / "stats.json").string();
    const auto solve = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"radiosity", scene, "--width", "32", "--height", "24"});
        return run(more);
    };
    const Outcome outcome = solve({"--links", links, "--stats", stats, "--pixel", "16,12", "--set",
                                   "radiosity.view=form_factors", "--output", (folder / "pictures").string()});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_NE(outcome.out.find(" at pixel 16,12\n"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("row sums 0 to 0"), std::string::npos) << "two triangles of one plane: " << outcome.out;
    EXPECT_NE(text_of(links).find("href=\"data:image/png;base64,iVBORw0KGgo"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(links + ".png"));
    const json costs = json::parse(text_of(stats));
    for (const char* key : {"elements", "links", "iterations", "residual"}) EXPECT_TRUE(costs.contains(key)) << key;
    EXPECT_TRUE(costs["rays"].contains("gather"));
    EXPECT_EQ(costs["radiosity"]["row_sums"]["greatest"], 0);
    EXPECT_EQ(costs["radiosity"]["solved"], true);
    expect_error(solve({"--quiet", "--pixel", "32,3"}), 2, "outside the picture");
    expect_error(solve({"--quiet", "--links", (folder / "no/links.svg").string()}), 1, "no folder");
    expect_error(solve({"--quiet", "--level", "-2"}), 2, "--level");
    expect_error(solve({"--quiet", "--bake", "baked.gltf"}), 2, "--bake: 'baked.gltf' does not end in .glb");
    ASSERT_EQ(solve({"--quiet", "--stats", stats, "--set", "radiosity.solver=progressive"}).code, 0);
    EXPECT_TRUE(json::parse(text_of(stats))["radiosity"]["row_sums"].is_null());
}

TEST_F(Command, FormFactorsAreAnArray) {
    const std::string array = (folder / "rows.npy").string(), text = (folder / "rows.csv").string();
    EXPECT_EQ(run({"form-factors", scene, "--output", array, "--quiet"}).code, 0);
    EXPECT_EQ(text_of(array).substr(0, 6), "\x93NUMPY");
    EXPECT_NE(text_of(array).find("'shape': (2, 2)"), std::string::npos);
    const std::string half = "radiosity.element_size=0.6";
    EXPECT_EQ(run({"form-factors", scene, "--output", array, "--quiet", "--set", half}).code, 0);
    EXPECT_NE(text_of(array).find("'shape': (18, 18)"), std::string::npos);  // a setting leaves the solver as it was
    EXPECT_EQ(run({"form-factors", scene, "--output", text, "--rows", "1", "--quiet"}).code, 0);
    EXPECT_EQ(text_of(text), "0,0\n");  // two triangles of one plane
    expect_error(run({"form-factors", scene, "--output", text, "--rows", "2", "--quiet"}), 2,
                 "--rows: there is no element 2; there are 2");
    expect_error(run({"form-factors", scene, "--output", "rows.txt"}), 2, "--output: 'rows.txt'");
    expect_error(run({"form-factors", scene, "--output", text, "--element", "1"}), 2, "--element requires --picture");
    expect_error(run({"form-factors", scene, "--picture", "a.png", "--rows", "1"}), 2, "--rows requires --output");
    expect_error(run({"form-factors", scene, "--output", text, "--width", "64"}), 2, "--width");
}

TEST_F(Command, FormFactorsAreDrawn) {
    const auto draw = [&](const std::string& name, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"form-factors", scene, "--quiet", "--set", "radiosity.hemicube_resolution=32",
                                   "--picture", (folder / name).string()});
        return run(more);
    };
    for (const char* name : {"circle.png", "circle.exr", "circle.svg"}) EXPECT_EQ(draw(name).code, 0) << name;
    EXPECT_EQ(draw("cross.png", {"--set", "radiosity.form_factors=hemicube", "--element", "1"}).code, 0);
    EXPECT_EQ(text_of(folder / "cross.png").substr(1, 3), "PNG");
    EXPECT_NE(text_of(folder / "circle.svg").find("What element 0 sees"), std::string::npos);
    expect_error(draw("circle.jpg"), 2, "circle.jpg' does not end in .png, .exr or .svg");
    expect_error(draw("circle.png", {"--element", "2"}), 2, "--element: there is no element 2; there are 2");
    expect_error(run({"form-factors", scene}), 2, "--output or --picture");
}

}  // namespace
}  // namespace triptych::test
