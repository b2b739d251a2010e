// A whole frame by a method that traces rays beside a bare loop over Embree that traces the very same rays, with the
// same flags, on the same number of threads. Whole frames and bare loops alternate; medians of the repeats, wall
// seconds and processor seconds. The bare loop runs against the core's own Embree scene and against a flat one; the
// ratio is taken to the faster. Prints a line of JSON to a figure.
#include <CLI/CLI.hpp>
#include <cmath>

#include "bench.h"
#include "flat_scene.h"
#include "one_light.h"
#include "replay.h"

using namespace trp_bench;
using triptych::cli::check;

namespace {

struct Options {
    std::string scene, name, picture, method = "ray_casting";
    std::array<float, 3> light{};
    bool own_lights = true;
    uint32_t width = 1920, height = 1080, samples = 4, threads = 2, repeats = 5;
    double goal = kNone;
};

TrpStatistics statistics_of(const TrpRender* render) {
    TrpStatistics statistics{};
    statistics.struct_size = sizeof statistics;
    check(trp_render_statistics(render, &statistics));
    return statistics;
}

uint64_t all_rays(const TrpStatistics& s) {
    return s.primary_rays + s.shadow_rays + s.reflection_rays + s.transmission_rays + s.gather_rays;
}

// One frame with every packet kept, checked against what the core says it traced.
Recording record_frame(TrpRender* render) {
    start_recording();
    check(trp_render_run(render, nullptr));
    Recording recording = stop_recording();
    const TrpStatistics statistics = statistics_of(render);
    const uint64_t counted = all_rays(statistics), kept = recording.rays();
    // A method that looks for solids around the eye does so before the frame, uncounted.
    constexpr uint64_t kMostBefore = 16;
    if (kept < counted || kept > counted + kMostBefore)
        throw std::runtime_error("the core counts " + std::to_string(counted) + " rays, and Embree was handed " +
                                 std::to_string(kept));
    return recording;
}

// Both scenes must be the same thing to rays; at edges rounding may tell them apart.
void compare_hits(uint64_t own, uint64_t flat) {
    const double difference = std::abs(static_cast<double>(own) - static_cast<double>(flat));
    if (difference > 1e-3 * static_cast<double>(own))
        throw std::runtime_error("the flat scene is hit by " + std::to_string(flat) + " rays, the core's by " +
                                 std::to_string(own));
}

void measure(const Options& options) {
    const auto loaded =
        options.own_lights
            ? load_complete(options.scene, options.width, options.height, options.threads)
            : load_with_one_light(options.scene, options.light, options.width, options.height, options.threads);
    const auto render = triptych::cli::make_render(loaded.scene.get(), options.method);
    check(trp_render_set_film(render.get(), options.width, options.height, 0, 0, 0, 0));
    check(trp_render_set(render.get(), "samples", std::to_string(options.samples).c_str()));
    check(trp_render_set(render.get(), "threads", std::to_string(options.threads).c_str()));
    const Recording recording = record_frame(render.get());
    if (!options.picture.empty()) check(trp_render_write(render.get(), options.picture.c_str()));
    if (recording.runs.empty()) throw std::runtime_error("the frame traces no rays");

    const FlatMeshes meshes = overheard_triangles(recording.runs[0]->packets[0].scene);
    const FlatScene flat(meshes, options.threads);
    compare_hits(replay(recording, options.threads, Loop::as_recorded, nullptr, true).hits,
                 replay(recording, options.threads, Loop::flat, flat.embree(), true).hits);

    std::vector<Cost> frames, own_loops, flat_loops;
    std::vector<double> primary, shadow, shading;
    for (uint32_t i = 0; i < options.repeats; ++i) {
        frames.push_back(cost_of([&] { check(trp_render_run(render.get(), nullptr)); }));
        const TrpStatistics statistics = statistics_of(render.get());
        primary.push_back(statistics.primary_seconds);
        shadow.push_back(statistics.shadow_seconds);
        shading.push_back(statistics.shading_seconds);
        own_loops.push_back(replay(recording, options.threads, Loop::as_recorded, nullptr).cost);
        flat_loops.push_back(replay(recording, options.threads, Loop::flat, flat.embree()).cost);
    }

    const std::string& name = options.name;
    const double wall = median_wall(frames), cpu = median_cpu(frames);
    const double own = median_wall(own_loops), of_flat = median_wall(flat_loops);
    const char* const own_peer = "bare Embree loop, the core's scene";
    const char* const flat_peer = "bare Embree loop, flat scene";
    print_against(name, wall, "s", own < of_flat ? own_peer : flat_peer, std::min(own, of_flat), options.goal);
    print_against(name + ".other_scene", wall, "s", own < of_flat ? flat_peer : own_peer, std::max(own, of_flat));
    print_against(name + ".cpu", cpu, "CPU s", own_peer, median_cpu(own_loops));
    print_against(name + ".cpu_flat", cpu, "CPU s", flat_peer, median_cpu(flat_loops));
    const double stages = median(primary) + median(shadow) + median(shading);
    print_value(name + ".primary", median(primary), "thread s");
    print_value(name + ".shadow", median(shadow), "thread s");
    print_value(name + ".shading", median(shading), "thread s");
    print_value(name + ".rest", wall * options.threads - stages, "thread s");
    const TrpStatistics statistics = statistics_of(render.get());
    const double megarays = 1e-6 * static_cast<double>(all_rays(statistics));
    print_value(name + ".rays", megarays, "Mrays");
    print_value(name + ".speed", megarays / wall, "Mrays/s");
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Frames of rays beside a bare loop over Embree");
    app.add_option("SCENE", options.scene, "A .glb or .gltf file")->required();
    app.add_option("--name", options.name, "Name of the figures")->required();
    app.add_option("--method", options.method, "The core's")->capture_default_str();
    const CLI::Option* const light =
        app.add_option("--light", options.light, "One point light in place of the scene's, X Y Z in metres");
    app.add_option("--width", options.width, "Pixels")->capture_default_str();
    app.add_option("--height", options.height, "Pixels")->capture_default_str();
    app.add_option("--samples", options.samples, "Of a pixel")->capture_default_str();
    app.add_option("--threads", options.threads, "Of the frame and of the loop")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--repeats", options.repeats, "Medians of so many")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--goal", options.goal, "The greatest ratio wanted");
    app.add_option("--picture", options.picture, "Also write the frame here, .exr or .png");
    CLI11_PARSE(app, argc, argv);
    options.own_lights = light->empty();
    return run("ray_bench", [&] { measure(options); });
}
