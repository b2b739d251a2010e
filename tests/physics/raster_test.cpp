// The rasterizer against rays: the same surfaces, depths and radiance through the centres of pixels.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <random>

#include "support/abi.h"

namespace trp_test {
namespace {

// One ray, or one sample, through each pixel's centre, without shadows.
const Settings kCentres = {{"samples", "1"}, {"raster.samples", "1"}, {"film.filter_width", "0"}, {"shadows", "off"}};

constexpr uint32_t kWidth = 200, kHeight = 140;
constexpr float kFieldOfView = 1.2f;

// A camera at the origin that looks along −z.
void look_down(Scene& scene, int32_t type = TRP_CAMERA_PERSPECTIVE) {
    scene.camera(kIdentity, [&](TrpCameraDesc& d) {
        d.type = type;
        d.field_of_view = kFieldOfView;
        d.width = 6;
        d.clip_start = 0.05f;
        d.clip_end = 100;
    });
}

// Distance in pixels from a pixel's centre to the nearest edge of the mesh on the film; edges are cut at clip_start.
double distance_to_edges(const MeshData& mesh, bool perspective, double px, double py) {
    using Point = std::array<double, 3>;
    const double per_pixel = (perspective ? 2 * std::tan(kFieldOfView / 2.0) : 6.0) / kWidth;
    auto project = [&](const Point& p) {
        const double depth = perspective ? -p[2] : 1;
        return std::array<double, 2>{p[0] / depth / per_pixel + kWidth / 2.0, p[1] / depth / per_pixel + kHeight / 2.0};
    };
    double nearest = 1e30;
    for (size_t t = 0; t < mesh.corners.size(); t += 3)
        for (size_t k = 0; k < 3; ++k) {
            Point a, b;
            for (size_t c = 0; c < 3; ++c) {
                a[c] = mesh.positions[3 * mesh.corners[t + k] + c];
                b[c] = mesh.positions[3 * mesh.corners[t + (k + 1) % 3] + c];
            }
            const double start = -0.05;
            if (a[2] > start && b[2] > start) continue;
            if (a[2] > start) std::swap(a, b);
            if (b[2] > start) {
                const double s = (start - a[2]) / (b[2] - a[2]);
                for (size_t c = 0; c < 3; ++c) b[c] = a[c] + (b[c] - a[c]) * s;
            }
            const auto from = project(a), to = project(b);
            const double dx = to[0] - from[0], dy = to[1] - from[1], length2 = dx * dx + dy * dy;
            const double s =
                length2 > 0 ? std::clamp(((px - from[0]) * dx + (py - from[1]) * dy) / length2, 0.0, 1.0) : 0;
            nearest = std::min(nearest, std::hypot(from[0] + s * dx - px, from[1] + s * dy - py));
        }
    return nearest;
}

MeshData random_soup(uint32_t seed, uint32_t triangles) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    MeshData soup;
    for (uint32_t t = 0; t < triangles; ++t) {
        // Small and large ones, some behind the eye and through its plane, and slivers.
        const Vec at = {4 * unit(random), 3 * unit(random), -6 + 7 * unit(random)};
        const float size = std::exp(3 * unit(random) - 2), thin = t % 7 == 0 ? 1e-3f : 1.0f;
        for (uint32_t k = 0; k < 3; ++k) {
            const float scale = k == 2 ? size * thin : size;
            for (size_t c = 0; c < 3; ++c)
                soup.positions.push_back(k == 2 && t % 7 == 0
                                             ? soup.positions[soup.positions.size() - 3] + scale * unit(random)
                                             : at[c] + scale * unit(random));
            soup.corners.push_back(3 * t + k);
        }
    }
    return soup;
}

TEST(Raster, SeesWhatRaysSee) {
    for (const int32_t type : {TRP_CAMERA_PERSPECTIVE, TRP_CAMERA_ORTHOGRAPHIC})
        for (uint32_t seed = 0; seed < 6; ++seed) {
            Scene scene;
            const MeshData soup = random_soup(seed, 400);
            scene.object(soup);
            look_down(scene, type);
            scene.commit();
            Render rays(scene, kWidth, kHeight, kCentres, {"Depth"});
            Render raster(scene, kWidth, kHeight, kCentres, {"Depth"}, "visible_surface");
            const Image expected = rays.run().read("Depth"), seen = raster.run().read("Depth");
            uint32_t differing = 0;
            for (uint32_t y = 0; y < kHeight; ++y)
                for (uint32_t x = 0; x < kWidth; ++x) {
                    const float a = expected.at(x, y)[0], b = seen.at(x, y)[0];
                    // Rounding in the depth of what is seen edge-on, and of what the near plane cuts.
                    if (std::abs(a - b) <= 5e-4f * a || std::min(a, b) < 0.0501f) continue;
                    ++differing;
                    EXPECT_LT(distance_to_edges(soup, type == TRP_CAMERA_PERSPECTIVE, x + 0.5, y + 0.5), 1.0 / 256)
                        << "pixel " << x << ", " << y << ": depth " << b << " where rays have " << a << ", seed "
                        << seed;
                }
            EXPECT_LT(differing, 60u) << "of " << kWidth * kHeight << ", seed " << seed;
        }
}

// A floor, a sphere, another sphere, under every kind of light.
void furnish(Scene& scene) {
    const uint32_t shiny = scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.6f, 0.3f, 0.2f}, TRP_NO_NODE};
        d.specular = {{0.4f, 0.4f, 0.4f}, TRP_NO_NODE};
        d.shininess = {{40, 0, 0}, TRP_NO_NODE};
        d.emission = {{0.01f, 0.02f, 0.03f}, TRP_NO_NODE};
    });
    scene.object(floor_square(5, -1), scene.diffuse(0.5f, 0.6f, 0.7f));
    scene.object(sphere({0, 0, 0}, 1, 24), shiny);
    scene.object(sphere({0, 0, 0}, 0.5f, 12), shiny, translation({1.6f, -0.4f, -0.5f}));
    scene.light(TRP_LIGHT_POINT, {30, 25, 20}, translation({3, -3, 4}));
    scene.light(TRP_LIGHT_SUN, {0.5f, 0.6f, 0.7f}, look_at({0, 0, 0}, {-1, 1, -2}));
    scene.light(TRP_LIGHT_SPOT, {20, 20, 30}, look_at({-3, -2, 4}, {0, 0, 0}));
    scene.light(TRP_LIGHT_AREA, {3, 3, 2}, look_at({2, 3, 3}, {0, 0, 0}));
    scene.world({0.1f, 0.1f, 0.2f});
    scene.camera(look_at({2, -4, 2.5f}, {0, 0, -0.2f}));
}

