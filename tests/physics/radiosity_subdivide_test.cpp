// Elements of the matrix and progressive solvers that are divided where radiosity changes fast.
#include <atomic>
#include <cstring>
#include <thread>

#include "support/radiosity_error.h"

namespace trp_test {
namespace {

const char* const kSolvers[] = {"matrix", "progressive"};

Solution::Settings divided(const std::string& solver, const std::string& size, int levels) {
    Solution::Settings settings = by(solver, "hemisphere");
    settings.insert(settings.end(),
                    {{"radiosity.element_size", size}, {"radiosity.subdivisions", std::to_string(levels)}});
    return settings;
}

void add_room(Scene& scene, unsigned seed, bool stands) {
    Random random{std::mt19937(seed)};
    make_room(scene, random, stands);
}

TEST(RadiositySubdivisions, HalveTheErrorWithFewerElementsThanHalfTheSize) {
    // Against path tracing of a room with a block. By contour integrals 9.1 %, and 3.9 % with 57 % of the elements of
    // half the size (2.8 %); chance in rows of rays divides some more and leaves some more. What the whole elements
    // have wrong by then stays, so that a second division gains little.
    Scene scene;
    add_room(scene, 0, true);
    const PathTraced known(scene, kEye, 64);
    Solution coarse(scene, divided("matrix", "0.125", 0)), parts(scene, divided("matrix", "0.125", 1)),
        fine(scene, divided("matrix", "0.0625", 0));
    EXPECT_LT(known.error_of(parts.solve()), 0.55 * known.error_of(coarse.solve()));
    EXPECT_LT(parts.info().element_count, 0.75 * fine.prepare().info().element_count);
}

TEST(RadiositySubdivisions, EdgesOfShadowsGetSmallElements) {
    // A square half a metre above a floor, half way under a lamp of one point: its shadow is twice as large.
    Scene scene;
    const uint32_t grey = wall(scene, 0.5f);
    scene.object(floor_square(1), grey);
    scene.object(floor_square(0.3f, 0.5f), wall(scene, 0));
    scene.light(TRP_LIGHT_POINT, {1, 1, 1}, translation({0, 0, 1}));
    for (const char* solver : kSolvers) {
        Solution::Settings settings = divided(solver, "0.25", 4);
        settings.emplace_back("radiosity.tolerance", "0.01");
        Solution solution(scene, settings);
        solution.solve();
        const std::vector<float> centre = solution.read("centre", 3), area = solution.read("area", 1);
        const float smallest = std::pow(0.25f / 16, 2.0f);
        uint32_t small = 0, large = 0;
        for (size_t k = 0; k < area.size(); ++k) {
            if (centre[3 * k + 2] != 0) continue;
            const float out = std::max(std::abs(centre[3 * k]), std::abs(centre[3 * k + 1])), side = std::sqrt(area[k]);
            small += area[k] < 1.01f * smallest;
            large += area[k] > 0.99f * 0.0625f;
            // Whoever the edge of the shadow crosses is of the smallest.
            const float along = std::min(std::abs(centre[3 * k]), std::abs(centre[3 * k + 1]));
            if (along < 0.5f && std::abs(out - 0.6f) < 0.45f * side) {
                EXPECT_NEAR(area[k], smallest, 1e-6f) << solver;
            }
        }
        EXPECT_GT(small, 250u) << solver;
        EXPECT_GT(large, 10u) << solver;
    }
}

TEST(RadiositySubdivisions, LessLightComesUnderWalls) {
    // Two rooms on one floor of three elements, a wall on the middle one, and a lamp in the one room: what is seen of
    // the floor in the other is less each time.
    Scene scene;
    const uint32_t grey = wall(scene, 0.5f);
    scene.object(inwards(box({0, 0, 0}, {3, 1, 1})), grey);
    scene.object(box({1.35f, -0.1f, -0.1f}, {1.65f, 1.1f, 1.1f}), grey);
    scene.light(TRP_LIGHT_POINT, {1, 1, 1}, translation({0.5f, 0.5f, 0.8f}));
    scene.camera(look_at({2.5f, 0.5f, 0.9f}, {1.8f, 0.5f, 0}));
    scene.commit();
    for (const char* solver : kSolvers) {
        double first = 0, before = 1e30;
        for (const int levels : {0, 1, 2, 3}) {
            Solution solution(scene, divided(solver, "1", levels));
            solution.solve();
            Render render(scene, 32, 32, {}, {}, "radiosity");
            check(trp_render_set_radiosity(render, solution));
            const double seen = mean(render.run().read());
            EXPECT_LT(seen, before) << solver << ' ' << levels;
            before = seen;
            if (levels == 0) first = seen;
        }
        EXPECT_LT(before, 0.3 * first) << solver;
    }
}

TEST(RadiositySubdivisions, WhatABodyStandsOnIsDividedAlongItsSides) {
    // A floor of one element under an even sky: but for the block, nothing would be divided more than once.
    Scene scene;
    scene.object(quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}), wall(scene, 0.5f));
    scene.light(TRP_LIGHT_SUN, {1, 1, 1}, translation({0, 0, 9}));
    scene.object(box({-0.7f, -0.7f, 0}, {0.7f, 0.7f, 0.01f}), wall(scene, 0));
    for (const char* solver : kSolvers) {
        Solution solution(scene, divided(solver, "0", 4));
        const std::vector<double> h = solution.solve().red("irradiance");
        const std::vector<float> centre = solution.read("centre", 3), area = solution.read("area", 1);
        const double sky = *std::max_element(h.begin(), h.end());
        uint32_t smallest = 0;
        for (size_t k = 0; k < area.size(); ++k) {
            if (centre[3 * k + 2] != 0) continue;
            const float out = std::max(std::abs(centre[3 * k]), std::abs(centre[3 * k + 1]));
            if (std::abs(area[k] - 0.015625f) < 1e-6f) {
                ++smallest;
                EXPECT_NEAR(out, 0.7f, 0.2f) << solver;
            }
            // Outside it is as bright as the sky makes it, beside the block too.
            if (out > 0.8f) {
                EXPECT_NEAR(h[k], sky, 0.01 * sky) << solver << ' ' << centre[3 * k] << ' ' << centre[3 * k + 1];
            }
        }
        EXPECT_GE(smallest, 36u) << solver;
    }
}

