#include "base/error.h"

namespace trp {

std::string item_name(const char* kind, uint32_t id, const std::string& name) {
    std::string text = id ? fmt::format("{} {}", kind, id) : kind;
    if (!name.empty()) text += fmt::format(" \"{}\"", name);
    return text;
}

}  // namespace trp
