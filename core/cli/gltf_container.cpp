// The outer shape of a glTF file. SPDX-License-Identifier: Apache-2.0
#include "gltf_container.h"

#include <fmt/format.h>

#include <cstring>

#include "error.h"

namespace triptych::cli {
namespace {

constexpr uint32_t chunk_json = 0x4E4F534A;    // "JSON"
constexpr uint32_t chunk_binary = 0x004E4942;  // "BIN\0"
constexpr int deepest_json = 100;

uint32_t read_uint32(const unsigned char* bytes) {
    return static_cast<uint32_t>(bytes[0]) | static_cast<uint32_t>(bytes[1]) << 8 |
           static_cast<uint32_t>(bytes[2]) << 16 | static_cast<uint32_t>(bytes[3]) << 24;
}

std::string_view text_of(ByteSpan bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data), bytes.size);
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.remove_suffix(1);
    return text;
}

GltfChunks split_glb(ByteSpan file) {
    if (file.size < 12) throw Error("header: the file ends within it");
    const uint32_t version = read_uint32(file.data + 4);
    if (version == 1) throw Error("header: glTF 1.0 is not supported; convert the file to glTF 2.0");
    if (version != 2) throw Error(fmt::format("header: version {} is not glTF 2.0", version));
    const uint64_t length = read_uint32(file.data + 8);
    if (length > file.size) {
        throw Error(fmt::format("header: the file says it has {} bytes and has {}; it was cut off", length, file.size));
    }
    GltfChunks chunks;
    bool has_json = false;
    uint64_t at = 12;
    while (at + 8 <= length) {
        const uint64_t size = read_uint32(file.data + at);
        const uint32_t type = read_uint32(file.data + at + 4);
        at += 8;
        if (size > length - at) {
            throw Error(
                fmt::format("chunk at byte {}: it says it has {} bytes, and {} are left", at - 8, size, length - at));
        }
        const ByteSpan bytes{file.data + at, size};
        if (type == chunk_json && !has_json) {
            chunks.json = text_of(bytes);
            has_json = true;
        } else if (type == chunk_binary && !chunks.has_binary) {
            chunks.binary = bytes;
            chunks.has_binary = true;
        }
        if (!has_json) throw Error("chunk at byte 12: the first chunk is not JSON");
        at += size;
    }
    if (!has_json) throw Error("header: the file has no JSON chunk");
    return chunks;
}

}  // namespace

GltfChunks split_gltf(ByteSpan file) {
    if (file.size >= 4 && std::memcmp(file.data, "glTF", 4) == 0) return split_glb(file);
    GltfChunks chunks;
    chunks.json = text_of(file);
    if (chunks.json.empty()) throw Error("the file is empty");
    return chunks;
}

void check_json_depth(std::string_view json) {
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < json.size(); ++i) {
        const char character = json[i];
        if (in_string) {
            if (character == '\\') {
                ++i;
            } else if (character == '"') {
                in_string = false;
            }
        } else if (character == '"') {
            in_string = true;
        } else if (character == '[' || character == '{') {
            if (++depth > deepest_json) throw Error(fmt::format("JSON: nested deeper than {} levels", deepest_json));
        } else if (character == ']' || character == '}') {
            --depth;
        }
    }
}

}  // namespace triptych::cli
