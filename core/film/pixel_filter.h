// Pixel filters, sampled by importance: a sample belongs to one pixel and weighs 1, its place is drawn from the filter
// (Ernst, Stamminger, Greiner, "Filter Importance Sampling", 2006). No two pixels share a sample, so tiles need no
// borders.
#pragma once

#include <array>

namespace trp {

class PixelFilter {
  public:
    enum class Kind { box, gaussian, blackman_harris };

    // `width` in pixels, with Blender's meaning: a box of that width; a Gaussian exp(−8 (x/width)²) cut off at 1.5
    // widths; a Blackman-Harris window of twice the width. 0: all samples at the centre.
    PixelFilter(Kind kind, float width);

    // The offset from the pixel's centre for u in [0, 1): offsets()[u · kSteps], interpolated linearly.
    static constexpr int kSteps = 1024;
    const float* offsets() const { return offsets_.data(); }

  private:
    std::array<float, kSteps + 1> offsets_;
};

}  // namespace trp
