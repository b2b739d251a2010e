// Path tracing against closed forms of light that is reflected for ever, and against ray tracing where both see the
// same.
#include "support/bodies.h"

namespace trp_test {
namespace {

Image path_traced(Scene& scene, uint32_t width, uint32_t height, const Settings& settings) {
    scene.commit();
    return Render(scene, width, height, with({{"film.filter", "box"}, {"film.filter_width", "1"}}, settings), {},
                  "path_tracing")
        .run()
        .read();
}

// A point light at the centre of a sphere of reflectance ρ: the wall's irradiance is I / r², its radiance after d
// diffuse reflections ρ I / (π r²) (1 + ρ + … + ρ^d).
TEST(PathTracing, AnIntegratingSphereIsAGeometricSeries) {
    constexpr float intensity = 5;
    constexpr double radius = 2;
    Scene scene;
    scene.object(sphere({0, 0, 0}, radius, 48), scene.diffuse(0.8f, 0.5f, 0.2f));
    scene.light(TRP_LIGHT_POINT, {intensity, intensity, intensity}, translation({0, 0, 0}));
    scene.camera(look_at({0.3f, -1.1f, 0.2f}, {0, 1, 0}));
    const double reflectances[] = {0.8, 0.5, 0.2};
    for (const int depth : {0, 1, 3, 64}) {
        const Image image =
            path_traced(scene, 16, 16, {{"samples", "256"}, {"trace.diffuse_depth", std::to_string(depth)}});
        for (uint32_t c = 0; c < 3; ++c) {
            const double rho = reflectances[c];
            const double expected =
                rho * intensity / (kPi * radius * radius) * (1 - std::pow(rho, depth + 1)) / (1 - rho);
            EXPECT_NEAR(mean(image, c) / expected, 1, 4e-3) << rho << ", depth " << depth;
        }
    }
}

// In a closed room that emits E everywhere, radiance is E / (1 − ρ).
TEST(PathTracing, AClosedRoomThatGlows) {
    Scene scene;
    const uint32_t material = scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.7f, 0.4f, 0}, TRP_NO_NODE};
        d.emission = {{1, 1, 1}, TRP_NO_NODE};
    });
    // Walls that met at an edge would give each other light without a bound, which no number of samples is enough for.
    MeshData wall = inwards(sphere({0, 0, 0}, 2, 24)), ball = sphere({-0.6f, 0.3f, -0.4f}, 0.7f, 24);
    for (MeshData* faceted : {&wall, &ball}) {
        faceted->normals.clear();
        scene.object(*faceted, material);
    }
    // A lamp that gives next to nothing takes nothing either: lamps are light, and no bodies.
    scene.light(TRP_LIGHT_AREA, {1e-6f, 1e-6f, 1e-6f}, look_at({0.5f, 0, 0.7f}, {0.5f, 0, 0}, {0, 1, 0}));
    scene.camera(look_at({1.2f, -0.8f, 0.5f}, {0, 0, -0.3f}));
    const Image image = path_traced(scene, 16, 16, {{"samples", "128"}});
    EXPECT_NEAR(mean(image, 0), 1 / 0.3, 0.04);
    EXPECT_NEAR(mean(image, 1), 1 / 0.6, 0.015);
    EXPECT_NEAR(mean(image, 2), 1, 1e-6) << "black walls: only what is seen counts";
}

// Nothing is seen of bodies that lose no light in a world that is 1 everywhere, whatever they are made of.
TEST(PathTracing, AFurnaceShowsNothing) {
    Scene scene;
    scene.object(sphere({-1.5f, 0, 0}, 1, 48), glass(scene, 1.5f));
    scene.object(sphere({0.9f, 0, 0}, 1, 48), scene.diffuse(1, 1, 1));
    scene.object(floor_square(3, -1), scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.5f, 0.5f, 0.5f}, TRP_NO_NODE};
        d.mirror = {{0.5f, 0.5f, 0.5f}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
    }));
    scene.world({1, 1, 1});
    scene.camera(look_at({0, -6, 2}, {0, 0, 0}));
    const Image image = path_traced(scene, 48, 32, {{"samples", "256"}});
    for (uint32_t c = 0; c < 3; ++c) EXPECT_NEAR(mean(image, c), 1, 3e-3);
    for (uint32_t y = 0; y < 32; y += 8)
        for (uint32_t x = 0; x < 48; x += 8) {
            double sum = 0;
            for (uint32_t k = 0; k < 64; ++k) sum += image.at(x + k % 8, y + k / 8)[0];
            EXPECT_NEAR(sum / 64, 1, 0.02) << x << ", " << y;
        }
}

