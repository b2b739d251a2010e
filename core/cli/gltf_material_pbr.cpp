// glTF's metallic-roughness materials as coefficients of the equation. SPDX-License-Identifier: Apache-2.0
#include "gltf_material_pbr.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace triptych::cli {
namespace {

constexpr float phong_over_blinn = 0.25f;  // exponents of lobes of about the same width
// An exponent of 400: the highlights of lamps stay wide enough to be seen.
constexpr float least_alpha_squared = 1.25e-3f;

}  // namespace

PbrMaterial::Reference PbrMaterial::reference(int index, int uv_set, const tinygltf::ExtensionMap& extensions) const {
    Reference result;
    result.index = index;
    result.uv_set = uv_set;
    if (index < 0 || !has_extension(extensions, "KHR_texture_transform")) return result;
    const Fields transform = extension(extensions, "KHR_texture_transform", where_);
    transform.read("offset", result.offset, 2, 2);
    transform.read("scale", result.scale, 2, 2);
    transform.read("rotation", result.rotation);
    transform.read("texCoord", result.uv_set);
    result.transformed = true;
    return result;
}

PbrMaterial::Reference PbrMaterial::reference(const Fields& extension, const char* key) const {
    const Fields info = extension.object(key);
    int index = -1;
    int32_t uv_set = 0;
    if (!info.read_index("index", index, file_.model.textures.size())) return {};
    info.read("texCoord", uv_set);
    tinygltf::ExtensionMap extensions;
    const Fields inner = info.object("extensions");
    if (const tinygltf::Value* transform = inner.value("KHR_texture_transform")) {
        extensions.emplace("KHR_texture_transform", *transform);
    }
    return reference(index, uv_set, extensions);
}

Expression PbrMaterial::sample(const Reference& reference, int32_t color_space) {
    const uint32_t texture = textures_.id(reference.index, color_space);
    int32_t uv = TRP_NO_NODE;
    if (reference.uv_set > 0 || reference.transformed) {
        TrpNode& node = program_.add(TRP_NODE_UV);
        if (reference.uv_set > 0) node.name = program_.keep(fmt::format("TEXCOORD_{}", reference.uv_set));
        uv = program_.last();
    }
    if (reference.transformed) {
        // The extension turns and moves with v down; the same map with v up (v' = 1 - v on both sides) keeps the scale
        // and the angle and has another offset.
        const float sine = std::sin(reference.rotation), cosine = std::cos(reference.rotation);
        TrpNode& node = program_.add(TRP_NODE_UV_TRANSFORM);
        node.inputs[0] = uv;
        node.value[0] = reference.scale[0];
        node.value[1] = reference.scale[1];
        node.value[2] = reference.offset[0] + reference.scale[1] * sine;
        node.value[3] = 1.0f - reference.offset[1] - reference.scale[1] * cosine;
        node.value2[0] = reference.rotation;
        uv = program_.last();
    }
    TrpNode& image = program_.add(TRP_NODE_IMAGE);
    image.inputs[0] = uv;
    image.texture = texture;
    return {{1, 1, 1, 1}, program_.last()};
}

Expression PbrMaterial::textured(const Fields& extension, const char* key, const Expression& factor,
                                 int32_t color_space, int channel) {
    const Reference texture = reference(extension, key);
    if (texture.index < 0) return factor;
    const Expression picture = sample(texture, color_space);
    return program_.product(factor, channel < 0 ? picture : program_.channel(picture, channel));
}

// Blinn's exponent for a microfacet distribution of width alpha = roughness² is 2/alpha² - 2; Phong's is a quarter of
// it.
Expression PbrMaterial::shininess(const Expression& roughness) {
    const Expression alpha_squared = program_.power(roughness, 4.0f);
    const Expression least = Expression::of(least_alpha_squared);
    // max(x, least), as power(x - least, 1) is max(x - least, 0)
    const Expression held = program_.sum(program_.power(program_.difference(alpha_squared, least), 1.0f), least);
    const Expression blinn = program_.difference(program_.quotient(Expression::of(2.0f), held), Expression::of(2.0f));
    return program_.product(program_.power(blinn, 1.0f), Expression::of(phong_over_blinn));
}

