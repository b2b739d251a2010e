// Materials of a glTF file as coefficients of the equation. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>

#include "gltf_file.h"
#include "gltf_texture.h"

namespace triptych::cli {

class MaterialLoader {
  public:
    MaterialLoader(const GltfFile& file, TrpScene* scene, Warnings& warnings);

    // The core's id of glTF material `index`, added when it is first asked for; TRP_NO_ID for -1.
    uint32_t id(int index);

    // The highest TEXCOORD set that the material's glTF textures read: 0 where it reads one or none.
    int highest_uv_set(int index) const;

    // Whether a material that was asked for is meant to light the scene.
    bool any_light() const { return any_light_; }

    TextureLoader& textures() { return textures_; }

  private:
    uint32_t add(int index);

    const GltfFile& file_;
    TrpScene* scene_;
    Warnings& warnings_;
    TextureLoader textures_;
    std::map<int, uint32_t> ids_;
    std::set<int> vertex_colored_;  // materials of primitives that have COLOR_0
    bool any_light_ = false;
};

}  // namespace triptych::cli
