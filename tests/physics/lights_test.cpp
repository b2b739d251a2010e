// Closed forms: what each kind of light leaves on a plane, with and without something in the way.
#include <random>

#include "support/abi.h"

namespace trp_test {
namespace {

constexpr float kRho = 0.6f;

// A white floor seen from above through one pixel's centre at (x, y): its radiance, and what the equation says with K_S
// 0.
class OverFloor {
  public:
    OverFloor() { scene.object(floor_square(50), scene.diffuse(kRho, kRho, kRho)); }
    // Radiance at a point of the floor, by the 256 pixels of a tiny picture: 16 samples of each are the 4096 random
    // numbers that as many samples of one pixel would get, and cost no more than 16 of those.
    double radiance(Vec at, int samples = 16, Settings more = {}) {
        scene.camera_above(1e-4f, at);
        more.emplace_back("samples", std::to_string(samples));
        more.emplace_back("film.filter_width", "0");
        return mean(render(scene, 16, 16, more));
    }
    Scene scene;
};

TEST(Lights, PointFollowsInverseSquareAndCosine) {
    OverFloor f;
    f.scene.light(TRP_LIGHT_POINT, {100, 100, 100}, translation({0, 0, 3}));
    for (const float x : {0.0f, 1.0f, 4.0f}) {
        const double d2 = 9 + x * x, expected = kRho / kPi * 100 / d2 * 3 / std::sqrt(d2);
        EXPECT_NEAR(f.radiance({x, 0, 0}, 1) / expected, 1, 1e-5) << "x = " << x;
    }
}

TEST(Lights, FalloffsAgreeAtOneMetre) {
    // Of a light's own, and of the setting, which overrides it.
    const double facing = kRho / kPi * 7;
    struct Case {
        int32_t own;
        const char* setting;
        double power;
    };
    for (const Case& c : {Case{TRP_FALLOFF_PHYSICAL, "light", 2}, Case{TRP_FALLOFF_LINEAR, "light", 1},
                          Case{TRP_FALLOFF_CONSTANT, "light", 0}, Case{TRP_FALLOFF_PHYSICAL, "none", 0},
                          Case{TRP_FALLOFF_PHYSICAL, "linear", 1}, Case{TRP_FALLOFF_CONSTANT, "quadratic", 2}})
        for (const float height : {1.0f, 2.0f, 5.0f}) {
            OverFloor f;
            f.scene.light(TRP_LIGHT_POINT, {7, 7, 7}, translation({0, 0, height}),
                          [&](TrpLightDesc& d) { d.falloff = c.own; });
            EXPECT_NEAR(
                f.radiance({0, 0, 0}, 1, {{"shading.falloff", c.setting}}) / (facing / std::pow(height, c.power)), 1,
                1e-5)
                << c.setting << " at " << height << " m";
        }
}

TEST(Lights, PointWithRadiusIsAFacingDisk) {
    OverFloor f;
    f.scene.light(TRP_LIGHT_POINT, {10, 10, 10}, translation({0, 0, 2}), [](TrpLightDesc& d) { d.radius = 1; });
    EXPECT_NEAR(f.radiance({0, 0, 0}) / (kRho / kPi * 10 / (4 + 1)), 1, 2e-3);
}

TEST(Lights, SpotFadesInItsConeAlone) {
    OverFloor f;
    const float full = 1.0f;
    f.scene.light(TRP_LIGHT_SPOT, {50, 50, 50}, translation({0, 0, 4}), [&](TrpLightDesc& d) {
        d.angle = full;
        d.blend = 0.5f;
    });
    const double edge = std::cos(full / 2.0), range = (1 - edge) * 0.5;
    for (const float x : {0.0f, 1.0f, 1.7f, 2.0f, 2.3f}) {
        const double d2 = 16 + x * x, cosine = 4 / std::sqrt(d2);
        const double t = std::clamp((cosine - edge) / range, 0.0, 1.0);
        EXPECT_NEAR(f.radiance({x, 0, 0}, 1), kRho / kPi * 50 / d2 * cosine * t * t * (3 - 2 * t), 1e-5) << "x = " << x;
    }
}

TEST(Lights, SunGivesItsIrradiance) {
    for (const float angle : {0.0f, 0.1f, 0.5f})
        for (const float slant : {0.0f, 0.6f}) {
            OverFloor f;
            f.scene.light(TRP_LIGHT_SUN, {3, 3, 3},
                          look_at({std::sin(slant), 0, std::cos(slant)}, {0, 0, 0}, {0, 1, 0}),
                          [&](TrpLightDesc& d) { d.angle = angle; });
            EXPECT_NEAR(f.radiance({0, 0, 0}) / (kRho / kPi * 3 * std::cos(slant)), 1, 1e-3) << angle << ", " << slant;
        }
}

TEST(Lights, RectangleIsItsFormFactor) {
    // A unit square at 1 m: the point form factors of a parallel square, under its centre and under its corner.
    OverFloor f;
    f.scene.light(TRP_LIGHT_AREA, {5, 5, 5}, translation({0, 0, 1}));
    EXPECT_NEAR(f.radiance({0, 0, 0}) / (kRho * 5 * 0.2394564705 * 1), 1, 2e-3);
    EXPECT_NEAR(f.radiance({0.5f, 0.5f, 0}) / (kRho * 5 * 0.1385316060), 1, 2e-3);
}

TEST(Lights, DiskIsItsFormFactor) {
    OverFloor f;
    f.scene.light(TRP_LIGHT_AREA, {5, 5, 5}, translation({0, 0, 1}), [](TrpLightDesc& d) {
        d.shape = TRP_SHAPE_ELLIPSE;
        d.size[0] = d.size[1] = 1;
    });
    EXPECT_NEAR(f.radiance({0, 0, 0}) / (kRho * 5 * 0.25 / 1.25), 1, 2e-3);  // r² / (r² + d²)
}

TEST(Lights, SpreadKeepsThePowerOfAnAreaLight) {
    // The flux through a large floor beneath a small light.
    auto flux = [](float spread) {
        Scene scene;
        scene.object(floor_square(50), scene.diffuse(1, 1, 1));
        scene.light(TRP_LIGHT_AREA, {1000, 1000, 1000}, translation({0, 0, 1}), [&](TrpLightDesc& d) {
            d.size[0] = d.size[1] = 0.05f;
            d.angle = spread;
        });
        scene.camera_above(40);
        return mean(render(scene, 200, 200, {{"samples", "16"}})) * 1600 * kPi;
    };
    const double all = 1000 * kPi * 0.05 * 0.05;
    EXPECT_NEAR(flux(static_cast<float>(kPi)) / all, 1, 0.01);
    EXPECT_NEAR(flux(static_cast<float>(kPi / 2)) / all, 1, 0.01);
}

TEST(Lights, ConstantWorldIsRadianceTimesReflectance) {
    // Irradiance πL, by the constant and by a picture of it.
    OverFloor f;
    f.scene.world({2, 1, 0.5f});
    EXPECT_NEAR(f.radiance({0, 0, 0}) / (kRho * 2), 1, 1e-3);
    const std::vector<float> pixels(8 * 4 * 3, 0.5f);
    TrpTextureDesc texture;
    check(trp_texture_desc_init(&texture, sizeof texture));
    texture.pixels = pixels.data();
    texture.width = 8, texture.height = 4, texture.channels = 3;
    uint32_t id = 0;
    check(trp_texture_add(f.scene, &texture, &id));
    f.scene.world({2, 2, 2}, [&](TrpWorldDesc& d) { d.texture = id; });
    EXPECT_NEAR(f.radiance({0, 0, 0}) / (kRho * 0.5 * 2), 1, 3e-3);
}

TEST(Lights, WorldPictureShinesFromWhereItIs) {
    // A picture whose one bright pixel lies at +X, +Y up: only walls that face it are lit, and shadows fall away from
    // it.
    std::vector<float> pixels(64 * 32 * 3, 0.0f);
    const uint32_t row = 20, column = 16;  // u = 16.5/64: direction at longitude (1/2 − u)·2π, above the horizon
    for (int k = 0; k < 3; ++k) pixels[(row * 64 + column) * 3 + static_cast<uint32_t>(k)] = 1000;
    const double longitude = (0.5 - 16.5 / 64) * 2 * kPi, latitude = (20.5 / 32 - 0.5) * kPi;
    const double solid_angle = 2 * kPi / 64 * kPi / 32 * std::cos(latitude);
    Scene scene;
    TrpTextureDesc texture;
    check(trp_texture_desc_init(&texture, sizeof texture));
    texture.pixels = pixels.data();
    texture.width = 64, texture.height = 32, texture.channels = 3;
    uint32_t id = 0;
    check(trp_texture_add(scene, &texture, &id));
    scene.world({1, 1, 1}, [&](TrpWorldDesc& d) { d.texture = id; });
    scene.object(floor_square(50), scene.diffuse(kRho, kRho, kRho));
    // A post on the side of the light shades the point; one on the far side does not.
    auto shaded = [&](double side) {
        const float x = static_cast<float>(side * std::cos(longitude)),
                    y = static_cast<float>(side * std::sin(longitude));
        const uint32_t post = scene.object(sphere({x, y, 0.5f}, 0.5f, 16));
        scene.camera_above(1e-4f);
        const double value = mean(render(scene, 1, 1, {{"samples", "1024"}}));
        check(trp_instance_remove(scene, post));
        return value;
    };
    const double open = kRho / kPi * 1000 * solid_angle * std::sin(latitude);
    EXPECT_NEAR(shaded(-1.0) / open, 1, 0.02);
    EXPECT_LT(shaded(0.8), 0.2 * open);
}

TEST(Lights, EmittingMeshIsAnAreaLight) {
    // A square of the radiance of an area light, seen from its front; from behind it shines only where it has two
    // sides.
    for (const bool two_sided : {true, false}) {
        OverFloor f;
        const uint32_t emitter = f.scene.material([&](TrpMaterialDesc& d) {
            d.emission = {{5, 5, 5}, TRP_NO_NODE};
            d.double_sided = two_sided;
        });
        const float h = 0.5f;
        f.scene.object(quad({-h, h, 1}, {h, h, 1}, {h, -h, 1}, {-h, -h, 1}), emitter);
        const double expected = kRho * 5 * 0.1385316060;
        EXPECT_NEAR(f.radiance({0.5f + 1e-3f, 0.5f + 1e-3f, 0}) / expected, 1, 5e-3);
        OverFloor up;
        up.scene.object(quad({-h, -h, 1}, {h, -h, 1}, {h, h, 1}, {-h, h, 1}),
                        up.scene.material([&](TrpMaterialDesc& d) {
                            d.emission = {{5, 5, 5}, TRP_NO_NODE};
                            d.double_sided = two_sided;
                        }));
        EXPECT_NEAR(up.radiance({0.5f + 1e-3f, 0.5f + 1e-3f, 0}) / (two_sided ? expected : 1), two_sided ? 1 : 0, 5e-3);
    }
}

TEST(Lights, AreaLightIsSeenWhereItIsToBe) {
    // From its front, with its radiance, unless something stands before it; not from behind, nor where it is not to be.
    for (const bool visible : {true, false})
        for (const int32_t shape : {TRP_SHAPE_RECTANGLE, TRP_SHAPE_ELLIPSE}) {
            Scene scene;
            scene.light(TRP_LIGHT_AREA, {3, 2, 1}, translation({0, 0, 2}), [&](TrpLightDesc& d) {
                d.shape = shape;
                d.size[0] = d.size[1] = 2;
                d.visible_camera = visible;
            });
            scene.object(quad({-1, -1, 1}, {0, -1, 1}, {0, 1, 1}, {-1, 1, 1}), scene.material([](TrpMaterialDesc& d) {
                d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
                d.emission = {{7, 7, 7}, TRP_NO_NODE};
            }));
            // From below, looking up; the picture's right is −x.
            scene.camera(look_at({0, 0, -1}, {0, 0, 2}, {0, 1, 0}), [](TrpCameraDesc& d) {
                d.type = TRP_CAMERA_ORTHOGRAPHIC;
                d.width = 4;
            });
            const Settings plain = {{"samples", "1"}, {"film.filter_width", "0"}};
            scene.commit();
            Render from_below(scene, 40, 40, plain, {"Shadow"});
            const Image below = from_below.run().read(), shadow = from_below.read("Shadow");
            const uint32_t light_x = below.at(25, 20)[0] == 7 ? 14 : 25, veil_x = 39 - light_x;
            EXPECT_FLOAT_EQ(below.at(light_x, 20)[1], visible ? 2 : 0);
            EXPECT_FLOAT_EQ(below.at(light_x, 20)[3], 1);
            EXPECT_FLOAT_EQ(shadow.at(light_x, 20)[0], 1) << "no surface is seen there";
            EXPECT_FLOAT_EQ(below.at(veil_x, 20)[1], 7);
            const uint32_t corner = light_x > 20 ? 29 : 10;
            EXPECT_FLOAT_EQ(below.at(corner, 29)[1], visible && shape == TRP_SHAPE_RECTANGLE ? 2 : 0);
            scene.camera(translation({0, 0, 5}), [](TrpCameraDesc& d) {
                d.type = TRP_CAMERA_ORTHOGRAPHIC;
                d.width = 4;
            });
            EXPECT_FLOAT_EQ(render(scene, 40, 40, plain).at(25, 20)[1], 0);
        }
}

TEST(Shadows, RectangleLightHalfCovered) {
    // A blocker in the light's own plane's half leaves half of the light: by symmetry half the radiance.
    OverFloor f;
    f.scene.light(TRP_LIGHT_AREA, {5, 5, 5}, translation({0, 0, 1}));
    f.scene.object(quad({0, -9, 0.999f}, {9, -9, 0.999f}, {9, 9, 0.999f}, {0, 9, 0.999f}));
    f.scene.camera(look_at({-2, 0, 0.5f}, {0, 0, 0}), [](TrpCameraDesc& d) { d.field_of_view = 1e-4f; });
    const double value = mean(render(f.scene, 16, 16, {{"samples", "16"}}));
    EXPECT_NEAR(value / (kRho * 5 * 0.2394564705 / 2), 1, 5e-3);
}

TEST(Shadows, OffMeansLightGoesThrough) {
    OverFloor f;
    f.scene.light(TRP_LIGHT_POINT, {100, 100, 100}, translation({0, 0, 3}));
    f.scene.object(sphere({0, 0, 1.5f}, 0.2f, 16));
    f.scene.camera(look_at({0, -2, 0.5f}, {0, 0, 0}), [](TrpCameraDesc& d) { d.field_of_view = 1e-4f; });
    EXPECT_EQ(mean(render(f.scene, 1, 1, {{"samples", "1"}})), 0);
    EXPECT_NEAR(mean(render(f.scene, 1, 1, {{"samples", "1"}, {"shadows", "off"}})) / (kRho / kPi * 100 / 9), 1, 1e-4);
}

TEST(Shadows, AlphaLetsItsShareThrough) {
    OverFloor f;
    f.scene.light(TRP_LIGHT_POINT, {100, 100, 100}, translation({0, 0, 3}));
    const uint32_t veil = f.scene.material([](TrpMaterialDesc& d) { d.alpha = {{0.25f, 0, 0}, TRP_NO_NODE}; });
    for (const float z : {1.0f, 1.5f}) f.scene.object(floor_square(1, z), veil);
    f.scene.camera(look_at({0, -3, 0.5f}, {0, 0, 0}), [](TrpCameraDesc& d) { d.field_of_view = 1e-4f; });
    EXPECT_NEAR(mean(render(f.scene, 1, 1, {{"samples", "1"}})) / (kRho / kPi * 100 / 9 * 0.75 * 0.75), 1, 1e-4);
}

TEST(Shadows, TransmissionColoursThem) {
    OverFloor f;
    f.scene.light(TRP_LIGHT_POINT, {100, 100, 100}, translation({0, 0, 3}));
    const uint32_t pane = f.scene.material([](TrpMaterialDesc& d) {
        d.transmission = {{0.25f, 0.5f, 1}, TRP_NO_NODE};
        d.alpha = {{0.8f, 0, 0}, TRP_NO_NODE};
    });
    const uint32_t clear = f.scene.material([](TrpMaterialDesc& d) { d.transmission = {{0.5f, 1, 1}, TRP_NO_NODE}; });
    f.scene.object(floor_square(1, 1), pane);
    f.scene.object(floor_square(1, 1.5f), clear);
    f.scene.camera(look_at({0, -3, 0.5f}, {0, 0, 0}), [](TrpCameraDesc& d) { d.field_of_view = 1e-4f; });
    f.scene.commit();
    for (const char* method : {"ray_casting", "ray_tracing", "phong"}) {
        const auto lit = [&](const char* shadows, int c) {
            Render render(f.scene, 1, 1,
                          {{"samples", "1"}, {"shadows", "on"}, {"shading.transparent_shadows", shadows}}, {}, method);
            return render.run().read().values[static_cast<size_t>(c)] / (kRho / kPi * 100 / 9);
        };
        const double through[3] = {0.25, 0.5, 1};
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(lit("opaque", c), 0) << method;
            EXPECT_NEAR(lit("transmission", c), (0.2 + 0.8 * through[c]) * (c ? 1 : 0.5), 1e-4) << method << ", " << c;
            EXPECT_NEAR(lit("none", c), 1, 1e-4) << method;
        }
    }
}

// Lamps that are passed over where they cannot matter are missed nowhere: dozens of narrow spots and of area lights
// that look all ways, against the sum over all of them, pixel by pixel.
TEST(Lights, NoneIsMissed) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(-1, 1);
    Scene scene;
    const uint32_t white = scene.diffuse(1, 1, 1);
    scene.object(floor_square(6), white);
    scene.object(sphere({0.5f, -0.3f, 1}, 0.9f, 48), white);
    scene.camera(look_at({3, -9, 7}, {0, 0, 0}));
    struct Lamp {
        bool is_spot;
        Vec at, down, x, y;  // unit; area: half the sides
        float cosine;
    };
    std::vector<Lamp> lamps;
    for (int k = 0; k < 60; ++k) {
        const Vec at = {5 * number(random), 5 * number(random), 2 + 1.5f * number(random)};
        const Vec to = at + Vec{number(random), number(random), number(random) - 0.5f};
        const Transform place = look_at(at, to, {0.3f, 0.2f, 0.9f});
        Lamp lamp{k % 2 == 0, at, unit(to - at), {place[0], place[4], place[8]}, {place[1], place[5], place[9]}, 0};
        const float angle = 0.3f + 0.8f * std::abs(number(random));
        lamp.cosine = std::cos(angle / 2);
        scene.light(lamp.is_spot ? TRP_LIGHT_SPOT : TRP_LIGHT_AREA, {5, 5, 5}, place, [&](TrpLightDesc& d) {
            d.radius = d.blend = 0;
            if (lamp.is_spot) d.angle = angle;
            d.size[0] = 0.6f, d.size[1] = 0.4f;
        });
        lamps.push_back(lamp);
    }
    scene.commit();
    Render render(scene, 96, 64,
                  {{"samples", "32"}, {"film.filter_width", "0"}, {"shadows", "off"}, {"shading.specular", "none"}},
                  {"Position", "Normal", "Depth"});
    const Image image = render.run().read(), positions = render.read("Position"), normals = render.read("Normal"),
                depth = render.read("Depth");
    constexpr int kCells = 8;
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 96; ++x) {
            if (*depth.at(x, y) > 1e9f) continue;
            const float *const p = positions.at(x, y), *const normal = normals.at(x, y);
            const Vec at = {p[0], p[1], p[2]}, n = {normal[0], normal[1], normal[2]};
            double spots = 0, areas = 0;
            bool at_an_edge = false;
            const auto given_by = [&](Vec from) {
                const Vec to = from - at, l = unit(to);
                return std::pair(std::max(dot(n, l), 0.0f) / (static_cast<float>(kPi) * dot(to, to)), dot(l, n));
            };
            for (const Lamp& lamp : lamps) {
                if (lamp.is_spot) {
                    const float cosine = dot(unit(at - lamp.at), lamp.down);
                    at_an_edge |= std::abs(cosine - lamp.cosine) < 1e-4f;
                    if (cosine > lamp.cosine) spots += 5 * given_by(lamp.at).first;
                    continue;
                }
                for (int i = 0; i < kCells; ++i)
                    for (int j = 0; j < kCells; ++j) {
                        const Vec from = lamp.at + lamp.x * (0.6f * ((static_cast<float>(i) + 0.5f) / kCells - 0.5f)) +
                                         lamp.y * (0.4f * ((static_cast<float>(j) + 0.5f) / kCells - 0.5f));
                        const float facing = std::max(dot(unit(at - from), lamp.down), 0.0f);
                        areas += 5 * 0.24 / (kCells * kCells) * facing * given_by(from).first;
                    }
            }
            if (at_an_edge) continue;
            ASSERT_NEAR(image.at(x, y)[0], spots + areas, 2e-3 + 0.01 * areas + 1e-4 * spots) << x << ", " << y;
        }
}

