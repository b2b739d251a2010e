// Textures of a glTF file, added to the core when a material first needs them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>

#include "gltf_file.h"

namespace triptych::cli {

class TextureLoader {
  public:
    TextureLoader(const GltfFile& file, TrpScene* scene, Warnings& warnings)
        : file_(file), scene_(scene), warnings_(warnings) {}

    // The core's id of glTF texture `index`, read in `color_space` unless its extras name one. A picture used in two
    // colour spaces is two textures. One that cannot be found is magenta, with a warning.
    uint32_t id(int index, int32_t color_space);

  private:
    uint32_t add(int index, int32_t color_space);

    const GltfFile& file_;
    TrpScene* scene_;
    Warnings& warnings_;
    std::map<std::pair<int, int32_t>, uint32_t> ids_;
};

}  // namespace triptych::cli
