// A picture in linear light at all sizes, and its filtering (Williams, "Pyramidal Parametrics", 1983).
//
// Ours, not OpenImageIO's texture system: that looks up one point at a time, which took more than half of the time of a
// frame of scenes/gallery, four times as long as its rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "textures/image_module.h"

namespace trp {

// Pictures of more pixels are refused: their texels are counted in 32 bits.
inline constexpr uint64_t kMostTexturePixels = uint64_t{1} << 28;

// Level 0 is the picture; each next one is half as wide and high, rounded down, to 1 × 1. Texels are RGBA, Rec. 709,
// straight alpha, row 0 at the bottom, in 16 bits where the picture had integers, else in floats.
class MipPyramid {
  public:
    // `srgb`: colours are to be made linear; alpha is so already.
    MipPyramid(const PixelArray& picture, bool srgb);

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    int levels() const { return static_cast<int>(offsets_.size()); }
    // Of the level's first texel, counted in texels.
    const int32_t* offsets() const { return offsets_.data(); }
    // Four numbers to a texel; null where the texels are of the other kind. 65535 is 1.
    const uint16_t* integers() const { return integers_.empty() ? nullptr : integers_.data(); }
    const float* floats() const { return floats_.empty() ? nullptr : floats_.data(); }

  private:
    uint32_t width_, height_;
    std::vector<int32_t> offsets_;
    std::vector<uint16_t> integers_;
    std::vector<float> floats_;
};

// Texture coordinates, v up, with their derivatives by one pixel to the right and one pixel up.
struct TextureCoordinates {
    const float *u, *v, *dudx, *dvdx, *dudy, *dvdy;
};

struct TextureSampler {
    int32_t wrap_u = 0, wrap_v = 0, filter = 0;  // TRP_WRAP_…, TRP_FILTER_…
};

// The picture's mean over the ellipse of each pixel's footprint, to r, g, b, a[count]: trilinear probes along its
// longer axis (McCormack et al., "Feline: Fast Elliptical Lines for Anisotropic Texture Mapping", 1999), as many as the
// axis is longer than the shorter one, at most 16. TRP_FILTER_NEAREST: the nearest texel of level 0.
void filter_texture(const MipPyramid& pyramid, const TextureSampler& sampler, size_t count,
                    const TextureCoordinates& at, float* const rgba[4]);

}  // namespace trp
