// The core's tables of methods, settings and passes as lists. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "error.h"

namespace triptych::cli {

std::vector<TrpMethodInfo> all_methods();
std::vector<TrpSettingInfo> all_settings();
std::vector<TrpPassInfo> all_passes();

// "a, b, c": for messages and help.
std::string method_names();

}  // namespace triptych::cli
