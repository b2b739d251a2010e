// How much of a pixel a line covers, by the distance of the pixel's centre from the line: the pixel filter integrated
// across the line's width.
#pragma once

#include <array>

#include "film/pixel_filter.h"

namespace trp {

struct LineProfile {
    LineProfile(const PixelFilter& filter, float width);

    static constexpr int kSteps = 2048;
    float radius;                            // beyond which the line covers nothing, pixels
    float scale;                             // steps to a pixel
    std::array<float, kSteps + 1> coverage;  // at distance i / scale; 0 at the last
};

}  // namespace trp
