#include "api/guard.h"

#include <string>

namespace trp {
namespace {

thread_local std::string t_message;

}  // namespace

void set_error_message(const char* text) noexcept {
    try {
        t_message = text;
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
