// Errors inside the core: an exception that carries the ABI's status, thrown by fail() and caught at the front door.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "triptych/triptych.h"

namespace trp {

class Error : public std::runtime_error {
  public:
    Error(TrpStatus status, const std::string& text) : std::runtime_error(text), status(status) {}
    TrpStatus status;
};

template <class... Args>
[[noreturn]] void fail(TrpStatus status, fmt::format_string<Args...> format, Args&&... args) {
    throw Error(status, fmt::format(format, std::forward<Args>(args)...));
}

// One line of the list that trp_scene_warning reads.
struct Warning {
    int32_t code;
    uint32_t item;
    std::string text;
};

// How a message names an item: `mesh 7 "Table"`.
std::string item_name(const char* kind, uint32_t id, const std::string& name);

}  // namespace trp
