// No power is lost, whatever has been solved by then: in a sealed scene, all that leaves the surfaces arrives.
#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

struct Powers {
    double left = 0, arrived = 0, emitted = 0, absorbed = 0, unshot = 0;  // W, of the first colour
};
Powers powers_of(const Solution& solution) {
    const std::vector<double> b = solution.red("radiosity"), h = solution.red("irradiance"),
                              e = solution.red("emission"), reflectance = solution.red("reflectance"),
                              unshot = solution.red("unshot");
    const std::vector<float> area = solution.read("area", 1);
    Powers out;
    for (size_t k = 0; k < b.size(); ++k) {
        const double a = area[k];
        out.left += a * b[k];
        out.arrived += a * h[k];
        out.emitted += a * e[k];
        out.absorbed += a * (1 - reflectance[k]) * h[k];
        out.unshot += a * unshot[k];
    }
    return out;
}

void add_room(Scene& scene) {
    Random random{std::mt19937(3)};
    make_room(scene, random, false);
}

TEST(RadiosityPower, EveryShotArrives) {
    // In every step, what has arrived is what was shot, B without what is unshot; and of what is emitted, what is not
    // absorbed is unshot. As single precision adds up.
    for (const char* order : {"sorted", "unsorted"})
        for (const char* levels : {"0", "1"}) {
            Scene scene;
            add_room(scene);
            Solution::Settings settings = by("progressive", "hemisphere");
            settings.insert(settings.end(), {{"radiosity.element_size", "0.2"},
                                             {"radiosity.order", order},
                                             {"radiosity.patch_levels", levels},
                                             {"radiosity.rays", "256"}});
            Solution solution(scene, settings);
            for (int k = 0; k < 30; ++k) {
                const Powers p = powers_of(solution.step(10));
                EXPECT_NEAR(p.arrived + p.unshot, p.left, 1e-6 * p.left) << order << ' ' << levels << ' ' << k;
                EXPECT_NEAR(p.absorbed + p.unshot, p.emitted, 1e-6 * p.emitted) << order << ' ' << levels << ' ' << k;
            }
            EXPECT_GT(powers_of(solution).absorbed, 0) << order << ' ' << levels;
        }
}

TEST(RadiosityPower, SweepsOverTheMatrixComeToKeepIt) {
    // From below, sweep by sweep, each by the reflectance at least.
    Scene scene;
    add_room(scene);
    Solution::Settings settings = by("matrix", "hemisphere");
    settings.emplace_back("radiosity.element_size", "0.2");
    Solution solution(scene, settings);
    double left = 0, missing = 1;
    while (!solution.info().solved) {
        const Powers p = powers_of(solution.step(1));
        EXPECT_GE(p.left, left * (1 - 1e-6));
        EXPECT_LE(p.absorbed, p.emitted * (1 + 1e-6));
        const double now = 1 - p.absorbed / p.emitted;
        EXPECT_LE(now, 0.8 * missing + 1e-6);  // the greatest reflectance
        left = p.left;
        missing = now;
    }
    EXPECT_NEAR(missing, 0, 1e-6);
}

TEST(RadiosityPower, TheHierarchyKeepsItWithinItsError) {
    // What arrives in all differs from what leaves by no more than the mean error that the solution states, times the
    // area, at every step.
    for (uint32_t seed = 0; seed < 3; ++seed) {
        Scene scene;
        Random random{std::mt19937(seed)};
        make_room(scene, random, false);
        Solution::Settings settings = by("hierarchical");
        settings.emplace_back("radiosity.tolerance", "0.03");
        Solution solution(scene, settings);
        while (!solution.info().solved) {
            const Powers p = powers_of(solution.step(1));
            const TrpRadiosityInfo info = solution.info();
            EXPECT_NEAR(p.arrived, p.left, info.residual * info.area) << seed << ", step " << info.iterations;
        }
    }
}

}  // namespace
}  // namespace trp_test