void PbrMaterial::translate_specular(const tinygltf::Material& material, const Expression& base,
                                     const Expression& metallic, const Expression& exponent, TrpMaterialDesc& desc) {
    float ior = 1.5f;
    const Fields ior_fields = extension(material.extensions, "KHR_materials_ior", where_);
    ior_fields.read("ior", ior);
    float f0 = (ior - 1.0f) / (ior + 1.0f) * ((ior - 1.0f) / (ior + 1.0f));
    if (ior <= 0.0f) {
        // 0 stands for a reflectance of 1 at every angle.
        f0 = 1.0f;
        ior = 1.5f;
    }
    desc.ior = {{ior, ior, ior}, TRP_NO_NODE};

    const Fields specular = extension(material.extensions, "KHR_materials_specular", where_);
    float factor = 1.0f;
    float color[3] = {1.0f, 1.0f, 1.0f};
    specular.read("specularFactor", factor);
    specular.read("specularColorFactor", color, 3, 3);
    Expression dielectric =
        textured(specular, "specularColorTexture", Expression::of(f0 * color[0], f0 * color[1], f0 * color[2]),
                 TRP_COLOR_SPACE_SRGB, -1);
    dielectric = program_.clamped(dielectric);
    dielectric = program_.product(
        dielectric, textured(specular, "specularTexture", Expression::of(factor), TRP_COLOR_SPACE_LINEAR, 3));
    const Expression reflectance = program_.mix(dielectric, base, metallic);
    desc.mirror = program_.coefficient(reflectance);
    desc.mirror_is_specular = 0;
    // The highlight of a lamp, which holds as much light as its mirror image: (n + 2)/2 times as bright at its middle
    // (the normalization of Phong's lobe), and no brighter than the lamp's light on a white surface.
    const Expression peak = program_.product(program_.sum(exponent, Expression::of(2.0f)), Expression::of(0.5f));
    desc.specular = program_.coefficient(program_.clamped(program_.product(reflectance, peak)));
}

void PbrMaterial::translate_alpha(const tinygltf::Material& material, const Expression& base, TrpMaterialDesc& desc) {
    if (material.alphaMode == "OPAQUE") return;
    const Expression alpha = program_.channel(base, 3);
    if (material.alphaMode == "BLEND") {
        desc.alpha = program_.coefficient(alpha);
    } else if (material.alphaMode == "MASK") {
        // Opaque at the cutoff itself, too.
        const float below = std::nextafter(static_cast<float>(material.alphaCutoff), -1.0f);
        desc.alpha = program_.coefficient(program_.greater(alpha, Expression::of(below)));
    } else {
        warnings_.add(fmt::format("{}.alphaMode: '{}' is unknown; opaque", where_, one_line(material.alphaMode)));
    }
}

void PbrMaterial::translate_normal(const tinygltf::Material& material, TrpMaterialDesc& desc) {
    const tinygltf::NormalTextureInfo& info = material.normalTexture;
    const Reference texture = reference(info.index, info.texCoord, info.extensions);
    if (texture.index < 0) return;
    const int32_t picture = program_.node_of(sample(texture, TRP_COLOR_SPACE_LINEAR));
    TrpNode& node = program_.add(TRP_NODE_NORMAL_MAP);
    node.inputs[0] = picture;
    node.value[0] = static_cast<float>(info.scale);
    if (texture.uv_set > 0) node.name = program_.keep(fmt::format("TEXCOORD_{}", texture.uv_set));
    desc.normal = program_.last();
}