// Lamps whose light is less than what is asked for are left out, and no more is lost than that.
TEST(Lights, TheLeastLightBoundsWhatIsLost) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> number(-1, 1);
    Scene scene;
    scene.object(floor_square(20), scene.diffuse(1, 1, 1));
    scene.camera_above(40);
    constexpr int kLamps = 40;
    constexpr float kLeast = 0.02f;
    for (int k = 0; k < kLamps; ++k)
        scene.light(k % 2 ? TRP_LIGHT_POINT : TRP_LIGHT_AREA, {2, 1, 0.5f},
                    look_at({20 * number(random), 20 * number(random), 2}, {0, 0, -50}),
                    [&](TrpLightDesc& d) { d.falloff = k % 4 < 2 ? TRP_FALLOFF_PHYSICAL : TRP_FALLOFF_LINEAR; });
    scene.commit();
    const Settings settings = {{"samples", "4"}, {"shadows", "off"}};
    const Image
        whole = Render(scene, 64, 64, settings).run().read(),
        cut = Render(scene, 64, 64, with(settings, {{"shading.least_light", std::to_string(kLeast)}})).run().read();
    double lost = 0;
    for (size_t i = 0; i < whole.values.size(); ++i) {
        const float difference = whole.values[i] - cut.values[i];
        ASSERT_GE(difference, -1e-5f);
        ASSERT_LE(difference, kLamps * kLeast);
        lost += difference;
    }
    EXPECT_GT(lost, 1) << "some are left out";
}

