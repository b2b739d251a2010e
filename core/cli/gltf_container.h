// The outer shape of a glTF file: a .glb's header and chunks (glTF 2.0 specification, section 4), or a .gltf's text.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace triptych::cli {

// Bytes in somebody else's memory.
struct ByteSpan {
    const unsigned char* data = nullptr;
    uint64_t size = 0;
};

struct GltfChunks {
    std::string_view json;
    ByteSpan binary;  // the BIN chunk; empty where there is none
    bool has_binary = false;
};

// Finds the chunks in `file` (both views point into it). Throws an Error that names the header's or the chunk's fault;
// what is returned lies within `file`.
GltfChunks split_gltf(ByteSpan file);

// Throws an Error where arrays and objects of `json` lie in one another deeper than any scene's: what reads them later
// is recursive.
void check_json_depth(std::string_view json);

}  // namespace triptych::cli