TEST(Raster, PhongIsRayCastingWithoutShadows) {
    Scene scene;
    furnish(scene);
    scene.commit();
    Render rays(scene, kWidth, kHeight, kCentres, {"Depth", "Normal", "Shadow"});
    Render phong(scene, kWidth, kHeight, kCentres, {"Depth", "Normal", "Shadow"}, "phong");
    rays.run(), phong.run();
    for (const char* pass : {"Combined", "Normal", "Shadow"}) {
        const Image expected = rays.read(pass), seen = phong.read(pass), depth = rays.read("Depth"),
                    other = phong.read("Depth");
        uint32_t differing = 0;
        for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
            if (std::abs(depth.values[i] - other.values[i]) > 1e-4f * depth.values[i]) {
                ++differing;  // another surface, at an edge
                continue;
            }
            for (uint32_t c = 0; c < expected.channels; ++c) {
                const float a = expected.values[i * expected.channels + c];
                // Normals of triangles that are seen edge-on carry the rounding of their barycentrics.
                const float tolerance = std::string(pass) == "Normal" ? 1e-3f : 1e-4f;
                ASSERT_NEAR(seen.values[i * expected.channels + c], a, tolerance * std::max(1.0f, std::abs(a)))
                    << pass << ", pixel " << i % kWidth << ", " << i / kWidth;
            }
        }
        EXPECT_LT(differing, 5u);
    }
}

