// Radiosity against closed forms: what form factors, the equation's solution and its parts must be.
#include <numeric>

#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

// -------------------------------------------------------------------------------------------------------- form factors

TEST(FormFactors, OfACubeAreThoseOfTheClosedForm) {
    struct Known {
        const char* kind;
        double opposite, sides, tolerance;
    };
    // Three standard deviations of random rays; a hemicube is that of the face's middle alone.
    for (const auto& [kind, opposite, sides, tolerance] :
         {Known{"analytic", 0.1998248957, 0.2000437761, 1e-9},
          Known{"hemisphere", 0.1998248957, 0.2000437761, 3 * 0.4 / 128},
          Known{"hemicube", 0.2394564705, (1 - 0.2394564705) / 4, 1e-3}}) {
        Scene scene;
        const uint32_t grey = wall(scene, 0.5f);
        add_cube(scene, grey, grey);
        Solution::Settings settings = by("matrix", kind);
        settings.emplace_back("radiosity.rays", "16384");
        Solution solution(scene, settings);
        solution.prepare();
        ASSERT_EQ(solution.info().element_count, 6u);
        const std::vector<double> row = solution.row(0);
        EXPECT_EQ(row[0], 0) << kind;
        EXPECT_NEAR(row[1], opposite, tolerance) << kind;
        double sum = 0;
        for (uint32_t j = 0; j < 6; ++j) {
            sum += row[j];
            if (j > 1) {
                EXPECT_NEAR(row[j], sides, tolerance) << kind << ' ' << j;
            }
        }
        // Rays of a closed scene all end somewhere; a cube of pixels nearly covers the hemisphere.
        EXPECT_NEAR(sum, 1, std::string(kind) == "hemicube" ? 1e-4 : 1e-9) << kind;
    }
}

TEST(FormFactors, SamplesConvergeToTheContourIntegral) {
    // A floor and a wall on its edge, of which it sees a known part (1 × 1 to a wall of height 2).
    const auto error = [](const char* kind, const char* name, const char* value) {
        Scene scene;
        const uint32_t grey = wall(scene, 0.5f, 1, false);
        scene.object(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), grey);
        scene.object(quad({0, 0, 2}, {0, 0, 0}, {0, 1, 0}, {0, 1, 2}), grey);
        Solution solution(scene, {{"radiosity.solver", "matrix"}, {"radiosity.form_factors", kind}, {name, value}});
        return std::abs(solution.prepare().row(0)[1] - 0.2328526028);
    };
    EXPECT_LT(error("analytic", "radiosity.rays", "1"), 1e-8);
    // Within three standard deviations of so many random rays.
    const double deviation = std::sqrt(0.2328526028 * (1 - 0.2328526028));
    EXPECT_LT(error("hemisphere", "radiosity.rays", "1024"), 3 * deviation / 32);
    EXPECT_LT(error("hemisphere", "radiosity.rays", "65536"), 3 * deviation / 256);
}

TEST(FormFactors, StopAtWhatStandsBetween) {
    Scene scene;
    const uint32_t grey = wall(scene, 0.5f, 1, false);
    scene.object(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), grey);
    scene.object(quad({0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}), grey);
    scene.object(quad({-9, -9, 0.5f}, {9, -9, 0.5f}, {9, 9, 0.5f}, {-9, 9, 0.5f}), wall(scene, 0));
    for (const char* kind : {"analytic", "hemisphere", "hemicube"}) {
        Solution solution(scene, by("matrix", kind));
        EXPECT_EQ(solution.prepare().row(0)[1], 0) << kind;
    }
}

TEST(FormFactors, CloseSurfacesSeeEachOther) {
    // A sealed slot, a hundredth as high as it is far from the origin: nothing stands between its sides. Rays start a
    // 2^-18th of that off them, so that next to its edges a few may be lost.
    Scene scene;
    const uint32_t bright = wall(scene, 0.5f, 1, false);
    scene.object(inwards(box({2, 2, 2}, {3, 3, 2.02f})), bright);
    add_cube(scene, bright, bright);
    for (const char* kind : {"analytic", "hemisphere"}) {
        Solution solution(scene, by("matrix", kind));
        solution.prepare();
        ASSERT_EQ(solution.info().element_count, 12u);
        for (uint32_t i = 0; i < 12; ++i) {
            const std::vector<double> row = solution.row(i);
            EXPECT_NEAR(std::accumulate(row.begin(), row.end(), 0.0), 1, 2e-3) << kind << ' ' << i;
        }
    }
}

