// Frames by the rasterizer beside Mesa's llvmpipe with the same mesh, camera, lights and shading, on the same number of
// threads. Frames alternate; medians of the repeats, wall seconds and processor seconds, the mesh already committed and
// uploaded. The pictures are compared. Prints a line of JSON to a figure.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench.h"
#include "gl_peer.h"
#include "gltf_scene.h"

using namespace trp_bench;
using triptych::cli::check;

namespace {

struct Options {
    std::string shape = "sphere", method = "phong", name;
    uint32_t side = 289, width = 1920, height = 1080, samples = 1, threads = 2, repeats = 5;
    double goal = kNone;
};

// Four squares that fill the view, from far to near.
IndexedMesh four_layers(const ClassicScene& scene) {
    IndexedMesh mesh;
    const auto& e = scene.eye;
    const float length = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    const float z[3] = {e[0] / length, e[1] / length, e[2] / length};
    const float x[3] = {1, 0, 0}, y[3] = {0, z[2], -z[1]};
    for (uint32_t layer = 0; layer < 4; ++layer) {
        const float at = -0.6f + 0.4f * static_cast<float>(layer), half = 4;
        for (const auto& [u, v] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}})
            for (int k = 0; k < 3; ++k) {
                mesh.positions.push_back(z[k] * at + x[k] * u + y[k] * v);
                mesh.normals.push_back(z[k]);
            }
        for (const uint32_t k : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(4 * layer + k);
    }
    return mesh;
}

using Scene = std::unique_ptr<TrpScene, void (*)(TrpScene*)>;

// The classic scene in the core: lights without falloff, E⊥ / π = the colour at any distance.
Scene make_scene(const ClassicScene& classic, const IndexedMesh& mesh, uint32_t threads) {
    TrpScene* made = nullptr;
    check(trp_scene_create(&made));
    Scene scene(made, trp_scene_destroy);
    TrpMaterialDesc material;
    check(trp_material_desc_init(&material, sizeof material));
    for (int k = 0; k < 3; ++k) {
        material.diffuse.value[k] = material.ambient.value[k] = classic.diffuse[k];
        material.specular.value[k] = classic.specular;
    }
    material.shininess.value[0] = classic.shininess;
    uint32_t material_id = 0, mesh_id = 0, id = 0;
    check(trp_material_add(made, &material, &material_id));
    TrpMeshDesc desc;
    check(trp_mesh_desc_init(&desc, sizeof desc));
    desc.positions = {mesh.positions.data(), mesh.positions.size() / 3, 0, TRP_FORMAT_FLOAT32};
    desc.normals = {mesh.normals.data(), mesh.normals.size() / 3, 0, TRP_FORMAT_FLOAT32};
    desc.corner_vertices = {mesh.indices.data(), mesh.indices.size(), 0, TRP_FORMAT_UINT32};
    desc.materials = &material_id;
    desc.material_count = 1;
    check(trp_mesh_add(made, &desc, &mesh_id));
    TrpInstanceDesc instance;
    check(trp_instance_desc_init(&instance, sizeof instance));
    instance.mesh = mesh_id;
    check(trp_instance_add(made, &instance, &id));
    for (size_t l = 0; l < 2; ++l) {
        TrpLightDesc light;
        check(trp_light_desc_init(&light, sizeof light));
        const auto& p = classic.light_positions[l];
        const float rows[12] = {1, 0, 0, p[0], 0, 1, 0, p[1], 0, 0, 1, p[2]};
        light.type = TRP_LIGHT_POINT;
        light.world_from_light = rows;
        for (int k = 0; k < 3; ++k) light.emission[k] = classic.light_colors[l][k] * std::numbers::pi_v<float>;
        check(trp_light_add(made, &light, &id));
    }
    TrpCameraDesc camera;
    check(trp_camera_desc_init(&camera, sizeof camera));
    const auto& e = classic.eye;
    const float length = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    const float z[3] = {e[0] / length, e[1] / length, e[2] / length};
    const float rows[12] = {1, 0, z[0], e[0], 0, z[2], z[1], e[1], 0, -z[1], z[2], e[2]};
    camera.world_from_camera = rows;
    camera.fit = TRP_FIT_VERTICAL;
    camera.field_of_view = classic.vertical_angle;
    camera.clip_start = classic.near;
    camera.clip_end = classic.far;
    check(trp_camera_add(made, &camera, &id));
    check(trp_scene_set_camera(made, id));
    check(trp_scene_commit(made, threads));
    return scene;
}

triptych::cli::RenderHandle make_render(TrpScene* scene, const ClassicScene& classic, const Options& options) {
    auto render = triptych::cli::make_render(scene, options.method);
    check(trp_render_set_film(render.get(), options.width, options.height, 0, 0, 0, 0));
    const std::string ambient = std::to_string(classic.ambient);
    for (const auto& [name, value] : std::initializer_list<std::pair<const char*, std::string>>{
             {"threads", std::to_string(options.threads)},
             {"raster.samples", std::to_string(options.samples)},
             {"film.filter", "box"},
             {"film.filter_width", "1"},
             {"shading.falloff", "none"},
             {"lines.width", "1"},
             {"lines.color", "1,1,1"},
             {"lines.paper", "0,0,0"},
             {"shading.ambient", ambient + "," + ambient + "," + ambient}})
        check(trp_render_set(render.get(), name, value.c_str()));
    return render;
}

