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
// constant in each element. It falls with the elements' size, and is the same for both, which solve the same equations.
TEST_P(RadiosityError, OfUniformElementsFallsWithTheirSize) {
    Random random{std::mt19937(static_cast<unsigned>(GetParam()))};
    Scene scene;
    make_room(scene, random, GetParam() % 2 == 0);
    const PathTraced known(scene, kEye, 256);
    double errors[2][2];  // by solver and size
    for (int solver = 0; solver < 2; ++solver)
        for (int half = 0; half < 2; ++half) {
            Solution::Settings settings = by(solver ? "progressive" : "matrix", "hemisphere");
            settings.insert(settings.end(),
                            {{"radiosity.element_size", half ? "0.0625" : "0.125"}, {"radiosity.rays", "4096"}});
            Solution solution(scene, settings);
            errors[solver][half] = known.error_of(solution.solve());
        }
    for (const auto& of : errors) EXPECT_LT(of[1], 0.75 * of[0]);
    for (int half = 0; half < 2; ++half) EXPECT_NEAR(errors[0][half], errors[1][half], 0.005);
}

INSTANTIATE_TEST_SUITE_P(Rooms, RadiosityError, testing::Range(0, 20));

}  // namespace
}  // namespace trp_test
