// Adaptive sampling: fewer samples where they are not needed, no more noise than was asked for, and nothing missed.
#include <numeric>

#include "support/bodies.h"

namespace trp_test {
namespace {

constexpr uint32_t kWidth = 96, kHeight = 64;

struct Picture {
    Image combined, samples;
};

Picture sampled(Scene& scene, const Settings& settings, const char* method = "ray_casting", uint32_t width = kWidth,
                uint32_t height = kHeight) {
    Render render(scene, width, height, with({{"film.filter", "box"}, {"film.filter_width", "1"}}, settings),
                  {"SampleCount"}, method);
    render.run();
    return {render.read(), render.read("SampleCount")};
}

double mean_samples(const Picture& picture) {
    return mean(picture.samples);
}

// How far a picture is from the right one, as the threshold has it.
double error_at(const Picture& picture, const Picture& right, size_t pixel, size_t c) {
    const double value = right.combined.values[4 * pixel + c];
    return (picture.combined.values[4 * pixel + c] - value) / std::sqrt(std::max(value, 0.01));
}

// A floor with a box, lit by an area light: a wide penumbra beside light that is all there, and one lamp far away.
void build_penumbra(Scene& scene) {
    scene.object(floor_square(20), scene.diffuse(0.7f, 0.6f, 0.5f));
    scene.object(box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 1}), scene.diffuse(0.2f, 0.5f, 0.7f));
    scene.light(TRP_LIGHT_AREA, {3, 3, 3}, look_at({-3, 2, 4}, {0, 0, 0}),
                [](TrpLightDesc& d) { d.size[0] = d.size[1] = 1.5f; });
    scene.camera(look_at({2, -5, 4}, {0.5f, 0, 0}));
    scene.commit();
}

TEST(Adaptive, APlainPictureTakesTheLeast) {
    Scene scene;
    scene.object(floor_square(100), scene.diffuse(0.5f, 0.5f, 0.5f));
    scene.light(TRP_LIGHT_SUN, {3, 3, 3}, look_at({1, 1, 2}, {0, 0, 0}));
    scene.camera_above(10);
    scene.commit();
    for (const float value : sampled(scene, {{"samples", "256"}, {"adaptive.threshold", "0.01"}}).samples.values)
        ASSERT_EQ(value, 32);
    for (const float value :
         sampled(scene, {{"samples", "256"}, {"adaptive.threshold", "0.01"}, {"adaptive.least_samples", "16"}})
             .samples.values)
        ASSERT_EQ(value, 16);
    for (const float value : sampled(scene, {{"samples", "6"}, {"adaptive.threshold", "0.01"}}).samples.values)
        ASSERT_EQ(value, 6) << "as many as were asked for at most";
}

