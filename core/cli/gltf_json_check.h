// Types and indices of a glTF file's JSON, checked in one place: every index that the loader follows later is known to
// be in range, and a value of a wrong type is an error that names it instead of a silent default.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace triptych::cli {

// Throws an Error that names the item ("nodes[3].mesh"). Integers written as 24.0 are turned into 24.
void check_gltf_json(nlohmann::json& root);

}  // namespace triptych::cli
