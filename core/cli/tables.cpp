// The core's tables as lists. SPDX-License-Identifier: Apache-2.0
#include "tables.h"

namespace triptych::cli {
namespace {

template <typename Info>
std::vector<Info> all(uint32_t count, TrpStatus (*get)(uint32_t, Info*)) {
    std::vector<Info> list;
    for (uint32_t i = 0; i < count; ++i) {
        Info info{};
        info.struct_size = sizeof info;
        check(get(i, &info));
        list.push_back(info);
    }
    return list;
}

}  // namespace

std::vector<TrpMethodInfo> all_methods() {
    return all<TrpMethodInfo>(trp_method_count(), trp_method_info);
}
std::vector<TrpSettingInfo> all_settings() {
    return all<TrpSettingInfo>(trp_setting_count(), trp_setting_info);
}
std::vector<TrpPassInfo> all_passes() {
    return all<TrpPassInfo>(trp_pass_count(), trp_pass_info);
}

std::string method_names() {
    std::string names;
    for (const TrpMethodInfo& method : all_methods()) names += (names.empty() ? "" : ", ") + std::string(method.name);
    return names;
}

}  // namespace triptych::cli
