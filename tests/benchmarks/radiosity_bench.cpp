// Radiosity: how far hierarchical solutions of a scene are from the truth. The truth is path tracing, twice, with
// different random numbers: the mean of (R - A)(R - B) is the square of the solution's error, whatever the noise of A
// and B, which are independent. Errors are RMS over the area of the surfaces that the camera sees, of radiosity, beside
// its mean. Wall seconds; medians of the repeats. Prints a line of JSON to a figure.
#include <CLI/CLI.hpp>
#include <cmath>
#include <numbers>
#include <sstream>

#include "bench.h"
#include "gltf_scene.h"

using namespace trp_bench;
using triptych::cli::check;

namespace {

struct Options {
    std::string name = "radiosity.cornell_box", scene, solver = "hierarchical";
    std::vector<double> tolerances = {0.01};  // of the mean radiosity
    uint32_t threads = 2, repeats = 5, width = 96, height = 96, samples = 1024;
    double error_goal = kNone, seconds_goal = kNone;
};

using Pixels = std::vector<float>;  // rows of RGB

triptych::cli::RenderHandle make_render(const Options& options, TrpScene* scene, const char* method) {
    auto render = triptych::cli::make_render(scene, method);
    check(trp_render_set_film(render.get(), options.width, options.height, 0, 0, 0, 0));
    check(trp_render_set(render.get(), "threads", std::to_string(options.threads).c_str()));
    check(trp_render_set(render.get(), "film.filter", "box"));
    check(trp_render_set(render.get(), "film.filter_width", "1"));
    return render;
}

Pixels read(const Options& options, TrpRender* render, const char* pass, size_t channels) {
    Pixels out(channels * options.width * options.height);
    check(trp_render_read(render, pass, 0, 0, options.width, options.height, out.data(), out.size()));
    return out;
}

// How much area of a surface each pixel shows: z³ / |n · (p − eye)|, up to a factor. None of what glows itself and of
// pixels at edges, of which the share that each surface has would count as an error.
Pixels areas_of(const Options& options, TrpRender* render, const std::array<float, 12>& eye) {
    const Pixels depth = read(options, render, "Depth", 1), place = read(options, render, "Position", 3),
                 normal = read(options, render, "Normal", 3), emission = read(options, render, "Emission", 3);
    const auto slope = [&](size_t i, size_t of) {  // of the way to a pixel's place against the plane of another's
        float sum = 0;
        for (size_t c = 0; c < 3; ++c) sum += normal[3 * of + c] * (place[3 * i + c] - eye[4 * c + 3]);
        return sum;
    };
    Pixels areas(depth.size(), 0);
    for (size_t y = 1; y + 1 < options.height; ++y)
        for (size_t x = 1; x + 1 < options.width; ++x) {
            const size_t i = y * options.width + x;
            bool whole = depth[i] < 1e9f;
            for (const size_t k : {i, i - 1, i + 1, i - options.width, i + options.width})
                whole &= emission[3 * k] + emission[3 * k + 1] + emission[3 * k + 2] == 0 &&
                         std::abs(slope(k, i) - slope(i, i)) < 0.02f * std::abs(slope(i, i));
            if (whole) areas[i] = depth[i] * depth[i] * depth[i] / std::max(std::abs(slope(i, i)), 1e-9f);
        }
    return areas;
}

Pixels truth(const Options& options, const triptych::cli::LoadedScene& loaded, uint32_t seed, Pixels& areas) {
    const auto render = make_render(options, loaded.scene.get(), "path_tracing");
    check(trp_render_set(render.get(), "samples", std::to_string(options.samples).c_str()));
    check(trp_render_set(render.get(), "seed", std::to_string(seed).c_str()));
    for (const char* pass : {"Depth", "Position", "Normal", "Emission"}) check(trp_render_add_pass(render.get(), pass));
    check(trp_render_run(render.get(), nullptr));
    areas = areas_of(options, render.get(), loaded.world_from_camera);
    return read(options, render.get(), "Combined", 4);
}

double brightness(const Pixels& pixels, size_t i) {
    return 0.2126 * static_cast<double>(pixels[4 * i]) + 0.7152 * static_cast<double>(pixels[4 * i + 1]) +
           0.0722 * static_cast<double>(pixels[4 * i + 2]);
}

struct Solved {
    Cost cost;
    TrpRadiosityInfo info{};
    Pixels pixels;
};

Solved solve(const Options& options, TrpScene* scene, double tolerance) {
    Solved out;
    TrpRadiosity* made = nullptr;
    check(trp_radiosity_create(scene, &made));
    const triptych::cli::RadiosityHandle solution(made);
    check(trp_radiosity_set(made, "threads", std::to_string(options.threads).c_str()));
    check(trp_radiosity_set(made, "radiosity.solver", options.solver.c_str()));
    check(trp_radiosity_set(made, "radiosity.tolerance", std::to_string(tolerance).c_str()));
    out.cost = cost_of([&] { check(trp_radiosity_solve(made, nullptr)); });
    out.info.struct_size = sizeof out.info;
    check(trp_radiosity_info(made, &out.info));
    const auto render = make_render(options, scene, "radiosity");
    check(trp_render_set(render.get(), "raster.samples", "32"));
    check(trp_render_set_radiosity(render.get(), made));
    check(trp_render_run(render.get(), nullptr));
    out.pixels = read(options, render.get(), "Combined", 4);
    return out;
}

void measure(const Options& options) {
    const auto loaded = triptych::cli::load_gltf(options.scene, "", options.threads);
    Pixels areas;
    const Pixels a = truth(options, loaded, 1, areas), b = truth(options, loaded, 2, areas);
    const auto mean_of = [&](auto&& value) {
        double sum = 0, area = 0;
        for (size_t i = 0; i < areas.size(); ++i) {
            sum += static_cast<double>(areas[i]) * value(i);
            area += static_cast<double>(areas[i]);
        }
        return sum / area;
    };
    const double mean = mean_of([&](size_t i) { return (brightness(a, i) + brightness(b, i)) / 2; });
    for (const double tolerance : options.tolerances) {
        std::vector<Cost> costs;
        Solved last;
        for (uint32_t k = 0; k < options.repeats; ++k) {
            last = solve(options, loaded.scene.get(), tolerance * mean * std::numbers::pi);
            costs.push_back(last.cost);
        }
        const double squared = mean_of([&](size_t i) {
            const double r = brightness(last.pixels, i);
            return (r - brightness(a, i)) * (r - brightness(b, i));
        });
        std::ostringstream called;
        called << options.name << '.' << tolerance;
        const std::string name = called.str();
        print_value(name + ".error", std::sqrt(std::max(squared, 0.0)) / mean, "of the mean", options.error_goal);
        print_value(name + ".estimate", last.info.residual / (mean * std::numbers::pi), "of the mean");
        print_value(name + ".elements", last.info.element_count, "elements");
        print_value(name + ".links", static_cast<double>(last.info.links), "links");
        print_value(name + ".seconds", median_wall(costs), "s", options.seconds_goal);
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("The true error of radiosity solutions, and their cost");
    app.add_option("scene", options.scene, "A .glb or .gltf file")->required();
    app.add_option("--name", options.name, "Of the figures")->capture_default_str();
    app.add_option("--solver", options.solver)->capture_default_str();
    app.add_option("--tolerance", options.tolerances, "Of the mean radiosity; several may be given");
    app.add_option("--samples", options.samples, "Of the paths, per pixel")->capture_default_str();
    app.add_option("--size", options.width, "Pixels along each side")->capture_default_str();
    app.add_option("--threads", options.threads, "Of everything")->check(CLI::Range(1, 1024))->capture_default_str();
    app.add_option("--repeats", options.repeats, "Medians of so many")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--error-goal", options.error_goal, "The greatest error wanted, of the mean");
    app.add_option("--seconds-goal", options.seconds_goal, "The greatest time wanted");
    CLI11_PARSE(app, argc, argv);
    options.height = options.width;
    return run("radiosity_bench", [&] { measure(options); });
}
