// glTF files by others: Debian's assimp-testmodels, with the outcome of each. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace triptych::test {

inline const std::filesystem::path models = "/usr/share/assimp/models";

inline std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".gltf" || extension == ".glb") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

// What does not load, and a part of the error that says why. All others load.
inline const std::map<std::string, std::string> expected_errors = {
    {"BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf", "the extension KHR_technique_webgl, which is not supported"},
    {"BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "meshes[0]: "},
    {"IndexOutOfRange/AllIndicesOutOfRange.gltf", "meshes[0]: "},
    {"IndexOutOfRange/IndexOutOfRange.gltf", "meshes[0]: "},
    {"MissingBin/BoxTextured.gltf", "buffers[0] 'BoxTextured0.bin': no such file"},
    {"RecursiveNodes/RecursiveNodes.gltf", "nodes[0] '': it is reached twice"},
    {"SchemaFailures/sceneWrongType.gltf", "scene: expected an integer"},
    {"TestNoRootNode/NoScene.gltf", "scene: there is no scenes[0]"},
    {"draco/2CylinderEngine.gltf", "the extension KHR_draco_mesh_compression, which is not supported"},
    {"wrongTypes/badArray.gltf", "meshes[0].primitives: expected an array"},
    {"wrongTypes/badNumber.gltf", "materials[0].normalTexture: 'index' is missing"},
    {"wrongTypes/badObject.gltf", "materials[0].pbrMetallicRoughness: expected an object"},
    {"wrongTypes/badString.gltf", "scenes[0].name: expected a string"},
    {"wrongTypes/badUint.gltf", "baseColorTexture.index: -1 is not an integer"},
};

}  // namespace triptych::test
