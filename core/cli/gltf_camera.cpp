// Cameras of nodes. SPDX-License-Identifier: Apache-2.0
#include "gltf_camera.h"

#include <fmt/format.h>

#include "gltf_fields.h"

namespace triptych::cli {
namespace {

constexpr float far_away = 1e6f;       // metres; where glTF's projection is infinite
constexpr float nearest_clip = 1e-4f;  // metres; glTF allows 0 for an orthographic camera

void read_gltf(const tinygltf::Camera& camera, const std::string& where, TrpCameraDesc& desc) {
    // glTF gives the height of the view; the width follows the film.
    desc.fit = TRP_FIT_VERTICAL;
    double near = 0.0, far = 0.0;
    if (camera.type == "orthographic") {
        desc.type = TRP_CAMERA_ORTHOGRAPHIC;
        desc.width = static_cast<float>(2.0 * camera.orthographic.ymag);
        if (!(desc.width > 0.0f)) throw Error(where + ".orthographic.ymag: it is not above 0");
        near = camera.orthographic.znear;
        far = camera.orthographic.zfar;
    } else {
        desc.type = TRP_CAMERA_PERSPECTIVE;
        desc.field_of_view = static_cast<float>(camera.perspective.yfov);
        near = camera.perspective.znear;
        far = camera.perspective.zfar;
    }
    desc.clip_start = near > 0.0 ? static_cast<float>(near) : nearest_clip;
    desc.clip_end = far > 0.0 ? static_cast<float>(far) : far_away;
}

void read_extras(const Fields& extras, TrpCameraDesc& desc, Warnings& warnings) {
    // The glTF camera's view is vertical; a view given here is along the film's longer side unless it says otherwise.
    if (extras.has("field_of_view") || extras.has("width")) desc.fit = TRP_FIT_AUTO;
    extras.read_enum("fit", desc.fit,
                     {{"auto", TRP_FIT_AUTO}, {"horizontal", TRP_FIT_HORIZONTAL}, {"vertical", TRP_FIT_VERTICAL}});
    extras.read("field_of_view", desc.field_of_view);
    extras.read("width", desc.width);
    extras.read("shift", desc.shift, 2, 2);
    extras.read("clip_start", desc.clip_start);
    extras.read("clip_end", desc.clip_end);
    extras.read("aperture_radius", desc.aperture_radius);
    extras.read("focus_distance", desc.focus_distance);
    extras.read("blade_count", desc.blade_count);
    extras.read("blade_rotation", desc.blade_rotation);
    extras.read("shutter", desc.shutter, 2, 2);
    extras.read("pixel_aspect", desc.pixel_aspect);
    extras.warn_unknown(warnings);
}

}  // namespace

uint32_t add_camera(const GltfFile& file, const tinygltf::Node& node, const std::string& name,
                    const Imath::M44d& world_from_node, TrpScene* scene, Warnings& warnings) {
    const tinygltf::Camera& camera = file.model.cameras[static_cast<size_t>(node.camera)];
    const std::string where = fmt::format("cameras[{}]", node.camera);
    TrpCameraDesc desc;
    check(trp_camera_desc_init(&desc, sizeof desc));
    read_gltf(camera, where, desc);
    read_extras(triptych_extras(camera.extras, where), desc, warnings);
    desc.name = name.c_str();
    const std::array<float, 12> rows = rows_of(world_from_node);
    desc.world_from_camera = rows.data();
    uint32_t id = TRP_NO_ID;
    check(trp_camera_add(scene, &desc, &id), where);
    return id;
}

}  // namespace triptych::cli
