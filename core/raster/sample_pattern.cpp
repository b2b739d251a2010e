#include "raster/sample_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "raster/projection.h"

namespace trp {
namespace {

int32_t place(const PixelFilter& filter, double u) {
    const double at = u * PixelFilter::kSteps;
    const auto step = static_cast<int>(at);
    const double low = filter.offsets()[step], high = filter.offsets()[step + 1];
    return static_cast<int32_t>(std::lround((low + (high - low) * (at - step)) * kSubpixels));
}

// The bits of i mirrored behind the point: van der Corput's sequence.
double mirrored(uint32_t i) {
    double value = 0, bit = 0.5;
    for (; i; i >>= 1, bit /= 2) value += bit * (i & 1);
    return value;
}

}  // namespace

std::vector<SampleOffset> sample_pattern(const Settings& settings) {
    const uint32_t count = settings.raster_samples;
    std::vector<SampleOffset> pattern(count);
    if (count == 1) return pattern;
    const PixelFilter filter(settings.filter, settings.filter_width);
    // Hammersley's points, each in the middle of its cell.
    for (uint32_t i = 0; i < count; ++i)
        pattern[i] = {place(filter, (i + 0.5) / count), place(filter, std::min(mirrored(i) + 0.5 / count, 0.999))};
    const auto distance2 = [](const SampleOffset& o) { return o.x * o.x + o.y * o.y; };
    std::stable_sort(pattern.begin(), pattern.end(),
                     [&](const SampleOffset& a, const SampleOffset& b) { return distance2(a) < distance2(b); });
    return pattern;
}

int32_t reach_of(const std::vector<SampleOffset>& pattern) {
    int32_t most = 0;
    for (const SampleOffset& offset : pattern) most = std::max({most, std::abs(offset.x), std::abs(offset.y)});
    return (most + kSubpixels - 1) / kSubpixels;
}

}  // namespace trp
