// Meshes of a glTF file: each becomes one mesh of the core, with a material slot to a primitive, and one more for its
// lines. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "gltf_file.h"
#include "gltf_material.h"

namespace triptych::cli {

struct PrimitiveData;

class MeshLoader {
  public:
    MeshLoader(const GltfFile& file, TrpScene* scene, MaterialLoader& materials, Warnings& warnings)
        : file_(file), scene_(scene), materials_(materials), warnings_(warnings) {}

    // The core's ids of glTF mesh `index`, added when it is first asked for; none where nothing in it can be rendered.
    const std::vector<uint32_t>& ids(int index);

  private:
    std::vector<uint32_t> load(int index);
    void load_faces(const std::string& name, const std::string& where, std::vector<PrimitiveData>& primitives,
                    std::vector<uint32_t>& ids);
    void load_lines(const std::string& name, const std::string& where, std::vector<PrimitiveData>& primitives,
                    std::vector<uint32_t>& ids);

    const GltfFile& file_;
    TrpScene* scene_;
    MaterialLoader& materials_;
    Warnings& warnings_;
    std::map<int, std::vector<uint32_t>> ids_;
};

}  // namespace triptych::cli