// Errors of neighbours make up for each other: the mean of 8 x 8 pixels is better than of as many pixels whose errors
// know nothing of each other, which would leave a 64th of a pixel's variance.
TEST(Lights, NoiseIsFine) {
    Scene scene;
    scene.object(floor_square(20), scene.diffuse(0.7f, 0.7f, 0.7f));
    scene.object(quad({-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}), scene.diffuse(0, 0, 0));
    scene.light(TRP_LIGHT_AREA, {3, 3, 3}, look_at({1, 1, 4}, {0, 0, 0}),
                [](TrpLightDesc& d) { d.size[0] = d.size[1] = 3; });
    scene.camera(look_at({0, 0, 0.9f}, {0, 0, 0}, {0, 1, 0}), [](TrpCameraDesc& d) { d.field_of_view = 1.8f; });
    scene.commit();
    constexpr uint32_t kSide = 96, kBlock = 8;
    const auto picture = [&](const char* method, int samples, const char* seed) {
        return Render(scene, kSide, kSide,
                      {{"samples", std::to_string(samples)}, {"film.filter_width", "0"}, {"seed", seed}}, {}, method)
            .run()
            .read();
    };
    const Image right = picture("ray_casting", 128, "7");
    for (const char* method : {"ray_casting", "ray_tracing", "path_tracing"})
        for (const int samples : {1, 4, 16}) {
            const Image noisy = picture(method, samples, "0");
            double of_pixels = 0, of_blocks = 0;
            for (uint32_t y = 0; y < kSide; y += kBlock)
                for (uint32_t x = 0; x < kSide; x += kBlock) {
                    double sum = 0;
                    for (uint32_t k = 0; k < kBlock * kBlock; ++k) {
                        const uint32_t px = x + k % kBlock, py = y + k / kBlock;
                        const double error = noisy.at(px, py)[0] - right.at(px, py)[0];
                        of_pixels += error * error;
                        sum += error;
                    }
                    of_blocks += sum * sum;
                }
            ASSERT_GT(of_pixels, 0);
            // Sums of independent errors would have the variance of all pixels together.
            EXPECT_LT(of_blocks / of_pixels, 0.5) << method << ", " << samples << " samples";
        }
}