TEST(FormFactors, AreTintedByGlass) {
    // Through a pane of K_T = 0.25.
    Scene scene;
    const uint32_t grey = wall(scene, 0.5f, 1, false);
    scene.object(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), grey);
    scene.object(quad({0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}), grey);
    const uint32_t pane = scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.transmission = {{0.25f, 0.25f, 0.25f}, TRP_NO_NODE};
        d.thin = 1;
    });
    scene.object(quad({-9, -9, 0.5f}, {9, -9, 0.5f}, {9, 9, 0.5f}, {-9, 9, 0.5f}), pane);
    for (const char* kind : {"analytic", "hemisphere", "hemicube"}) {
        Solution::Settings settings = by("matrix", kind);
        settings.emplace_back("radiosity.rays", "16384");
        Solution solution(scene, settings);
        const double open = std::string(kind) == "hemicube" ? 0.2394564705 : 0.1998248957;
        EXPECT_NEAR(solution.prepare().row(0)[1], 0.25 * open, 1e-3) << kind;
    }
}

TEST(Radiosity, BacksLetNoLightThrough) {
    // A lit floor, a large panel that faces down, and a ceiling that glows: the ceiling has its own light alone, and
    // what comes through the panel's holes, as many from behind as from the front.
    for (const float alpha : {1.0f, 0.5f}) {
        Scene scene;
        scene.object(quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}), wall(scene, 0.5f, 0, false));
        scene.object(quad({-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}), wall(scene, 0.5f, 1, false));
        const uint32_t panel = scene.material([&](TrpMaterialDesc& d) {
            d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
            d.alpha = {{alpha, 0, 0}, TRP_NO_NODE};
            d.double_sided = 0;
        });
        scene.object(quad({-3, 3, 0.5f}, {3, 3, 0.5f}, {3, -3, 0.5f}, {-3, -3, 0.5f}), panel);
        scene.light(TRP_LIGHT_POINT, {1, 1, 1}, translation({0, 0, 0.25f}));
        for (const char* kind : {"analytic", "hemisphere", "hemicube"})
            for (const char* solver : {"matrix", "progressive", "hierarchical"}) {
                Solution solution(scene, by(solver, kind));
                const std::vector<double> radiosity = solution.solve().red("radiosity");
                const std::vector<float> centres = solution.read("centre", 3);
                double ceiling = 0, floor = 0;
                for (size_t k = 0; k < radiosity.size(); ++k) {
                    double& most = centres[3 * k + 2] > 0.9f ? ceiling : floor;
                    most = std::max(most, radiosity[k]);
                }
                EXPECT_GT(floor, 0.5) << solver << ' ' << kind;
                if (alpha < 1)
                    EXPECT_GT(ceiling, 1.02) << solver << ' ' << kind;
                else
                    EXPECT_NEAR(ceiling, 1, 1e-6) << solver << ' ' << kind;
            }
    }
}

// A square of radiosity 1 at a mirror half a metre above it, which hands on half of all light.
void make_mirrored_square(Scene& scene) {
    scene.object(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), wall(scene, 0.5f, 1, false));
    const uint32_t mirror = scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.mirror = {{0.5f, 0.5f, 0.5f}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
        d.double_sided = 0;
    });
    scene.object(quad({-9, -9, 0.5f}, {-9, 9, 0.5f}, {9, 9, 0.5f}, {9, -9, 0.5f}), mirror);
}

