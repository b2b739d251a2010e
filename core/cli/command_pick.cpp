// `triptych pick`: how the value of a pixel is interpolated along its scan line. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "picture_job.h"

namespace triptych::cli {
namespace {

using nlohmann::ordered_json;

struct Options : PictureJob {
    bool as_json = false;
};

ordered_json side_of(const TrpScanLine& line, int first) {
    ordered_json vertices = ordered_json::array(), values = ordered_json::array();
    for (int k = first; k < first + 2; ++k) {
        vertices.push_back(line.vertices[k] == TRP_NO_VERTEX ? ordered_json() : ordered_json(line.vertices[k]));
        values.push_back(line.values[k]);
    }
    return {{"vertices", vertices}, {"values", values}};
}

ordered_json describe(const TrpScanLine& line, const Options& options) {
    ordered_json out = {{"pixel", options.pixel}, {"method", options.method}, {"seen", line.seen != 0}};
    if (!line.seen) return out;
    out.update({{"mesh", line.mesh},
                {"instance", line.instance},
                {"face", line.face},
                {"quantity", options.method == "gouraud" ? "radiance" : "normal"},
                {"left", side_of(line, 0)},
                {"right", side_of(line, 2)},
                {"alpha", line.alpha},
                {"beta", line.beta},
                {"gamma", line.gamma},
                {"A", line.a},
                {"B", line.b},
                {"I", line.value}});
    return out;
}

void print_text(const TrpScanLine& line, const Options& options) {
    if (!line.seen) {
        fmt::print("no surface is seen there\n");
        return;
    }
    const auto triple = [](const float(&v)[3]) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]); };
    const auto end = [&](int k) {
        return fmt::format("{} {}", triple(line.values[k]),
                           line.vertices[k] == TRP_NO_VERTEX ? "where the near plane cuts"
                                                             : fmt::format("at vertex {}", line.vertices[k]));
    };
    fmt::print("{} interpolated over face {} of {}\n", options.method == "gouraud" ? "radiance" : "normals", line.face,
               one_line(line.mesh));
    fmt::print("I1 = {}\nI2 = {}\nI3 = {}\nI4 = {}\n", end(0), end(1), end(2), end(3));
    fmt::print("alpha = {:.6g}  A = alpha I1 + (1 - alpha) I2 = {}\n", line.alpha, triple(line.a));
    fmt::print("beta  = {:.6g}  B = beta I3 + (1 - beta) I4 = {}\n", line.beta, triple(line.b));
    fmt::print("gamma = {:.6g}  I = (1 - gamma) A + gamma B = {}\n", line.gamma, triple(line.value));
}

int run(Options options) {
    check_picture(options);
    if (options.method != "gouraud" && options.method != "phong") {
        throw UsageError(fmt::format("--method: {} does not interpolate; gouraud and phong do", options.method));
    }
    LoadedPicture picture = load_picture(options);
    check_pixel(options, picture);
    const RenderHandle render = make_picture(options, picture);
    TrpScanLine line{};
    line.struct_size = sizeof line;
    check(trp_render_pick_scan_line(render.get(), options.pixel[0], picture.height - 1 - options.pixel[1], &line));
    if (options.as_json) {
        fmt::print("{}\n", describe(line, options).dump(2, ' ', false, ordered_json::error_handler_t::replace));
    } else {
        print_text(line, options);
    }
    return 0;
}

}  // namespace

Command add_pick_command(CLI::App& program) {
    CLI::App* app =
        program.add_subcommand("pick", "Show how a pixel's value is interpolated along its scan line, by the books");
    const auto options = std::make_shared<Options>();
    options->method = "gouraud";
    add_picture_options(*app, *options);
    add_pixel_option(*app, *options)->required();
    app->add_option("--method", options->method, "gouraud: radiance; phong: normals")->capture_default_str();
    app->add_flag("--json", options->as_json, "As JSON");
    return {app, [options] { return run(*options); }};
}

}  // namespace triptych::cli
