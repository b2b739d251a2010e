// Steps of progressive refinement beside a bare loop over Embree that traces the very same rays: the shot of one patch
// at all elements of a scene, for each kind of form factors that traces rays. Two solutions advance together, one on
// the clock and one recorded. Processor seconds; medians of the repeats. Prints a line of JSON to a figure.
#include <CLI/CLI.hpp>

#include "bench.h"
#include "one_light.h"
#include "replay.h"

using namespace trp_bench;
using triptych::cli::check;

namespace {

struct Options {
    std::string scene, name = "radiosity.shot";
    std::vector<std::string> kinds = {"analytic", "hemisphere"};
    double element_size = 0.0045, goal = kNone;
    uint32_t rays = 1u << 18, threads = 2, repeats = 5;
};

TrpRadiosityInfo info_of(TrpRadiosity* solution) {
    TrpRadiosityInfo info{};
    info.struct_size = sizeof info;
    check(trp_radiosity_info(solution, &info));
    return info;
}

triptych::cli::RadiosityHandle make_solution(const Options& options, TrpScene* scene, const std::string& kind) {
    TrpRadiosity* made = nullptr;
    check(trp_radiosity_create(scene, &made));
    triptych::cli::RadiosityHandle solution(made);
    for (const auto& [name, value] : std::initializer_list<std::pair<const char*, std::string>>{
             {"threads", std::to_string(options.threads)},
             {"radiosity.solver", "progressive"},
             {"radiosity.form_factors", kind},
             {"radiosity.element_size", std::to_string(options.element_size)},
             {"radiosity.rays", std::to_string(options.rays)}})
        check(trp_radiosity_set(made, name, value.c_str()));
    check(trp_radiosity_step(made, 1, nullptr));  // finds the patches besides
    return solution;
}

void measure(const Options& options, TrpScene* scene, const std::string& kind) {
    const auto timed = make_solution(options, scene, kind), recorded = make_solution(options, scene, kind);
    std::vector<Cost> steps, loops;
    std::vector<double> rays;
    for (uint32_t k = 0; k < options.repeats; ++k) {
        steps.push_back(cost_of([&] { check(trp_radiosity_step(timed.get(), 1, nullptr)); }));
        const uint64_t before = info_of(recorded.get()).rays;
        start_recording();
        check(trp_radiosity_step(recorded.get(), 1, nullptr));
        const Recording recording = stop_recording();
        const uint64_t counted = info_of(recorded.get()).rays - before;
        if (recording.rays() != counted)
            throw std::runtime_error("the core counts " + std::to_string(counted) + " rays, and Embree was handed " +
                                     std::to_string(recording.rays()));
        rays.push_back(1e-6 * static_cast<double>(counted));
        loops.push_back(replay(recording, options.threads, Loop::as_recorded, nullptr).cost);
    }
    const std::string name = options.name + '.' + kind;
    print_against(name, 1e3 * median_cpu(steps), "CPU ms", "bare Embree loop, the core's scene",
                  1e3 * median_cpu(loops), options.goal);
    print_value(name + ".rays", median(rays), "Mrays");
    print_value(name + ".elements", info_of(timed.get()).element_count, "elements");
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Shots of progressive radiosity beside a bare loop over Embree");
    app.add_option("SCENE", options.scene, "A .glb or .gltf file")->required();
    app.add_option("--name", options.name, "Of the figures")->capture_default_str();
    app.add_option("--kind", options.kinds, "Of the form factors; several may be given")->capture_default_str();
    app.add_option("--element-size", options.element_size, "Metres")->capture_default_str();
    app.add_option("--rays", options.rays, "Of a shot into the hemisphere")->capture_default_str();
    app.add_option("--threads", options.threads, "Of the step and of the loop")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--repeats", options.repeats, "Medians of so many")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--goal", options.goal, "The greatest ratio wanted");
    CLI11_PARSE(app, argc, argv);
    return run("shot_bench", [&] {
        const auto loaded = load_complete(options.scene, 960, 540, options.threads);
        for (const std::string& kind : options.kinds) measure(options, loaded.scene.get(), kind);
    });
}