TEST(FormFactors, MirrorsShowTheirImage) {
    // The square sees itself as it would see its twin at one metre.
    Scene scene;
    make_mirrored_square(scene);
    for (const char* kind : {"hemisphere", "analytic", "hemicube"}) {
        Solution solution(
            scene, {{"radiosity.solver", "matrix"}, {"radiosity.form_factors", kind}, {"radiosity.rays", "16384"}});
        EXPECT_NEAR(solution.prepare().row(0)[0], 0.5 * 0.1998248957, 1e-3) << kind;
    }
}

TEST(Radiosity, MirrorsHandLightOn) {
    // B = E + ρ F B / 2 with the mean F of the square and its twin, by every solver.
    Scene scene;
    make_mirrored_square(scene);
    const double known = 1 / (1 - 0.5 * 0.5 * 0.1998248957);
    for (const char* solver : {"hierarchical", "matrix", "progressive"}) {
        // The hierarchy traces 256 rays at most from an element: by one of them alone it is right to 7e-3.
        double mean = 0;
        constexpr int kSeeds = 16;
        for (int seed = 0; seed < kSeeds; ++seed) {
            Solution solution(scene, {{"radiosity.solver", solver},
                                      {"radiosity.form_factors", "analytic"},
                                      {"radiosity.rays", "16384"},
                                      {"radiosity.tolerance", "0.001"},
                                      {"seed", std::to_string(seed)}});
            solution.solve();
            const std::vector<double> b = solution.red("radiosity");
            const std::vector<float> area = solution.read("area", 1), face = solution.read("instance", 1);
            double sum = 0, total = 0;
            for (size_t k = 0; k < b.size(); ++k)
                if (face[k] == face[0]) sum += b[k] * area[k], total += area[k];
            mean += sum / total / kSeeds;
        }
        EXPECT_NEAR(mean, known, 3e-3) << solver;
    }
}

// ----------------------------------------------------------------------------------------------------------- solutions

TEST(Radiosity, OfSixPatchesIsThatOfTheirMatrix) {
    struct Known {
        float reflectance;
        double lit, opposite, sides;
    };
    for (const Known known : {Known{0.5f, 1.09090909811, 0.181745826108, 0.181836268946},
                              Known{0.8f, 1.55172415364, 0.689551070738, 0.689681193904}}) {
        for (const char* solver : {"matrix", "progressive"}) {
            Scene scene;
            add_cube(scene, wall(scene, known.reflectance, 1), wall(scene, known.reflectance));
            Solution::Settings settings = by(solver);
            settings.emplace_back("radiosity.tolerance", "1e-8");
            const std::vector<double> b = Solution(scene, settings).solve().red("radiosity");
            ASSERT_EQ(b.size(), 6u);
            // Reflectance is kept in single precision, and what is unshot is a part of the tolerance.
            const double tolerance = 1e-6;
            EXPECT_NEAR(b[0], known.lit, tolerance) << solver;
            EXPECT_NEAR(b[1], known.opposite, tolerance) << solver;
            for (int k = 2; k < 6; ++k) EXPECT_NEAR(b[k], known.sides, tolerance) << solver;
        }
    }
}

TEST(Radiosity, OfAWhiteFurnaceIsTheSameEverywhere) {
    Scene scene;
    const uint32_t grey = wall(scene, 0.5f, 1);
    add_cube(scene, grey, grey);
    scene.object(box({0.3f, 0.3f, 0.2f}, {0.6f, 0.7f, 0.5f}), grey);
    for (const char* solver : {"matrix", "progressive"}) {
        Solution::Settings settings = by(solver, "hemisphere");
        settings.insert(
            settings.end(),
            {{"radiosity.element_size", "0.5"}, {"radiosity.rays", "16384"}, {"radiosity.tolerance", "0.001"}});
        for (const double b : Solution(scene, settings).solve().red("radiosity")) EXPECT_NEAR(b, 2, 0.03) << solver;
    }
    // The error that the hierarchy allows is the root mean square over the area.
    Solution::Settings settings = by("hierarchical");
    settings.emplace_back("radiosity.tolerance", "0.04");
    Solution solution(scene, settings);
    const std::vector<double> b = solution.solve().red("radiosity");
    const std::vector<float> area = solution.read("area", 1);
    double squares = 0, total = 0;
    for (size_t k = 0; k < b.size(); ++k) squares += area[k] * (b[k] - 2) * (b[k] - 2), total += area[k];
    EXPECT_LT(std::sqrt(squares / total), 2 * 0.04);
}

