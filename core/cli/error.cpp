// One-line messages, and the core's status turned into an exception. SPDX-License-Identifier: Apache-2.0
#include "error.h"

namespace triptych::cli {

std::string one_line(const std::string& text) {
    std::string line;
    line.reserve(text.size());
    for (const char character : text) {
        const bool blank = static_cast<unsigned char>(character) < 0x20 || character == ' ' || character == 0x7f;
        if (!blank) {
            line.push_back(character);
        } else if (!line.empty() && line.back() != ' ') {
            line.push_back(' ');
        }
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

void check(TrpStatus status, const std::string& item) {
    if (status == TRP_OK) return;
    const std::string message = trp_error_message();
    throw Error(item.empty() ? message : item + ": " + message);
}

}  // namespace triptych::cli