// All that may be read of a solution.
std::vector<float> all_of(const Solution& solution) {
    std::vector<float> out;
    for (const char* name : {"radiosity", "irradiance", "unshot", "reflectance", "centre", "vertex_irradiance"}) {
        const std::vector<float> values = solution.read(name, 3);
        out.insert(out.end(), values.begin(), values.end());
    }
    return out;
}

TEST(RadiositySubdivisions, StoppedTheyLeaveTheSolutionAndGoOn) {
    Scene scene;
    add_room(scene, 3, true);
    for (const char* solver : kSolvers) {
        Solution whole(scene, divided(solver, "0.2", 0)), known(scene, divided(solver, "0.2", 2)),
            solution(scene, divided(solver, "0.2", 2));
        const uint32_t steps = whole.solve().info().iterations;
        EXPECT_EQ(known.solve().info().iterations, steps + 2) << solver;
        const std::vector<float> before = all_of(whole);
        EXPECT_EQ(all_of(solution.step(steps)), before) << solver;
        std::atomic<bool> done{false};
        std::thread stopper([&] {
            while (!done) {
                check(trp_radiosity_cancel(solution));
                std::this_thread::sleep_for(std::chrono::microseconds(100));
            }
        });
        const TrpStatus status = trp_radiosity_solve(solution, nullptr);
        done = true;
        stopper.join();
        EXPECT_EQ(status, TRP_CANCELLED) << solver;
        EXPECT_EQ(solution.info().iterations, steps) << solver;
        EXPECT_FALSE(solution.info().solved) << solver;
        EXPECT_EQ(all_of(solution), before) << solver;
        EXPECT_EQ(all_of(solution.solve()), all_of(known)) << solver;
        EXPECT_TRUE(solution.info().solved) << solver;
    }
}