TEST(Radiosity, InsideASphereIsTheMeanEverywhere) {
    // B = E + ρ/(1 − ρ) Σ E A / A: one hemisphere glows.
    Scene scene;
    MeshData ball = inwards(sphere({0, 0, 0}, 1, 12));
    ball.normals.clear();
    ball.materials = {wall(scene, 0.5f, 1, false), wall(scene, 0.5f, 0, false)};
    for (size_t f = 0; f + 1 < ball.offsets.size(); ++f) ball.face_materials.push_back(f >= ball.offsets.size() / 2);
    scene.object(ball);
    Solution::Settings settings = by("matrix", "hemisphere");
    settings.emplace_back("radiosity.rays", "4096");
    Solution solution(scene, settings);
    const std::vector<double> b = solution.solve().red("radiosity"), e = solution.red("emission");
    const std::vector<float> area = solution.read("area", 1);
    double power = 0, total = 0;
    for (size_t k = 0; k < b.size(); ++k) power += e[k] * area[k], total += area[k];
    // A ball of flat faces: neighbours see a little less of each other.
    for (size_t k = 0; k < b.size(); ++k) EXPECT_NEAR(b[k], e[k] + power / total, 0.02);
}

TEST(Radiosity, ALampLightsAsInRayCasting) {
    // A point lamp of 1 W/sr over the middle of a floor: H = cos³ / h².
    Scene scene;
    scene.object(floor_square(1), wall(scene, 0.5f));
    scene.light(TRP_LIGHT_POINT, {1, 1, 1}, translation({0, 0, 1}));
    for (const char* solver : {"matrix", "progressive", "hierarchical"}) {
        Solution::Settings settings = by(solver);
        settings.emplace_back("radiosity.element_size", "0.05");
        Solution solution(scene, settings);
        const std::vector<double> h = solution.solve().red("irradiance");
        const std::vector<float> centre = solution.read("centre", 3), area = solution.read("area", 1);
        ASSERT_GT(h.size(), 30u);
        for (size_t k = 0; k < h.size(); ++k) {
            double mean = 0;  // over the element
            const double side = std::sqrt(area[k]);
            for (int place = 0; place < 64; ++place) {
                const double x = centre[3 * k] + side * ((place % 8 + 0.5) / 8 - 0.5),
                             y = centre[3 * k + 1] + side * ((place / 8 + 0.5) / 8 - 0.5);
                mean += std::pow(1 + x * x + y * y, -1.5) / 64;
            }
            EXPECT_NEAR(h[k], mean, 0.01) << solver;
        }
    }
}

TEST(Radiosity, SolversAgreeOnARoomWithABlock) {
    Scene scene;
    add_cube(scene, wall(scene, 0.3f, 1), wall(scene, 0.7f));
    scene.object(box({0.25f, 0.3f, 0.3f}, {0.55f, 0.7f, 0.7f}), wall(scene, 0.4f));
    const auto mean = [&](const Solution::Settings& settings) {
        Solution solution(scene, settings);
        const TrpRadiosityInfo info = solution.solve().info();
        return info.power[0] / info.area;
    };
    Solution::Settings matrix = by("matrix", "hemisphere"), analytic = by("matrix"), shots = by("progressive"),
                       hierarchy = by("hierarchical");
    for (Solution::Settings* settings : {&matrix, &analytic, &shots})
        settings->emplace_back("radiosity.element_size", "0.125");
    hierarchy.emplace_back("radiosity.tolerance", "0.005");
    const double reference = mean(matrix);
    EXPECT_NEAR(mean(analytic), reference, 0.005 * reference);
    EXPECT_NEAR(mean(shots), reference, 0.01 * reference);
    EXPECT_NEAR(mean(hierarchy), reference, 0.01 * reference);
}

