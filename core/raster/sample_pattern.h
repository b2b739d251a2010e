// Where a pixel's samples lie: the same in every pixel, distributed as the pixel filter weighs.
#pragma once

#include <vector>

#include "film/settings.h"

namespace trp {

struct SampleOffset {
    int32_t x = 0, y = 0;  // from the pixel's centre, in 1/256 pixel
};

// Settings::raster_samples of them, those that are nearest to the centre first; a single one lies in the centre.
std::vector<SampleOffset> sample_pattern(const Settings& settings);

// How far from its pixel a sample may lie, in whole pixels.
int32_t reach_of(const std::vector<SampleOffset>& pattern);

}  // namespace trp
