// Radiosity of scenes whose solution is known in closed form, by every solver.
#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

// Two plates of one metre's distance that look at each other.
void add_plates(Scene& scene, float side, float reflectance1, float radiosity1, float reflectance2, float radiosity2) {
    scene.object(quad({0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}),
                 wall(scene, reflectance1, radiosity1, false));
    scene.object(quad({0, 0, 1}, {0, side, 1}, {side, side, 1}, {side, 0, 1}),
                 wall(scene, reflectance2, radiosity2, false));
}

// B1 = (E1 + ρ1 F E2) / (1 − ρ1 ρ2 F²), of infinite plates with F = 1.
std::array<double, 2> plates(double f, double reflectance1, double e1, double reflectance2, double e2) {
    const double all = 1 - reflectance1 * reflectance2 * f * f;
    return {(e1 + reflectance1 * f * e2) / all, (e2 + reflectance2 * f * e1) / all};
}

TEST(RadiosityClosedForms, LargePlatesAreLikeInfiniteOnes) {
    // What escapes at the rim, 1 − F < 2 / x of plates of x distances, counts for at most dB / dF at F = 1.
    const auto infinite = plates(1, 0.5, 1, 0.8, 0.25);
    const double slopes[2] = {(0.5 * 0.25 + 2 * 0.4 * infinite[0]) / 0.6, (0.8 * 1 + 2 * 0.4 * infinite[1]) / 0.6};
    for (const float side : {10.0f, 100.0f, 1000.0f})
        for (const char* solver : {"matrix", "progressive"}) {
            Scene scene;
            add_plates(scene, side, 0.5f, 1, 0.8f, 0.25f);
            Solution::Settings settings = by(solver);
            settings.emplace_back("radiosity.tolerance", "1e-8");
            Solution solution(scene, settings);
            const std::vector<double> b = solution.solve().red("radiosity");
            const auto known = plates(solution.row(0)[1], 0.5, 1, 0.8, 0.25);
            for (size_t k = 0; k < 2; ++k) {
                EXPECT_NEAR(b[k], known[k], 1e-6) << solver << ' ' << side;
                EXPECT_LE(b[k], infinite[k] + 1e-6) << solver << ' ' << side;
                EXPECT_GE(b[k], infinite[k] - slopes[k] * 2 / static_cast<double>(side)) << solver << ' ' << side;
            }
        }
}

TEST(RadiosityClosedForms, PlatesBetweenMirrorsAreInfinite) {
    // Nothing escapes at the rim where it is closed by mirrors, but for rays that meet more than 16 of them: flatter
    // than 16 · 4 / √2 metres to the metre, 1 / (1 + 45²) of all.
    const auto known = plates(1, 0.5, 1, 0.8, 0.25);
    Scene scene;
    add_plates(scene, 4, 0.5f, 1, 0.8f, 0.25f);
    const uint32_t mirror = scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.mirror = {{1, 1, 1}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
    });
    const Vec rim[5] = {{0, 0, 0}, {0, 4, 0}, {4, 4, 0}, {4, 0, 0}, {0, 0, 0}};
    for (int k = 0; k < 4; ++k)
        scene.object(quad(rim[k], rim[k + 1], rim[k + 1] + Vec{0, 0, 1}, rim[k] + Vec{0, 0, 1}), mirror);
    for (const char* solver : {"matrix", "progressive"}) {
        Solution::Settings settings = by(solver, "hemisphere");
        settings.insert(settings.end(), {{"radiosity.rays", "16384"}, {"radiosity.tolerance", "1e-6"}});
        Solution solution(scene, settings);
        const std::vector<double> b = solution.solve().red("radiosity");
        EXPECT_NEAR(solution.row(0)[1], 1, 5e-4);
        // dB / dF as above.
        EXPECT_NEAR(b[0], known[0], 2.71 * 5e-4) << solver;
        EXPECT_NEAR(b[1], known[1], 3.67 * 5e-4) << solver;
    }
}

TEST(RadiosityClosedForms, OfConcentricSpheres) {
    // r2 = 2 r1, ρ = 0.5, E1 = 1. Of two spheres that are faceted the same way, all that leaves the inner one arrives
    // at the outer one, and a quarter of what leaves that comes back, as of true spheres.
    Scene scene;
    const auto ball = [](float radius) {
        MeshData m = sphere({0, 0, 0}, radius, 8);
        m.normals.clear();
        return m;
    };
    scene.object(ball(1), wall(scene, 0.5f, 1, false));
    scene.object(inwards(ball(2)), wall(scene, 0.5f, 0, false));
    const double known[2] = {1.1111111, 0.2222222};
    // Rays: the outer sphere sees the inner one by a quarter of 1024 of them, of which chance is 0.0135, times ρ ΔB.
    // Hierarchical: twice its tolerance.
    for (const auto& [solver, kind, tolerance, error] : {std::tuple{"matrix", "hemisphere", "0", 0.006},
                                                         {"progressive", "hemisphere", "1e-4", 0.006},
                                                         {"hierarchical", "analytic", "0.03", 0.06}}) {
        Solution::Settings settings = by(solver, kind);
        settings.emplace_back("radiosity.tolerance", tolerance);
        Solution solution(scene, settings);
        const std::vector<double> b = solution.solve().red("radiosity"), e = solution.red("emission");
        const std::vector<float> area = solution.read("area", 1);
        double sums[2] = {}, areas[2] = {}, squares[2] = {};
        for (size_t k = 0; k < b.size(); ++k) {
            const size_t sphere = e[k] > 0 ? 0 : 1;
            sums[sphere] += b[k] * area[k];
            areas[sphere] += area[k];
            squares[sphere] += area[k] * std::pow(b[k] - known[sphere], 2);
        }
        for (size_t k = 0; k < 2; ++k) {
            EXPECT_NEAR(sums[k] / areas[k], known[k], error / 3) << solver;
            EXPECT_LT(std::sqrt(squares[k] / areas[k]), error) << solver;
        }
    }
}

}  // namespace
}  // namespace trp_test