TEST(Radiosity, WhatABlockStandsOnIsNotDarkAroundIt) {
    // A floor of one element under an even sky, whose middle a block without light covers: none of what the floor gets
    // is lost to the part that lies in the dark, and the block's inside takes no part.
    Scene scene;
    scene.object(quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}), wall(scene, 0.5f));
    scene.light(TRP_LIGHT_SUN, {1, 1, 1}, translation({0, 0, 9}));
    const auto irradiance = [&](const char* solver) {
        Solution solution(scene, by(solver));
        solution.solve();
        const std::vector<double> h = solution.red("irradiance");
        const std::vector<float> centre = solution.read("centre", 3), area = solution.read("area", 1);
        double sum = 0, count = 0;
        for (size_t k = 0; k < h.size(); ++k)
            if (centre[3 * k + 2] == 0 && h[k] > 0) sum += h[k] * area[k], count += area[k];
        return sum / count;
    };
    const double open = irradiance("matrix");
    scene.object(box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0.01f}), wall(scene, 0));
    for (const char* solver : {"matrix", "progressive", "hierarchical"})
        EXPECT_NEAR(irradiance(solver), open, 1e-3 * open) << solver;
    Solution solution(scene, by("matrix"));
    EXPECT_EQ(solution.prepare().info().element_count, 7u);
}

TEST(Radiosity, ShootingTakesFromTheBrightestAndLosesNothing) {
    Scene scene;
    add_cube(scene, wall(scene, 0.5f, 1), wall(scene, 0.5f));
    Solution solution(scene, by("progressive", "hemisphere"));
    double before = 1e30;
    for (int k = 0; k < 12; ++k) {
        const TrpRadiosityInfo info = solution.step(1).info();
        EXPECT_LT(info.unshot[0], before);
        before = info.unshot[0];
    }
    EXPECT_EQ(solution.info().iterations, 12u);
    // What the lit face has shot has arrived: of 1 W, half is left to be shot on after the first step.
    Solution first(scene, by("progressive", "hemisphere"));
    EXPECT_NEAR(first.step(1).info().unshot[0], 0.5, 1e-5);
}

TEST(Radiosity, FallsWithItsTolerance) {
    Scene scene;
    add_cube(scene, wall(scene, 0.3f, 1), wall(scene, 0.7f));
    Solution::Settings fine = by("matrix", "hemisphere");
    fine.insert(fine.end(), {{"radiosity.element_size", "0.0625"}, {"radiosity.rays", "2048"}});
    const std::vector<double> reference = Solution(scene, fine).solve().red("radiosity");
    // The reference has 16 × 16 elements to a face; the mean of each face is compared.
    const auto faces = [](const std::vector<double>& b, const std::vector<float>& area,
                          const std::vector<float>& face) {
        std::array<double, 6> sum{}, total{};
        for (size_t k = 0; k < b.size(); ++k) {
            sum[static_cast<size_t>(face[k])] += b[k] * area[k];
            total[static_cast<size_t>(face[k])] += area[k];
        }
        for (size_t f = 0; f < 6; ++f) sum[f] /= total[f];
        return sum;
    };
    std::array<double, 6> known{};
    for (size_t k = 0; k < reference.size(); ++k) known[k / 256] += reference[k] / 256;
    for (const auto& [text, tolerance] : {std::pair{"0.05", 0.05}, {"0.01", 0.01}}) {
        Solution::Settings settings = by("hierarchical");
        settings.emplace_back("radiosity.tolerance", text);
        Solution solution(scene, settings);
        solution.solve();
        const auto found = faces(solution.red("radiosity"), solution.read("area", 1), solution.read("face", 1));
        for (size_t f = 0; f < 6; ++f) EXPECT_NEAR(found[f], known[f], tolerance) << text << " face " << f;
    }
}

// -------------------------------------------------------------------------------------------------------------
// pictures

