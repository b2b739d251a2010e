// `triptych radiosity`: solves a scene's radiosity, and leaves pictures of the solution. SPDX-License-Identifier:
// Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <numeric>
#include <set>

#include "bake_glb.h"
#include "commands.h"
#include "links_svg.h"
#include "radiosity_job.h"
#include "report.h"
#include "statistics.h"

namespace triptych::cli {
namespace {

struct Options : PictureJob {
    std::string snapshots_text, output, stats, links, bake;
    std::vector<uint32_t> snapshots;
    int32_t level = no_level;
    static constexpr int32_t no_level = -2;
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

// That is seen in the job's pixel.
uint32_t picked_element(const Options& options, const LoadedPicture& picture, const TrpRender* render,
                        TrpRadiosity* radiosity) {
    uint32_t element = 0;
    check(trp_radiosity_pick(radiosity, render, options.pixel[0], picture.height - 1 - options.pixel[1], &element));
    if (element == TRP_NO_ELEMENT)
        throw Error(fmt::format("--pixel: no element is seen at {},{}", options.pixel[0], options.pixel[1]));
    return element;
}

// Throws an Error where none of them is of the level that was asked for.
void keep_level(std::vector<TrpRadiosityLink>& links, int32_t level) {
    std::set<int32_t> levels;
    for (const TrpRadiosityLink& link : links) levels.insert(link.level);
    if (!levels.contains(level))
        throw Error(fmt::format("--level: there are no links of level {}; there are {}", level,
                                levels.empty() ? "none" : fmt::format("those of {}", fmt::join(levels, ", "))));
    std::erase_if(links, [&](const TrpRadiosityLink& link) { return link.level != level; });
}

// Draws the links that were asked for over the elements.
void draw_links(const Options& options, const LoadedPicture& picture, TrpRender* render, TrpRadiosity* radiosity) {
    std::vector<uint64_t> numbers(info_of(radiosity).links);
    std::iota(numbers.begin(), numbers.end(), uint64_t{0});
    if (options.has_pixel) {
        size_t count = 0;
        check(trp_radiosity_element_links(radiosity, picked_element(options, picture, render, radiosity),
                                          numbers.data(), numbers.size(), &count));
        numbers.resize(count);
    }
    std::vector<TrpRadiosityLink> links;
    for (const uint64_t number : numbers) {
        TrpRadiosityLink link{};
        link.struct_size = sizeof link;
        check(trp_radiosity_link(radiosity, number, &link));
        links.push_back(link);
    }
    if (options.level != Options::no_level) keep_level(links, options.level);
    if (links.empty() && !options.quiet) print_warnings({"--links: there are none"});
    check(trp_render_set(render, "radiosity.mesh", "on"));
    check(trp_render_set_radiosity(render, radiosity));
    check(trp_render_run(render, nullptr));
    write_links_svg(render, picture.width, picture.height, links, options.links);
}

// Draws the solution as it is into DIR/NAME.exr and .png.
void draw(const Options& options, const LoadedPicture& picture, const RenderHandle& render,
          const RadiosityHandle& radiosity, const std::string& name) {
    if (options.has_pixel) {
        const uint32_t element = picked_element(options, picture, render.get(), radiosity.get());
        check(trp_render_set(render.get(), "radiosity.view_element", std::to_string(element).c_str()));
    }
    check(trp_render_set_radiosity(render.get(), radiosity.get()));
    check(trp_render_run(render.get(), nullptr));
    for (const char* extension : {".exr", ".png"})
        check(trp_render_write(render.get(), (options.output + "/" + name + extension).c_str()));
}

std::string snapshot_name(uint32_t step) {
    return fmt::format("iteration_{:04}", step);
}

// Advances to each snapshot and draws it, or solves as far as it goes. Returns what is said where it was interrupted,
// whose last state is drawn in place of the snapshots that are left.
std::string solve(const Options& options, const LoadedPicture& picture, const RenderHandle& render,
                  const RadiosityHandle& radiosity) {
    SolveCallbacks callbacks(options.quiet);
    const auto steps = [&] { return info_of(radiosity.get()).iterations; };
    bool whole = true;
    uint32_t drawn = 0;
    if (options.snapshots.empty()) whole = callbacks.check_whole(trp_radiosity_solve(radiosity.get(), callbacks.get()));
    for (const uint32_t step : options.snapshots) {
        if (step > steps())
            whole = callbacks.check_whole(trp_radiosity_step(radiosity.get(), step - steps(), callbacks.get()));
        if (!whole || InterruptGuard::interrupted()) break;
        draw(options, picture, render, radiosity, snapshot_name(step));
        drawn = step;
    }
    const std::string ending = InterruptGuard::interrupted() ? interrupted_after(info_of(radiosity.get())) : "";
    if (ending.empty() && !options.snapshots.empty() && options.snapshots.back() > steps() && !options.quiet)
        print_warnings({fmt::format("--snapshots: it was solved after {} steps, which later ones show", steps())});
    if (options.output.empty()) return ending;
    if (options.snapshots.empty())
        draw(options, picture, render, radiosity, "radiosity");
    else if (!ending.empty() && steps() > drawn)
        draw(options, picture, render, radiosity, snapshot_name(steps()));
    return ending.empty() ? "" : ending + ": the picture shows them";
}

void print_summary(const Options& options, const LoadedPicture& picture, const RenderHandle& render,
                   const RadiosityHandle& radiosity) {
    const TrpRadiosityInfo info = info_of(radiosity.get());
    fmt::print("{} elements, {} links, {} steps, {} rays, {:.3g} s, residual {:.3g}{}\n", info.element_count,
               info.links, info.iterations, info.rays, info.seconds, info.residual,
               !info.solved   ? ""
               : info.limited ? ", ended at its limit"
                              : ", solved");
    if (const auto sums = row_sums_of(radiosity.get()))
        fmt::print("row sums {:.4g} to {:.4g}, mean {:.4g}\n", sums->least, sums->greatest, sums->mean);
    if (options.has_pixel)
        fmt::print("element {} at pixel {},{}\n", picked_element(options, picture, render.get(), radiosity.get()),
                   options.pixel[0], options.pixel[1]);
}

// Throws a UsageError for what is wrong in the call, as far as the scene is not needed for it.
void check_options(Options& options) {
    if (!options.snapshots_text.empty()) options.snapshots = parse_snapshots(options.snapshots_text);
    check_picture(options);
    if (!options.bake.empty() && std::filesystem::u8path(options.bake).extension() != ".glb")
        throw UsageError(fmt::format("--bake: '{}' does not end in .glb", options.bake));
    for (const std::string* path : {&options.stats, &options.links, &options.bake})
        if (!path->empty()) check_writable(*path);
    if (!options.output.empty()) {
        const std::filesystem::path folder = std::filesystem::u8path(options.output);
        if (folder.extension() == ".png" || folder.extension() == ".exr")
            throw UsageError(fmt::format("--output: '{}' is to be the folder of the pictures", options.output));
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        if (error) throw Error(fmt::format("{}: the folder cannot be made: {}", options.output, error.message()));
    }
}

int run(Options options) {
    check_options(options);
    InterruptGuard guard;
    LoadedPicture picture = load_picture(options);
    if (options.has_pixel) check_pixel(options, picture);
    if (const std::string solver = setting_of(options, picture, "radiosity.solver");
        !options.links.empty() && solver != "hierarchical")
        throw UsageError(fmt::format("--links: the {} solver has none; radiosity.solver=hierarchical has", solver));
    const RenderHandle render = make_picture(options, picture);
    print_unused_settings(options, picture);
    const RadiosityHandle radiosity = make_radiosity(options, picture);
    SolveCallbacks callbacks(options.quiet);
    if (!callbacks.check_whole(trp_radiosity_prepare(radiosity.get(), callbacks.get())))
        throw Interrupted("interrupted");
    guard.hold();
    const uint32_t told = print_radiosity_warnings(options, radiosity.get());
    if (options.has_pixel) picked_element(options, picture, render.get(), radiosity.get());  // or fails early
    const std::string ending = solve(options, picture, render, radiosity);
    print_radiosity_warnings(options, radiosity.get(), told);
    if (!options.quiet) print_summary(options, picture, render, radiosity);
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
        put_solution(radiosity.get(), costs);
        costs.width = picture.width;
        costs.height = picture.height;
        write_file(options.stats, statistics_json(costs));
    }
    if (!options.bake.empty()) write_baked_glb(options.scene, radiosity.get(), options.bake);
    if (!options.links.empty()) draw_links(options, picture, render.get(), radiosity.get());
    if (guard.interrupted()) throw Interrupted(ending.empty() ? "interrupted: all is written" : ending);
    return 0;
}

}  // namespace

Command add_radiosity_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("radiosity", "Solve a scene's radiosity, and draw the solution");
    const auto options = std::make_shared<Options>();
    options->method = "radiosity";
    add_picture_options(*app, *options);
    CLI::Option* output = app->add_option("--output", options->output,
                                          "DIR: the folder of the pictures; without snapshots, radiosity.exr and "
                                          ".png of the whole solution, or on Ctrl-C of what there is");
    app->add_option("--snapshots", options->snapshots_text,
                    "1,2,24,…: draw the solution after these steps, whatever radiosity.iterations says, into "
                    "DIR/iteration_0001.exr and .png; on Ctrl-C after the last step")
        ->needs(output);
    app->add_option("--stats", options->stats, "Write what it cost into this file, as JSON");
    app->add_option("--bake", options->bake,
                    "FILE.glb: the scene as a mesh of its elements with their radiosity as vertex colours");
    add_pixel_option(*app, *options)
        ->description("X,Y, from the top left: the element seen there, for --links and the view form_factors");
    CLI::Option* links = app->add_option(
        "--links", options->links,
        "FILE.svg: the hierarchical solver's links over the elements; with --pixel, those that bring light to "
        "its element");
    app->add_option("--level", options->level,
                    "Of the links, those whose receivers were divided so often; -1: groups of elements")
        ->check(CLI::Range(-1, 32))
        ->needs(links);
    return {app, [options] { return run(*options); }};
}

}  // namespace triptych::cli
