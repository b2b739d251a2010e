// The JSON that --stats writes. SPDX-License-Identifier: Apache-2.0
#include "statistics.h"

#include <nlohmann/json.hpp>

namespace triptych::cli {

std::string statistics_json(const CommandCosts& costs) {
    using nlohmann::ordered_json;
    const TrpStatistics& render = costs.render;
    ordered_json json = {
        {"method", costs.method},
        {"seconds",
         {{"load", costs.load_seconds},
          {"commit", costs.commit_seconds},
          {"solve", render.solve_seconds},
          {"render", render.render_seconds},
          {"write", costs.write_seconds},
          {"bvh", costs.scene.bvh_seconds}}},
        {"rays",
         {{"primary", render.primary_rays},
          {"shadow", render.shadow_rays},
          {"reflection", render.reflection_rays},
          {"transmission", render.transmission_rays},
          {"gather", render.gather_rays}}},
        {"triangles", render.triangles},
        {"elements", render.elements},
        {"links", render.links},
        {"iterations", render.iterations},
        {"residual", render.residual},
        {"peak_memory_bytes", render.peak_memory_bytes},
        {"threads", render.threads},
        {"width", costs.width},
        {"height", costs.height},
        {"thread_seconds",
         {{"primary", render.primary_seconds}, {"shadow", render.shadow_seconds}, {"shading", render.shading_seconds}}},
        {"scene_bytes",
         {{"mesh", costs.scene.mesh_bytes}, {"held", costs.scene.held_bytes}, {"bvh", costs.scene.bvh_bytes}}},
    };
    if (const auto& info = costs.radiosity) {
        json["radiosity"] = {{"solved", info->solved && !info->limited},
                             {"limited", info->limited != TRP_LIMIT_NONE},
                             {"vertices", info->vertex_count},
                             {"area", info->area},
                             {"power", info->power},
                             {"unshot", info->unshot},
                             {"row_sums", nullptr}};
        if (const auto& sums = costs.row_sums)
            json["radiosity"]["row_sums"] = {
                {"least", sums->least}, {"mean", sums->mean}, {"greatest", sums->greatest}};
    }
    return json.dump(2) + "\n";
}

}  // namespace triptych::cli
