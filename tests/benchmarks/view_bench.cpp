// Pictures of a radiosity solution beside the rasterizer's Gouraud shading of the same mesh: the solution's elements as
// the faces of one mesh, with its vertices and their normals, lit by one point light without shadows. Both committed
// and solved before. Frames alternate; processor seconds, medians of the repeats. Prints a line of JSON to a figure.
#include <CLI/CLI.hpp>

#include "bench.h"
#include "one_light.h"

using namespace trp_bench;
using triptych::cli::check;

namespace {

struct Options {
    std::string scene, name = "radiosity.view";
    double element_size = 0.0045, goal = kNone;
    uint32_t width = 1920, height = 1080, threads = 2, repeats = 5;
};

TrpRadiosityInfo info_of(TrpRadiosity* solution) {
    TrpRadiosityInfo info{};
    info.struct_size = sizeof info;
    check(trp_radiosity_info(solution, &info));
    return info;
}

triptych::cli::RadiosityHandle solve(const Options& options, TrpScene* scene) {
    TrpRadiosity* made = nullptr;
    check(trp_radiosity_create(scene, &made));
    triptych::cli::RadiosityHandle solution(made);
    check(trp_radiosity_set(made, "threads", std::to_string(options.threads).c_str()));
    check(trp_radiosity_set(made, "radiosity.solver", "progressive"));
    check(trp_radiosity_set(made, "radiosity.element_size", std::to_string(options.element_size).c_str()));
    check(trp_radiosity_step(made, 1, nullptr));
    return solution;
}

std::vector<float> read(TrpRadiosity* solution, const char* values, size_t count) {
    std::vector<float> out(3 * count);
    check(trp_radiosity_read(solution, values, out.data(), out.size()));
    return out;
}

// Both scenes are seen by the same camera, where the file's stands.
void set_camera(TrpScene* scene, const triptych::cli::LoadedScene& loaded, uint32_t threads) {
    TrpCameraDesc camera;
    check(trp_camera_desc_init(&camera, sizeof camera));
    camera.world_from_camera = loaded.world_from_camera.data();
    uint32_t id = 0;
    check(trp_camera_add(scene, &camera, &id));
    check(trp_scene_set_camera(scene, id));
    check(trp_scene_commit(scene, threads));
}

// The elements as a scene of their own.
triptych::cli::SceneHandle scene_of_elements(const Options& options, TrpRadiosity* solution,
                                             const triptych::cli::LoadedScene& from) {
    const TrpRadiosityInfo info = info_of(solution);
    std::vector<uint32_t> offsets(info.element_count + 1), corners(info.corner_count);
    check(trp_radiosity_polygons(solution, offsets.data(), offsets.size(), corners.data(), corners.size()));
    const std::vector<float> positions = read(solution, "vertex_position", info.vertex_count),
                             normals = read(solution, "vertex_normal", info.vertex_count);
    auto scene = triptych::cli::make_scene();
    TrpMeshDesc mesh;
    check(trp_mesh_desc_init(&mesh, sizeof mesh));
    mesh.positions = {positions.data(), info.vertex_count, 0, TRP_FORMAT_FLOAT32};
    mesh.normals = {normals.data(), info.vertex_count, 0, TRP_FORMAT_FLOAT32};
    mesh.face_offsets = {offsets.data(), offsets.size(), 0, TRP_FORMAT_UINT32};
    mesh.corner_vertices = {corners.data(), corners.size(), 0, TRP_FORMAT_UINT32};
    uint32_t id = 0;
    check(trp_mesh_add(scene.get(), &mesh, &id));
    TrpInstanceDesc instance;
    check(trp_instance_desc_init(&instance, sizeof instance));
    instance.mesh = id;
    check(trp_instance_add(scene.get(), &instance, &id));
    TrpLightDesc light;
    check(trp_light_desc_init(&light, sizeof light));
    light.type = TRP_LIGHT_POINT;
    light.world_from_light = from.world_from_camera.data();
    check(trp_light_add(scene.get(), &light, &id));
    set_camera(scene.get(), from, options.threads);
    return scene;
}

triptych::cli::RenderHandle make_render(const Options& options, TrpScene* scene, const char* method) {
    auto render = triptych::cli::make_render(scene, method);
    check(trp_render_set_film(render.get(), options.width, options.height, 0, 0, 0, 0));
    check(trp_render_set(render.get(), "threads", std::to_string(options.threads).c_str()));
    check(trp_render_set(render.get(), "raster.samples", "1"));
    return render;
}

void measure(const Options& options) {
    const auto loaded = load_complete(options.scene, options.width, options.height, options.threads);
    set_camera(loaded.scene.get(), loaded, options.threads);
    const auto solution = solve(options, loaded.scene.get());
    const auto elements = scene_of_elements(options, solution.get(), loaded);
    const auto view = make_render(options, loaded.scene.get(), "radiosity"),
               gouraud = make_render(options, elements.get(), "gouraud");
    check(trp_render_set_radiosity(view.get(), solution.get()));
    std::vector<Cost> views, gourauds;
    for (uint32_t k = 0; k < options.repeats; ++k) {
        views.push_back(cost_of([&] { check(trp_render_run(view.get(), nullptr)); }));
        gourauds.push_back(cost_of([&] { check(trp_render_run(gouraud.get(), nullptr)); }));
    }
    const std::string& name = options.name;
    const char* const peer = "Gouraud shading of the elements";
    print_against(name, 1e3 * median_cpu(views), "CPU ms", peer, 1e3 * median_cpu(gourauds), options.goal);
    print_against(name + ".wall", 1e3 * median_wall(views), "ms", peer, 1e3 * median_wall(gourauds));
    print_value(name + ".elements", info_of(solution.get()).element_count, "elements");
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Views of a radiosity solution beside Gouraud shading");
    app.add_option("SCENE", options.scene, "A .glb or .gltf file")->required();
    app.add_option("--name", options.name, "Of the figures")->capture_default_str();
    app.add_option("--element-size", options.element_size, "Metres")->capture_default_str();
    app.add_option("--width", options.width, "Pixels")->capture_default_str();
    app.add_option("--height", options.height, "Pixels")->capture_default_str();
    app.add_option("--threads", options.threads, "Of both")->check(CLI::Range(1, 1024))->capture_default_str();
    app.add_option("--repeats", options.repeats, "Medians of so many")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--goal", options.goal, "The greatest ratio wanted");
    CLI11_PARSE(app, argc, argv);
    return run("view_bench", [&] { measure(options); });
}
