// A tree of rays as a drawing: I_pixel at the root, a branch to each ray with its kind, and at open ends the
// background. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ray_tree.h"

namespace triptych::cli {

// The file appears whole or not at all. Throws an Error that names it.
void write_tree_svg(const RayTree& tree, const std::string& path);

}  // namespace triptych::cli