TEST(RadiositySubdivisions, AreTheSameForAnyThreads) {
    Scene scene;
    add_room(scene, 4, true);
    scene.light(TRP_LIGHT_POINT, {0.2f, 0.2f, 0.2f}, translation({0.5f, 0.5f, 0.5f}),
                [](TrpLightDesc& d) { d.radius = 0.05f; });
    for (const char* solver : kSolvers)
        for (const char* kind : {"analytic", "hemisphere", "hemicube"}) {
            std::vector<float> values[2];
            for (int k = 0; k < 2; ++k) {
                Solution::Settings settings = divided(solver, "0.3", 1);
                settings.insert(settings.end(), {{"threads", k ? "2" : "1"},
                                                 {"radiosity.form_factors", kind},
                                                 {"radiosity.iterations", "40"},
                                                 {"radiosity.hemicube_resolution", "64"}});
                Solution solution(scene, settings);
                values[k] = all_of(solution.solve());
            }
            ASSERT_EQ(values[0].size(), values[1].size()) << solver << ' ' << kind;
            EXPECT_EQ(std::memcmp(values[0].data(), values[1].data(), values[0].size() * sizeof(float)), 0)
                << solver << ' ' << kind;
        }
}

TEST(RadiositySubdivisions, RowsOfPartsSumToOne) {
    Scene scene;
    add_cube(scene, wall(scene, 0.5f, 1, false), wall(scene, 0.5f, 0, false));
    Solution::Settings settings = divided("matrix", "0.25", 2);
    settings.emplace_back("radiosity.form_factors", "analytic");
    Solution solution(scene, settings);
    solution.solve();
    ASSERT_GT(solution.info().element_count, 150u);
    for (const float sum : solution.read("row_sum", 1)) EXPECT_NEAR(sum, 1, 1e-6);
    double sum = 0;
    for (const double f : solution.row(solution.info().element_count - 1)) sum += f;
    EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(RadiositySubdivisions, PartsHaveThePowerOfTheWhole) {
    Scene scene;
    add_room(scene, 5, false);
    for (const char* solver : kSolvers) {
        double power[2], area[2];
        for (const int levels : {0, 2}) {
            Solution solution(scene, divided(solver, "0.2", levels));
            const TrpRadiosityInfo info = solution.solve().info();
            power[levels / 2] = info.power[0];
            area[levels / 2] = info.area;
        }
        EXPECT_NEAR(area[1], area[0], 1e-5 * area[0]) << solver;
        EXPECT_NEAR(power[1], power[0], 0.01 * power[0]) << solver;
    }
}

TEST(RadiositySubdivisions, AreInterpolatedWithoutCracks) {
    // Along lines that are sides of elements, large ones on one side and smaller ones on the other: what is seen a
    // twentieth of a millimetre off is the same on both.
    Scene scene;
    scene.object(floor_square(1), wall(scene, 0.5f));
    scene.object(floor_square(0.3f, 0.5f), wall(scene, 0));
    scene.light(TRP_LIGHT_POINT, {1, 1, 1}, translation({0, 0, 1}));
    for (const char* solver : kSolvers) {
        Solution solution(scene, divided(solver, "0.25", 3));
        solution.solve();
        const std::vector<double> h = solution.red("irradiance");
        const double greatest = *std::max_element(h.begin(), h.end()) * 0.5 / kPi;
        uint32_t changes = 0;
        for (const float y : {-0.9375f, -0.875f, -0.75f, -0.6875f, -0.625f, -0.5f, -0.4375f}) {
            scene.camera_above(1.9f, {0, y});
            scene.commit();
            constexpr uint32_t kAcross = 19000;
            Render render(scene, kAcross, 2, {{"raster.samples", "1"}, {"film.filter_width", "0"}}, {}, "radiosity");
            check(trp_render_set_radiosity(render, solution));
            const Image image = render.run().read();
            for (uint32_t x = 0; x < kAcross; ++x) {
                // The steepest there is: from light to shadow within one of the smallest elements.
                EXPECT_NEAR(image.at(x, 0)[0], image.at(x, 1)[0], 1e-4 / (0.25 / 8) * greatest) << y << ' ' << x;
                changes += x >= 100 && std::abs(image.at(x, 0)[0] - image.at(x - 100, 0)[0]) > 0.02 * greatest;
            }
        }
        EXPECT_GT(changes, 100u) << solver;
    }
}

}  // namespace
}  // namespace trp_test