TEST(Raster, FlatHasOneColourToAPolygon) {
    // A twelve-sided polygon, a quad and a triangle.
    Scene scene;
    MeshData polygon;
    polygon.offsets = {0, 12};
    for (uint32_t k = 0; k < 12; ++k) {
        const float angle = static_cast<float>(2 * kPi * k / 12), radius = k % 2 ? 1.0f : 0.7f;
        polygon.positions.insert(polygon.positions.end(), {radius * std::cos(angle), radius * std::sin(angle), 0});
        polygon.corners.push_back(k);
    }
    const uint32_t material = scene.material([](TrpMaterialDesc& d) {
        d.specular = {{0.5f, 0.5f, 0.5f}, TRP_NO_NODE};
        d.shininess = {{5, 0, 0}, TRP_NO_NODE};
    });
    scene.object(polygon, material, translation({-1.2f, 0, 0}));
    scene.object(floor_square(0.8f), material, translation({1, 0, 0}));
    scene.light(TRP_LIGHT_POINT, {10, 10, 10}, translation({0, 0, 0.7f}));
    scene.camera(look_at({0, -2, 3}, {0, 0, 0}));
    scene.commit();
    const Image image = Render(scene, 160, 90, kCentres, {}, "flat").run().read();
    std::vector<std::array<float, 3>> colors;
    for (uint32_t i = 0; i < 160 * 90; ++i) {
        const float* p = &image.values[4 * i];
        const std::array<float, 3> color = {p[0], p[1], p[2]};
        if (p[3] > 0 && std::find(colors.begin(), colors.end(), color) == colors.end()) colors.push_back(color);
    }
    EXPECT_EQ(colors.size(), 2u + 1u) << "two polygons and the background";
}

// The root mean square of what Gouraud shading differs by from Phong's, on a sphere of so many rings.
double gouraud_error(int rings) {
    Scene scene;
    scene.object(sphere({0, 0, 0}, 1, rings), scene.diffuse(0.8f, 0.8f, 0.8f));
    scene.light(TRP_LIGHT_SUN, {3, 3, 3}, look_at({0, 0, 0}, {-1, -0.5f, -3}));
    scene.camera_above(1);  // its lit middle
    scene.commit();
    const Image phong = Render(scene, 64, 64, kCentres, {}, "phong").run().read(),
                gouraud = Render(scene, 64, 64, kCentres, {}, "gouraud").run().read();
    double sum = 0;
    for (size_t i = 0; i < phong.values.size(); ++i) sum += std::pow(phong.values[i] - gouraud.values[i], 2);
    return std::sqrt(sum / static_cast<double>(phong.values.size()));
}

TEST(Raster, GouraudConvergesToPhong) {
    const double coarse = gouraud_error(16), fine = gouraud_error(32), finest = gouraud_error(64);
    EXPECT_GT(coarse, 1e-4) << "there is something to converge from";
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.35);
    EXPECT_NEAR(std::log2(fine / finest), 2, 0.35);
}

TEST(Raster, GouraudIsLinearWithinATriangle) {
    Scene scene;
    const MeshData coarse = sphere({0, 0, 0}, 1, 6);
    scene.object(coarse, scene.diffuse(0.8f, 0.8f, 0.8f));
    scene.light(TRP_LIGHT_SUN, {3, 3, 3}, look_at({0, 0, 0}, {-1, -0.5f, -1}));
    scene.camera_above(2.2f);
    scene.commit();
    Render render(scene, 256, 256, kCentres, {"Normal"}, "gouraud");
    const Image image = render.run().read();
    // Second differences along a scan line vanish but where two triangles meet: few pixels of many.
    uint32_t inside = 0, bent = 0;
    for (uint32_t y = 20; y < 236; y += 4)
        for (uint32_t x = 2; x < 254; ++x) {
            if (image.at(x - 1, y)[3] < 1 || image.at(x, y)[3] < 1 || image.at(x + 1, y)[3] < 1) continue;
            const float second = image.at(x - 1, y)[0] - 2 * image.at(x, y)[0] + image.at(x + 1, y)[0];
            ++inside;
            bent += std::abs(second) > 2e-5f;
        }
    EXPECT_GT(inside, 5000u);
    EXPECT_LT(bent, inside / 8);
    EXPECT_GT(bent, 100u) << "Mach bands lie along the edges";
}

