// References from a glTF file, and whole files. SPDX-License-Identifier: Apache-2.0
#include "uri.h"

#include <array>
#include <fstream>

#include "error.h"

namespace triptych::cli {
namespace {

int hex_digit(char character) {
    if (character >= '0' && character <= '9') return character - '0';
    if (character >= 'a' && character <= 'f') return character - 'a' + 10;
    if (character >= 'A' && character <= 'F') return character - 'A' + 10;
    return -1;
}

std::string percent_decoded(const std::string& text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0) {
            decoded.push_back(static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])));
            i += 2;
        } else {
            decoded.push_back(text[i]);
        }
    }
    return decoded;
}

// RFC 4648, both alphabets; -1 for what is not a digit.
constexpr std::array<int8_t, 256> base64_digits() {
    std::array<int8_t, 256> digits{};
    for (int8_t& digit : digits) digit = -1;
    for (int i = 0; i < 26; ++i) {
        digits['A' + i] = static_cast<int8_t>(i);
        digits['a' + i] = static_cast<int8_t>(26 + i);
    }
    for (int i = 0; i < 10; ++i) digits['0' + i] = static_cast<int8_t>(52 + i);
    digits['+'] = digits['-'] = 62;
    digits['/'] = digits['_'] = 63;
    return digits;
}

std::vector<unsigned char> base64_decoded(const std::string& text, size_t begin) {
    static constexpr std::array<int8_t, 256> digits = base64_digits();
    std::vector<unsigned char> bytes;
    bytes.reserve((text.size() - begin) / 4 * 3 + 3);
    uint32_t bits = 0;
    int bit_count = 0;
    for (size_t i = begin; i < text.size() && text[i] != '='; ++i) {
        const int digit = digits[static_cast<unsigned char>(text[i])];
        if (digit < 0) throw Error("a data URI has a character that is not base64");
        bits = (bits << 6) | static_cast<uint32_t>(digit);
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            bytes.push_back(static_cast<unsigned char>(bits >> bit_count));
        }
    }
    return bytes;
}

}  // namespace

bool is_data_uri(const std::string& uri) {
    return uri.rfind("data:", 0) == 0;
}

std::vector<unsigned char> decode_data_uri(const std::string& uri) {
    const size_t comma = uri.find(',');
    if (comma == std::string::npos) throw Error("a data URI has no comma before its data");
    const std::string header = uri.substr(0, comma);
    const std::string marker = ";base64";
    if (header.size() >= marker.size() && header.compare(header.size() - marker.size(), marker.size(), marker) == 0) {
        return base64_decoded(uri, comma + 1);
    }
    const std::string text = percent_decoded(uri.substr(comma + 1));
    return {text.begin(), text.end()};
}

std::filesystem::path path_of_uri(const std::string& uri, const std::filesystem::path& folder) {
    std::string path = uri;
    if (path.rfind("file://", 0) == 0) {
        path = path.substr(7);
    } else if (path.find("://") != std::string::npos) {
        throw Error("'" + one_line(uri.substr(0, 80)) + "' is not a file; only files are read");
    }
    path = percent_decoded(path);
    if (path.find('\0') != std::string::npos) throw Error("a file name holds a zero byte");
    return folder / std::filesystem::u8path(path);
}

FileBytes read_file(const std::filesystem::path& path, uint64_t limit) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw Error("no such file");
    // Devices and pipes have no size, and may have no end.
    if (!std::filesystem::is_regular_file(status)) throw Error("not a file");
    const uint64_t size = std::filesystem::file_size(path, error);
    if (error) throw Error(one_line(error.message()));
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw Error("cannot be opened for reading");
    FileBytes bytes;
    bytes.size = std::min(size, limit);
    bytes.data.reset(new unsigned char[bytes.size + 1]);
    stream.read(reinterpret_cast<char*>(bytes.data.get()), static_cast<std::streamsize>(bytes.size));
    if (static_cast<uint64_t>(stream.gcount()) != bytes.size) throw Error("cannot be read to its end");
    return bytes;
}

}  // namespace triptych::cli
