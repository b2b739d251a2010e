// glTF's metallic-roughness materials as coefficients of the equation (glTF 2.0 specification, appendix B, and
// KHR_materials_*). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gltf_fields.h"
#include "gltf_file.h"
#include "gltf_texture.h"
#include "node_program.h"

namespace triptych::cli {

class PbrMaterial {
  public:
    PbrMaterial(const GltfFile& file, TextureLoader& textures, NodeProgram& program, Warnings& warnings,
                std::string where)
        : file_(file), textures_(textures), program_(program), warnings_(warnings), where_(std::move(where)) {}

    // Writes the coefficients into `desc`; its nodes are those of the program.
    void translate(const tinygltf::Material& material, bool vertex_colors, TrpMaterialDesc& desc);

  private:
    // A texture reference with KHR_texture_transform. index -1: none.
    struct Reference {
        int index = -1;
        int uv_set = 0;
        float offset[2] = {0.0f, 0.0f};
        float scale[2] = {1.0f, 1.0f};
        float rotation = 0.0f;
        bool transformed = false;
    };
    Reference reference(int index, int uv_set, const tinygltf::ExtensionMap& extensions) const;
    Reference reference(const Fields& extension, const char* key) const;
    Expression sample(const Reference& reference, int32_t color_space);
    // `factor` times a texture of the extension, or `factor` alone.
    Expression textured(const Fields& extension, const char* key, const Expression& factor, int32_t color_space,
                        int channel);

    Expression shininess(const Expression& roughness);
    void translate_specular(const tinygltf::Material& material, const Expression& base, const Expression& metallic,
                            const Expression& exponent, TrpMaterialDesc& desc);
    void translate_alpha(const tinygltf::Material& material, const Expression& base, TrpMaterialDesc& desc);
    void translate_normal(const tinygltf::Material& material, TrpMaterialDesc& desc);

    const GltfFile& file_;
    TextureLoader& textures_;
    NodeProgram& program_;
    Warnings& warnings_;
    std::string where_;
};

// Whether the material is meant to light what is around it. A picture of emission without a strength of its own is the
// glow of a display or a label, and an unlit material has no light at all: a scene of these alone would stay dark.
bool emits_as_light(const tinygltf::Material& material);

// The highest UV set that any texture of the material reads.
int highest_uv_set_of(const tinygltf::Material& material);

}  // namespace triptych::cli
