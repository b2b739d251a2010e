// Hundreds of lamps over a large floor with pillars, most of them too far from any place to matter there: the time that
// all lamps cost a frame by ray casting, beside what as many lamps cost as reach a place in the mean, each at the price
// of one lamp that reaches all of them. CPU seconds; medians of the repeats. Prints a line of JSON to a figure.
#include <CLI/CLI.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "bench.h"
#include "gltf_scene.h"

using namespace trp_bench;
using triptych::cli::check;

namespace {

struct Options {
    uint32_t threads = 2, repeats = 5, lamps = 500;
    double goal = kNone;
};

constexpr float kSide = 400, kLampHeight = 3, kLeastLight = 0.01f;
constexpr float kReach = 20;  // of a lamp, metres
constexpr uint32_t kWidth = 1280, kHeight = 720;

void add_floor(TrpScene* scene) {
    std::vector<float> positions;
    std::vector<uint32_t> corners, offsets = {0};
    const auto add_quad = [&](std::array<std::array<float, 3>, 4> points) {
        for (const auto& p : points) {
            corners.push_back(static_cast<uint32_t>(positions.size() / 3));
            positions.insert(positions.end(), p.begin(), p.end());
        }
        offsets.push_back(static_cast<uint32_t>(corners.size()));
    };
    add_quad({{{0, 0, 0}, {kSide, 0, 0}, {kSide, kSide, 0}, {0, kSide, 0}}});
    constexpr float kApart = 10;
    constexpr int kAcross = static_cast<int>(kSide / kApart);
    for (int i = 0; i < kAcross; ++i)
        for (int j = 0; j < kAcross; ++j) {
            const float x = kApart * (static_cast<float>(i) + 0.5f), y = kApart * (static_cast<float>(j) + 0.5f);
            const float a = x + 1, b = y + 1, h = 2;
            add_quad({{{x, y, 0}, {a, y, 0}, {a, y, h}, {x, y, h}}});
            add_quad({{{a, y, 0}, {a, b, 0}, {a, b, h}, {a, y, h}}});
            add_quad({{{a, b, 0}, {x, b, 0}, {x, b, h}, {a, b, h}}});
            add_quad({{{x, b, 0}, {x, y, 0}, {x, y, h}, {x, b, h}}});
        }
    TrpMeshDesc mesh;
    check(trp_mesh_desc_init(&mesh, sizeof mesh));
    mesh.positions = {positions.data(), positions.size() / 3, 0, TRP_FORMAT_FLOAT32};
    mesh.corner_vertices = {corners.data(), corners.size(), 0, TRP_FORMAT_UINT32};
    mesh.face_offsets = {offsets.data(), offsets.size(), 0, TRP_FORMAT_UINT32};
    TrpInstanceDesc instance;
    check(trp_instance_desc_init(&instance, sizeof instance));
    check(trp_mesh_add(scene, &mesh, &instance.mesh));
    uint32_t id = 0;
    check(trp_instance_add(scene, &instance, &id));
}

void add_lamp(TrpScene* scene, float x, float y, float reach) {
    TrpLightDesc lamp;
    check(trp_light_desc_init(&lamp, sizeof lamp));
    const float place[12] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, kLampHeight};
    lamp.type = TRP_LIGHT_POINT;
    lamp.world_from_light = place;
    std::fill_n(lamp.emission, 3, kLeastLight * std::numbers::pi_v<float> * reach * reach);  // I_L = I / (π d²)
    uint32_t id = 0;
    check(trp_light_add(scene, &lamp, &id));
}

// Seen from above at a slant, as far as the floor goes.
void add_camera(TrpScene* scene) {
    TrpCameraDesc camera;
    check(trp_camera_desc_init(&camera, sizeof camera));
    const float c = std::cos(0.9f), s = std::sin(0.9f);
    const float place[12] = {1, 0, 0, kSide / 2, 0, c, -s, -40, 0, s, c, 130};
    camera.world_from_camera = place;
    camera.clip_end = 4 * kSide;
    uint32_t id = 0;
    check(trp_camera_add(scene, &camera, &id));
    check(trp_scene_set_camera(scene, id));
}

struct Frame {
    triptych::cli::SceneHandle scene = triptych::cli::make_scene();
    triptych::cli::RenderHandle render;
    std::vector<double> cpu;

    void commit(const Options& options) {
        check(trp_scene_commit(scene.get(), options.threads));
        render = triptych::cli::make_render(scene.get(), "ray_casting");
        check(trp_render_set_film(render.get(), kWidth, kHeight, 0, 0, 0, 0));
        check(trp_render_set(render.get(), "samples", "2"));
        check(trp_render_set(render.get(), "threads", std::to_string(options.threads).c_str()));
        check(trp_render_set(render.get(), "shading.least_light", std::to_string(kLeastLight).c_str()));
        check(trp_render_add_pass(render.get(), "Position"));
        check(trp_render_add_pass(render.get(), "Depth"));
    }
};

void measure(const Options& options) {
    Frame none, one, all;
    for (Frame* frame : {&none, &one, &all}) {
        add_floor(frame->scene.get());
        add_camera(frame->scene.get());
    }
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(0, kSide);
    std::vector<std::array<float, 2>> lamps;
    for (uint32_t k = 0; k < options.lamps; ++k) {
        lamps.push_back({place(random), place(random)});
        add_lamp(all.scene.get(), lamps.back()[0], lamps.back()[1], kReach);
    }
    add_lamp(one.scene.get(), kSide / 2, kSide / 2, 10 * kSide);
    for (Frame* frame : {&none, &one, &all}) frame->commit(options);
    for (uint32_t i = 0; i < options.repeats; ++i)
        for (Frame* frame : {&none, &one, &all})
            frame->cpu.push_back(cost_of([&] { check(trp_render_run(frame->render.get(), nullptr)); }).cpu);

    std::vector<float> positions(size_t{3} * kWidth * kHeight), depth(size_t{kWidth} * kHeight);
    check(trp_render_read(all.render.get(), "Position", 0, 0, kWidth, kHeight, positions.data(), positions.size()));
    check(trp_render_read(all.render.get(), "Depth", 0, 0, kWidth, kHeight, depth.data(), depth.size()));
    uint64_t reached = 0, seen = 0;
    for (size_t i = 0; i < depth.size(); i += 97) {
        if (depth[i] > 1e9f) continue;
        ++seen;
        for (const auto& [x, y] : lamps) {
            const float dx = positions[3 * i] - x, dy = positions[3 * i + 1] - y,
                        dz = positions[3 * i + 2] - kLampHeight;
            reached += dx * dx + dy * dy + dz * dz <= kReach * kReach;
        }
    }
    const double mean = static_cast<double>(reached) / static_cast<double>(seen);
    const double without = median(none.cpu);
    print_value("lamps.reaching", mean, "lamps");
    print_against("lamps", median(all.cpu) - without, "CPU s", "as many lamps as reach a place",
                  mean * (median(one.cpu) - without), options.goal);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Hundreds of lamps");
    app.add_option("--lamps", options.lamps, "Spread over the floor")->capture_default_str();
    app.add_option("--threads", options.threads, "Of the renders")->check(CLI::Range(1, 1024))->capture_default_str();
    app.add_option("--repeats", options.repeats, "Medians of so many")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--goal", options.goal, "The greatest ratio wanted");
    CLI11_PARSE(app, argc, argv);
    return run("lamps_bench", [&] { measure(options); });
}
