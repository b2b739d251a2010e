// Motion blur: transforms, meshes, the camera and lights that move while the shutter is open.
#include "support/bodies.h"

namespace trp_test {
namespace {

constexpr const char* kMethods[] = {"ray_casting", "ray_tracing", "path_tracing"};

std::vector<float> steps(const std::vector<Transform>& transforms) {
    std::vector<float> rows;
    for (const Transform& t : transforms) rows.insert(rows.end(), t.begin(), t.end());
    return rows;
}

uint32_t moving(Scene& scene, uint32_t mesh, const std::vector<Transform>& transforms) {
    const std::vector<float> rows = steps(transforms);
    return scene.instance(mesh, kIdentity, [&](TrpInstanceDesc& d) {
        d.world_from_object = rows.data();
        d.time_count = static_cast<uint32_t>(transforms.size());
    });
}

Transform turned(float angle, Vec at) {
    const float c = std::cos(angle), s = std::sin(angle);
    return {c, -s, 0, at[0], s, c, 0, at[1], 0, 0, 1, at[2]};
}

Image blurred(Scene& scene, const char* method, const Settings& more = {}, uint32_t width = 60, uint32_t height = 20) {
    scene.commit();
    return Render(scene, width, height,
                  with({{"samples", "256"}, {"film.filter", "box"}, {"film.filter_width", "1"}}, more), {}, method)
        .run()
        .read();
}

// A glowing square of half width 0.5 m that moves from x = −1 to x = 1, seen from above, 10 pixels to the metre.
double covered(double x) {
    const double from = std::clamp((x + 1 - 0.5) / 2, 0.0, 1.0), to = std::clamp((x + 1 + 0.5) / 2, 0.0, 1.0);
    return to - from;
}
void expect_covered(const Image& image, const char* what) {
    for (uint32_t x = 0; x < 60; ++x) {
        double expected = 0;
        for (int k = 0; k < 16; ++k) expected += covered((x + (k + 0.5) / 16 - 30) / 10) / 16;
        double seen = 0;
        for (uint32_t y = 6; y < 14; ++y) seen += image.at(x, y)[0] / 8;
        EXPECT_NEAR(seen, expected, 6e-3) << what << ", column " << x;
    }
}

TEST(Motion, ATransformBlurs) {
    for (const char* method : kMethods) {
        Scene scene;
        MeshData square = floor_square(0.5f);
        square.materials = {glowing(scene, 1)};
        moving(scene, scene.mesh(square), {translation({-1, 0, 0}), translation({1, 0, 0})});
        scene.camera_above(6);
        expect_covered(blurred(scene, method), method);
    }
}

TEST(Motion, AMeshBlurs) {
    Scene scene;
    MeshData square = floor_square(0.5f);
    square.materials = {glowing(scene, 1)};
    const uint32_t mesh = [&] {
        MeshData twice = square;
        for (size_t v = 0; v < 4; ++v) twice.positions[3 * v] -= 1;
        for (size_t v = 0; v < 4; ++v)
            for (size_t k = 0; k < 3; ++k)
                twice.positions.push_back(square.positions[3 * v + k] + (k == 0 ? 1.0f : 0.0f));
        return scene.mesh(twice, [](TrpMeshDesc& d) { d.time_count = 2; });
    }();
    scene.instance(mesh);
    scene.camera_above(6);
    expect_covered(blurred(scene, "ray_casting"), "mesh");
}

// A surface that stands in the scene many times is not copied; each copy moves for itself.
TEST(Motion, InstancesBlur) {
    Scene scene;
    const int side = 200;
    MeshData grid;
    for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x)
            for (const float v : {static_cast<float>(x) / side - 0.5f, static_cast<float>(y) / side - 0.5f, 0.0f})
                grid.positions.push_back(v);
    grid.offsets = {0};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto at = [&](int i, int j) { return static_cast<uint32_t>(j * (side + 1) + i); };
            for (const uint32_t v : {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)}) grid.corners.push_back(v);
            grid.offsets.push_back(static_cast<uint32_t>(grid.corners.size()));
        }
    grid.materials = {glowing(scene, 1)};
    const uint32_t mesh = scene.mesh(grid);
    moving(scene, mesh, {translation({-1, 0, 0}), translation({1, 0, 0})});
    scene.instance(mesh, translation({0, 50, 0}));
    scene.camera_above(6);
    expect_covered(blurred(scene, "ray_casting"), "instance");
}

