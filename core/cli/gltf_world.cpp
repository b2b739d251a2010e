// `extras.triptych` of a scene. SPDX-License-Identifier: Apache-2.0
#include "gltf_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gltf_fields.h"

namespace triptych::cli {
namespace {

bool set_world(const GltfFile& file, const Fields& world, TextureLoader& textures, TrpScene* scene,
               Warnings& warnings) {
    TrpWorldDesc desc;
    check(trp_world_desc_init(&desc, sizeof desc));
    int texture = -1;
    if (world.read_index("texture", texture, file.model.textures.size(), true) && texture >= 0) {
        desc.texture = textures.id(texture, TRP_COLOR_SPACE_AUTO);
        std::fill_n(desc.radiance, 3, 1.0f);
    }
    world.read("radiance", desc.radiance, 3, 3);
    world.read("visible_camera", desc.visible_camera);
    world.read("light", desc.light);
    float turn[9] = {};
    const int given = world.read("rotation", turn, 1, 9);
    if (given > 1 && given < 9) throw Error(world.where() + ": 'rotation' has neither 1 nor 9 numbers");
    float rows[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    if (given == 9) {
        for (int r = 0; r < 3; ++r) std::copy_n(turn + 3 * r, 3, rows + 4 * r);
    } else {
        rows[0] = rows[5] = std::cos(turn[0]);
        rows[4] = std::sin(turn[0]);
        rows[1] = -rows[4];
    }
    desc.world_from_texture = rows;
    world.warn_unknown(warnings);
    check(trp_scene_set_world(scene, &desc), world.where());
    return desc.light != 0 && std::max({desc.radiance[0], desc.radiance[1], desc.radiance[2]}) > 0.0f;
}

// Settings as text; numbers, truth and colours are allowed as JSON has them.
std::string setting_text(const tinygltf::Value& value, const std::string& where) {
    if (value.IsString()) return value.Get<std::string>();
    if (value.IsBool()) return value.Get<bool>() ? "on" : "off";
    if (value.IsInt()) return fmt::format("{}", value.GetNumberAsInt());
    if (value.IsNumber()) return fmt::format("{}", value.GetNumberAsDouble());
    if (value.IsArray()) {
        std::string text;
        for (size_t i = 0; i < value.ArrayLen(); ++i) {
            if (!value.Get(static_cast<int>(i)).IsNumber()) throw Error(where + ": expected numbers");
            text += fmt::format("{}{}", i == 0 ? "" : ",", value.Get(static_cast<int>(i)).GetNumberAsDouble());
        }
        return text;
    }
    throw Error(where + ": expected a string");
}

}  // namespace

SceneExtras read_scene_extras(const GltfFile& file, int index, TextureLoader& textures, TrpScene* scene,
                              Warnings& warnings) {
    SceneExtras result;
    if (index < 0) return result;
    const tinygltf::Scene& source = file.model.scenes[static_cast<size_t>(index)];
    const Fields extras = triptych_extras(source.extras, fmt::format("scenes[{}]", index));
    if (extras.has("world")) result.has_world = set_world(file, extras.object("world"), textures, scene, warnings);
    extras.read_index("camera", result.camera_node, file.model.nodes.size(), true);
    const Fields film = extras.object("film");
    film.read("width", result.film_width);
    film.read("height", result.film_height);
    film.warn_unknown(warnings);
    if (const tinygltf::Value* settings = extras.value("settings")) {
        for (const std::string& name : settings->Keys()) {
            result.settings.emplace_back(name,
                                         setting_text(settings->Get(name), extras.place("settings") + "." + name));
        }
    }
    extras.warn_unknown(warnings);
    return result;
}

}  // namespace triptych::cli