void PbrMaterial::translate(const tinygltf::Material& material, bool vertex_colors, TrpMaterialDesc& desc) {
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    const auto real = [](double value) { return static_cast<float>(value); };

    Expression base = Expression::of(real(pbr.baseColorFactor[0]), real(pbr.baseColorFactor[1]),
                                     real(pbr.baseColorFactor[2]), real(pbr.baseColorFactor[3]));
    const Reference base_texture =
        reference(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, pbr.baseColorTexture.extensions);
    if (base_texture.index >= 0) base = program_.product(base, sample(base_texture, TRP_COLOR_SPACE_SRGB));
    if (vertex_colors) {
        TrpNode& node = program_.add(TRP_NODE_COLOR);
        node.name = program_.keep("COLOR_0");
        base = program_.product(base, {{1, 1, 1, 1}, program_.last()});
    }
    translate_alpha(material, base, desc);
    desc.double_sided = material.doubleSided ? 1 : 0;

    if (has_extension(material.extensions, "KHR_materials_unlit")) {
        desc.emission = program_.coefficient(base);
        desc.diffuse = desc.specular = program_.coefficient(Expression::of(0.0f));
        return;
    }

    Expression metallic = Expression::of(real(pbr.metallicFactor));
    Expression roughness = Expression::of(real(pbr.roughnessFactor));
    const tinygltf::TextureInfo& info = pbr.metallicRoughnessTexture;
    const Reference surface_texture = reference(info.index, info.texCoord, info.extensions);
    if (surface_texture.index >= 0) {
        const Expression picture = sample(surface_texture, TRP_COLOR_SPACE_LINEAR);
        metallic = program_.product(metallic, program_.channel(picture, 2));
        roughness = program_.product(roughness, program_.channel(picture, 1));
    }

    const Fields transmission_fields = extension(material.extensions, "KHR_materials_transmission", where_);
    float transmission_factor = 0.0f;
    transmission_fields.read("transmissionFactor", transmission_factor);
    Expression transmission = Expression::of(transmission_factor);
    if (transmission_factor > 0.0f) {
        transmission = textured(transmission_fields, "transmissionTexture", transmission, TRP_COLOR_SPACE_LINEAR, 0);
    }

    // What is not metal scatters or transmits its colour.
    const Expression body = program_.product(base, program_.one_minus(metallic));
    desc.diffuse = program_.coefficient(program_.product(body, program_.one_minus(transmission)));
    const Expression exponent = shininess(roughness);
    desc.shininess = program_.coefficient(exponent);
    translate_specular(material, base, metallic, exponent, desc);

    if (transmission_factor > 0.0f) {
        desc.transmission = program_.coefficient(program_.product(body, transmission));
        const Fields volume = extension(material.extensions, "KHR_materials_volume", where_);
        float thickness = 0.0f;
        volume.read("thicknessFactor", thickness);
        desc.thin = thickness > 0.0f ? 0 : 1;
        // A ray inside a solid must meet its surface from behind.
        desc.double_sided = 1;
        // color = exp(-absorption distance)
        float distance = std::numeric_limits<float>::infinity();
        float color[3] = {1.0f, 1.0f, 1.0f};
        volume.read("attenuationDistance", distance);
        volume.read("attenuationColor", color, 3, 3);
        for (int c = 0; c < 3 && thickness > 0.0f && distance > 0.0f; ++c) {
            desc.absorption[c] = std::max(-std::log(std::max(color[c], 1e-30f)) / distance, 0.0f);
        }
        // Of a metal, K_S is its colour at every angle.
        if (pbr.metallicFactor == 0.0) {
            desc.fresnel = 1;
            desc.mirror = program_.coefficient(Expression::of(1.0f));
        }
    }

    float strength = 1.0f;
    extension(material.extensions, "KHR_materials_emissive_strength", where_).read("emissiveStrength", strength);
    Expression emission =
        Expression::of(real(material.emissiveFactor[0]) * strength, real(material.emissiveFactor[1]) * strength,
                       real(material.emissiveFactor[2]) * strength);
    const Reference emission_texture = reference(material.emissiveTexture.index, material.emissiveTexture.texCoord,
                                                 material.emissiveTexture.extensions);
    if (emission_texture.index >= 0 && std::max({emission.factor[0], emission.factor[1], emission.factor[2]}) > 0.0f) {
        emission = program_.product(emission, sample(emission_texture, TRP_COLOR_SPACE_SRGB));
    }
    desc.emission = program_.coefficient(emission);
    translate_normal(material, desc);
}

bool emits_as_light(const tinygltf::Material& material) {
    if (has_extension(material.extensions, "KHR_materials_unlit")) return false;
    return material.emissiveTexture.index < 0 || has_extension(material.extensions, "KHR_materials_emissive_strength");
}

int highest_uv_set_of(const tinygltf::Material& material) {
    int highest = 0;
    const auto see = [&](int index, int uv_set, const tinygltf::ExtensionMap& extensions) {
        if (index < 0) return;
        int32_t set = uv_set;
        extension(extensions, "KHR_texture_transform", "").read("texCoord", set);
        highest = std::max(highest, set);
    };
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    see(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, pbr.baseColorTexture.extensions);
    see(pbr.metallicRoughnessTexture.index, pbr.metallicRoughnessTexture.texCoord,
        pbr.metallicRoughnessTexture.extensions);
    see(material.normalTexture.index, material.normalTexture.texCoord, material.normalTexture.extensions);
    see(material.emissiveTexture.index, material.emissiveTexture.texCoord, material.emissiveTexture.extensions);
    return highest;
}

}  // namespace triptych::cli
