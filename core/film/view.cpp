#include "film/view.h"

#include <cmath>

namespace trp {

View make_view(const Camera& camera, const Vec3d& origin, uint32_t width, uint32_t height, size_t time_sample) {
    View view;
    const Affine m = camera.world_from_camera[time_sample].relative_to(origin);
    view.position = m.column(3);
    // Scale and shear are no part of a camera: the axes are made orthonormal from where it looks and what is up.
    view.z = m.column(2).normalized();
    view.x = m.column(1).cross(view.z).normalized();
    view.y = view.z.cross(view.x);
    view.perspective = camera.type == TRP_CAMERA_PERSPECTIVE;

    const double w = static_cast<double>(width) * camera.pixel_aspect, h = height;
    const bool horizontal = camera.fit == TRP_FIT_HORIZONTAL || (camera.fit == TRP_FIT_AUTO && w >= h);
    const double fitted = view.perspective ? 2 * std::tan(camera.field_of_view / 2.0) : camera.width;
    const double side_x = horizontal ? fitted : fitted * w / h, side_y = horizontal ? fitted * h / w : fitted;
    view.left = static_cast<float>(fitted * camera.shift[0] - side_x / 2);
    view.bottom = static_cast<float>(fitted * camera.shift[1] - side_y / 2);
    view.step_x = static_cast<float>(side_x / width);
    view.step_y = static_cast<float>(side_y / height);
    view.clip_start = camera.clip_start;
    view.clip_end = camera.clip_end;
    view.aperture_radius = camera.aperture_radius;
    view.focus_distance = camera.focus_distance;
    view.blade_count = camera.blade_count;
    view.blade_rotation = camera.blade_rotation;
    return view;
}

}  // namespace trp