TEST(Motion, ACameraBlurs) {
    Scene scene;
    scene.object(floor_square(0.5f), glowing(scene, 1));
    const std::vector<float> rows = steps({translation({1, 0, 10}), translation({-1, 0, 10})});
    scene.camera(kIdentity, [&](TrpCameraDesc& d) {
        d.type = TRP_CAMERA_ORTHOGRAPHIC;
        d.width = 6;
        d.world_from_camera = rows.data();
        d.time_count = 2;
    });
    for (const char* method : kMethods) expect_covered(blurred(scene, method), method);
}

// All that moves, with shadows, normals and reflections: the mean of pictures at fixed times. Of three time samples, so
// that the way is not straight.
TEST(Motion, IsTheMeanOverTime) {
    const auto build = [](Scene& scene, float open, float close) {
        scene.object(floor_square(4), scene.diffuse(0.7f, 0.7f, 0.7f));
        MeshData ball = sphere({0, 0, 0}, 0.6f, 24);
        ball.materials = {scene.material([](TrpMaterialDesc& d) {
            d.diffuse = {{0.5f, 0.4f, 0.2f}, TRP_NO_NODE};
            d.specular = {{0.4f, 0.4f, 0.4f}, TRP_NO_NODE};
        })};
        const uint32_t smooth = scene.mesh(ball);
        moving(scene, smooth, {turned(0, {-1, 0, 0.7f}), turned(0.4f, {0, 0.4f, 0.9f}), turned(0.8f, {0.8f, 0, 0.7f})});
        MeshData twice = box({-0.4f, -1.5f, 0}, {0.4f, -1, 1});
        twice.materials = {scene.diffuse(0.2f, 0.3f, 0.8f)};
        const size_t count = twice.positions.size();
        for (size_t i = 0; i < count; ++i)
            twice.positions.push_back(twice.positions[i] * (i % 3 == 2 ? 1.5f : 1.0f) + (i % 3 == 0 ? 0.5f : 0.0f));
        scene.instance(scene.mesh(twice, [](TrpMeshDesc& d) { d.time_count = 2; }));
        const std::vector<float> lamp = steps({translation({-2, -3, 4}), translation({2, -3, 4})});
        scene.light(TRP_LIGHT_POINT, {40, 40, 40}, kIdentity, [&](TrpLightDesc& d) {
            d.world_from_light = lamp.data();
            d.time_count = 2;
        });
        const std::vector<float> panel = steps({look_at({2, 0, 3}, {0, 0, 0}), look_at({2, 1, 3}, {0, 0, 0})});
        scene.light(TRP_LIGHT_AREA, {2, 2, 2}, kIdentity, [&](TrpLightDesc& d) {
            d.world_from_light = panel.data();
            d.time_count = 2;
        });
        const std::vector<float> eye =
            steps({look_at({0, -7, 3}, {0, 0, 0.5f}), look_at({0.3f, -7, 3}, {0.2f, 0, 0.5f})});
        scene.camera(kIdentity, [&](TrpCameraDesc& d) {
            d.world_from_camera = eye.data();
            d.time_count = 2;
            d.shutter[0] = open, d.shutter[1] = close;
        });
    };
    constexpr uint32_t kWidth = 48, kHeight = 32, kTimes = 32;
    Scene open;
    build(open, 0.1f, 0.9f);
    for (const char* method : {"ray_casting", "ray_tracing"}) {
        const Image image = blurred(open, method, {}, kWidth, kHeight);
        std::vector<double> mean_of(image.values.size(), 0);
        for (uint32_t k = 0; k < kTimes; ++k) {
            const float time = 0.1f + 0.8f * (static_cast<float>(k) + 0.5f) / kTimes;
            Scene fixed;
            build(fixed, time, time);
            const Image at = blurred(fixed, method, {{"samples", "32"}, {"seed", std::to_string(k)}}, kWidth, kHeight);
            for (size_t i = 0; i < mean_of.size(); ++i) mean_of[i] += at.values[i] / kTimes;
        }
        double squares = 0, total = 0, blur = 0;
        Scene still;
        build(still, 0.5f, 0.5f);
        const Image middle = blurred(still, method, {{"samples", "64"}}, kWidth, kHeight);
        for (size_t i = 0; i < mean_of.size(); ++i) {
            if (i % 4 == 3) continue;
            squares += std::pow(image.values[i] - mean_of[i], 2);
            blur += std::pow(middle.values[i] - mean_of[i], 2);
            total += mean_of[i] * mean_of[i];
        }
        EXPECT_LT(std::sqrt(squares / total), 0.012) << method;
        EXPECT_GT(std::sqrt(blur / total), 0.05) << "something moves";
    }
}

