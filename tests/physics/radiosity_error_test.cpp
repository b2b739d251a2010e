// The error of solutions is what they say: against path tracing, in random sealed rooms. Errors are RMS over the area
// of the surfaces that the camera sees, of radiosity.
#include "support/radiosity_error.h"

namespace trp_test {
namespace {

class RadiosityError : public testing::TestWithParam<int> {};

TEST_P(RadiosityError, IsAtMostTwiceTheTolerance) {
    Random random{std::mt19937(static_cast<unsigned>(GetParam()))};
    Scene scene;
    make_room(scene, random, GetParam() % 2 == 0);
    const PathTraced known(scene, kEye, 256);
    double before = 1e30;
    for (const double tolerance : {0.08, 0.02}) {
        const double allowed = tolerance * known.mean_radiosity();
        Solution solution(scene, {{"radiosity.tolerance", std::to_string(allowed)}});
        solution.solve();
        EXPECT_LE(solution.info().residual, allowed);
        const double error = known.error_of(solution);
        EXPECT_LE(error, 2 * tolerance);
        EXPECT_LT(error, before);
        before = error;
    }
}

// The matrix and shots know nothing of what elements are too coarse for: their error is that of radiosity which is
// constant in each element, and falls with the elements' size.
TEST_P(RadiosityError, OfUniformElementsFallsWithTheirSize) {
    Random random{std::mt19937(static_cast<unsigned>(GetParam()))};
    Scene scene;
    make_room(scene, random, GetParam() % 2 == 0);
    const PathTraced known(scene, kEye, 256);
    for (const char* solver : {"matrix", "progressive"}) {
        double before = 1e30;
        for (const char* size : {"0.125", "0.0625"}) {
            Solution::Settings settings = by(solver, "hemisphere");
            settings.insert(settings.end(), {{"radiosity.element_size", size}, {"radiosity.rays", "4096"}});
            Solution solution(scene, settings);
            const double error = known.error_of(solution.solve());
            EXPECT_LT(error, before) << solver;
            before = error;
        }
        EXPECT_LT(before, 0.05) << solver;
    }
}

INSTANTIATE_TEST_SUITE_P(Rooms, RadiosityError, testing::Range(0, 20));

}  // namespace
}  // namespace trp_test
