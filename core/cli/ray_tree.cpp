// A pixel's tree of rays, as the core gives it. SPDX-License-Identifier: Apache-2.0
#include "ray_tree.h"

namespace triptych::cli {

RayTree trace_tree(TrpRender* render, uint32_t x, uint32_t y) {
    uint32_t count = 0;
    check(trp_render_trace_tree(render, x, y, &count));
    RayTree tree;
    tree.rays.resize(count);
    tree.children.resize(count);
    for (uint32_t k = 0; k < count; ++k) {
        tree.rays[k].struct_size = sizeof(TrpRay);
        check(trp_render_ray(render, k, &tree.rays[k]));
        if (tree.rays[k].parent != TRP_NO_PARENT) tree.children[tree.rays[k].parent].push_back(k);
    }
    return tree;
}

const char* ray_kind(const TrpRay& ray) {
    static const char* const names[] = {"primary", "reflection", "transmission"};
    return names[ray.kind];
}

const char* ray_end(const TrpRay& ray) {
    static const char* const names[] = {"surface", "light", "background", "depth", "weight"};
    return names[ray.end];
}

}  // namespace triptych::cli