// Half way through a wide turn, a spot has its cone, a sun its strength and a camera its field of view.
TEST(Motion, TurnsKeepTheirSize) {
    const auto picture = [](float angle, bool turns, int what) {
        Scene scene;
        scene.object(floor_square(4), scene.diffuse(0.8f, 0.8f, 0.8f));
        scene.object(box({-0.5f, -0.3f, 0}, {0.7f, 0.6f, 0.4f}), scene.diffuse(0.3f, 0.5f, 0.8f));
        const auto at = [&](float share, Vec from) {  // turned about the axis through `from`, y upwards
            const float a = (share - 0.5f) * angle, c = std::cos(a), s = std::sin(a);
            return Transform{c, -s, 0, from[0], s, c, 0, from[1], 0, 0, 1, from[2]};
        };
        const auto tilted = [&](float share, Vec from) {  // turned about x
            const float a = (share - 0.5f) * angle, c = std::cos(a), s = std::sin(a);
            return Transform{1, 0, 0, from[0], 0, c, -s, from[1], 0, s, c, from[2]};
        };
        const bool lamp_turns = turns && what < 2, camera_turns = turns && what == 2;
        const std::vector<float> lamp =
            lamp_turns ? steps({tilted(0, {0, 0, 5}), tilted(1, {0, 0, 5})}) : steps({tilted(0.5f, {0, 0, 5})});
        scene.light(what == 1 ? TRP_LIGHT_SUN : TRP_LIGHT_SPOT, {20, 20, 20}, kIdentity, [&](TrpLightDesc& d) {
            d.world_from_light = lamp.data();
            d.time_count = lamp_turns ? 2 : 1;
            d.radius = 0;
            if (what != 1) d.angle = 0.7f;
            if (what == 1) d.angle = 0;
        });
        const std::vector<float> eye =
            camera_turns ? steps({at(0, {0, 0, 6}), at(1, {0, 0, 6})}) : steps({at(0.5f, {0, 0, 6})});
        scene.camera(kIdentity, [&](TrpCameraDesc& d) {
            d.world_from_camera = eye.data();
            d.time_count = camera_turns ? 2 : 1;
            d.shutter[0] = d.shutter[1] = 0.5f;
        });
        return blurred(scene, "ray_casting", {{"samples", "16"}}, 40, 40);
    };
    for (const int what : {0, 1, 2}) {
        const Image moved = picture(1.5f, true, what), still = picture(1.5f, false, what);
        size_t differ = 0;
        for (size_t i = 0; i < still.values.size(); ++i) differ += std::abs(moved.values[i] - still.values[i]) > 1e-3;
        EXPECT_LE(differ, 40u) << what << ": at edges, to rounding";
        EXPECT_GT(mean(still), 0.01);
    }
}

// A body that glows and grows gives as much light as its mean over time.
TEST(Motion, EmittersThatGrow) {
    const auto lit = [](float open, float close) {
        Scene scene;
        MeshData square = quad({-0.1f, -0.1f, 0}, {-0.1f, 0.1f, 0}, {0.1f, 0.1f, 0}, {0.1f, -0.1f, 0});
        square.materials = {glowing(scene, 50)};
        Transform large = translation({0, 0, 3});
        large[0] = large[5] = large[10] = 4;
        moving(scene, scene.mesh(square), {translation({0, 0, 3}), large});
        scene.object(floor_square(2), scene.diffuse(0.8f, 0.8f, 0.8f));
        scene.camera(look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0}), [&](TrpCameraDesc& d) {
            d.shutter[0] = open, d.shutter[1] = close;
            d.field_of_view = 0.3f;
        });
        return mean(blurred(scene, "ray_casting", {{"samples", "64"}}, 16, 16));
    };
    double expected = 0;
    for (int k = 0; k < 16; ++k) {
        const float time = (static_cast<float>(k) + 0.5f) / 16;
        expected += lit(time, time) / 16;
    }
    EXPECT_NEAR(lit(0, 1) / expected, 1, 0.02);
}

