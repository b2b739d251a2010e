// From the scene to the film's fixed-point grid.
//
// Film positions count 1/256 pixel from the bottom left. Nearness grows towards the eye and is affine over the film: 1
// over the depth through a perspective camera, minus the depth through an orthographic one.
#pragma once

#include <cstdint>

#include "base/vec.h"
#include "film/film.h"
#include "film/view.h"
#include "shading/snapshot.h"

namespace trp {

inline constexpr int32_t kSubpixels = 256;
// Where the centre of the pixels of a column or row lies on the grid.
inline int32_t grid_centre(int32_t pixel) {
    return pixel * kSubpixels + kSubpixels / 2;
}
// Film positions this far outside the film, in pixels, are still exact; what reaches farther is cut off.
inline constexpr float kGuardBand = 16384;

// Rows give film x and y in pixels, times the depth through a perspective camera, and the depth.
struct FilmTransform {
    float rows[3][4];
};

class Projection {
  public:
    Projection(const View& view, uint32_t width, uint32_t height);

    bool perspective() const { return perspective_; }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    float clip_start() const { return clip_start_; }
    // What nothing seen can be behind of.
    float farthest() const { return perspective_ ? 1 / clip_end_ : -clip_end_; }
    float nearness(float depth) const { return perspective_ ? 1 / depth : -depth; }
    // How much nearness changes over a depth of a pixel's size: through a perspective camera, times the nearness.
    float pixel_size() const { return pixel_size_; }
    // For points given before `world_from_object`.
    FilmTransform transform(const Affine& world_from_object) const;

  private:
    double rows_[3][4];
    bool perspective_;
    uint32_t width_, height_;
    float clip_start_, clip_end_, pixel_size_;
};

// The scene's camera for a film of that size. Throws Error where there is none, or it has a lens that `method` cannot
// show.
View make_raster_view(const Snapshot& snapshot, const Window& window, const char* method);

}  // namespace trp
