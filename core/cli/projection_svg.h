// Nusselt's analog as a drawing. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "error.h"

namespace triptych::cli {

// The elements that face the middle of an element, themselves projected to its hemisphere and down to the base circle,
// in exact curves. Nearer ones are drawn over those farther off. Each path says its element and its form factor from
// that point, with nothing between. Throws an Error where the file cannot be written.
void write_projection_svg(TrpRadiosity* radiosity, uint32_t element, const std::string& path);

}  // namespace triptych::cli
