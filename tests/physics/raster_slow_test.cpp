// The rasterizer at the sizes that people have: slow.
#include <cmath>
#include <random>

#include "support/abi.h"

namespace trp_test {
namespace {

TEST(RasterSlow, AClosedMeshHasNoHoleFromAnyView) {
    // A sphere of 10^6 triangles, emitting, before a dark world: every pixel whose ray meets the sphere that lies
    // wholly within the mesh is covered, at the sphere's depth, whatever way it is looked at.
    constexpr int kRings = 500;
    constexpr uint32_t kSide = 400;
    Scene scene;
    MeshData body = sphere({0, 0, 0}, 1, kRings);
    body.normals.clear();
    scene.object(body, scene.veil(1, 1));
    const double inside = std::cos(kPi / kRings) * std::cos(kPi / (2 * kRings));  // of all faces' planes
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    const Settings settings = {{"raster.samples", "1"}};
    uint64_t covered = 0, holes = 0, wrong = 0;
    for (int view = 0; view < 100; ++view) {
        const Vec way = unit({normal(random), normal(random), normal(random)}), up = unit({normal(random), 0.1f, 1});
        const float distance = 1.2f + 3 * static_cast<float>(view % 10) / 10,
                    angle = 2 * std::asin(1.05f / (distance + 0.2f));
        scene.camera(look_at(way * distance, {0, 0, 0}, up), [&](TrpCameraDesc& d) {
            d.field_of_view = angle;
            d.clip_start = 0.01f;
        });
        scene.commit();
        Render render(scene, kSide, kSide, settings, {"Depth"}, "visible_surface");
        const Image image = render.run().read(), depth = render.read("Depth");
        const double step = 2 * std::tan(angle / 2.0) / kSide;
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                // The ray (u, v, −1) t from (0, 0, distance): |p|² = inside².
                const double u = (x + 0.5) * step - step * kSide / 2, v = (y + 0.5) * step - step * kSide / 2,
                             a = u * u + v * v + 1, b = static_cast<double>(distance), c = b * b - inside * inside,
                             root = b * b - a * c;
                if (root <= 0) continue;
                const double inner = (b - std::sqrt(root)) / a;
                ++covered;
                holes += image.at(x, y)[0] != 1;
                wrong += depth.at(x, y)[0] > static_cast<float>(inner * 1.00001);
            }
    }
    EXPECT_GT(covered, 5'000'000u);
    EXPECT_EQ(holes, 0u);
    EXPECT_EQ(wrong, 0u) << "the far side is seen through the near one";
}

TEST(RasterSlow, LargeFilmsWithManySamplesTakeTheFilmsMemory) {
    Scene scene;
    scene.object(sphere({0, 0, 0}, 1, 200), scene.veil(1, 1));
    scene.camera_above(2.5f);
    scene.commit();
    constexpr uint32_t kSide = 8192;
    Render render(scene, kSide, kSide, {{"raster.samples", "32"}}, {}, "visible_surface");
    render.run();
    TrpStatistics statistics{};
    statistics.struct_size = sizeof statistics;
    check(trp_render_statistics(render, &statistics));
    constexpr uint64_t kFilm = uint64_t{kSide} * kSide * 4 * sizeof(float);
    EXPECT_LT(statistics.peak_memory_bytes, kFilm + (uint64_t{400} << 20));
    std::vector<float> row(size_t{kSide} * 4);
    check(trp_render_read(render, "Combined", 0, kSide / 2, kSide, 1, row.data(), row.size()));
    double sum = 0;
    for (size_t x = 0; x < kSide; ++x) sum += static_cast<double>(row[4 * x]);
    EXPECT_NEAR(sum, kSide * 2 / 2.5, 2) << "the sphere's width";
}

}  // namespace
}  // namespace trp_test