// Gloss in a world of 1, seen along the normal: Phong's 2 K_S / (n + 1); Blinn's ∫ K_S (N·H)^n / π dω =
// 8 K_S (1 − cos^(n + 2) 45°) / (n + 2).
TEST(PathTracing, GlossScattersLikeTheHighlight) {
    for (const char* specular : {"phong", "blinn"})
        for (const float n : {1.0f, 5.0f, 40.0f}) {
            Scene scene;
            scene.object(floor_square(5), scene.material([&](TrpMaterialDesc& d) {
                d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
                d.specular = {{0.6f, 0.3f, 0}, TRP_NO_NODE};
                d.shininess = {{n, 0, 0}, TRP_NO_NODE};
                d.mirror = {{0, 0, 0}, TRP_NO_NODE};
                d.mirror_is_specular = 0;
            }));
            scene.world({1, 1, 1});
            scene.camera_above(1);
            const Image image = path_traced(scene, 16, 16, {{"samples", "64"}, {"shading.specular", specular}});
            const double expected =
                specular[0] == 'p' ? 2 / (n + 1.0) : 8 * (1 - std::pow(0.5, (n + 2) / 2.0)) / (n + 2);
            EXPECT_NEAR(mean(image, 0), 0.6 * expected, 0.01 * expected) << specular << " " << n;
            EXPECT_NEAR(mean(image, 1), 0.3 * expected, 0.01 * expected) << specular << " " << n;
            EXPECT_EQ(mean(image, 2), 0);
        }
}

void build_mirrors_and_glass(Scene& scene) {
    scene.object(floor_square(4), scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.6f, 0.5f, 0.4f}, TRP_NO_NODE};
        d.mirror = {{0.3f, 0.3f, 0.3f}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
    }));
    scene.object(sphere({-1, 0, 1}, 0.9f, 32), glass(scene, 1.5f, [](TrpMaterialDesc& d) { d.absorption[0] = 0.3f; }));
    scene.object(sphere({1, 0.5f, 1}, 0.9f, 32), scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.2f, 0.2f, 0.2f}, TRP_NO_NODE};
        d.specular = {{0.7f, 0.6f, 0.5f}, TRP_NO_NODE};
        d.alpha = {{0.75f, 0, 0}, TRP_NO_NODE};
    }));
    scene.light(TRP_LIGHT_AREA, {4, 4, 4}, look_at({-3, -3, 4}, {0, 0, 0}));
    scene.light(TRP_LIGHT_POINT, {30, 30, 30}, translation({2, -3, 5}));
    scene.world({0.2f, 0.3f, 0.4f});
    scene.camera(look_at({0, -6, 2.5f}, {0, 0, 0.8f}));
}

// Without diffuse reflections and gloss, paths see what the trees see.
TEST(PathTracing, IsRayTracingOfMirrorsAndGlass) {
    Scene scene;
    build_mirrors_and_glass(scene);
    scene.commit();
    const Settings common = {{"samples", "64"},    {"film.filter", "box"},          {"film.filter_width", "1"},
                             {"trace.depth", "4"}, {"trace.reflection_depth", "4"}, {"trace.transmission_depth", "4"}};
    const auto picture = [&](const char* method, const Settings& more) {
        return Render(scene, 48, 32, with(common, more), {}, method).run().read();
    };
    // The difference of two pictures of a method tells its noise.
    const Settings all = {{"trace.least_weight", "0"}}, sharp = {{"trace.diffuse_depth", "0"}};
    const Image trees[] = {picture("ray_tracing", with(all, {{"seed", "1"}})),
                           picture("ray_tracing", with(all, {{"seed", "2"}}))},
                paths[] = {picture("path_tracing", with(sharp, {{"seed", "3"}})),
                           picture("path_tracing", with(sharp, {{"seed", "4"}}))};
    double greatest = 0;
    for (uint32_t c = 0; c < 3; ++c)
        for (uint32_t y = 0; y < 32; y += 8)
            for (uint32_t x = 0; x < 48; x += 8) {
                double difference = 0, noise = 0;
                for (uint32_t k = 0; k < 64; ++k)
                    for (const auto* of : {trees, paths}) {
                        const float p = of[0].at(x + k % 8, y + k / 8)[c], q = of[1].at(x + k % 8, y + k / 8)[c];
                        difference += (of == paths ? 0.5 : -0.5) * (p + q);
                        noise += (p - q) * (p - q) / 4;
                    }
                greatest = std::max(greatest, std::abs(difference) / std::sqrt(noise + 1e-12));
            }
    EXPECT_LT(greatest, 4) << "standard deviations, of 72 blocks";
    EXPECT_NEAR((mean(paths[0]) + mean(paths[1])) / (mean(trees[0]) + mean(trees[1])), 1, 2e-3);
}

