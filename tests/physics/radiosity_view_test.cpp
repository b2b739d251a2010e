// A solution is seen the same from anywhere, and is the same bit for bit whoever computes it.
#include <cstring>

#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

// One ray through the middle of each pixel.
const Settings kSharp = {{"samples", "1"}, {"raster.samples", "1"}, {"film.filter_width", "0"}};
const char* const kSolvers[] = {"matrix", "progressive", "hierarchical"};

Solution::Settings coarse(const std::string& solver) {
    Solution::Settings settings = by(solver, "hemisphere");
    settings.insert(settings.end(), {{"radiosity.element_size", solver == "hierarchical" ? "0" : "0.2"},
                                     {"radiosity.iterations", "40"}});
    return settings;
}

TEST(RadiosityPictures, TwoCamerasSeeTheSame) {
    Random random{std::mt19937(5)};
    Scene scene;
    make_room(scene, random, true);
    for (const char* solver : kSolvers) {
        Solution solution(scene, coarse(solver));
        solution.solve();
        scene.camera(look_at(kEye, {0.6f, 0.5f, 0.35f}), [](TrpCameraDesc& d) { d.field_of_view = 1.6f; });
        scene.commit();
        constexpr uint32_t kSide = 9;
        Render first(scene, kSide, kSide, kSharp, {"Position"}, "radiosity");
        check(trp_render_set_radiosity(first, solution));
        const Image seen = first.run().read(), places = first.read("Position");
        uint32_t compared = 0;
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                const float* const p = places.at(x, y);
                const Vec place = {p[0], p[1], p[2]};
                scene.camera(look_at({0.9f, 0.1f, 0.6f}, place));
                scene.commit();
                Render second(scene, 1, 1, kSharp, {"Position"}, "radiosity");
                check(trp_render_set_radiosity(second, solution));
                const Image again = second.run().read();
                const Image found = second.read("Position");
                const float* const there = found.at(0, 0);
                const Vec off = Vec{there[0], there[1], there[2]} - place;
                if (dot(off, off) > 1e-8f) continue;  // something stands between
                ++compared;
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(again.at(0, 0)[c], seen.at(x, y)[c], 1e-4 * seen.at(x, y)[c])
                        << solver << ' ' << x << ' ' << y;
            }
        EXPECT_GT(compared, 40u);
    }
}

TEST(RadiosityPictures, IsTheSameForAnyThreadsAndTiles) {
    Random random{std::mt19937(6)};
    Scene scene;
    make_room(scene, random, true);
    scene.light(TRP_LIGHT_POINT, {0.2f, 0.2f, 0.2f}, translation({0.5f, 0.5f, 0.5f}),
                [](TrpLightDesc& d) { d.radius = 0.05f; });
    scene.commit();
    for (const char* solver : kSolvers) {
        std::vector<float> values[3], pictures[3];
        const char* const threads[] = {"1", "2", "5"};
        const char* const tiles[] = {"64", "16", "40"};
        for (int k = 0; k < 3; ++k) {
            Solution::Settings settings = coarse(solver);
            settings.emplace_back("threads", threads[k]);
            Solution solution(scene, settings);
            values[k] = solution.solve().read("radiosity", 3);
            Render render(scene, 60, 40, {{"threads", threads[k]}, {"film.tile_size", tiles[k]}}, {}, "radiosity");
            check(trp_render_set_radiosity(render, solution));
            pictures[k] = render.run().read().values;
        }
        for (int k = 1; k < 3; ++k) {
            ASSERT_EQ(values[k].size(), values[0].size());
            EXPECT_EQ(std::memcmp(values[k].data(), values[0].data(), values[0].size() * sizeof(float)), 0) << solver;
            EXPECT_EQ(std::memcmp(pictures[k].data(), pictures[0].data(), pictures[0].size() * sizeof(float)), 0)
                << solver;
        }
    }
}

}  // namespace
}  // namespace trp_test
