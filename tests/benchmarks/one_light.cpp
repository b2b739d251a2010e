#include "one_light.h"

#include <algorithm>

#include "framing.h"
#include "interpose.h"

namespace trp_bench {
namespace {

bool g_darken = false;  // what the reader adds gives no light

float squared_distance(const float* rows, const std::array<float, 3>& point) {
    float sum = 0;
    for (size_t k = 0; k < 3; ++k) sum += (rows[4 * k + 3] - point[k]) * (rows[4 * k + 3] - point[k]);
    return sum;
}

}  // namespace

triptych::cli::LoadedScene load_complete(const std::string& path, uint32_t film_width, uint32_t film_height,
                                         uint32_t threads) {
    triptych::cli::LoadedScene loaded = triptych::cli::load_gltf(path, {}, threads);
    triptych::cli::complete_scene(loaded, film_width, film_height, threads);
    return loaded;
}

triptych::cli::LoadedScene load_with_one_light(const std::string& path, const std::array<float, 3>& light,
                                               uint32_t film_width, uint32_t film_height, uint32_t threads) {
    using triptych::cli::check;
    g_darken = true;
    triptych::cli::LoadedScene loaded = triptych::cli::load_gltf(path, {}, threads);
    loaded.needs_light = false;
    triptych::cli::complete_scene(loaded, film_width, film_height, threads);
    g_darken = false;

    TrpLightDesc desc;
    check(trp_light_desc_init(&desc, sizeof desc));
    const float world_from_light[12] = {1, 0, 0, light[0], 0, 1, 0, light[1], 0, 0, 1, light[2]};
    desc.type = TRP_LIGHT_POINT;
    desc.world_from_light = world_from_light;
    // As bright as to be seen in a picture, whatever the scene's size.
    std::fill_n(desc.emission, 3, 2 * squared_distance(loaded.world_from_camera.data(), light));
    uint32_t id = TRP_NO_ID;
    check(trp_light_add(loaded.scene.get(), &desc, &id));
    triptych::cli::commit(loaded, threads);
    return loaded;
}

}  // namespace trp_bench

// The functions that the reader calls in the core's place.

using trp_bench::g_darken;
using trp_bench::next_definition;

TrpStatus trp_light_add(TrpScene* scene, const TrpLightDesc* desc, uint32_t* id) {
    static const auto real = next_definition<decltype(trp_light_add)>("trp_light_add");
    if (!g_darken) return real(scene, desc, id);
    *id = TRP_NO_ID;
    return TRP_OK;
}

TrpStatus trp_material_add(TrpScene* scene, const TrpMaterialDesc* desc, uint32_t* id) {
    static const auto real = next_definition<decltype(trp_material_add)>("trp_material_add");
    TrpMaterialDesc dark = *desc;
    if (g_darken) dark.emission = {{0, 0, 0}, TRP_NO_NODE};
    return real(scene, &dark, id);
}

TrpStatus trp_scene_set_world(TrpScene* scene, const TrpWorldDesc* desc) {
    static const auto real = next_definition<decltype(trp_scene_set_world)>("trp_scene_set_world");
    return g_darken ? TRP_OK : real(scene, desc);
}
