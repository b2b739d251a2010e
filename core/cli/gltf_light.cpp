// Lights of nodes. Candela and lux become W/sr and W/m² by 683 lm/W, as Blender's importer has it.
// SPDX-License-Identifier: Apache-2.0
#include "gltf_light.h"

#include <fmt/format.h>

#include <algorithm>

#include "gltf_fields.h"

namespace triptych::cli {
namespace {

constexpr double lumens_per_watt = 683.0;

void read_punctual(const tinygltf::Light& light, const std::string& where, TrpLightDesc& desc) {
    if (light.type == "directional") {
        desc.type = TRP_LIGHT_SUN;
    } else if (light.type == "point") {
        desc.type = TRP_LIGHT_POINT;
    } else if (light.type == "spot") {
        desc.type = TRP_LIGHT_SPOT;
        const double outer = light.spot.outerConeAngle, inner = light.spot.innerConeAngle;
        desc.angle = static_cast<float>(2.0 * outer);
        desc.blend = outer > 0.0 ? static_cast<float>(std::clamp(1.0 - inner / outer, 0.0, 1.0)) : 0.0f;
    } else {
        throw Error(fmt::format("{}.type: '{}' is not directional, point or spot", where, one_line(light.type)));
    }
    for (size_t k = 0; k < 3; ++k) {
        const double color = light.color.size() == 3 ? light.color[k] : 1.0;
        desc.emission[k] = static_cast<float>(color * light.intensity / lumens_per_watt);
    }
}

void read_extras(const Fields& light, TrpLightDesc& desc, Warnings& warnings) {
    light.read_enum(
        "type", desc.type,
        {{"point", TRP_LIGHT_POINT}, {"spot", TRP_LIGHT_SPOT}, {"sun", TRP_LIGHT_SUN}, {"area", TRP_LIGHT_AREA}});
    light.read("emission", desc.emission, 3, 3);
    light.read("radius", desc.radius);
    light.read("angle", desc.angle);
    light.read("blend", desc.blend);
    light.read("size", desc.size, 2, 2);
    light.read_enum("shape", desc.shape, {{"rectangle", TRP_SHAPE_RECTANGLE}, {"ellipse", TRP_SHAPE_ELLIPSE}});
    light.read_enum(
        "falloff", desc.falloff,
        {{"physical", TRP_FALLOFF_PHYSICAL}, {"linear", TRP_FALLOFF_LINEAR}, {"constant", TRP_FALLOFF_CONSTANT}});
    light.read("cast_shadow", desc.cast_shadow);
    light.read("visible_camera", desc.visible_camera);
    light.read("group", desc.group);
    light.warn_unknown(warnings);
}

}  // namespace

bool add_light(const GltfFile& file, const tinygltf::Node& node, const std::string& where,
               const Imath::M44d& world_from_node, TrpScene* scene, Warnings& warnings) {
    const Fields extras = triptych_extras(node.extras, where);
    const bool of_extras = extras.has("light");
    const bool punctual = has_extension(node.extensions, "KHR_lights_punctual");
    if (!of_extras && !punctual) return false;

    TrpLightDesc desc;
    check(trp_light_desc_init(&desc, sizeof desc));
    std::string name = node.name;
    if (punctual) {
        int index = -1;
        const Fields reference = extension(node.extensions, "KHR_lights_punctual", where);
        if (!reference.read_index("light", index, file.model.lights.size())) {
            throw Error(reference.where() + ": 'light' is missing");
        }
        const tinygltf::Light& light = file.model.lights[static_cast<size_t>(index)];
        read_punctual(light, fmt::format("extensions.KHR_lights_punctual.lights[{}]", index), desc);
        if (name.empty()) name = light.name;
    }
    if (of_extras) read_extras(extras.object("light"), desc, warnings);
    if (name.empty()) name = where;
    desc.name = name.c_str();
    const std::array<float, 12> rows = rows_of(world_from_node);
    desc.world_from_light = rows.data();
    uint32_t id = TRP_NO_ID;
    check(trp_light_add(scene, &desc, &id), where);
    return true;
}

}  // namespace triptych::cli
