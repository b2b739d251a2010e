// `triptych ray-tree`: the rays of a pixel, as text, JSON or a drawing. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "picture_job.h"
#include "ray_tree.h"
#include "ray_tree_svg.h"
#include "report.h"

namespace triptych::cli {
namespace {

using nlohmann::ordered_json;

struct Options : PictureJob {
    std::string svg;
    bool as_json = false;
};

ordered_json describe(const RayTree& tree, size_t index) {
    const TrpRay& ray = tree.rays[index];
    ordered_json out = {
        {"kind", ray_kind(ray)}, {"origin", ray.origin}, {"direction", ray.direction}, {"end", ray_end(ray)}};
    if (ray.end == TRP_END_SURFACE) {
        out.update({{"object", ray.object}, {"material", ray.material}});
    }
    if (ray.end == TRP_END_SURFACE || ray.end == TRP_END_LIGHT) out["distance"] = ray.distance;
    if (ray.end == TRP_END_SURFACE) {
        out.update({{"position", ray.position}, {"normal", ray.normal}});
    }
    out.update({{"local", ray.local}, {"weight", ray.weight}, {"intensity", ray.intensity}});
    out["children"] = ordered_json::array();
    return out;
}

// Children stand behind their parents, so that every child is whole when it is put into its own.
ordered_json as_json(const RayTree& tree) {
    std::vector<ordered_json> nodes;
    for (size_t k = 0; k < tree.rays.size(); ++k) nodes.push_back(describe(tree, k));
    for (size_t k = nodes.size(); k-- > 0;)
        for (size_t c = tree.children[k].size(); c-- > 0;)
            nodes[k]["children"].insert(nodes[k]["children"].begin(), std::move(nodes[tree.children[k][c]]));
    return std::move(nodes[0]);
}

void print_text(const RayTree& tree) {
    const auto triple = [](const float(&v)[3]) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", v[0], v[1], v[2]); };
    std::vector<std::pair<size_t, int>> open = {{0, 0}};
    while (!open.empty()) {
        const auto [at, depth] = open.back();
        open.pop_back();
        const TrpRay& ray = tree.rays[at];
        const std::string where = ray.end == TRP_END_SURFACE ? fmt::format("{} ({}) at {:.4g} m", one_line(ray.object),
                                                                           one_line(ray.material), ray.distance)
                                                             : ray_end(ray);
        fmt::print("{:{}}{} to {}: {} local {} intensity {}\n", "", 2 * depth, ray_kind(ray), where,
                   depth ? fmt::format("weight {}", triple(ray.weight)) : "", triple(ray.local), triple(ray.intensity));
        for (size_t c = tree.children[at].size(); c-- > 0;) open.emplace_back(tree.children[at][c], depth + 1);
    }
}

int run(Options options) {
    if (!options.svg.empty()) check_writable(options.svg);
    check_picture(options);
    LoadedPicture picture = load_picture(options);
    check_pixel(options, picture);
    const RenderHandle render = make_picture(options, picture);
    const RayTree tree = trace_tree(render.get(), options.pixel[0], picture.height - 1 - options.pixel[1]);
    if (!options.svg.empty()) write_tree_svg(tree, options.svg);
    if (options.as_json) {
        fmt::print("{}\n", as_json(tree).dump(2, ' ', false, ordered_json::error_handler_t::replace));
    } else if (options.svg.empty()) {
        print_text(tree);
    }
    return 0;
}

}  // namespace

Command add_ray_tree_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("ray-tree", "Show the tree of rays that makes a pixel");
    const auto options = std::make_shared<Options>();
    options->method = "ray_tracing";
    add_picture_options(*app, *options);
    add_pixel_option(*app, *options)->required();
    app->add_flag("--json", options->as_json, "As JSON");
    app->add_option("--svg", options->svg, "Draw the tree into a file");
    return {app, [options] { return run(*options); }};
}

}  // namespace triptych::cli
