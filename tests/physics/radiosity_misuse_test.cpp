// Scenes that are not as they should be, and solving that is stopped: what there is is said or valid.
#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

const char* const kSolvers[] = {"matrix", "progressive", "hierarchical"};
const char* const kKinds[] = {"analytic", "hemisphere", "hemicube"};

void expect_within(const std::vector<double>& values, double low, double high, const std::string& what) {
    for (size_t k = 0; k < values.size(); ++k) {
        ASSERT_TRUE(std::isfinite(values[k])) << what << ", element " << k;
        EXPECT_GE(values[k], low) << what << ", element " << k;
        EXPECT_LE(values[k], high) << what << ", element " << k;
    }
}

// Bodies in a furnace, E = 1 and ρ = 0.5 everywhere, so that B = 2 wherever light comes.
struct Furnace : Scene {
    explicit Furnace(const std::vector<MeshData>& bodies) {
        const uint32_t grey = wall(*this, 0.5f, 1);
        add_cube(*this, grey, grey);
        for (const MeshData& body : bodies) object(body, grey);
    }
};
double rms_from_2(const Solution& solution) {
    const std::vector<double> b = solution.red("radiosity");
    const std::vector<float> area = solution.read("area", 1);
    double squares = 0, all = 0;
    for (size_t k = 0; k < b.size(); ++k) squares += area[k] * std::pow(b[k] - 2, 2), all += area[k];
    return std::sqrt(squares / all);
}

const MeshData kBox = box({0.2f, 0.2f, 0.2f}, {0.6f, 0.6f, 0.6f});

TrpWarning first_warning(TrpRadiosity* solution) {
    TrpWarning warning{};
    warning.struct_size = sizeof warning;
    check(trp_radiosity_warning(solution, 0, &warning));
    return warning;
}
std::string first_text(TrpRadiosity* solution) {
    return first_warning(solution).text;
}

TEST(RadiosityMisuse, BodiesThatCrossHideEachOther) {
    Furnace furnace({kBox, box({0.4f, 0.4f, 0.4f}, {0.8f, 0.8f, 0.8f})});
    for (const auto& [solver, kind] : {std::pair{"matrix", "analytic"},
                                       {"matrix", "hemisphere"},
                                       {"progressive", "analytic"},
                                       {"hierarchical", "analytic"}}) {
        Solution::Settings settings = by(solver, kind);
        settings.emplace_back("radiosity.element_size", std::string(solver) == "hierarchical" ? "0" : "0.25");
        settings.emplace_back("radiosity.tolerance", "0.04");
        Solution solution(furnace, settings);
        solution.solve();
        EXPECT_LT(rms_from_2(solution), 0.08) << solver << ' ' << kind;
    }
}

TEST(RadiosityMisuse, FacesInOnePlaceShareTheirLight) {
    // A body twice, two that touch, and a sheet on the floor, face up or down: what is seen twice is not twice as
    // bright.
    for (const std::vector<MeshData>& bodies : std::vector<std::vector<MeshData>>{
             {kBox, kBox},
             {kBox, box({0.6f, 0.2f, 0.2f}, {0.8f, 0.6f, 0.6f})},
             {quad({0.2f, 0.2f, 0}, {0.6f, 0.2f, 0}, {0.6f, 0.6f, 0}, {0.2f, 0.6f, 0})},
             {quad({0.2f, 0.2f, 0}, {0.2f, 0.6f, 0}, {0.6f, 0.6f, 0}, {0.6f, 0.2f, 0})}}) {
        Furnace furnace(bodies);
        for (const char* kind : {"analytic", "hemisphere"}) {
            Solution::Settings settings = by("matrix", kind);
            settings.emplace_back("radiosity.element_size", "0.25");
            Solution solution(furnace, settings);
            solution.solve();
            EXPECT_LT(rms_from_2(solution), 0.02) << kind;
        }
        // Shots end, whatever is in one place.
        Solution::Settings settings = by("progressive");
        settings.insert(
            settings.end(),
            {{"radiosity.element_size", "0.25"}, {"radiosity.iterations", "2000"}, {"radiosity.tolerance", "0.04"}});
        Solution solution(furnace, settings);
        solution.solve();
        EXPECT_TRUE(solution.info().solved);
        expect_within(solution.red("radiosity"), 1 - 1e-6, 4, "progressive");
    }
}