TEST(Raster, ClosedMeshesHaveNoHoles) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> value(-1, 1);
    Scene scene;
    scene.world({0, 1, 0});
    scene.object(sphere({0, 0, 0}, 1, 300), scene.material([](TrpMaterialDesc& d) {
        d.emission = {{1, 0, 0}, TRP_NO_NODE};
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
    }));
    for (int view = 0; view < 10; ++view) {
        const Vec from = unit({value(random), value(random), value(random)});
        scene.camera(look_at({3 * from[0], 3 * from[1], 3 * from[2]}, {0, 0, 0}), [](TrpCameraDesc& d) {
            d.field_of_view = 0.4f;  // within the sphere's outline
        });
        scene.commit();
        const Image image = Render(scene, 160, 160, kCentres, {}, "visible_surface").run().read();
        for (uint32_t i = 0; i < 160 * 160; ++i) ASSERT_EQ(image.values[4 * i], 1) << "view " << view;
    }
}

TEST(Raster, HolesShowWhatLiesBehindThem) {
    Scene scene;
    scene.world({0, 0, 1});
    scene.object(floor_square(1, 1), scene.veil(1, 0.5f));
    scene.object(floor_square(1, 2), scene.veil(2, 0.25f));
    scene.object(floor_square(1, 2), scene.veil(4, 0.5f));  // in the same plane
    scene.camera_above(3);
    scene.commit();
    const Settings settings = {{"raster.samples", "1"}};
    for (const char* method : {"visible_surface", "flat", "gouraud", "phong"}) {
        Render render(scene, 30, 30, settings, {"Depth"}, method);
        const Image image = render.run().read();
        // Two planes at one depth: either may be first.
        const double first = 0.25 * 2 + 0.75 * 0.5 * 4, second = 0.5 * 4 + 0.5 * 0.25 * 2, left = 0.75 * 0.5;
        const double behind = left * 0.5 * 1, red = image.at(15, 15)[0];
        EXPECT_NEAR(std::min(std::abs(red - first - behind), std::abs(red - second - behind)), 0, 1e-5) << method;
        EXPECT_NEAR(image.at(15, 15)[2], left * 0.5, 1e-5) << method;
        EXPECT_NEAR(image.at(15, 15)[3], 1, 1e-5) << method;
        EXPECT_NEAR(image.at(1, 1)[2], 1, 1e-6) << method;
        EXPECT_NEAR(render.read("Depth").at(15, 15)[0], 8, 1e-4) << method;
        EXPECT_NEAR(render.read("Depth").at(1, 1)[0], 1e10, 1e5) << method;
    }
}

TEST(Raster, TransmissionShowsWhatLiesBehind) {
    // I = I_E + K_T I_T along the straight way, through a filter before another with an alpha.
    Scene scene;
    scene.world({1, 1, 1});
    const auto filter = [&](Vec transmission, float emission, float alpha) {
        return scene.material([&](TrpMaterialDesc& d) {
            d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
            d.emission = {{emission, emission, emission}, TRP_NO_NODE};
            std::copy_n(transmission.begin(), 3, d.transmission.value);
            d.alpha = {{alpha, 0, 0}, TRP_NO_NODE};
        });
    };
    const Vec near = {0.5f, 0.25f, 0}, far = {1, 0.5f, 0.75f};
    scene.object(floor_square(1, 2), filter(near, 0.125f, 1));
    scene.object(floor_square(1, 1), filter(far, 0.25f, 0.5f));
    scene.camera_above(3);
    scene.commit();
    for (const char* method : {"ray_casting", "visible_surface", "flat", "gouraud", "phong"}) {
        const Image image = Render(scene, 30, 30, {{"raster.samples", "2"}}, {}, method).run().read();
        Settings clear = {{"film.transparent", "on"}};
        const Image cut = Render(scene, 30, 30, clear, {}, method).run().read();
        float through = 0;
        for (size_t k = 0; k < 3; ++k) {
            const float behind = 0.5f + 0.5f * far[k];  // past an alpha of a half
            EXPECT_NEAR(image.at(15, 15)[k], 0.125f + near[k] * (0.5f * 0.25f + behind), 1e-5) << method;
            EXPECT_NEAR(cut.at(15, 15)[k], 0.125f + near[k] * 0.5f * 0.25f, 1e-5) << method;
            through += near[k] * behind / 3;
        }
        EXPECT_NEAR(image.at(15, 15)[3], 1, 1e-5) << method;
        EXPECT_NEAR(cut.at(15, 15)[3], 1 - through, 1e-5) << method;
    }
}

