// A glTF 2.0 file in memory. SPDX-License-Identifier: Apache-2.0
#include "gltf_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "gltf_json_check.h"

namespace triptych::cli {
namespace {

using nlohmann::json;

const std::set<std::string> known_extensions = {"KHR_lights_punctual",
                                                "KHR_materials_ior",
                                                "KHR_materials_transmission",
                                                "KHR_materials_specular",
                                                "KHR_materials_volume",
                                                "KHR_materials_unlit",
                                                "KHR_materials_emissive_strength",
                                                "KHR_texture_transform",
                                                "KHR_mesh_quantization",
                                                "EXT_mesh_gpu_instancing",
                                                "FB_ngon_encoding"};

json parse_json(std::string_view text) {
    try {
        return json::parse(text.begin(), text.end());
    } catch (const json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: …"
        const std::string message = error.what();
        const size_t bracket = message.find("] ");
        throw Error("JSON: " + one_line(bracket == std::string::npos ? message : message.substr(bracket + 2)));
    }
}

void check_version(const json& root) {
    if (!root.is_object()) throw Error("JSON: expected an object");
    const auto asset = root.find("asset");
    const auto version = asset != root.end() && asset->is_object() ? asset->find("version") : json::const_iterator();
    const bool has_version = asset != root.end() && asset->is_object() && version != asset->end();
    // glTF 1.0 keeps its items in objects by name.
    const auto meshes = root.find("meshes");
    const bool by_name = meshes != root.end() && meshes->is_object();
    if (has_version && version->is_string()) {
        const std::string text = *version;
        if (text.rfind("2.", 0) == 0 && !by_name) return;
        if (text.rfind("1.", 0) == 0 || text == "1" || by_name) {
            throw Error("asset.version: glTF 1.0 is not supported; convert the file to glTF 2.0");
        }
        throw Error(fmt::format("asset.version: '{}' is not glTF 2.0", one_line(text)));
    }
    if (by_name) throw Error("asset: glTF 1.0 is not supported; convert the file to glTF 2.0");
    throw Error("asset.version is missing: this is not a glTF 2.0 file");
}

void check_extensions(const json& root, Warnings& warnings) {
    std::set<std::string> required;
    if (const auto found = root.find("extensionsRequired"); found != root.end()) {
        for (const json& name : *found) {
            required.insert(name);
            if (known_extensions.count(name) == 0) {
                throw Error(
                    fmt::format("extensionsRequired: this file cannot be read without the extension {}, "
                                "which is not supported",
                                one_line(name)));
            }
        }
    }
    if (const auto found = root.find("extensionsUsed"); found != root.end()) {
        for (const json& name : *found) {
            if (known_extensions.count(name) == 0) {
                warnings.add(fmt::format("extension {} is not supported and left out", one_line(name)));
            }
        }
    }
}

ByteSpan keep(GltfFile& file, FileBytes bytes) {
    const ByteSpan span{bytes.data.get(), bytes.size};
    file.files.push_back(std::move(bytes));
    return span;
}

ByteSpan keep(GltfFile& file, std::vector<unsigned char> bytes) {
    file.decoded.push_back(std::move(bytes));
    return {file.decoded.back().data(), file.decoded.back().size()};
}

void find_buffers(GltfFile& file, const json& root, const GltfChunks& chunks) {
    const auto buffers = root.find("buffers");
    if (buffers == root.end()) return;
    for (size_t i = 0; i < buffers->size(); ++i) {
        const json& buffer = (*buffers)[i];
        const std::string where = fmt::format("buffers[{}]", i);
        const uint64_t length = buffer["byteLength"];
        ByteSpan span;
        if (!buffer.contains("uri")) {
            if (i != 0 || !chunks.has_binary)
                throw Error(where + ": it has no uri, and the file no binary chunk for it");
            span = chunks.binary;
        } else {
            const std::string uri = buffer["uri"];
            try {
                span = is_data_uri(uri) ? keep(file, decode_data_uri(uri))
                                        : keep(file, read_file(path_of_uri(uri, file.path.parent_path()), length));
            } catch (const Error& error) {
                const std::string shown = is_data_uri(uri) ? "" : fmt::format(" '{}'", one_line(uri));
                throw Error(fmt::format("{}{}: {}", where, shown, error.what()));
            }
        }
        if (span.size < length) {
            throw Error(fmt::format("{}: it says it has {} bytes and has {}", where, length, span.size));
        }
        span.size = length;
        file.buffers.push_back(span);
        file.total_bytes += length;
    }
}

PictureSource find_picture(GltfFile& file, const json& image, size_t index) {
    PictureSource picture;
    const std::string uri = image.value("uri", std::string());
    picture.name = image.value("name", is_data_uri(uri) ? std::string() : uri);
    if (picture.name.empty()) picture.name = fmt::format("images[{}]", index);
    if (image.contains("bufferView")) {
        const tinygltf::BufferView& view = file.model.bufferViews[image["bufferView"].get<size_t>()];
        const ByteSpan buffer = file.buffers[static_cast<size_t>(view.buffer)];
        if (view.byteOffset > buffer.size || view.byteLength > buffer.size - view.byteOffset) {
            picture.problem = "its bytes lie beyond the end of the buffer";
        } else if (view.byteLength == 0) {
            picture.problem = "it has no bytes";
        } else {
            picture.bytes = {buffer.data + view.byteOffset, view.byteLength};
        }
        return picture;
    }
    if (uri.empty()) {
        picture.problem = "it has neither a uri nor a bufferView";
        return picture;
    }
    try {
        if (is_data_uri(uri)) {
            picture.bytes = keep(file, decode_data_uri(uri));
            if (picture.bytes.size == 0) picture.problem = "it has no bytes";
            return picture;
        }
        picture.path = path_of_uri(uri, file.path.parent_path());
        std::error_code error;
        if (!std::filesystem::exists(picture.path, error)) {
            picture.problem = "no such file";
        } else if (!std::filesystem::is_regular_file(picture.path, error)) {
            picture.problem = "not a file";
        }
    } catch (const std::exception& error) {
        picture.problem = one_line(error.what());
    }
    return picture;
}

// tinygltf's messages come as lines one after the other.
void parse_model(GltfFile& file, json root, Warnings& warnings) {
    root.erase("buffers");
    root.erase("images");
    // Not rendered, and not worth a failure.
    root.erase("animations");
    const std::string text = root.dump();
    tinygltf::TinyGLTF reader;
    std::string error, warning;
    if (!reader.LoadASCIIFromString(&file.model, &error, &warning, text.data(), static_cast<unsigned>(text.size()),
                                    "")) {
        throw Error(one_line(error.empty() ? "the JSON is not a glTF scene" : error));
    }
    for (const std::string& message : {error, warning}) {
        if (!message.empty()) warnings.add(one_line(message));
    }
}

}  // namespace

GltfFile open_gltf(const std::filesystem::path& path, Warnings& warnings) {
    GltfFile file;
    file.path = path;
    const ByteSpan bytes = keep(file, read_file(path));
    file.total_bytes = bytes.size;
    const GltfChunks chunks = split_gltf(bytes);
    if (chunks.json.size() > UINT32_MAX / 2) throw Error("JSON: larger than 2 GB");
    check_json_depth(chunks.json);
    json root = parse_json(chunks.json);
    check_version(root);
    check_gltf_json(root);
    check_extensions(root, warnings);
    find_buffers(file, root, chunks);
    const json images = root.value("images", json::array());
    parse_model(file, std::move(root), warnings);
    for (size_t i = 0; i < images.size(); ++i) file.pictures.push_back(find_picture(file, images[i], i));
    return file;
}

}  // namespace triptych::cli