TEST(RadiosityMisuse, FacesSeenEdgeOnGiveNothing) {
    // A wall in the plane of another; one that stands in the other's plane; and one behind it.
    for (const MeshData& other :
         {quad({2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}), quad({1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}),
          quad({2, 0, -1}, {2, 1, -1}, {2, 1, 0}, {2, 0, 0}), quad({0, 0, -1}, {1, 0, -1}, {1, 1, -1}, {0, 1, -1})}) {
        Scene scene;
        const uint32_t grey = wall(scene, 0.5f, 1, false);
        scene.object(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), grey);
        scene.object(other, grey);
        for (const char* kind : kKinds) {
            Solution solution(scene, by("matrix", kind));
            solution.prepare();
            ASSERT_EQ(solution.info().element_count, 2u);
            EXPECT_EQ(solution.row(0)[1], 0) << kind;
            EXPECT_EQ(solution.row(1)[0], 0) << kind;
        }
        for (const char* solver : kSolvers)
            for (const double b : Solution(scene, by(solver)).solve().red("radiosity"))
                EXPECT_NEAR(b, 1, 1e-6) << solver;
    }
}

TEST(RadiosityMisuse, FacesWithoutAreaTakeNoPart) {
    // A point, a line, a triangle as thin as single precision has it, a sound quad, and one whose corners lie in a
    // line.
    MeshData m;
    m.positions = {0.2f, 0.2f,       0.5f, 0.5f, 0.2f, 0.5f, 0.8f, 0.2f, 0.5f,
                   0.4f, 0.2000001f, 0.5f, 0.2f, 0.8f, 0.5f, 0.5f, 0.8f, 0.5f};
    m.corners = {0, 0, 0, 0, 1, 2, 0, 1, 3, 0, 1, 5, 4, 0, 1, 2, 1};
    m.offsets = {0, 3, 6, 9, 13, 17};
    Scene scene;
    const uint32_t grey = wall(scene, 0.5f, 1);
    scene.object(m, grey);
    add_cube(scene, grey, grey);
    for (const std::string solver : kSolvers)
        for (const char* kind : kKinds)
            for (const char* size : {"0", "0.3"}) {
                Solution::Settings settings = by(solver, kind);
                settings.insert(settings.end(), {{"radiosity.element_size", size},
                                                 {"radiosity.iterations", "50"},
                                                 {"radiosity.hemicube_resolution", "32"}});
                Solution solution(scene, settings);
                expect_within(solution.solve().red("radiosity"), 1 - 1e-6, 2.2, solver + " " + kind);
                for (const float a : solution.read("vertex_radiosity", 3)) EXPECT_TRUE(std::isfinite(a));
            }
}

TEST(RadiosityMisuse, OpenScenesLoseWhatLeavesThem) {
    Scene scene;
    scene.object(box({-1, -1, 0.1f}, {1, 1, 1}), wall(scene, 0.5f, 1, false));
    scene.object(floor_square(4), wall(scene, 0.8f, 0, false));
    scene.world({0.5f, 0.5f, 0.5f});
    for (const std::string solver : kSolvers) {
        Solution::Settings settings = by(solver);
        settings.emplace_back("radiosity.element_size", solver == "hierarchical" ? "0" : "0.5");
        Solution solution(scene, settings);
        const std::vector<double> b = solution.solve().red("radiosity");
        // Of the brightest, B = 1 + 0.5 H, where H is at most that of the world, π / 2, or of the brightest.
        expect_within(b, 0, 2, solver);
        EXPECT_EQ(trp_radiosity_warning_count(solution), 0u);
    }
}