// On a coarse smooth ball there is light where N·L > 0, though the faces there look away from it.
TEST(Lights, ReachWhereShadingNormalsSaySo) {
    Scene scene;
    scene.object(sphere({0, 0, 0}, 1, 4), scene.diffuse(1, 1, 1));
    const Vec lamp = {4, -2, 1};
    scene.light(TRP_LIGHT_POINT, {30, 30, 30}, translation(lamp), [](TrpLightDesc& d) { d.radius = 0; });
    scene.camera(look_at({0, -5, 0}, {0, 0, 0}));
    scene.commit();
    for (const char* method : {"ray_casting", "phong"}) {
        Render render(scene, 96, 96,
                      {{"samples", "1"},
                       {"raster.samples", "1"},
                       {"film.filter_width", "0"},
                       {"shadows", "off"},
                       {"shading.specular", "none"}},
                      {"Position", "Normal", "Depth"}, method);
        const Image image = render.run().read(), positions = render.read("Position"), normals = render.read("Normal"),
                    depth = render.read("Depth");
        for (uint32_t y = 0; y < 96; ++y)
            for (uint32_t x = 0; x < 96; ++x) {
                if (*depth.at(x, y) > 1e9f) continue;
                const float *const p = positions.at(x, y), *const n = normals.at(x, y);
                const Vec to = lamp - Vec{p[0], p[1], p[2]};
                const double cosine = std::max(dot(Vec{n[0], n[1], n[2]}, unit(to)), 0.0f);
                ASSERT_NEAR(image.at(x, y)[0], cosine * 30 / kPi / dot(to, to), 1e-4)
                    << method << " " << x << ", " << y;
            }
    }
}

}  // namespace
}  // namespace trp_test