// What grows from a point is there.
TEST(Motion, WhatGrowsFromNothing) {
    Scene scene;
    MeshData square = floor_square(1);
    square.materials = {glowing(scene, 1)};
    Transform nothing = kIdentity;
    nothing[0] = nothing[5] = nothing[10] = 0;
    moving(scene, scene.mesh(square), {nothing, kIdentity});
    scene.camera_above(3);
    EXPECT_GT(mean(blurred(scene, "ray_casting")), 0.05);
}

// A shutter that opens for no time sees the mesh where it is then, to rounding: as one that stands there.
TEST(Motion, AClosedShutterSeesOneTime) {
    const auto picture = [](bool moves) {
        Scene scene;
        MeshData ball = sphere({0, 0, 0}, 0.6f, 24);
        ball.materials = {scene.diffuse(0.8f, 0.5f, 0.3f)};
        const uint32_t mesh = scene.mesh(ball);
        if (moves)
            moving(scene, mesh, {translation({-1, 0, 0}), translation({1, 2, 0})});
        else
            scene.instance(mesh, translation({-0.5f, 0.5f, 0}));
        scene.light(TRP_LIGHT_SUN, {3, 3, 3}, look_at({-1, -1, 2}, {0, 0, 0}));
        scene.camera(look_at({0, -4, 3}, {0, 0, 0}), [](TrpCameraDesc& d) { d.shutter[0] = d.shutter[1] = 0.25f; });
        return blurred(scene, "ray_casting", {{"samples", "16"}}, 40, 40);
    };
    const Image a = picture(true), b = picture(false);
    size_t differ = 0;
    for (size_t i = 0; i < a.values.size(); ++i) differ += std::abs(a.values[i] - b.values[i]) > 1e-4;
    EXPECT_LE(differ, 12u) << "where a ray meets an edge";
}

size_t different(const Image& a, const Image& b) {
    size_t count = 0;
    for (size_t i = 0; i < a.values.size(); ++i) count += std::abs(a.values[i] - b.values[i]) > 1e-3;
    return count;
}

// The samples of a mesh and those of its instance need not be at the same times.
TEST(Motion, SamplesOfMeshAndInstanceAreAllMet) {
    const auto picture = [](float time, bool moves) {
        // Along x by its mesh, of three samples, and along y by its instance, of four.
        const auto along = [&](std::vector<float> samples) {
            const float at = time * static_cast<float>(samples.size() - 1);
            const auto before = static_cast<size_t>(at);
            return samples[before] + (at - static_cast<float>(before)) * (samples[before + 1] - samples[before]);
        };
        const std::vector<float> x = {-1, 1, -1}, y = {0, 0.5f, -0.5f, 0};
        Scene scene;
        MeshData square = floor_square(0.5f);
        square.materials = {glowing(scene, 1)};
        if (moves) {
            const std::vector<float> first = square.positions;
            square.positions.clear();
            for (const float step : x)
                for (size_t i = 0; i < first.size(); ++i) square.positions.push_back(first[i] + (i % 3 ? 0 : step));
            std::vector<Transform> places;
            for (const float step : y) places.push_back(translation({0, step, 0}));
            moving(scene, scene.mesh(square, [](TrpMeshDesc& d) { d.time_count = 3; }), places);
        } else {
            scene.instance(scene.mesh(square), translation({along(x), along(y), 0}));
        }
        scene.camera(translation({0, 0, 10}), [&](TrpCameraDesc& d) {
            d.type = TRP_CAMERA_ORTHOGRAPHIC;
            d.width = 4;
            d.shutter[0] = d.shutter[1] = time;
        });
        return blurred(scene, "ray_casting", {{"samples", "4"}}, 40, 40);
    };
    for (const float time : {0.2f, 0.37f, 0.5f, 0.75f})
        EXPECT_LE(different(picture(time, true), picture(time, false)), 12u) << time << ": at edges, to rounding";
}

