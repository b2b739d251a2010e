// What both kinds of line drawings make of edges that are absurd, cut or absent.
#include <cmath>
#include <random>

#include "support/drawings.h"

namespace trp_test {
namespace {

TEST(Lines, AbsurdEdgesDoNoHarm) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> u(-1, 1);
    for (const int32_t type : {TRP_CAMERA_PERSPECTIVE, TRP_CAMERA_ORTHOGRAPHIC}) {
        Scene scene;
        MeshData m;
        const float sizes[] = {1e-30f, 1e-3f, 1, 50, 1e6f, 1e17f, 1e30f};
        for (uint32_t t = 0; t < 3000; ++t)
            for (uint32_t k = 0; k < 3; ++k) {
                const float size = sizes[random() % 7];
                for (int c = 0; c < 3; ++c) m.positions.push_back(size * u(random));
                m.corners.push_back(3 * t + k);
            }
        scene.object(m);
        for (int k = 0; k < 50; ++k)
            loose_edge(scene, {u(random) * 1e30f, 0, u(random)}, {u(random), u(random) * 1e30f, u(random) * 1e30f});
        scene.camera(kIdentity, [&](TrpCameraDesc& d) { d.type = type; });
        scene.commit();
        for (const char* method : {"wireframe", "hidden_line"})
            for (const float value : draw(scene, 120, 90, method, {{"lines.depth_cue", "0.5"}}).values)
                ASSERT_TRUE(value >= 0 && value <= 1) << method;
    }
}

TEST(Lines, EdgesThroughTheEyePlaneAreCut) {
    Scene scene;
    loose_edge(scene, {-1, -0.5f, -4}, {3, 1.5f, 4});
    scene.camera(kIdentity, [](TrpCameraDesc& d) { d.clip_start = 0.1f; });
    scene.commit();
    // The line goes through (0, 0, −2) and (0.95, 0.475, −0.1), far outside of the film.
    const Image image = draw(scene, 200, 160, "wireframe");
    EXPECT_GT(ink(image, 100, 80) + ink(image, 99, 79), 0.4f);
    EXPECT_LT(ink(image, 50, 150), 0.01f);
    EXPECT_GT(total_ink(image), 50);
}

TEST(Lines, EdgesEndAtTheFarEnd) {
    Scene scene;
    loose_edge(scene, {-2, -0.5f, -2}, {6, -0.5f, -18});  // straight on the film, to the right
    scene.camera(kIdentity, [](TrpCameraDesc& d) {
        d.clip_start = 0.1f;
        d.clip_end = 6;
        d.field_of_view = 1.6f;
    });
    scene.commit();
    // At depth 6 the edge is at (0, −0.5).
    const double per_pixel = 2 * std::tan(0.8) / 200;
    for (const char* method : {"wireframe", "hidden_line"}) {
        const Image image = draw(scene, 200, 160, method, {{"lines.width", "3"}});
        const auto inked = [&](double depth) {
            const double x = (-2 + (depth - 2) / 2) / depth / per_pixel + 100, y = -0.5 / depth / per_pixel + 80;
            return ink(image, static_cast<int>(x), static_cast<int>(y));
        };
        EXPECT_GT(inked(5.5), 0.5f) << method;
        EXPECT_LT(inked(6.8), 0.02f) << method;
        EXPECT_LT(inked(12), 0.02f) << method;
    }
}

TEST(Lines, ASceneWithoutEdgesIsPaper) {
    Scene scene;
    see_from_above(scene);
    for (const char* method : {"wireframe", "hidden_line"}) EXPECT_EQ(total_ink(draw(scene, 40, 30, method)), 0);
}

TEST(Lines, ManyEdgesInOnePixel) {
    Scene scene;
    MeshData tiny = sphere({0, 0, 0}, 1e-3f, 200);
    scene.object(tiny);
    see_from_above(scene);
    for (const char* method : {"wireframe", "hidden_line"}) {
        const Image image = draw(scene, kWidth, kHeight, method);
        EXPECT_GT(total_ink(image), 0.5) << method;
        EXPECT_LT(total_ink(image), 4) << method;
    }
}

TEST(Lines, DepthOfFieldIsRefused) {
    Scene scene;
    scene.object(floor_square(1));
    scene.camera(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}), [](TrpCameraDesc& d) { d.aperture_radius = 0.1f; });
    scene.commit();
    for (const char* method : {"wireframe", "hidden_line"}) {
        Render render(scene, 20, 20, {}, {}, method);
        EXPECT_EQ(trp_render_run(render, nullptr), TRP_ERROR_STATE);
        EXPECT_NE(std::string(trp_error_message()).find("ray_casting"), std::string::npos) << trp_error_message();
    }
}

}  // namespace
}  // namespace trp_test
