// A pixel's tree of rays, as the core gives it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "handles.h"

namespace triptych::cli {

struct RayTree {
    std::vector<TrpRay> rays;                   // parents before children; names are the render's
    std::vector<std::vector<size_t>> children;  // of each ray
};

// x and y from the bottom left.
RayTree trace_tree(TrpRender* render, uint32_t x, uint32_t y);

const char* ray_kind(const TrpRay& ray);
const char* ray_end(const TrpRay& ray);

}  // namespace triptych::cli
