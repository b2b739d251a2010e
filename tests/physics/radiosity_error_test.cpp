// The error of hierarchical solutions is what they say: against path tracing, in random sealed rooms.
//
// Path tracing is done twice, with different random numbers: the mean of (R - A)(R - B) is the square of the error of
// R, whatever the noise of A and B, which are independent. Errors are RMS over the area of the surfaces that the camera
// sees, of radiosity.
#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

constexpr uint32_t kSide = 64;

const Settings kFilm = {{"film.filter", "box"}, {"film.filter_width", "1"}};

// How much area each pixel shows: z³ / |n · (p − eye)|, up to a factor; none of what glows, nor at edges.
std::vector<double> areas_of(Render& render) {
    const Image depth = render.read("Depth"), place = render.read("Position"), normal = render.read("Normal"),
                emission = render.read("Emission");
    const auto slope = [&](size_t i, size_t of) {  // of the way to a pixel's place against the plane of another's
        float sum = 0;
        for (size_t c = 0; c < 3; ++c) sum += normal.values[3 * of + c] * (place.values[3 * i + c] - kEye[c]);
        return sum;
    };
    std::vector<double> areas(size_t{kSide} * kSide, 0.0);
    for (size_t y = 1; y + 1 < kSide; ++y)
        for (size_t x = 1; x + 1 < kSide; ++x) {
            const size_t i = y * kSide + x;
            bool whole = true;
            for (const size_t k : {i, i - 1, i + 1, i - kSide, i + kSide})
                whole &=
                    emission.values[3 * k] == 0 && std::abs(slope(k, i) - slope(i, i)) < 0.02f * std::abs(slope(i, i));
            if (whole) areas[i] = std::pow(depth.values[i], 3) / std::max(std::abs(slope(i, i)), 1e-9f);
        }
    return areas;
}

std::vector<double> brightness(const Image& image) {
    std::vector<double> out;
    for (size_t i = 0; i < image.values.size(); i += 4)
        out.push_back(0.2126 * image.values[i] + 0.7152 * image.values[i + 1] + 0.0722 * image.values[i + 2]);
    return out;
}

class RadiosityError : public testing::TestWithParam<int> {};

TEST_P(RadiosityError, IsAtMostTwiceTheTolerance) {
    Random random{std::mt19937(static_cast<unsigned>(GetParam()))};
    Scene scene;
    make_room(scene, random, GetParam() % 2 == 0);
    scene.commit();
    std::vector<double> truth[2], areas;
    for (int k = 0; k < 2; ++k) {
        Settings settings = kFilm;
        settings.insert(settings.end(), {{"samples", "256"}, {"seed", std::to_string(k)}});
        Render render(scene, kSide, kSide, settings, {"Depth", "Position", "Normal", "Emission"}, "path_tracing");
        truth[k] = brightness(render.run().read());
        areas = areas_of(render);
    }
    const auto mean_of = [&](auto&& value) {
        double sum = 0, area = 0;
        for (size_t i = 0; i < areas.size(); ++i) sum += areas[i] * value(i), area += areas[i];
        return sum / area;
    };
    const double mean = mean_of([&](size_t i) { return (truth[0][i] + truth[1][i]) / 2; });
    double before = 1e30;
    for (const double tolerance : {0.08, 0.02}) {
        Solution solution(scene, {{"radiosity.tolerance", std::to_string(tolerance * mean * kPi)}});
        solution.solve();
        EXPECT_LE(solution.info().residual, tolerance * mean * kPi);
        Settings settings = kFilm;
        settings.emplace_back("raster.samples", "32");
        Render render(scene, kSide, kSide, settings, {}, "radiosity");
        check(trp_render_set_radiosity(render, solution));
        const std::vector<double> seen = brightness(render.run().read());
        const double error =
            std::sqrt(
                std::max(mean_of([&](size_t i) { return (seen[i] - truth[0][i]) * (seen[i] - truth[1][i]); }), 0.0)) /
            mean;
        EXPECT_LE(error, 2 * tolerance);
        EXPECT_LT(error, before);
        before = error;
    }
}

INSTANTIATE_TEST_SUITE_P(Rooms, RadiosityError, testing::Range(0, 20));

}  // namespace
}  // namespace trp_test