// How the time of a frame grows with the triangles, and falls with the threads.
void measure_scaling(const Options& options) {
    const ClassicScene classic;
    const auto seconds_of = [&](TrpRender* render) {
        std::vector<Cost> costs;
        for (uint32_t i = 0; i < options.repeats + 1; ++i) {
            const Cost cost = cost_of([&] { check(trp_render_run(render, nullptr)); });
            if (i > 0) costs.push_back(cost);
        }
        return median_wall(costs);
    };
    double last = 0;
    for (const uint32_t side : {29u, 91u, 289u, 913u}) {
        const IndexedMesh mesh = cube_sphere(side);
        const Scene scene = make_scene(classic, mesh, options.threads);
        const auto render = make_render(scene.get(), classic, options);
        const double seconds = seconds_of(render.get());
        const size_t triangles = mesh.indices.size() / 3;
        print_value(options.name + "." + std::to_string(triangles), seconds, "s");
        if (side == 913) print_value(options.name + ".ten_times_1m", seconds / (10 * last), "of 10 frames", 1.2);
        if (side == 289) {
            check(trp_render_set(render.get(), "threads", "1"));
            print_value(options.name + ".two_threads", seconds / seconds_of(render.get()), "of one thread", 1 / 1.8);
        }
        last = seconds;
    }
}

void measure(const Options& options) {
    const ClassicScene classic;
    const IndexedMesh mesh = options.shape == "layers" ? four_layers(classic) : cube_sphere(options.side);
    const Scene scene = make_scene(classic, mesh, options.threads);
    const auto render = make_render(scene.get(), classic, options);
    GlPeer peer(classic, options.width, options.height, options.samples, options.threads);
    peer.set_mesh(mesh);
    const GlPeer::Drawing drawing = options.method == "wireframe"     ? GlPeer::Drawing::wireframe
                                    : options.method == "hidden_line" ? GlPeer::Drawing::hidden_line
                                                                      : GlPeer::Drawing::phong;
    std::vector<Cost> ours, theirs;
    std::vector<double> visibility, shading;
    for (uint32_t i = 0; i < options.repeats + 2; ++i) {
        const Cost mine = cost_of([&] { check(trp_render_run(render.get(), nullptr)); });
        const Cost others = cost_of([&] { peer.draw(drawing); });
        if (i < 2) continue;  // shaders are compiled, clusters made
        ours.push_back(mine);
        theirs.push_back(others);
        TrpStatistics statistics{};
        statistics.struct_size = sizeof statistics;
        check(trp_render_statistics(render.get(), &statistics));
        visibility.push_back(statistics.primary_seconds);
        shading.push_back(statistics.shading_seconds);
    }
    const std::string& name = options.name;
    print_against(name, median_wall(ours), "s", peer.renderer(), median_wall(theirs), options.goal);
    print_against(name + ".cpu", median_cpu(ours), "CPU s", "llvmpipe", median_cpu(theirs));
    print_value(name + ".visibility", median(visibility), "thread s");
    print_value(name + ".shading", median(shading), "thread s");

    if (drawing != GlPeer::Drawing::phong) return;  // the peer's lines are not smoothed: their pictures differ
    std::vector<float> pixels(size_t{4} * options.width * options.height);
    check(trp_render_read(render.get(), "Combined", 0, 0, options.width, options.height, pixels.data(), pixels.size()));
    const std::vector<uint8_t> drawn = peer.read();
    size_t coverage = 0, color = 0, covered = 0;
    for (size_t i = 0; i < drawn.size(); i += 4) {
        const bool here = pixels[i] > 0, there = drawn[i] > 0;
        covered += here || there;
        coverage += here != there;
        if (!here || !there) continue;
        for (size_t c = 0; c < 3; ++c)
            if (std::abs(std::min(pixels[i + c], 1.0f) * 255 - static_cast<float>(drawn[i + c])) > 1) {
                ++color;
                break;
            }
    }
    print_value(name + ".coverage_differs", static_cast<double>(coverage) / static_cast<double>(covered), "of pixels");
    print_value(name + ".colour_differs", static_cast<double>(color) / static_cast<double>(covered), "of pixels");
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("The rasterizer beside llvmpipe");
    app.add_option("--name", options.name, "Name of the figures")->required();
    app.add_option(
           "--shape", options.shape,
           "sphere; layers: four squares that fill the view; scaling: spheres from 10^4 to 10^7 triangles, without "
           "the peer")
        ->check(CLI::IsMember({"sphere", "layers", "scaling"}));
    app.add_option("--method", options.method, "phong, wireframe or hidden_line")
        ->check(CLI::IsMember({"phong", "wireframe", "hidden_line"}));
    app.add_option("--side", options.side, "Quads along a sixth of the sphere")->capture_default_str();
    app.add_option("--width", options.width, "Pixels")->capture_default_str();
    app.add_option("--height", options.height, "Pixels")->capture_default_str();
    app.add_option("--samples", options.samples, "Of a pixel")->capture_default_str();
    app.add_option("--threads", options.threads, "Of both sides")->check(CLI::Range(1, 32))->capture_default_str();
    app.add_option("--repeats", options.repeats, "Medians of so many")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--goal", options.goal, "The greatest ratio wanted");
    CLI11_PARSE(app, argc, argv);
    return run("raster_bench", [&] { (options.shape == "scaling" ? measure_scaling : measure)(options); });
}
