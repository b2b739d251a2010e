// Links of a radiosity solution as a drawing. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "error.h"

namespace triptych::cli {

// Lines from the middles of sources to those of receivers, in the picture that the render has drawn; a colour to each
// level of the receivers, and a dot at them. Throws an Error where the file cannot be written.
void write_links_svg(const TrpRender* render, uint32_t width, uint32_t height,
                     const std::vector<TrpRadiosityLink>& links, const std::string& path);

}  // namespace triptych::cli
