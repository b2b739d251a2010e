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

INSTANTIATE_TEST_SUITE_P(Rooms, RadiosityError, testing::Range(0, 20));

}  // namespace
}  // namespace trp_test