TEST(RadiosityView, ShowsTheSolutionFromAnywhere) {
    Scene scene;
    const uint32_t grey = wall(scene, 0.5f, 1);
    add_cube(scene, grey, grey);
    scene.camera(look_at({0.5f, 0.5f, 0.5f}, {1, 0.6f, 0.4f}));
    Solution solution(scene, by("matrix"));
    solution.solve();
    Render render(scene, 32, 24, {}, {}, "radiosity");
    check(trp_render_set_radiosity(render, solution));
    const Image image = render.run().read();
    for (uint32_t y = 0; y < 24; ++y)
        for (uint32_t x = 0; x < 32; ++x) EXPECT_NEAR(image.at(x, y)[0], 2 / kPi, 1e-4);
}

TEST(RadiosityView, NoLightComesUnderTheWallsOfASealedBox) {
    Scene scene;
    const uint32_t grey = wall(scene, 0.8f);
    scene.object(box({0, 0, 0}, {1, 1, 1}), grey);
    scene.world({10, 10, 10});
    scene.camera(look_at({0.5f, 0.5f, 0.5f}, {1, 0.1f, 0}));
    for (const char* solver : {"matrix", "progressive", "hierarchical"}) {
        scene.commit();
        Render render(scene, 32, 24, {{"radiosity.solver", solver}, {"radiosity.element_size", "0.2"}}, {},
                      "radiosity");
        const Image image = render.run().read();
        for (uint32_t y = 0; y < 24; ++y)
            for (uint32_t x = 0; x < 32; ++x) EXPECT_EQ(image.at(x, y)[0], 0) << solver << ' ' << x << ' ' << y;
    }
}

// ----------------------------------------------------------------------------------------------------------- bad input

TEST(Radiosity, SaysWhatItCannotDo) {
    Scene scene;
    const uint32_t white = wall(scene, 1);
    add_cube(scene, white, white);
    Solution solution(scene,
                      {{"radiosity.solver", "matrix"}, {"radiosity.element_size", "0.02"}, {"radiosity.memory", "1"}});
    std::vector<float> values(3);
    EXPECT_EQ(trp_radiosity_read(solution, "radiosity", values.data(), 3), TRP_ERROR_STATE);
    EXPECT_EQ(trp_radiosity_solve(solution, nullptr), TRP_ERROR_MEMORY);
    EXPECT_NE(std::string(trp_error_message()).find("MiB"), std::string::npos);
    EXPECT_EQ(trp_radiosity_set(solution, "radiosity.rays", "2"), TRP_ERROR_STATE);
    EXPECT_EQ(trp_radiosity_read(solution, "radiance", values.data(), 3), TRP_ERROR_ARGUMENT);
    EXPECT_EQ(trp_radiosity_read(solution, "radiosity", values.data(), 3), TRP_ERROR_ARGUMENT);
    EXPECT_EQ(trp_radiosity_form_factors(solution, ~0u, nullptr, 0), TRP_ERROR_ARGUMENT);
    // A reflectance of 1 is held below it, and that is said.
    ASSERT_EQ(trp_radiosity_warning_count(solution), 1u);
}

TEST(Radiosity, OfNothingIsNothing) {
    Scene empty;
    for (const char* solver : {"matrix", "progressive", "hierarchical"}) {
        Solution solution(empty, by(solver));
        EXPECT_EQ(solution.solve().info().element_count, 0u);
        Scene dark;  // one element, and no light
        dark.object(floor_square(1));
        EXPECT_EQ(Solution(dark, by(solver)).solve().red("radiosity")[0], 0) << solver;
    }
}

TEST(Radiosity, OfAnotherSceneIsRefused) {
    Scene scene, other;
    const uint32_t grey = wall(scene, 0.5f, 1);
    add_cube(scene, grey, grey);
    other.object(floor_square(1));
    other.camera(look_at({0, 0, 2}, {0, 0.1f, 0}));
    other.commit();
    Solution solution(scene, by("matrix"));
    solution.solve();
    Render render(other, 32, 24, {}, {}, "radiosity");
    EXPECT_EQ(trp_render_set_radiosity(render, solution), TRP_ERROR_STATE);
}

}  // namespace
}  // namespace trp_test
