#include "raster/projection.h"

#include <algorithm>

namespace trp {

Projection::Projection(const View& view, uint32_t width, uint32_t height)
    : perspective_(view.perspective),
      width_(width),
      height_(height),
      clip_start_(view.clip_start),
      clip_end_(view.clip_end),
      pixel_size_(static_cast<float>(std::max(view.step_x, view.step_y))) {
    const Vec3d axes[3] = {Vec3d(view.x), Vec3d(view.y), -Vec3d(view.z)}, position(view.position);
    const double steps[2] = {view.step_x, view.step_y}, ends[2] = {view.left, view.bottom};
    for (int c = 0; c < 3; ++c) rows_[2][c] = axes[2][c];
    rows_[2][3] = -axes[2].dot(position);
    // x / depth − left, or x − left, over the step.
    for (int r = 0; r < 2; ++r) {
        for (int c = 0; c < 3; ++c) rows_[r][c] = axes[r][c] / steps[r];
        rows_[r][3] = -axes[r].dot(position) / steps[r];
        if (perspective_)
            for (int c = 0; c < 4; ++c) rows_[r][c] -= ends[r] / steps[r] * rows_[2][c];
        else
            rows_[r][3] -= ends[r] / steps[r];
    }
}

FilmTransform Projection::transform(const Affine& world_from_object) const {
    FilmTransform out;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) {
            double sum = c == 3 ? rows_[r][3] : 0;
            for (int k = 0; k < 3; ++k) sum += rows_[r][k] * static_cast<double>(world_from_object.rows[k][c]);
            out.rows[r][c] = static_cast<float>(sum);
        }
    return out;
}

View make_raster_view(const Snapshot& snapshot, const Window& window, const char* method) {
    if (!snapshot.camera) fail(TRP_ERROR_STATE, "the scene has no camera to render from");
    const View view = make_view(*snapshot.camera, snapshot.origin, window.width, window.height);
    if (view.aperture_radius > 0)
        fail(TRP_ERROR_STATE, "{} cannot show depth of field: use ray_casting, or a camera without an aperture",
             method);
    return view;
}

}  // namespace trp
