// Textures of a glTF file. SPDX-License-Identifier: Apache-2.0
#include "gltf_texture.h"

#include <fmt/format.h>

#include "gltf_fields.h"

namespace triptych::cli {
namespace {

int32_t wrap_of(int mode) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return TRP_WRAP_CLAMP;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return TRP_WRAP_MIRROR;
        default:
            return TRP_WRAP_REPEAT;
    }
}

int32_t wrap_of(const tinygltf::Value& value, const std::string& where) {
    if (value.IsString()) {
        const std::string& name = value.Get<std::string>();
        if (name == "repeat") return TRP_WRAP_REPEAT;
        if (name == "clamp") return TRP_WRAP_CLAMP;
        if (name == "mirror") return TRP_WRAP_MIRROR;
        if (name == "black") return TRP_WRAP_BLACK;
    }
    throw Error(where + ": expected repeat, clamp, mirror or black");
}

void apply_sampler(const tinygltf::Sampler& sampler, TrpTextureDesc& desc) {
    desc.wrap_u = wrap_of(sampler.wrapS);
    desc.wrap_v = wrap_of(sampler.wrapT);
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) desc.filter = TRP_FILTER_NEAREST;
}

void apply_extras(const Fields& extras, TrpTextureDesc& desc, Warnings& warnings) {
    extras.read_enum(
        "color_space", desc.color_space,
        {{"auto", TRP_COLOR_SPACE_AUTO}, {"srgb", TRP_COLOR_SPACE_SRGB}, {"linear", TRP_COLOR_SPACE_LINEAR}});
    extras.read_enum("filter", desc.filter, {{"smooth", TRP_FILTER_SMOOTH}, {"nearest", TRP_FILTER_NEAREST}});
    if (const tinygltf::Value* wrap = extras.value("wrap")) {
        if (wrap->ArrayLen() != 2) throw Error(extras.place("wrap") + ": expected two names");
        desc.wrap_u = wrap_of(wrap->Get(0), extras.place("wrap") + "[0]");
        desc.wrap_v = wrap_of(wrap->Get(1), extras.place("wrap") + "[1]");
    }
    extras.warn_unknown(warnings);
}

}  // namespace

uint32_t TextureLoader::id(int index, int32_t color_space) {
    const auto key = std::make_pair(index, color_space);
    const auto found = ids_.find(key);
    if (found != ids_.end()) return found->second;
    const uint32_t id = add(index, color_space);
    ids_.emplace(key, id);
    return id;
}

uint32_t TextureLoader::add(int index, int32_t color_space) {
    const tinygltf::Texture& texture = file_.model.textures[static_cast<size_t>(index)];
    const std::string where = fmt::format("textures[{}]", index);
    TrpTextureDesc desc;
    check(trp_texture_desc_init(&desc, sizeof desc));
    desc.color_space = color_space;
    if (texture.sampler >= 0) apply_sampler(file_.model.samplers[static_cast<size_t>(texture.sampler)], desc);
    apply_extras(triptych_extras(texture.extras, where), desc, warnings_);

    static const PictureSource none{"", {}, {}, "it names no picture that can be read"};
    const PictureSource& picture = texture.source >= 0 ? file_.pictures[static_cast<size_t>(texture.source)] : none;
    const std::string name = !texture.name.empty() ? texture.name : !picture.name.empty() ? picture.name : where;
    const std::u8string path = picture.path.u8string();
    desc.name = name.c_str();
    static const float magenta[3] = {1.0f, 0.0f, 1.0f};
    if (!picture.problem.empty()) {
        warnings_.add(fmt::format("{}: picture '{}': {}; magenta stands in", where, one_line(name), picture.problem));
        desc.pixels = magenta;
        desc.width = desc.height = 1;
        desc.channels = 3;
        desc.color_space = TRP_COLOR_SPACE_LINEAR;
    } else if (picture.bytes.data != nullptr) {
        desc.file_data = picture.bytes.data;
        desc.file_size = picture.bytes.size;
    } else {
        desc.path = reinterpret_cast<const char*>(path.c_str());
    }
    uint32_t id = TRP_NO_ID;
    check(trp_texture_add(scene_, &desc, &id), fmt::format("{} '{}'", where, one_line(name)));
    return id;
}

}  // namespace triptych::cli
