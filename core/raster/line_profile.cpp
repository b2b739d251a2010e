#include "raster/line_profile.h"

#include <algorithm>

namespace trp {
namespace {

// The share of the filter's weight that lies left of x.
double share_below(const PixelFilter& filter, double x) {
    const float *const begin = filter.offsets(), *const end = begin + PixelFilter::kSteps + 1;
    if (x < *begin) return 0;
    if (x >= end[-1]) return 1;
    const float* const next = std::upper_bound(begin, end - 1, static_cast<float>(x));
    const double low = next[-1], high = *next;
    return (static_cast<double>(next - 1 - begin) + (x - low) / (high - low)) / PixelFilter::kSteps;
}

}  // namespace

LineProfile::LineProfile(const PixelFilter& filter, float width) {
    constexpr double kLeast = 1.0 / 1024;  // less is not seen
    const double half = width / 2.0;
    const auto at = [&](double distance) {
        return share_below(filter, distance + half) - share_below(filter, distance - half);
    };
    constexpr double kStep = 1.0 / 64;
    double reach = half + static_cast<double>(filter.offsets()[PixelFilter::kSteps]);
    while (reach > 0 && at(reach) < kLeast) reach -= kStep;
    reach = std::max(reach, 0.0) + kStep;
    radius = static_cast<float>(reach);
    scale = kSteps / radius;
    for (int i = 0; i < kSteps; ++i) coverage[i] = static_cast<float>(at(i / static_cast<double>(scale)));
    coverage[kSteps] = 0;
}

}  // namespace trp
