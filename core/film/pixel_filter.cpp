#include "film/pixel_filter.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace trp {
namespace {

struct Shape {
    double half_width;
    double (*value)(double x);  // of x from −1 to 1, over the half width
};

Shape shape_of(PixelFilter::Kind kind, double width) {
    switch (kind) {
        case PixelFilter::Kind::gaussian:
            return {1.5 * width, [](double x) { return std::exp(-18 * x * x); }};
        case PixelFilter::Kind::blackman_harris:
            // Harris, "On the Use of Windows for Harmonic Analysis" (1978): the 4-term window of −92 dB.
            return {width, [](double x) {
                        const double a = std::numbers::pi * (x + 1);
                        return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
                    }};
        default:
            return {width / 2, [](double) { return 1.0; }};
    }
}

}  // namespace

PixelFilter::PixelFilter(Kind kind, float width) {
    // The inverse of the distribution, from its integral on a fine grid.
    const Shape shape = shape_of(kind, width);
    constexpr int kGrid = 8192;
    std::vector<double> integral(kGrid + 1, 0.0);
    for (int i = 0; i < kGrid; ++i) integral[i + 1] = integral[i] + shape.value((i + 0.5) * 2 / kGrid - 1);
    int at = 0;
    for (int step = 0; step <= kSteps; ++step) {
        const double wanted = integral[kGrid] * step / kSteps;
        while (at < kGrid - 1 && integral[at + 1] < wanted) ++at;
        const double within = (wanted - integral[at]) / (integral[at + 1] - integral[at]);
        offsets_[step] = static_cast<float>(shape.half_width * ((at + within) * 2 / kGrid - 1));
    }
}

}  // namespace trp