TEST(Raster, OneSidedSurfacesAreNotSeenFromBehind) {
    Scene scene;
    scene.world({0, 0, 1});
    const uint32_t one_sided = scene.material([](TrpMaterialDesc& d) {
        d.emission = {{1, 0, 0}, TRP_NO_NODE};
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.double_sided = 0;
    });
    scene.object(quad({-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}), one_sided);  // faces down
    scene.object(floor_square(0.5f, 1), one_sided);
    scene.camera_above(3);
    scene.commit();
    for (const char* method : {"ray_casting", "visible_surface", "flat", "gouraud", "phong"}) {
        Render render(scene, 30, 30, kCentres, {"Depth"}, method);
        const Image image = render.run().read(), depth = render.read("Depth");
        EXPECT_FLOAT_EQ(image.at(15, 15)[0], 1) << method << ": the square below";
        EXPECT_NEAR(depth.at(15, 15)[0], 9, 1e-4) << method;
        EXPECT_FLOAT_EQ(image.at(7, 15)[2], 1) << method << ": the world";
        EXPECT_FLOAT_EQ(image.at(7, 15)[3], 1) << method;
        EXPECT_NEAR(depth.at(7, 15)[0], 1e10, 1e5) << method;
    }
}

TEST(Raster, EdgeSamplesCoverAsMuchAsTheShape) {
    // A square of 10.5 × 10.5 pixels: with a box filter its mean coverage is its area.
    Scene scene;
    scene.object(floor_square(0.5f * 10.5f), scene.material([](TrpMaterialDesc& d) {
        d.emission = {{1, 1, 1}, TRP_NO_NODE};
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
    }));
    scene.camera_above(32, {0.3f, 0.2f, 0});
    scene.commit();
    for (const char* samples : {"4", "8", "16", "32"}) {
        const Settings settings = {{"raster.samples", samples}, {"film.filter", "box"}, {"film.filter_width", "1"}};
        const Image image = Render(scene, 32, 32, settings, {}, "visible_surface").run().read();
        EXPECT_NEAR(mean(image) * 32 * 32, 10.5 * 10.5, 10.5 * 4 / std::stod(samples)) << samples;
    }
}

TEST(Raster, WholePixelsAreShadedAtTheirCentres) {
    // A floor that fills the picture, two triangles, under a lamp close above it: with smoothed edges or without.
    Scene scene;
    scene.object(floor_square(4), scene.diffuse(0.5f, 0.5f, 0.5f));
    scene.light(TRP_LIGHT_POINT, {1, 1, 1}, look_at({0.3f, 0.2f, 0.2f}, {0, 0, 0}));
    scene.camera_above(2);
    scene.commit();
    const Settings box = {{"film.filter", "box"}, {"film.filter_width", "1"}};
    const Image centres = Render(scene, 32, 32, with(box, {{"raster.samples", "1"}}), {}, "phong").run().read();
    for (const char* samples : {"4", "8", "32"}) {
        const Image smooth = Render(scene, 32, 32, with(box, {{"raster.samples", samples}}), {}, "phong").run().read();
        for (size_t i = 0; i < centres.values.size(); ++i)
            ASSERT_FLOAT_EQ(smooth.values[i], centres.values[i]) << samples << ", value " << i;
    }
}