TEST(RadiosityMisuse, WhatIsNotANumberIsRefusedByName) {
    Scene scene;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        TrpMaterialDesc desc;
        check(trp_material_desc_init(&desc, sizeof desc));
        desc.name = "lamp";
        desc.emission = {{1, bad, 1}, TRP_NO_NODE};
        uint32_t id = 0;
        EXPECT_EQ(trp_material_add(scene, &desc, &id), TRP_ERROR_ARGUMENT);
        EXPECT_NE(std::string(trp_error_message()).find("lamp"), std::string::npos);
        EXPECT_NE(std::string(trp_error_message()).find("emission"), std::string::npos);
    }
    scene.object(floor_square(1));
    Solution solution(scene, {});
    for (const char* name : {"radiosity.tolerance", "radiosity.element_size"})
        for (const char* bad : {"nan", "inf", "-1", ""})
            EXPECT_EQ(trp_radiosity_set(solution, name, bad), TRP_ERROR_ARGUMENT) << name << ' ' << bad;
}

TEST(RadiosityMisuse, ReflectanceOfOneIsHeldBelowItAndSaid) {
    Scene scene;
    const uint32_t white = scene.material([](TrpMaterialDesc& d) {
        d.name = "snow";
        d.diffuse = {{1.5f, 1, 0.5f}, TRP_NO_NODE};
        d.emission = {{0.1f, 0.1f, 0.1f}, TRP_NO_NODE};
    });
    add_cube(scene, white, white);
    for (const std::string solver : kSolvers) {
        Solution::Settings settings = by(solver, "hemisphere");
        settings.emplace_back("radiosity.iterations", "30");
        Solution solution(scene, settings);
        // E / (1 − ρ) at most, with ρ = 0.999; but for the hierarchy, whose form factors are off by more than 1 − ρ.
        const double most = solver == "hierarchical" ? 1e30 : 0.1 * kPi / 0.001 * 1.01;
        expect_within(solution.solve().red("radiosity"), 0.1 * kPi - 1e-6, most, solver);
        for (const double r : solution.red("reflectance")) EXPECT_FLOAT_EQ(static_cast<float>(r), 0.999f);
        ASSERT_EQ(trp_radiosity_warning_count(solution), 1u);
        const TrpWarning warning = first_warning(solution);
        EXPECT_EQ(warning.code, TRP_WARNING_MATERIAL);
        EXPECT_NE(std::string(warning.text).find("snow"), std::string::npos) << warning.text;
    }
}

TEST(RadiosityMisuse, WhatEndsBeforeItsToleranceSaysWhy) {
    Random random{std::mt19937(9)};
    Scene scene;
    make_room(scene, random, true);
    Solution::Settings settings = by("hierarchical");
    settings.emplace_back("radiosity.element_size", "0.5");
    settings.emplace_back("radiosity.tolerance", "1e-5");
    Solution solution(scene, settings);
    solution.solve().step(3);
    EXPECT_TRUE(solution.info().solved);
    EXPECT_GT(solution.info().residual, 1e-5);
    EXPECT_EQ(solution.info().limited, TRP_LIMIT_SIZE);
    ASSERT_EQ(trp_radiosity_warning_count(solution), 1u) << "once";
    const TrpWarning warning = first_warning(solution);
    EXPECT_NE(std::string(warning.text).find("no element may be divided further"), std::string::npos) << warning.text;
    settings.back().second = "10";
    Solution rough(scene, settings);
    EXPECT_TRUE(rough.solve().info().solved);
    EXPECT_EQ(rough.info().limited, TRP_LIMIT_NONE);
}

