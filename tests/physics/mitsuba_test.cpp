// Path tracing against what Mitsuba 3.9.1 makes of the same scenes by its `path` integrator. mitsuba_figures.py is its
// program, and tells how the figures are found. See tests/cli/mitsuba_test.cpp for a third scene.
#include "support/mitsuba.h"

#include "support/bodies.h"

namespace trp_test {
namespace {

void expect_mitsuba(Scene& scene, uint32_t width, uint32_t height, const Settings& settings, const BlockMeans& expected,
                    double noise_of_means) {
    scene.commit();
    std::vector<float> pictures[2];
    for (const int k : {0, 1})
        pictures[k] = Render(scene, width, height,
                             with({{"film.filter", "box"}, {"film.filter_width", "1"}, {"shading.specular", "none"}},
                                  with(settings, {{"seed", std::to_string(k)}})),
                             {}, "path_tracing")
                          .run()
                          .read()
                          .values;
    expect_block_means(pictures[0], pictures[1], width, height, expected, noise_of_means);
}

uint32_t mirror(Scene& scene, Vec specular) {
    return scene.material([&](TrpMaterialDesc& d) {
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.mirror = {{specular[0], specular[1], specular[2]}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
    });
}

constexpr BlockMeans kRoom = {{
    {0.40363, 0.146113, 0.101485},
    {0.442828, 0.328958, 0.276684},
    {0.442989, 0.373382, 0.304972},
    {0.255065, 0.292531, 0.178546},
    {0.377881, 0.0972267, 0.0569632},
    {0.550847, 0.404633, 0.28721},
    {0.280015, 0.250248, 0.17625},
    {0.203768, 0.21968, 0.124008},
    {0.351351, 0.12878, 0.0740695},
    {0.333711, 0.235956, 0.130648},
    {0.139626, 0.138305, 0.0721487},
    {0.144982, 0.13142, 0.0768212},
    {0.528515, 0.32885, 0.202887},
    {0.480054, 0.33914, 0.202361},
    {0.219483, 0.209049, 0.116752},
    {0.256861, 0.235058, 0.152525},
}};

// Glass, a pane, a curved and a flat mirror, under a lamp in the ceiling that they show. 2560 samples, max_depth 64;
// noise of the figures: 2.4e-3.
TEST(Mitsuba, SeesTheSameRoom) {
    Scene scene;
    const uint32_t clear = glass(scene, 1.5f);
    scene.object(quad({-2, -2, 0}, {0.2f, -2, 0}, {0.2f, 2, 0}, {-2, 2, 0}), scene.diffuse(0.8f, 0.7f, 0.6f));
    scene.object(quad({0.2f, -2, 0}, {2, -2, 0}, {2, 2, 0}, {0.2f, 2, 0}), mirror(scene, {0.6f, 0.6f, 0.5f}));
    scene.object(quad({-2, -2, 4}, {-2, 2, 4}, {2, 2, 4}, {2, -2, 4}), scene.diffuse(0.7f, 0.7f, 0.7f));
    scene.object(quad({-2, -2, 0}, {-2, 2, 0}, {-2, 2, 4}, {-2, -2, 4}), scene.diffuse(0.7f, 0.2f, 0.15f));
    scene.object(quad({2, -2, 0}, {2, -2, 4}, {2, 2, 4}, {2, 2, 0}), scene.diffuse(0.2f, 0.6f, 0.25f));
    scene.object(quad({-2, 2, 0}, {2, 2, 0}, {2, 2, 4}, {-2, 2, 4}), scene.diffuse(0.6f, 0.6f, 0.7f));
    scene.object(quad({-2, -2, 0}, {-2, -2, 4}, {2, -2, 4}, {2, -2, 0}), scene.diffuse(0.5f, 0.5f, 0.5f));
    scene.object(sphere({0.8f, -0.2f, 0.85f}, 0.8f, 96), clear);
    scene.object(box({-0.3f, -0.4f, 0.05f}, {-0.05f, 0.2f, 1.2f}), clear);
    scene.object(sphere({-0.9f, 0.8f, 0.75f}, 0.7f, 96), mirror(scene, {0.9f, 0.8f, 0.7f}));
    scene.object(quad({-1.7f, -0.6f, 0.05f}, {-0.5f, -0.6f, 0.05f}, {-0.5f, -0.6f, 1.6f}, {-1.7f, -0.6f, 1.6f}),
                 glass(scene, 1.5f, [](TrpMaterialDesc& d) { d.thin = 1; }));
    // Lamps are no bodies here, and black ones there.
    scene.object(quad({-1, -1, 3.9995f}, {1, -1, 3.9995f}, {1, 1, 3.9995f}, {-1, 1, 3.9995f}), scene.diffuse(0, 0, 0));
    scene.light(TRP_LIGHT_AREA, {6, 5, 4}, translation({0, 0, 3.999f}), [](TrpLightDesc& d) {
        d.size[0] = d.size[1] = 2;
        d.visible_camera = 1;
    });
    scene.camera(look_at({0.2f, -1.95f, 1.8f}, {0, 0.4f, 0.9f}), [](TrpCameraDesc& d) { d.field_of_view = 1.3f; });
    expect_mitsuba(scene, 128, 128, {{"samples", "64"}}, kRoom, 2.4e-3);
}

// Radiance of the sky from the direction d.
Vec sky(Vec d) {
    const float bright = std::exp(12 * (dot(d, unit(Vec{1, -1, 1.2f})) - 1)), high = 0.6f + 0.4f * d[2];
    return Vec{0.25f, 0.35f, 0.5f} * high + Vec{3, 2, 1} * bright;
}

uint32_t texture(Scene& scene, uint32_t width, uint32_t height, const std::vector<float>& pixels, int32_t filter) {
    TrpTextureDesc desc;
    check(trp_texture_desc_init(&desc, sizeof desc));
    desc.pixels = pixels.data();
    desc.width = width, desc.height = height, desc.channels = 3;
    desc.filter = filter;
    uint32_t id = 0;
    check(trp_texture_add(scene, &desc, &id));
    return id;
}

constexpr BlockMeans kTerrace = {{
    {0.186702, 0.219243, 0.279766},
    {0.389183, 0.327718, 0.284864},
    {0.147769, 0.212785, 0.311965},
    {0.140011, 0.196989, 0.28287},
    {0.468818, 0.398287, 0.28384},
    {0.774832, 0.523376, 0.250781},
    {0.363598, 0.43887, 0.564944},
    {0.234005, 0.328579, 0.430743},
    {0.43664, 0.316566, 0.329342},
    {0.341326, 0.280878, 0.212382},
    {0.486062, 0.458027, 0.422647},
    {0.477535, 0.427597, 0.477543},
    {0.318428, 0.439267, 0.24224},
    {0.400191, 0.317317, 0.291711},
    {0.591223, 0.5696, 0.387034},
    {0.369214, 0.367718, 0.536891},
}};

// A textured floor and smooth bodies under a sky, a sun, a spot and a point light, through a lens. Two reflections.
// 3072 samples, max_depth 4; noise of the figures: 7e-4.
TEST(Mitsuba, SeesTheSameTerrace) {
    Scene scene;
    std::vector<float> texels;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            for (const int k : {(3 * x + 5 * y) % 8, (5 * x + y) % 8, (x + 3 * y) % 8})
                texels.push_back(0.2f + 0.6f / 8 * static_cast<float>(k));
    TrpNode board;
    check(trp_node_init(&board, TRP_NODE_IMAGE));
    board.texture = texture(scene, 8, 8, texels, TRP_FILTER_NEAREST);
    scene.object(floor_square(4), scene.material([&](TrpMaterialDesc& d) {
        d.nodes = &board;
        d.node_count = 1;
        d.diffuse = {{1, 1, 1}, 0};
    }));
    scene.object(sphere({-1, 0.3f, 0.9f}, 0.9f, 48), scene.diffuse(0.8f, 0.6f, 0.3f));
    scene.object(sphere({1.2f, 1.5f, 0.7f}, 0.7f, 48), scene.diffuse(0.3f, 0.5f, 0.8f));
    scene.object(box({0.4f, -1.2f, 0}, {1.4f, -0.4f, 1.1f}), scene.diffuse(0.7f, 0.7f, 0.7f));

    constexpr uint32_t kWidth = 512, kHeight = 256;
    std::vector<float> pixels;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const double longitude = (0.5 - (x + 0.5) / kWidth) * 2 * kPi, latitude = ((y + 0.5) / kHeight - 0.5) * kPi;
            for (const float c : sky({static_cast<float>(std::cos(latitude) * std::cos(longitude)),
                                      static_cast<float>(std::cos(latitude) * std::sin(longitude)),
                                      static_cast<float>(std::sin(latitude))}))
                pixels.push_back(c);
        }
    const uint32_t picture = texture(scene, kWidth, kHeight, pixels, TRP_FILTER_SMOOTH);
    scene.world({1, 1, 1}, [&](TrpWorldDesc& d) { d.texture = picture; });
    scene.light(TRP_LIGHT_SUN, {1.5f, 1.4f, 1.2f}, look_at({-1, -2, 2}, {0, 0, 0}),
                [](TrpLightDesc& d) { d.angle = 0; });
    scene.light(TRP_LIGHT_SPOT, {20, 12, 8}, look_at({-3, -2, 4}, {-0.5f, 0, 0.3f}), [](TrpLightDesc& d) {
        d.angle = static_cast<float>(40 * kPi / 180);
        d.blend = 0;
    });
    scene.light(TRP_LIGHT_POINT, {2, 4, 6}, translation({2.5f, 0.5f, 2.2f}));
    scene.camera(look_at({0.5f, -6, 2.6f}, {0, 0, 0.7f}), [](TrpCameraDesc& d) {
        d.field_of_view = 0.8f;
        d.aperture_radius = 0.1f;
        d.focus_distance = 6;
    });
    // Mitsuba's depth counts the rays of a path, with those to the eye and to the light.
    expect_mitsuba(scene, 160, 96, {{"samples", "64"}, {"trace.depth", "2"}}, kTerrace, 7.5e-4);
}

}  // namespace
}  // namespace trp_test