TEST(Raster, DrawsAnyGeometry) {
    // Behind the eye, through its plane and in it, slivers, points, far away, and very many in one pixel.
    const std::vector<Vec> corners = {
        {0, 0, 0},      {1, 0, 0},           {0, 1, 0},          {0, 0, 3},      {1e-20f, 0, -1}, {0, 1e-20f, -1},
        {1e17f, 0, -1}, {0, -1e17f, -1},     {-1e17f, 1e17f, 5}, {0, 0, -0.05f}, {1, 1, -0.05f},  {-1, 1, -0.05f},
        {5, 5, -5},     {5.0000005f, 5, -5}, {-5, -5, -5},       {0, 0, 1e17f},  {0, 0, -1e17f},  {3, 2, -1e-30f}};
    std::mt19937 random(11);
    MeshData mesh;
    for (const Vec& p : corners) mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
    for (int t = 0; t < 3000; ++t)
        for (int k = 0; k < 3; ++k) mesh.corners.push_back(static_cast<uint32_t>(random() % corners.size()));
    const uint32_t first = static_cast<uint32_t>(corners.size());
    for (uint32_t t = 0; t < 20000; ++t) {
        const float x = 1e-5f * static_cast<float>(t % 100), y = 1e-5f * static_cast<float>(t / 100 % 100);
        mesh.positions.insert(mesh.positions.end(), {x, y, -2, x + 1e-5f, y, -2, x, y + 1e-5f, -2});
        mesh.corners.insert(mesh.corners.end(), {first + 3 * t, first + 3 * t + 1, first + 3 * t + 2});
    }
    for (const int32_t type : {TRP_CAMERA_PERSPECTIVE, TRP_CAMERA_ORTHOGRAPHIC}) {
        Scene scene;
        scene.object(mesh, scene.veil(0.1f, 0.5f));
        scene.light(TRP_LIGHT_POINT, {1, 1, 1}, kIdentity);
        look_down(scene, type);
        scene.commit();
        for (const char* method : {"visible_surface", "flat", "gouraud", "phong"}) {
            Render render(scene, 50, 40, {{"raster.samples", "1"}}, {"Normal", "Position", "UV"}, method);
            for (const float value : render.run().read().values) ASSERT_TRUE(std::isfinite(value)) << method;
        }
    }
}

TEST(Raster, ProgressCancels) {
    // Gouraud shading takes long before its first tile: 10^5 vertices with 4000 rays each.
    Scene scene;
    scene.object(sphere({0, 0, 0}, 1, 220));
    scene.light(TRP_LIGHT_AREA, {3, 3, 3}, look_at({2, 3, 3}, {0, 0, 0}));
    scene.camera(look_at({2, -4, 2.5f}, {0, 0, 0}));
    scene.commit();
    Render render(scene, 64, 64, {{"samples", "4000"}, {"shadows", "on"}}, {}, "gouraud");
    TrpCallbacks callbacks;
    check(trp_callbacks_init(&callbacks, sizeof callbacks));
    callbacks.progress = [](void*, const TrpProgress* progress) { return progress->seconds < 0.1 ? 1 : 0; };
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(trp_render_run(render, &callbacks), TRP_CANCELLED);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
}

TEST(Raster, RefusesDepthOfField) {
    Scene scene;
    scene.object(floor_square(1));
    scene.camera(look_at({0, -2, 2}, {0, 0, 0}), [](TrpCameraDesc& d) { d.aperture_radius = 0.1f; });
    scene.commit();
    Render render(scene, 8, 8, {}, {}, "phong");
    EXPECT_EQ(trp_render_run(render, nullptr), TRP_ERROR_STATE);
    EXPECT_NE(std::string(trp_error_message()).find("use ray_casting"), std::string::npos) << trp_error_message();
}

}  // namespace
}  // namespace trp_test
