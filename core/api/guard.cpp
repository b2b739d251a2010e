#include "api/guard.h"

#include <algorithm>
#include <string>

namespace trp {
namespace {

thread_local std::string t_message;

}  // namespace

void set_error_message(const char* text) noexcept {
    try {
        t_message = text;
        // One line, whatever stands in the names of items.
        std::replace_if(
            t_message.begin(), t_message.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    } catch (...) {
        t_message.clear();
    }
}

}  // namespace trp

extern "C" {

uint32_t trp_version(void) {
    return TRP_VERSION;
}

const char* trp_error_message(void) {
    return trp::t_message.c_str();
}

}  // extern "C"
