// How far pictures of radiosity are from path tracing, over the area of the surfaces that a camera sees.
//
// Path tracing is done twice, with different random numbers: the mean of (R - A)(R - B) is the square of the error of
// R, whatever the noise of A and B, which are independent.
#pragma once

#include "support/radiosity_scenes.h"

namespace trp_test {

class PathTraced {
  public:
    static constexpr uint32_t kSide = 64;

    // From `eye`, where the scene's camera is. Diffuse scenes alone.
    PathTraced(Scene& scene, const Vec& eye, uint32_t samples) : scene_(scene) {
        scene.commit();
        for (int k = 0; k < 2; ++k) {
            Settings settings = film();
            settings.insert(settings.end(), {{"samples", std::to_string(samples)}, {"seed", std::to_string(k)}});
            Render render(scene, kSide, kSide, settings, {"Depth", "Position", "Normal", "Emission"}, "path_tracing");
            truth_[k] = brightness(render.run().read());
            if (k == 0) areas_ = areas_of(render, eye);
        }
        mean_ = mean_of([&](size_t i) { return (truth_[0][i] + truth_[1][i]) / 2; });
    }
    // Of the radiosity of what is seen.
    double mean_radiosity() const { return mean_ * kPi; }
    // The root mean square of the error of a solution's radiosity, over the mean.
    double error_of(TrpRadiosity* solution) const {
        Settings settings = film();
        settings.emplace_back("raster.samples", "32");
        Render render(scene_, kSide, kSide, settings, {}, "radiosity");
        check(trp_render_set_radiosity(render, solution));
        const std::vector<double> seen = brightness(render.run().read());
        const double squares = mean_of([&](size_t i) { return (seen[i] - truth_[0][i]) * (seen[i] - truth_[1][i]); });
        return std::sqrt(std::max(squares, 0.0)) / mean_;
    }

  private:
    static Settings film() { return {{"film.filter", "box"}, {"film.filter_width", "1"}}; }

    // How much area each pixel shows: z³ / |n · (p − eye)|, up to a factor; none of what glows, nor at edges.
    static std::vector<double> areas_of(Render& render, const Vec& eye) {
        const Image depth = render.read("Depth"), place = render.read("Position"), normal = render.read("Normal"),
                    emission = render.read("Emission");
        const auto slope = [&](size_t i, size_t of) {  // of the way to a pixel's place against the plane of another's
            float sum = 0;
            for (size_t c = 0; c < 3; ++c) sum += normal.values[3 * of + c] * (place.values[3 * i + c] - eye[c]);
            return sum;
        };
        std::vector<double> areas(size_t{kSide} * kSide, 0.0);
        for (size_t y = 1; y + 1 < kSide; ++y)
            for (size_t x = 1; x + 1 < kSide; ++x) {
                const size_t i = y * kSide + x;
                bool whole = true;
                for (const size_t k : {i, i - 1, i + 1, i - kSide, i + kSide})
                    whole &= emission.values[3 * k] == 0 &&
                             std::abs(slope(k, i) - slope(i, i)) < 0.02f * std::abs(slope(i, i));
                if (whole) areas[i] = std::pow(depth.values[i], 3) / std::max(std::abs(slope(i, i)), 1e-9f);
            }
        return areas;
    }
    static std::vector<double> brightness(const Image& image) {
        std::vector<double> out;
        for (size_t i = 0; i < image.values.size(); i += 4)
            out.push_back(0.2126 * image.values[i] + 0.7152 * image.values[i + 1] + 0.0722 * image.values[i + 2]);
        return out;
    }
    template <class Value>
    double mean_of(Value&& value) const {
        double sum = 0, area = 0;
        for (size_t i = 0; i < areas_.size(); ++i) sum += areas_[i] * value(i), area += areas_[i];
        return sum / area;
    }

    Scene& scene_;
    std::vector<double> truth_[2], areas_;
    double mean_ = 0;
};

}  // namespace trp_test
