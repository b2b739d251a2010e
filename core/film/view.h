// A camera made ready for a film: where the picture plane lies, in camera space, for each pixel.
#pragma once

#include "scene/items.h"

namespace trp {

struct View {
    Vec3 position{0, 0, 0};                   // relative to the snapshot's origin
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  // unit axes; the camera looks along −z
    bool perspective = true;
    // A film position (px, py), in pixels from the bottom left, lies at left + px · step_x, bottom + py · step_y: on
    // the plane at depth 1 where the camera is perspective, else in metres.
    float left = 0, bottom = 0, step_x = 0, step_y = 0;
    float clip_start = 0, clip_end = 0;
    float aperture_radius = 0, focus_distance = 1, blade_rotation = 0;
    uint32_t blade_count = 0;
};

// At one of the camera's time samples.
View make_view(const Camera& camera, const Vec3d& origin, uint32_t width, uint32_t height, size_t time_sample = 0);

}  // namespace trp
