// References from a glTF file: data URIs (RFC 2397), and percent-encoded relative paths (RFC 3986).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace triptych::cli {

bool is_data_uri(const std::string& uri);

// The bytes of a data URI, base64 or percent-encoded. Throws an Error where it is malformed.
std::vector<unsigned char> decode_data_uri(const std::string& uri);

// The file that a relative (or file:) URI names, seen from `folder`. Throws an Error for other schemes.
std::filesystem::path path_of_uri(const std::string& uri, const std::filesystem::path& folder);

// A whole file in memory, not initialized before it is read.
struct FileBytes {
    std::unique_ptr<unsigned char[]> data;
    uint64_t size = 0;
};

// Reads a regular file, or its first `limit` bytes. Throws an Error that says what is wrong, without the path.
FileBytes read_file(const std::filesystem::path& path, uint64_t limit = UINT64_MAX);

}  // namespace triptych::cli
