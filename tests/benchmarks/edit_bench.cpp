// What an edit costs: in a scene of 1000 meshes of 1000 triangles, moving one instance or replacing one mesh, and the
// commit after it, beside the first commit of the whole scene. And how long a render takes to return after
// trp_render_cancel: the longest of several tries on a glTF scene as it is. Wall seconds; medians of the repeats.
// Prints a line of JSON to a figure.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

#include "bench.h"
#include "gltf_scene.h"

using namespace trp_bench;
using triptych::cli::check;

namespace {

struct Options {
    std::string scene;
    uint32_t threads = 2, repeats = 5, tries = 10;
    double edit_goal = kNone, cancel_goal = kNone;
};

constexpr uint32_t kAround = 25, kAcross = 20;  // 2 · 25 · 20 triangles
constexpr uint32_t kSide = 10;                  // objects along each side of the cube they stand in

struct Torus {
    std::vector<float> positions;
    std::vector<uint32_t> indices;
};

Torus make_torus(float tube) {
    Torus torus;
    for (uint32_t a = 0; a < kAround; ++a)
        for (uint32_t b = 0; b < kAcross; ++b) {
            const float u = 2 * std::numbers::pi_v<float> * static_cast<float>(a) / kAround;
            const float v = 2 * std::numbers::pi_v<float> * static_cast<float>(b) / kAcross;
            const float r = 0.3f + tube * std::cos(v);
            torus.positions.insert(torus.positions.end(), {r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
            const uint32_t a1 = (a + 1) % kAround, b1 = (b + 1) % kAcross;
            const uint32_t p = a * kAcross + b, q = a1 * kAcross + b, r1 = a1 * kAcross + b1, s = a * kAcross + b1;
            torus.indices.insert(torus.indices.end(), {p, q, r1, p, r1, s});
        }
    return torus;
}

TrpMeshDesc describe(const Torus& torus) {
    TrpMeshDesc desc;
    check(trp_mesh_desc_init(&desc, sizeof desc));
    desc.positions = {torus.positions.data(), torus.positions.size() / 3, 0, TRP_FORMAT_FLOAT32};
    desc.corner_vertices = {torus.indices.data(), torus.indices.size(), 0, TRP_FORMAT_UINT32};
    return desc;
}

std::array<float, 12> place_of(uint32_t object, float shift) {
    return {1, 0, 0, static_cast<float>(object % kSide) + shift, 0, 1, 0, static_cast<float>(object / kSide % kSide),
            0, 0, 1, static_cast<float>(object / kSide / kSide)};
}

// A scene of kSide³ objects, not yet committed.
struct ManyObjects {
    ManyObjects() : scene(triptych::cli::make_scene()) {
        const Torus torus = make_torus(0.1f);
        const TrpMeshDesc mesh = describe(torus);
        for (uint32_t object = 0; object < kSide * kSide * kSide; ++object) {
            TrpInstanceDesc instance;
            check(trp_instance_desc_init(&instance, sizeof instance));
            check(trp_mesh_add(scene.get(), &mesh, &instance.mesh));
            const auto place = place_of(object, 0);
            instance.world_from_object = place.data();
            uint32_t id = TRP_NO_ID;
            check(trp_instance_add(scene.get(), &instance, &id));
            meshes.push_back(instance.mesh);
            instances.push_back(id);
        }
    }
    triptych::cli::SceneHandle scene;
    std::vector<uint32_t> meshes, instances;
};

void measure_edits(const Options& options) {
    std::vector<double> firsts, moves, replacements;
    for (uint32_t i = 0; i < options.repeats; ++i) {
        const ManyObjects objects;
        TrpScene* scene = objects.scene.get();
        const auto commit = [&] { check(trp_scene_commit(scene, options.threads)); };
        firsts.push_back(cost_of(commit).wall);
        const uint32_t object = (i * 377 + 123) % (kSide * kSide * kSide);
        const auto place = place_of(object, 0.25f);
        moves.push_back(cost_of([&] {
                            check(trp_instance_move(scene, objects.instances[object], place.data(), 1));
                            commit();
                        }).wall);
        const Torus torus = make_torus(0.15f);
        const TrpMeshDesc mesh = describe(torus);
        replacements.push_back(cost_of([&] {
                                   check(trp_mesh_replace(scene, objects.meshes[object], &mesh));
                                   commit();
                               }).wall);
    }
    const double first = median(firsts);
    print_against("edit.move", median(moves), "s", "first commit, 1000 objects", first, options.edit_goal);
    print_against("edit.replace", median(replacements), "s", "first commit, 1000 objects", first, options.edit_goal);
}

// Seconds from trp_render_cancel to the return of trp_render_run, `delay` seconds after it started.
double cancel_after(TrpRender* render, double delay) {
    Clock::time_point returned;
    TrpStatus status = TRP_OK;
    std::thread runner([&] {
        status = trp_render_run(render, nullptr);
        returned = Clock::now();
    });
    std::this_thread::sleep_for(std::chrono::duration<double>(delay));
    const auto asked = Clock::now();
    const TrpStatus asking = trp_render_cancel(render);
    runner.join();
    check(asking);
    if (status != TRP_CANCELLED) throw std::runtime_error("the render ended before it was cancelled");
    return std::chrono::duration<double>(returned - asked).count();
}

void measure_cancel(const Options& options) {
    const auto loaded = triptych::cli::load_gltf(options.scene, {}, options.threads);
    const auto render = triptych::cli::make_render(loaded.scene.get(), "ray_casting");
    check(trp_render_set_film(render.get(), 1920, 1080, 0, 0, 0, 0));
    check(trp_render_set(render.get(), "samples", "65536"));
    check(trp_render_set(render.get(), "threads", std::to_string(options.threads).c_str()));
    double longest = 0;
    for (uint32_t i = 0; i < options.tries; ++i)
        longest = std::max(longest, cancel_after(render.get(), 0.05 + 0.037 * i));
    print_value("cancel", longest, "s", options.cancel_goal);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Edits and cancelling");
    app.add_option("SCENE", options.scene, "The .glb file to be rendered and cancelled; without it only edits");
    app.add_option("--threads", options.threads, "Of commits and renders")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--repeats", options.repeats, "Medians of so many")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--edit-goal", options.edit_goal, "The greatest ratio wanted");
    app.add_option("--cancel-goal", options.cancel_goal, "The longest wait wanted, seconds");
    CLI11_PARSE(app, argc, argv);
    return run("edit_bench", [&] {
        measure_edits(options);
        if (!options.scene.empty()) measure_cancel(options);
    });
}
