// `triptych radiosity`: solves a scene's radiosity, and leaves pictures of the solution. SPDX-License-Identifier:
// Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "radiosity_job.h"
#include "report.h"
#include "statistics.h"

namespace triptych::cli {
namespace {

struct Options : PictureJob {
    std::string snapshots_text, output, stats;
    std::vector<uint32_t> snapshots;
};

// "1,2,24,100", in the order of the steps.
std::vector<uint32_t> parse_snapshots(const std::string& text) {
    std::vector<uint32_t> out(static_cast<size_t>(std::count(text.begin(), text.end(), ',')) + 1);
    if (!parse_numbers(text, out.data(), out.size()))
        throw UsageError(fmt::format("--snapshots: '{}' is not a list of numbers like 1,2,24", text));
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    if (out.front() == 0) throw UsageError("--snapshots: the first step is 1");
    return out;
}

// Draws the solution as it is into DIR/NAME.exr and .png.
void draw(const Options& options, const RenderHandle& render, const RadiosityHandle& radiosity, const std::string& name,
          InterruptGuard& guard) {
    check(trp_render_set_radiosity(render.get(), radiosity.get()));
    check(trp_render_run(render.get(), nullptr));
    guard.begin_writing();
    for (const char* extension : {".exr", ".png"})
        check(trp_render_write(render.get(), (options.output + "/" + name + extension).c_str()));
    guard.end_writing();
    if (guard.interrupted()) throw Error("interrupted");
}

int run(Options options) {
    if (!options.snapshots_text.empty()) {
        if (options.output.empty()) throw UsageError("--snapshots: needs --output");
        options.snapshots = parse_snapshots(options.snapshots_text);
    }
    check_picture(options);
    if (!options.stats.empty()) check_writable(options.stats);
    if (!options.output.empty()) {
        std::error_code error;
        std::filesystem::create_directories(std::filesystem::u8path(options.output), error);
        if (error) throw Error(fmt::format("{}: the folder cannot be made: {}", options.output, error.message()));
    }
    InterruptGuard guard;
    LoadedPicture picture = load_picture(options);
    const RenderHandle render = make_picture(options, picture);
    const RadiosityHandle radiosity = make_radiosity(options, picture);
    SolveCallbacks callbacks(guard, options.quiet);
    callbacks.check_call(trp_radiosity_prepare(radiosity.get(), callbacks.get()));
    print_radiosity_warnings(options, radiosity.get());
    for (const uint32_t step : options.snapshots) {
        const uint32_t done = info_of(radiosity.get()).iterations;
        if (step > done) callbacks.check_call(trp_radiosity_step(radiosity.get(), step - done, callbacks.get()));
        draw(options, render, radiosity, fmt::format("iteration_{:04}", step), guard);
    }
    if (options.snapshots.empty()) {
        callbacks.check_call(trp_radiosity_solve(radiosity.get(), callbacks.get()));
        if (!options.output.empty()) draw(options, render, radiosity, "radiosity", guard);
    }
    const TrpRadiosityInfo info = info_of(radiosity.get());
    if (!options.quiet)
        fmt::print("{} elements, {} links, {} steps, {} rays, {:.3g} s, residual {:.3g}{}\n", info.element_count,
                   info.links, info.iterations, info.rays, info.seconds, info.residual, info.solved ? ", solved" : "");
    if (!options.stats.empty()) {
        CommandCosts costs;
        costs.method = options.method;
        costs.load_seconds = picture.loaded.load_seconds;
        costs.commit_seconds = picture.loaded.commit_seconds;
        costs.scene.struct_size = sizeof costs.scene;
        check(trp_scene_info(picture.loaded.scene.get(), &costs.scene));
        if (!options.output.empty()) {
            costs.render.struct_size = sizeof costs.render;
            check(trp_render_statistics(render.get(), &costs.render));
        }
        costs.render.solve_seconds = info.seconds;
        costs.render.gather_rays = info.rays;
        costs.render.elements = info.element_count;
        costs.render.links = info.links;
        costs.render.iterations = info.iterations;
        costs.render.residual = info.residual;
        costs.width = picture.width;
        costs.height = picture.height;
        write_file(options.stats, statistics_json(costs));
    }
    return 0;
}

}  // namespace

Command add_radiosity_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("radiosity", "Solve a scene's radiosity, and draw the solution");
    const auto options = std::make_shared<Options>();
    options->method = "radiosity";
    add_picture_options(*app, *options);
    app->add_option("--snapshots", options->snapshots_text,
                    "1,2,24,…: draw the solution after these steps, into DIR/iteration_0001.exr and .png");
    app->add_option("--output", options->output,
                    "DIR: the folder of the pictures; without snapshots, radiosity.exr and "
                    ".png of the whole solution");
    app->add_option("--stats", options->stats, "Write what it cost into this file, as JSON");
    return {app, [options] { return run(*options); }};
}

}  // namespace triptych::cli
