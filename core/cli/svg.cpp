// Words, colours and pictures in drawings. SPDX-License-Identifier: Apache-2.0
#include "svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.h"

namespace triptych::cli {

std::string page_color(const float (&linear)[3]) {
    std::string out = "#";
    for (const float c : linear) {
        const double x = std::clamp(std::isfinite(c) ? static_cast<double>(c) : 0.0, 0.0, 1.0);
        const double s = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
        out += fmt::format("{:02x}", static_cast<int>(std::lround(255 * s)));
    }
    return out;
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : one_line(text)) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string base64(const std::string& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t k = 0; k < bytes.size(); k += 3) {
        const size_t count = std::min<size_t>(bytes.size() - k, 3);
        uint32_t three = 0;
        for (size_t c = 0; c < 3; ++c) three = three << 8 | (c < count ? static_cast<unsigned char>(bytes[k + c]) : 0U);
        for (size_t c = 0; c < 4; ++c) out += c <= count ? kDigits[three >> (18 - 6 * c) & 63] : '=';
    }
    return out;
}

}  // namespace triptych::cli