// A lamp shines down on a mirror, which throws its light on a wall, as much as the lamp's mirror image below the floor
// gives it. No ray from the wall could be aimed at that light.
TEST(PathTracing, MirrorsThrowLight) {
    const auto wall_at = [](Scene& scene) {
        scene.object(quad({0, -2, 0.01f}, {0, 2, 0.01f}, {0, 2, 4}, {0, -2, 4}), scene.diffuse(0.9f, 0.9f, 0.9f));
        scene.camera(look_at({4, 0, 2}, {0, 0, 2}), [](TrpCameraDesc& d) { d.field_of_view = 0.2f; });
    };
    Scene thrown, image_lamp;
    wall_at(thrown);
    wall_at(image_lamp);
    thrown.object(floor_square(50), thrown.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.mirror = {{1, 1, 1}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
    }));
    const auto large = [](TrpLightDesc& d) { d.size[0] = d.size[1] = 2; };
    thrown.light(TRP_LIGHT_AREA, {5, 5, 5}, look_at({1.5f, 0, 3.5f}, {1.5f, 0, 0}, {0, 1, 0}), large);
    image_lamp.light(TRP_LIGHT_AREA, {5, 5, 5}, look_at({1.5f, 0, -3.5f}, {1.5f, 0, 0}, {0, 1, 0}), large);
    thrown.commit();
    Render paths(thrown, 16, 16, {{"samples", "512"}, {"trace.diffuse_depth", "1"}}, {"DiffuseIndirect"},
                 "path_tracing");
    const Image a = paths.run().read("DiffuseIndirect");
    const Image b = path_traced(image_lamp, 16, 16, {{"samples", "256"}, {"trace.diffuse_depth", "0"}});
    EXPECT_GT(mean(b), 0.02);
    EXPECT_NEAR(mean(a) / mean(b), 1, 0.02);
}

// A ceiling that glows, and below a lit floor a panel that faces down: the eye sees the floor through the panel's back,
// also in a mirror, and the ceiling gets nothing of it, neither of the lamp nor of the floor.
TEST(PathTracing, BacksLetTheEyeThroughAndNoLight) {
    Scene scene;
    const auto one_sided = [&](float reflectance, float radiance, float mirror) {
        return scene.material([&](TrpMaterialDesc& d) {
            d.diffuse = {{reflectance, reflectance, reflectance}, TRP_NO_NODE};
            d.emission = {{radiance, radiance, radiance}, TRP_NO_NODE};
            d.mirror = {{mirror, mirror, mirror}, TRP_NO_NODE};
            d.mirror_is_specular = d.double_sided = 0;
        });
    };
    const auto square = [&](float half, float z, bool up, uint32_t material) {
        const float y = up ? half : -half;
        scene.object(quad({-half, -y, z}, {half, -y, z}, {half, y, z}, {-half, y, z}), material);
    };
    square(1, 0, true, one_sided(0.5f, 0, 0));
    square(20, 0.5f, false, one_sided(0, 0, 0));
    scene.light(TRP_LIGHT_POINT, {1, 1, 1}, translation({0, 0, 0.25f}));
    const uint32_t ceiling = one_sided(0.5f, 1, 0), mirror = one_sided(0, 0, 1);
    square(1, 1, false, ceiling);
    const auto seen = [&](Vec at) {
        scene.camera(look_at({0, 0, 0.75f}, at, {0, 1, 0}), [](TrpCameraDesc& d) { d.field_of_view = 0.5f; });
        return mean(path_traced(scene, 16, 16, {{"samples", "64"}}));
    };
    EXPECT_FLOAT_EQ(static_cast<float>(seen({0, 0, 1})), 1);
    const double floor = seen({0, 0, 0});
    EXPECT_GT(floor, 1);
    square(1, 0.9f, false, mirror);
    EXPECT_GT(seen({0, 0, 1}), floor / 2) << "in the mirror";
}

// Blurred mirrors lose nothing, blur by n, and are sharp where n is great.
TEST(RoughMirrors, BlurByTheLobe) {
    // A mirror seen from straight above, through a disc that only rays from below see: of the lobe about the normal,
    // the share within the angle a that the disc covers is 1 − cos^(n + 1) a.
    const float half_angle = 0.3f, height = 2;
    for (const float n : {1.0f, 10.0f, 100.0f, 1e5f}) {
        Scene scene;
        scene.object(floor_square(5), scene.material([&](TrpMaterialDesc& d) {
            d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
            d.mirror = {{0.8f, 0.8f, 0.8f}, TRP_NO_NODE};
            d.mirror_is_specular = 0;
            d.shininess = {{n, 0, 0}, TRP_NO_NODE};
        }));
        scene.light(TRP_LIGHT_AREA, {1, 1, 1}, look_at({0, 0, height}, {0, 0, 0}, {0, 1, 0}), [&](TrpLightDesc& d) {
            d.size[0] = d.size[1] = 2 * height * std::tan(half_angle);
            d.shape = TRP_SHAPE_ELLIPSE;
        });
        scene.camera(translation({0, 0, 10}), [](TrpCameraDesc& d) { d.field_of_view = 1e-3f; });
        scene.commit();
        const double share = 1 - std::pow(std::cos(half_angle), n + 1);
        for (const char* method : {"ray_tracing", "path_tracing"}) {
            const Image image =
                Render(scene, 16, 16, {{"samples", "64"}, {"trace.rough", "on"}, {"shading.specular", "none"}}, {},
                       method)
                    .run()
                    .read();
            EXPECT_NEAR(mean(image), 0.8 * share, 2e-3) << method << " " << n;
        }
    }
}

}  // namespace
}  // namespace trp_test
