// A radiosity solution as a scene of its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "error.h"

namespace triptych::cli {

// Writes `path`, a .glb: the cameras and nodes of the glTF file `scene`, and in place of its surfaces and lights one
// mesh of the elements without cracks, whose vertex colours (COLOR_0, linear) are the radiance that leaves them,
// radiosity over π, with an unlit material. Colours above 1, as of lamps, are kept; other programs may cut them off.
// Throws an Error where a file cannot be read or written.
void write_baked_glb(const std::string& scene, TrpRadiosity* radiosity, const std::string& path);

}  // namespace triptych::cli
