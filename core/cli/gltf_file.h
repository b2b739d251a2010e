// A glTF 2.0 file in memory: its model, its buffers and its pictures' sources.
// The JSON is read by tinygltf; the container, the buffers and the pictures are found here, because tinygltf copies the
// binary chunk and takes bytes of pictures without looking at their bounds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "error.h"
#include "gltf_container.h"
#include "tinygltf_model.h"
#include "uri.h"

namespace triptych::cli {

// Where a picture's bytes come from: a file, or memory. With neither, `problem` says why.
struct PictureSource {
    std::string name;
    std::filesystem::path path;
    ByteSpan bytes;
    std::string problem;
};

struct GltfFile {
    std::filesystem::path path;
    tinygltf::Model model;  // without buffers and images, which are these:
    std::vector<ByteSpan> buffers;
    std::vector<PictureSource> pictures;
    // All bytes of the file and of its buffers: a measure for what counts are believable.
    uint64_t total_bytes = 0;

    // What the spans point into.
    std::deque<FileBytes> files;
    std::deque<std::vector<unsigned char>> decoded;
};

// Reads a .glb or .gltf. Throws an Error that names the item but not the file. Every index in the model's own fields is
// in range afterwards; what accessors reach is checked when they are read.
GltfFile open_gltf(const std::filesystem::path& path, Warnings& warnings);

}  // namespace triptych::cli
