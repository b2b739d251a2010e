// From a glTF file on disk to a committed scene, beside the least that it must cost: Embree's own build of the same
// triangles as one flat mesh (medium quality, robust, the same threads), and reading the file's bytes. Wall seconds,
// medians of the repeats, which alternate; the file is in the page cache. Then the bytes that the core holds for the
// meshes. Prints a line of JSON to a figure.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "bench.h"
#include "flat_scene.h"
#include "gltf_scene.h"

using namespace trp_bench;
using triptych::cli::check;

namespace {

struct Options {
    std::string scene, name;
    uint32_t threads = 2, repeats = 5;
    double load_goal = kNone, memory_goal = kNone;
};

// Reads all bytes into fresh memory.
void read_bytes(const std::string& path) {
    const auto size = static_cast<size_t>(std::filesystem::file_size(path));
    const auto bytes = std::make_unique_for_overwrite<char[]>(size);
    const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file || std::fread(bytes.get(), 1, size, file.get()) != size)
        throw std::runtime_error(path + ": cannot be read");
}

void measure(const Options& options) {
    std::vector<double> totals, reads, builds, readers, commits, core_builds;
    FlatMeshes meshes;
    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    for (uint32_t i = 0; i < options.repeats; ++i) {
        {
            const auto start = Clock::now();
            const auto loaded = triptych::cli::load_gltf(options.scene, {}, options.threads);
            totals.push_back(seconds_since(start));
            readers.push_back(loaded.load_seconds);
            commits.push_back(loaded.commit_seconds);
            core_builds.push_back(loaded.bvh_seconds);
            check(trp_scene_info(loaded.scene.get(), &info));
            if (i == 0) meshes = overheard_triangles(overheard_top_scene());
        }
        builds.push_back(FlatScene(meshes, options.threads).build_seconds());
        reads.push_back(cost_of([&] { read_bytes(options.scene); }).wall);
    }

    const std::string& name = options.name;
    print_against(name, median(totals), "s", "2 x Embree's build + read", 2 * median(builds) + median(reads),
                  options.load_goal);
    print_against(name + ".build", median(core_builds), "s", "Embree's build, one flat mesh", median(builds));
    print_against(name + ".reader", median(readers), "s", "reading the file's bytes", median(reads));
    print_value(name + ".commit", median(commits), "s");
    print_value(name + ".first", totals.front(), "s");
    constexpr double kMegabyte = 1e6;
    print_against("memory" + name.substr(std::min(name.find('.'), name.size())),
                  static_cast<double>(info.held_bytes) / kMegabyte, "MB", "the meshes' own bytes",
                  static_cast<double>(info.mesh_bytes) / kMegabyte, options.memory_goal);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("From glTF to a committed scene");
    app.add_option("SCENE", options.scene, "A .glb file")->required();
    app.add_option("--name", options.name, "Name of the figures: load.SCENE")->required();
    app.add_option("--threads", options.threads, "Of the commit and of the peer's build")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--repeats", options.repeats, "Medians of so many")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--load-goal", options.load_goal, "The greatest ratio wanted");
    app.add_option("--memory-goal", options.memory_goal, "The greatest ratio wanted");
    CLI11_PARSE(app, argc, argv);
    return run("load_bench", [&] { measure(options); });
}