TEST(RadiosityMisuse, FacesInOnePlaceAreSaid) {
    // Quads on each other, from other corners on, at 0 and −0: the same way up, or one of both two-sided; but a sheet
    // of two one-sided faces is sound.
    const MeshData up = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}),
                   turned = quad({1, 1, -0.0f}, {0, 1, -0.0f}, {0, 0, -0.0f}, {1, 0, -0.0f}),
                   down = quad({1, 1, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}),
                   beside = quad({1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0});
    struct Case {
        const MeshData& other;
        bool two_sided, said;
    };
    for (const auto& [other, two_sided, said] :
         {Case{turned, false, true}, Case{down, true, true}, Case{down, false, false}, Case{beside, true, false}}) {
        Scene scene;
        scene.object(up, wall(scene, 0.5f, 1, false));
        scene.object(other, wall(scene, 0.5f, 1, two_sided));
        Solution solution(scene, {});
        solution.prepare();
        ASSERT_EQ(trp_radiosity_warning_count(solution), said);
        if (said) {
            EXPECT_TRUE(first_text(solution).starts_with("faces lie where others do, 1 of them"));
        }
    }
}

TEST(RadiosityMisuse, WhatWouldBeSlowOrBlackIsSaid) {
    Scene scene;
    scene.object(floor_square(0.5f), scene.material([](TrpMaterialDesc& d) {
        d.name = "chrome";
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.mirror = {{1, 1, 1}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
    }));
    scene.world({1, 1, 1});
    Solution shown(scene, by("hierarchical"));
    ASSERT_EQ(trp_radiosity_warning_count(shown.prepare()), 1u);
    EXPECT_NE(first_text(shown).find("as material \"chrome\", hands light on"), std::string::npos) << first_text(shown);

    Scene large;
    large.object(floor_square(0.5f));
    large.world({1, 1, 1});
    for (const char* levels : {"0", "2"}) {
        Solution::Settings settings = by("progressive");
        settings.insert(settings.end(), {{"radiosity.element_size", "0.0099"}, {"radiosity.patch_levels", levels}});
        Solution solution(large, settings);
        ASSERT_EQ(trp_radiosity_warning_count(solution.prepare()), std::string(levels) == "0") << levels;
        if (std::string(levels) == "0") {
            EXPECT_NE(first_text(solution).find("patch_levels"), std::string::npos);
        }
    }
}

TEST(RadiosityMisuse, SaysHowMuchMemoryAMatrixNeeds) {
    Scene scene;
    const uint32_t grey = wall(scene, 0.5f, 1);
    add_cube(scene, grey, grey);
    Solution::Settings settings = by("matrix");
    settings.insert(settings.end(), {{"radiosity.element_size", "0.04"}, {"radiosity.memory", "100"}});
    // 6 × 25 × 25 = 3750 elements, and 8 bytes to each pair.
    Solution solution(scene, settings);
    EXPECT_EQ(trp_radiosity_solve(solution, nullptr), TRP_ERROR_MEMORY);
    const std::string said = trp_error_message();
    EXPECT_NE(said.find("3750"), std::string::npos) << said;
    EXPECT_NE(said.find("107 MiB"), std::string::npos) << said;
    EXPECT_NE(said.find("100"), std::string::npos) << said;
    // The elements are there, and a row of their form factors.
    double sum = 0;
    for (const double f : solution.row(0)) sum += f;
    EXPECT_NEAR(sum, 1, 1e-3);
}

TEST(RadiosityMisuse, OfALampThatIsTooBrightIsFinite) {
    for (const char* solver : kSolvers) {
        Scene scene;
        add_cube(scene, wall(scene, 0.5f, 1e31f), wall(scene, 0.5f));
        Solution solution(scene, by(solver));
        solution.solve();
        EXPECT_TRUE(std::isfinite(solution.info().residual)) << solver;
        for (const double v : solution.red("radiosity")) ASSERT_TRUE(std::isfinite(v)) << solver;
        ASSERT_GT(trp_radiosity_warning_count(solution), 0u) << solver;
        const TrpWarning warning = first_warning(solution);
        EXPECT_NE(std::string(warning.text).find("more W/m² than can be reckoned with"), std::string::npos) << solver;
    }
}

TEST(RadiosityMisuse, ProgressGoesFromNothingToAll) {
    Random random{std::mt19937(8)};
    Scene scene;
    make_room(scene, random, true);
    for (const std::string solver : {"progressive", "hierarchical"}) {
        Solution::Settings settings = by(solver, "hemisphere");
        settings.insert(settings.end(), {{"radiosity.element_size", solver == "hierarchical" ? "0" : "0.08"},
                                         {"radiosity.tolerance", solver == "hierarchical" ? "0.004" : "0"}});
        Solution solution(scene, settings);
        std::vector<double> fractions;
        TrpCallbacks callbacks{};
        callbacks.struct_size = sizeof callbacks;
        callbacks.user = &fractions;
        callbacks.progress = [](void* user, const TrpProgress* progress) {
            static_cast<std::vector<double>*>(user)->push_back(progress->fraction);
            return 1;
        };
        check(trp_radiosity_solve(solution, &callbacks));
        ASSERT_GT(fractions.size(), 3u) << solver;
        EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end())) << solver;
        EXPECT_LT(fractions.front(), 0.5) << solver;
        EXPECT_GT(fractions.back(), 0.5) << solver;
        EXPECT_LE(fractions.back(), 1) << solver;
    }
}