TEST(Adaptive, LeavesTheNoiseThatWasAskedFor) {
    Scene scene;
    build_penumbra(scene);
    const Picture right = sampled(scene, {{"samples", "512"}, {"seed", "9"}});
    double before = 0;
    for (const double threshold : {0.04, 0.02, 0.01}) {
        const Picture picture =
            sampled(scene, {{"samples", "2048"}, {"adaptive.threshold", std::to_string(threshold)}});
        double squares = 0;
        size_t beyond = 0;
        for (size_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
            for (size_t c = 0; c < 3; ++c) {
                const double error = error_at(picture, right, pixel, c);
                squares += error * error / (3 * kWidth * kHeight);
                beyond += std::abs(error) > 3 * threshold;
            }
        EXPECT_LT(std::sqrt(squares), threshold);
        EXPECT_LT(static_cast<double>(beyond) / (3 * kWidth * kHeight), 2e-3) << "pixels at " << threshold;
        EXPECT_GT(mean_samples(picture), before) << "less noise takes more samples";
        before = mean_samples(picture);
        EXPECT_LT(before, 1500);
        EXPECT_GE(*std::min_element(picture.samples.values.begin(), picture.samples.values.end()), 32);
    }
}

// Wires an eighth of a pixel wide, in all directions: where many samples see one, few do not miss it.
TEST(Adaptive, MissesNothingOfAFineGrid) {
    Scene scene;
    const uint32_t white = scene.diffuse(1, 1, 1);
    for (int k = 0; k < 12; ++k) {
        const float angle = 0.37f * static_cast<float>(k), at = -4 + static_cast<float>(k) * 0.7f;
        const Vec along = {std::cos(angle), std::sin(angle), 0}, across = {-along[1], along[0], 0};
        const Vec from = across * at - along * 10, to = across * at + along * 10, side = across * (0.125f / 9.6f / 2);
        scene.object(quad(from - side, to - side, to + side, from + side), white);
    }
    scene.camera_above(10);
    scene.commit();
    const Settings lit = {{"shading.ambient", "1,1,1"}};
    const Picture right = sampled(scene, with(lit, {{"samples", "256"}, {"seed", "9"}})),
                  picture = sampled(scene, with(lit, {{"samples", "512"}, {"adaptive.threshold", "0.06"}}));
    size_t seen = 0;
    for (size_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
        seen += right.combined.values[4 * pixel] > 0.05f;
        ASSERT_NEAR(error_at(picture, right, pixel, 0), 0, 0.2) << pixel;
        if (right.combined.values[4 * pixel] > 0.02f) {
            ASSERT_GT(picture.combined.values[4 * pixel], 0) << pixel;
        }
    }
    EXPECT_GT(seen, 500u);
    EXPECT_LT(mean_samples(picture), 300);
}

// Edges are trusted later than plain faces, in every method.
TEST(Adaptive, EdgesTakeMore) {
    Scene scene;
    scene.object(floor_square(2));
    scene.object(floor_square(1, 0.001f));
    scene.camera_above(3.1f);
    scene.commit();
    for (const char* method : {"ray_casting", "ray_tracing", "path_tracing"}) {
        const Picture picture = sampled(scene, {{"samples", "1024"}, {"adaptive.threshold", "1"}}, method);
        const auto [least, most] = std::minmax_element(picture.samples.values.begin(), picture.samples.values.end());
        EXPECT_EQ(*least, 32) << method;
        EXPECT_EQ(*most, 128) << method;
    }
}

// A black card on a film without a background: all that can be noisy is alpha.
TEST(Adaptive, LooksAtAlpha) {
    Scene scene;
    MeshData card = quad({-1, -0.7f, 0}, {0.8f, -1, 0}, {1, 0.6f, 0}, {-0.9f, 0.9f, 0});
    scene.object(card, scene.diffuse(0, 0, 0));
    scene.camera_above(3);
    scene.commit();
    constexpr uint32_t kSide = 48;
    const auto seen = [&](const Settings& settings) {
        return sampled(scene, with({{"film.transparent", "on"}, {"samples", "512"}}, settings), "ray_casting", kSide,
                       kSide)
            .combined;
    };
    const Image right = seen({{"seed", "5"}}), picture = seen({{"adaptive.threshold", "0.01"}});
    for (size_t pixel = 0; pixel < kSide * kSide; ++pixel)
        ASSERT_NEAR(picture.values[4 * pixel + 3], right.values[4 * pixel + 3], 0.025) << pixel;
}

TEST(Adaptive, DependsNotOnTilesThreadsAndWindows) {
    Scene scene;
    build_penumbra(scene);
    for (const char* method : {"ray_casting", "path_tracing"}) {
        const Settings settings = {{"samples", "100"}, {"adaptive.threshold", "0.03"}, {"threads", "1"}};
        const Picture picture = sampled(scene, settings, method);
        const Picture others[] = {sampled(scene, with(settings, {{"threads", "5"}, {"film.tile_size", "16"}}), method)};
        for (const Picture& other : others) {
            EXPECT_EQ(picture.combined.values, other.combined.values) << method;
            EXPECT_EQ(picture.samples.values, other.samples.values) << method;
        }
        // A window that cuts blocks.
        Render part(scene, kWidth, kHeight, with({{"film.filter", "box"}, {"film.filter_width", "1"}}, settings), {},
                    method);
        check(trp_render_set_film(part, kWidth, kHeight, 21, 13, 40, 30));
        part.run();
        std::vector<float> values(size_t{40} * 30 * 4);
        check(trp_render_read(part, "Combined", 21, 13, 40, 30, values.data(), values.size()));
        for (uint32_t y = 0; y < 30; ++y)
            for (uint32_t i = 0; i < 160; ++i)
                ASSERT_EQ(values[y * 160 + i], picture.combined.at(21, 13 + y)[i])
                    << method << " " << i / 4 << ", " << y;
    }
}

}  // namespace
}  // namespace trp_test
