// A camera that frames the whole scene, and a headlight. SPDX-License-Identifier: Apache-2.0
#include "framing.h"

#include <ImathVec.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace triptych::cli {
namespace {

using Imath::V3d;

constexpr double field_of_view = 0.69;  // radians, across the longer side
constexpr double margin = 1.08;

// A camera's axes as the columns of world_from_camera.
struct Frame {
    V3d right, up, back, position;
};

// Looks from the front, the right and above, as at a still life.
Frame frame_along(const V3d& back) {
    Frame frame;
    frame.back = back.normalized();
    frame.right = V3d(0, 0, 1).cross(frame.back).normalized();
    frame.up = frame.back.cross(frame.right);
    return frame;
}

void write_rows(const Frame& frame, float rows[12]) {
    for (int row = 0; row < 3; ++row) {
        rows[4 * row] = static_cast<float>(frame.right[row]);
        rows[4 * row + 1] = static_cast<float>(frame.up[row]);
        rows[4 * row + 2] = static_cast<float>(frame.back[row]);
        rows[4 * row + 3] = static_cast<float>(frame.position[row]);
    }
}

// Moves the camera back until all corners of the box are in the picture.
void add_framing_camera(TrpScene* scene, const V3d& low, const V3d& high, double aspect, float rows[12]) {
    Frame frame = frame_along(V3d(0.55, -1.0, 0.5));
    const V3d center = (low + high) * 0.5;
    const double longer = std::tan(0.5 * field_of_view) / margin;
    const double tan_x = aspect >= 1.0 ? longer : longer * aspect;
    const double tan_y = aspect >= 1.0 ? longer / aspect : longer;
    double distance = 0.0, depth = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const V3d offset(((corner & 1) != 0 ? high.x : low.x) - center.x,
                         ((corner & 2) != 0 ? high.y : low.y) - center.y,
                         ((corner & 4) != 0 ? high.z : low.z) - center.z);
        const double towards = offset.dot(frame.back);
        distance = std::max({distance, towards + std::fabs(offset.dot(frame.right)) / tan_x,
                             towards + std::fabs(offset.dot(frame.up)) / tan_y});
        depth = std::max(depth, std::fabs(towards));
    }
    frame.position = center + frame.back * distance;

    TrpCameraDesc desc;
    check(trp_camera_desc_init(&desc, sizeof desc));
    write_rows(frame, rows);
    desc.name = "whole scene";
    desc.world_from_camera = rows;
    desc.field_of_view = static_cast<float>(field_of_view);
    desc.clip_start = static_cast<float>(std::max((distance - depth) * 0.5, distance * 1e-3));
    desc.clip_end = static_cast<float>((distance + depth) * 2.0);
    desc.focus_distance = static_cast<float>(distance);
    uint32_t id = TRP_NO_ID;
    check(trp_camera_add(scene, &desc, &id), "the camera that frames the scene");
    check(trp_scene_set_camera(scene, id));
}

// A sun that shines where the camera looks. It needs no shadows: those it casts are behind what is seen, and a camera
// within a closed room must not leave it dark.
void add_headlight(TrpScene* scene, const float world_from_camera[12]) {
    TrpLightDesc desc;
    check(trp_light_desc_init(&desc, sizeof desc));
    desc.type = TRP_LIGHT_SUN;
    desc.name = "headlight";
    desc.world_from_light = world_from_camera;
    // A white surface that faces it is seen with a radiance of 1.
    std::fill_n(desc.emission, 3, std::numbers::pi_v<float>);
    desc.cast_shadow = 0;
    uint32_t id = TRP_NO_ID;
    check(trp_light_add(scene, &desc, &id), "the headlight");
}

}  // namespace

void complete_scene(LoadedScene& loaded, uint32_t film_width, uint32_t film_height, uint32_t threads) {
    if (!loaded.needs_camera && !loaded.needs_light) return;
    TrpScene* scene = loaded.scene.get();
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    check(trp_scene_info(scene, &info));
    V3d low(-1.0), high(1.0);
    if (info.bounds_min[0] <= info.bounds_max[0]) {
        low = V3d(info.bounds_min[0], info.bounds_min[1], info.bounds_min[2]);
        high = V3d(info.bounds_max[0], info.bounds_max[1], info.bounds_max[2]);
    }
    // A single point has no size to frame.
    const double size = (high - low).length();
    if (size <= 0.0) {
        low -= V3d(1.0);
        high += V3d(1.0);
    }
    if (loaded.needs_camera) {
        add_framing_camera(scene, low, high, static_cast<double>(film_width) / static_cast<double>(film_height),
                           loaded.world_from_camera.data());
    }
    if (loaded.needs_light) add_headlight(scene, loaded.world_from_camera.data());
    commit(loaded, threads);
}

}  // namespace triptych::cli
