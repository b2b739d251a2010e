// Words, colours and pictures in drawings. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace triptych::cli {

// Linear colour as one of the page, #rrggbb.
std::string page_color(const float (&linear)[3]);

// Bytes as text, for a picture within the drawing (RFC 4648).
std::string base64(const std::string& bytes);

// As it may stand between tags, on one line.
std::string escaped(const std::string& text);

}  // namespace triptych::cli