// A transform may come to mirror while the shutter is open: what is outside stays outside.
TEST(Motion, MirroringTurnsNothingInsideOut) {
    const auto picture = [](float share, bool moves, const char* method) {
        Scene scene;
        const auto scaled = [](float x) { return Transform{x, 0, 0, 0.3f, 0, 1, 0, 0, 0, 0, 1, 0}; };
        const auto add = [&](MeshData mesh, uint32_t material) {
            mesh.materials = {material};
            if (moves)
                moving(scene, scene.mesh(mesh), {scaled(1), scaled(-1)});
            else
                scene.instance(scene.mesh(mesh), scaled(1 - 2 * share));
        };
        add(sphere({0.8f, 0, 0}, 0.6f, 24), scene.material([](TrpMaterialDesc& d) {
            d.diffuse = {{0.8f, 0.3f, 0.2f}, TRP_NO_NODE};
            d.double_sided = 0;
        }));
        add(box({-1.5f, -0.5f, -0.5f}, {-0.7f, 0.5f, 0.5f}),
            glass(scene, 1.5f, [](TrpMaterialDesc& d) { d.absorption[0] = 1; }));
        scene.light(TRP_LIGHT_SUN, {3, 3, 3}, look_at({-1, -2, 2}, {0, 0, 0}));
        scene.world({0.5f, 0.5f, 0.5f});
        scene.camera(look_at({0.3f, -5, 1}, {0, 0, 0}), [&](TrpCameraDesc& d) { d.shutter[0] = d.shutter[1] = share; });
        return blurred(scene, method, {{"samples", "4"}}, 40, 40);
    };
    for (const char* method : {"ray_casting", "ray_tracing"})
        for (const float share : {0.1f, 0.9f})
            EXPECT_LE(different(picture(share, true, method), picture(share, false, method)), 40u)
                << method << " " << share << ": at edges, to rounding";
}

std::vector<std::string> warnings(Scene& scene) {
    scene.commit();
    std::vector<std::string> texts;
    for (uint32_t k = 0; k < trp_scene_warning_count(scene); ++k) {
        TrpWarning warning{};
        warning.struct_size = sizeof warning;
        check(trp_scene_warning(scene, k, &warning));
        texts.emplace_back(warning.text);
    }
    return texts;
}

TEST(Motion, WarnsOfWhatIsNotShown) {
    Scene scene;
    const auto lamp = [&](const char* name, int32_t type, const std::vector<Transform>& transforms) {
        const std::vector<float> rows = steps(transforms);
        scene.light(type, {1, 1, 1}, kIdentity, [&](TrpLightDesc& d) {
            d.name = name;
            d.world_from_light = rows.data();
            d.time_count = static_cast<uint32_t>(transforms.size());
        });
    };
    Transform large = kIdentity;
    large[5] = 1.5f;
    lamp("Growing", TRP_LIGHT_AREA, {kIdentity, kIdentity, large});
    lamp("Turning", TRP_LIGHT_AREA, {look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}), look_at({0, 1, 3}, {0, 2, 0})});
    lamp("Point", TRP_LIGHT_POINT, {kIdentity, large});
    const auto shown = [&](const char* name, uint32_t of_mesh, uint32_t of_instance) {
        MeshData square;
        for (uint32_t step = 0; step < of_mesh; ++step) {
            const std::vector<float> at = floor_square(1 + 0.1f * static_cast<float>(step)).positions;
            square.positions.insert(square.positions.end(), at.begin(), at.end());
        }
        square.offsets = {0, 4};
        square.corners = {0, 1, 2, 3};
        std::vector<Transform> places;
        for (uint32_t step = 0; step < of_instance; ++step)
            places.push_back(translation({0, 0, static_cast<float>(step)}));
        const std::vector<float> rows = steps(places);
        scene.instance(scene.mesh(square, [&](TrpMeshDesc& d) { d.time_count = of_mesh; }), kIdentity,
                       [&](TrpInstanceDesc& d) {
                           d.name = name;
                           d.world_from_object = rows.data();
                           d.time_count = of_instance;
                       });
    };
    shown("Together", 3, 5);
    shown("Apart", 4, 12);
    shown("Far apart", 128, 129);
    const std::vector<std::string> texts = warnings(scene);
    ASSERT_EQ(texts.size(), 2u);
    EXPECT_NE(texts[0].find("\"Growing\" changes its size"), std::string::npos) << texts[0];
    EXPECT_NE(texts[1].find("\"Far apart\" has 129 time samples and its mesh 128"), std::string::npos) << texts[1];
}

}  // namespace
}  // namespace trp_test