TEST(RadiosityMisuse, StoppedAtAnyMomentItIsValidAndGoesOn) {
    Random random{std::mt19937(8)};
    Scene scene;
    make_room(scene, random, true);
    TrpCallbacks callbacks{};
    callbacks.struct_size = sizeof callbacks;
    callbacks.progress = [](void*, const TrpProgress*) { return 1; };
    for (const std::string solver : kSolvers) {
        Solution::Settings settings = by(solver, "hemisphere");
        settings.insert(settings.end(), {{"radiosity.element_size", solver == "hierarchical" ? "0" : "0.2"},
                                         {"radiosity.rays", "512"},
                                         {"radiosity.tolerance", solver == "hierarchical" ? "0.05" : "0"},
                                         {"radiosity.iterations", solver == "progressive" ? "200" : "0"}});
        Solution whole(scene, settings);
        const std::vector<double> known = whole.solve().red("radiosity");
        const double greatest = *std::max_element(known.begin(), known.end());
        Solution solution(scene, settings);
        uint32_t stopped = 0;
        for (double seconds = 5e-4;; seconds *= 2) {
            std::atomic<bool> done{false};
            std::thread stopper([&] {
                std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
                while (!done) {
                    check(trp_radiosity_cancel(solution));
                    std::this_thread::sleep_for(std::chrono::microseconds(100));
                }
            });
            const TrpStatus status = trp_radiosity_solve(solution, &callbacks);
            done = true;
            stopper.join();
            if (status == TRP_OK) break;
            ASSERT_EQ(status, TRP_CANCELLED);
            ++stopped;
            if (solution.info().element_count == 0) continue;  // it was not so far
            expect_within(solution.red("radiosity"), 0, 1.1 * greatest, solver);
            for (const float v : solution.read("vertex_irradiance", 3)) ASSERT_TRUE(std::isfinite(v)) << solver;
        }
        EXPECT_GT(stopped, 0u) << solver;
        // The hierarchy may go another way, for what it knew when it was stopped, to the same tolerance.
        const TrpRadiosityInfo found = solution.info(), of_whole = whole.info();
        EXPECT_EQ(found.solved, of_whole.solved) << solver;
        EXPECT_NEAR(found.power[0], of_whole.power[0], (solver == "hierarchical" ? 0.02 : 1e-9) * of_whole.power[0]);
    }
}

}  // namespace
}  // namespace trp_test
