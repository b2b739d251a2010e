// `triptych render`: a picture of a glTF scene by one method. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <memory>

#include "commands.h"
#include "interrupt.h"
#include "radiosity_job.h"
#include "render_job.h"
#include "report.h"
#include "statistics.h"
#include "tables.h"

namespace triptych::cli {
namespace {

struct CallbackState {
    ProgressLine line;
    bool quiet, stops;
    uint32_t passes = 0, pass_count = 0;  // over the film: done, and all
};

int32_t on_progress(void* user, const TrpProgress* progress) {
    CallbackState& state = *static_cast<CallbackState*>(user);
    state.line.show(*progress);
    state.passes = progress->pass, state.pass_count = progress->pass_count;
    return state.stops && InterruptGuard::interrupted() ? 0 : 1;
}

void on_log(void* user, const char* text) {
    CallbackState& state = *static_cast<CallbackState*>(user);
    if (state.quiet) return;
    state.line.clear();
    fmt::print(stderr, "triptych: {}\n", one_line(text));
}

// Solves what the render shows. Returns how far it came where it was interrupted, else nothing.
std::string solve(const RenderJob& job, TrpRender* render, TrpRadiosity* radiosity) {
    SolveCallbacks callbacks(job.quiet);
    const bool whole = callbacks.check_whole(trp_radiosity_solve(radiosity, callbacks.get()));
    const std::string ending = whole ? "" : interrupted_after(info_of(radiosity)) + ": the picture shows them";
    print_radiosity_warnings(job, radiosity);
    check(trp_render_set_radiosity(render, radiosity));
    return ending;
}

// Draws the picture. `stops`: on an interrupt. Returns how far it came where it was stopped, else nothing.
std::string run_render(TrpRender* render, bool quiet, bool stops) {
    CallbackState state{ProgressLine(!quiet && error_is_terminal()), quiet, stops};
    TrpCallbacks callbacks;
    check(trp_callbacks_init(&callbacks, sizeof callbacks));
    callbacks.user = &state;
    callbacks.progress = on_progress;
    callbacks.log = on_log;
    const TrpStatus status = trp_render_run(render, &callbacks);
    state.line.clear();
    if (status != TRP_CANCELLED) {
        check(status);
        return "";
    }
    if (state.passes == 0) throw Interrupted("interrupted");
    return fmt::format("interrupted after {} of {} passes: the picture shows them", state.passes, state.pass_count);
}

CommandCosts costs_of(const RenderJob& job, const LoadedScene& loaded, TrpRender* render) {
    CommandCosts costs;
    costs.method = job.method;
    costs.load_seconds = loaded.load_seconds;
    costs.scene.struct_size = sizeof costs.scene;
    check(trp_scene_info(loaded.scene.get(), &costs.scene));
    costs.commit_seconds = loaded.commit_seconds;
    costs.scene.bvh_seconds = loaded.bvh_seconds;
    costs.render.struct_size = sizeof costs.render;
    check(trp_render_statistics(render, &costs.render));
    return costs;
}

int run(RenderJob job) {
    check_job(job);
    InterruptGuard guard;
    LoadedPicture picture = load_picture(job);
    check_tile(job, picture.width, picture.height);
    const RenderHandle render = make_picture(job, picture);
    if (job.tile.given()) set_tile(render.get(), job, picture.width, picture.height);
    for (const std::string& pass : job.passes) check(trp_render_add_pass(render.get(), pass.c_str()));
    guard.hold();
    RadiosityHandle radiosity;
    std::string ending;
    if (job.method == "radiosity") {
        print_unused_settings(job, picture);
        radiosity = make_radiosity(job, picture);
        ending = solve(job, render.get(), radiosity.get());
    }
    ending += run_render(render.get(), job.quiet, !radiosity);

    const auto start = std::chrono::steady_clock::now();
    check(trp_render_write(render.get(), job.output.c_str()));  // its message names the file
    const double write_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!job.stats.empty()) {
        CommandCosts costs = costs_of(job, picture.loaded, render.get());
        costs.write_seconds = write_seconds;
        costs.width = picture.width;
        costs.height = picture.height;
        if (radiosity) put_solution(radiosity.get(), costs);
        write_file(job.stats, statistics_json(costs));
    }
    if (guard.interrupted()) throw Interrupted(ending.empty() ? "interrupted: the picture is whole" : ending);
    return 0;
}

}  // namespace

Command add_render_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("render", "Render a glTF scene into a picture");
    const auto job = std::make_shared<RenderJob>();
    add_picture_options(*app, *job);
    app->add_option("--method", job->method, "One of " + method_names())->required();
    app->add_option("--output", job->output, "The picture: .exr (all passes, float) or .png")->required();
    app->add_option("--samples", job->samples, "Samples to a pixel: --set samples=N");
    app->add_option("--seed", job->seed, "Of the random sequences: --set seed=N");
    app->add_option("--pass", job->passes, "A pass of `triptych passes`")->take_all()->allow_extra_args(false);
    app->add_option("--tile", job->tile_text, "X,Y,W,H: this part of the picture alone, from its top left");
    app->add_option("--stats", job->stats, "Write what it cost into this file, as JSON");
    return {app, [job] { return run(*job); }};
}

}  // namespace triptych::cli
