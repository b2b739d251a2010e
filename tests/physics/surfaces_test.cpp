// Closed forms of surfaces and cameras: highlights, ambient light, normals, alpha, passes, depth of field.
#include <algorithm>

#include "support/abi.h"

namespace trp_test {
namespace {

TEST(Equation, PhongAndBlinnHighlights) {
    // One point light over a floor; the viewer's direction sets V·R.
    const Vec light = {1, 0.5f, 2};
    for (const char* specular : {"none", "phong", "blinn"})
        for (const float n : {1.0f, 12.0f, 150.0f})
            for (const Vec& eye : {Vec{-1, -0.5f, 2}, Vec{-1.2f, -0.3f, 2}, Vec{0.2f, 1, 3}}) {
                Scene scene;
                scene.object(floor_square(5), scene.material([&](TrpMaterialDesc& d) {
                    d.diffuse = {{0.3f, 0.3f, 0.3f}, TRP_NO_NODE};
                    d.specular = {{0.5f, 0.5f, 0.5f}, TRP_NO_NODE};
                    d.shininess = {{n, 0, 0}, TRP_NO_NODE};
                }));
                scene.light(TRP_LIGHT_POINT, {40, 40, 40}, translation(light));
                scene.camera(look_at(eye, {0, 0, 0}), [](TrpCameraDesc& d) { d.field_of_view = 1e-4f; });
                const double value = mean(render(scene, 1, 1, {{"samples", "1"}, {"shading.specular", specular}}));
                const Vec l = unit(light), v = unit(eye), r = {-l[0], -l[1], l[2]}, h = unit(l + v);
                const double light_i = 40 / dot(light, light) / kPi;
                const double cosine = specular[0] == 'p' ? std::max(dot(v, r), 0.0f) : h[2];
                const double shine = specular[0] == 'n' ? 0 : 0.5 * std::pow(cosine, n);
                EXPECT_NEAR(value / ((0.3 * l[2] + shine) * light_i), 1, 2e-3) << specular << ", n = " << n;
            }
}

TEST(Equation, EmissionAndAmbient) {
    Scene scene;
    scene.object(floor_square(5), scene.material([](TrpMaterialDesc& d) {
        d.emission = {{0.5f, 0.25f, 0}, TRP_NO_NODE};
        d.ambient = {{0.1f, 0.2f, 0.4f}, TRP_NO_NODE};
        d.ambient_is_diffuse = 0;
    }));
    scene.camera_above(1);
    const Image image = render(scene, 4, 4, {{"samples", "1"}, {"shading.ambient", "2, 3, 4"}});
    EXPECT_NEAR(image.at(1, 1)[0], 0.5 + 0.1 * 2, 1e-6);
    EXPECT_NEAR(image.at(1, 1)[1], 0.25 + 0.2 * 3, 1e-6);
    EXPECT_NEAR(image.at(1, 1)[2], 0.4 * 4, 1e-6);
}

TEST(Normals, SphereOfFacesWithItsNormalsIsASphere) {
    // N·L of a smooth sphere under a sun from above, where the mesh has no normals of its own but smooth faces.
    MeshData ball = sphere({0, 0, 0}, 1, 96);
    ball.normals.clear();
    ball.smooth.assign(ball.offsets.size() - 1, 1);
    Scene scene;
    scene.object(ball, scene.diffuse(1, 1, 1));
    scene.light(TRP_LIGHT_SUN, {1, 1, 1}, kIdentity);
    scene.camera_above(2.2f);
    const Image image = render(scene, 110, 110, {{"samples", "1"}, {"film.filter_width", "0"}});
    for (int step = 0; step < 50; ++step) {
        const double x = (step + 0.5) * 0.02;
        if (x > 0.95) continue;
        EXPECT_NEAR(image.at(static_cast<uint32_t>(55 + step), 55)[0] * kPi, std::sqrt(1 - x * x - 1e-4), 2e-3) << x;
    }
}

TEST(Normals, SharpEdgesPartAverages) {
    // A box whose faces are smooth and whose edges are all sharp is flat.
    MeshData box;
    box.positions = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
    box.offsets = {0, 4, 8, 12, 16, 20, 24};
    box.corners = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    box.smooth.assign(6, 1);
    const std::vector<uint32_t> edges = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4, 0, 4, 1, 5, 2, 6, 3, 7};
    for (const bool sharp : {true, false}) {
        const std::vector<uint8_t> flags(12, sharp ? TRP_EDGE_SHARP : 0);
        Scene scene;
        scene.instance(scene.mesh(box, [&](TrpMeshDesc& d) {
            d.edges = indices(edges, 2);
            d.edge_flags = {flags.data(), flags.size(), 0, TRP_FORMAT_UINT8};
        }));
        scene.camera_above(2);
        scene.commit();
        Render r(scene, 8, 8, {{"samples", "1"}, {"film.filter_width", "0"}}, {"Normal"});
        const Image normal = r.run().read("Normal");
        EXPECT_EQ(normal.at(0, 0)[2] > 0.999f, sharp);
        EXPECT_NEAR(normal.at(3, 3)[2], 1, 0.1);
    }
}

TEST(Normals, MirroredInstancesFaceOutwards) {
    // The Normal pass of a ball under a transform that mirrors, baked and instanced, and of one-sided material.
    for (const int copies : {1, 2}) {
        Scene scene;
        MeshData ball = sphere({0, 0, 0}, 1, 48);
        ball.materials = {scene.material([](TrpMaterialDesc& d) { d.double_sided = 0; })};
        const uint32_t mesh = scene.mesh(ball);
        for (int i = 0; i < copies; ++i)
            scene.instance(mesh, {-1, 0, 0, 10.0f * static_cast<float>(i), 0, 1, 0, 0, 0, 0, 1, 0});
        scene.camera_above(2.2f);
        scene.commit();
        Render r(scene, 22, 22, {{"samples", "1"}, {"film.filter_width", "0"}}, {"Normal", "Depth"});
        const Image normal = r.run().read("Normal"), depth = r.read("Depth");
        EXPECT_NEAR(depth.at(11, 11)[0], 9, 0.01);
        EXPECT_NEAR(normal.at(18, 11)[0], 0.75, 0.01);
        EXPECT_GT(normal.at(18, 11)[2], 0);
    }
}

TEST(Alpha, PicturesAreLayered) {
    Scene scene;
    scene.world({0, 0, 1});
    scene.object(floor_square(1, 1), scene.veil(1, 0.5f));
    scene.object(floor_square(1, 2), scene.veil(2, 0.25f));
    scene.camera_above(1);
    Image image = render(scene, 2, 2, {{"samples", "1"}});
    EXPECT_NEAR(image.at(0, 0)[0], 0.25 * 2 + 0.75 * 0.5 * 1, 1e-5);
    EXPECT_NEAR(image.at(0, 0)[2], 0.75 * 0.5, 1e-5);
    EXPECT_NEAR(image.at(0, 0)[3], 1, 1e-5);
    image = render(scene, 2, 2, {{"samples", "1"}, {"film.transparent", "on"}});
    EXPECT_NEAR(image.at(0, 0)[2], 0, 1e-6);
    EXPECT_NEAR(image.at(0, 0)[3], 1 - 0.75 * 0.5, 1e-5);
}

TEST(Passes, SayWhatIsSeen) {
    Scene scene;
    MeshData floor = floor_square(1, 2);
    floor.materials = {scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.1f, 0.2f, 0.3f}, TRP_NO_NODE};
        d.emission = {{4, 5, 6}, TRP_NO_NODE};
        d.index = 9;
    })};
    scene.instance(scene.mesh(floor), kIdentity, [](TrpInstanceDesc& d) { d.index = 7; });
    scene.camera_above(4);  // at height 10
    scene.commit();
    Render r(
        scene, 8, 8, {{"samples", "4"}},
        {"Depth", "Position", "Normal", "UV", "Albedo", "Emission", "IndexOB", "IndexMA", "Shadow", "SampleCount"});
    r.run();
    EXPECT_NEAR(r.read("Depth").at(4, 4)[0], 8, 1e-5);
    EXPECT_NEAR(r.read("Depth").at(0, 0)[0], 1e10, 1e5);
    const Image position = r.read("Position"), uv = r.read("UV");
    EXPECT_NEAR(position.at(4, 4)[2], 2, 1e-6);
    EXPECT_NEAR(position.at(4, 4)[0], 0.25, 0.76);
    EXPECT_NEAR(uv.at(4, 4)[0], (position.at(4, 4)[0] + 1) / 2, 1e-5);
    EXPECT_NEAR(uv.at(4, 4)[1], (position.at(4, 4)[1] + 1) / 2, 1e-5);
    EXPECT_NEAR(r.read("Normal").at(4, 4)[2], 1, 1e-6);
    EXPECT_NEAR(r.read("Albedo").at(4, 4)[1], 0.2, 1e-6);
    EXPECT_NEAR(r.read("Emission").at(4, 4)[2], 6, 1e-5);
    EXPECT_EQ(r.read("IndexOB").at(4, 4)[0], 7);
    EXPECT_EQ(r.read("IndexMA").at(4, 4)[0], 9);
    EXPECT_EQ(r.read("SampleCount").at(4, 4)[0], 4);
    EXPECT_NEAR(r.read("Shadow").at(4, 4)[0], 1, 1e-6);
}

TEST(Camera, FramesWhatItsAnglesSay) {
    // A wall at 10 m whose half width is 10 tan(fov/2) fills the fitted side exactly: edges lie on the picture's
    // border.
    for (const int32_t fit : {TRP_FIT_AUTO, TRP_FIT_HORIZONTAL, TRP_FIT_VERTICAL}) {
        const float fov = 0.8f, half = 10 * std::tan(fov / 2);
        Scene scene;
        scene.world({0, 0, 0});
        scene.object(floor_square(half), scene.material([](TrpMaterialDesc& d) {
            d.emission = {{1, 1, 1}, TRP_NO_NODE};
        }));
        scene.camera(translation({0, 0, 10}), [&](TrpCameraDesc& d) {
            d.fit = fit;
            d.field_of_view = fov;
            d.shift[0] = 0.25f;
        });
        // Landscape, 40 × 20: shifted by a quarter of the fitted side, 10 or 5 pixels, to the left.
        const Image image = render(scene, 40, 20, {{"samples", "1"}, {"film.filter_width", "0"}});
        uint32_t lit = 0;
        for (uint32_t x = 0; x < 40; ++x) lit += image.at(x, 10)[0] > 0;
        const bool vertical = fit == TRP_FIT_VERTICAL;
        EXPECT_EQ(lit, vertical ? 20u : 30u);
        EXPECT_GT(image.at(vertical ? 5 : 0, 10)[0], 0);
        EXPECT_EQ(image.at(vertical ? 4 : 30, 10)[0], 0);
    }
}

TEST(Camera, LensBlursByItsCircleOfConfusion) {
    // A bright edge out of focus: the picture of a half plane at depth z goes from 0 to 1 over the circle of confusion,
    // whose width on the plane is 2 a |z − f| / f; its profile is the disk's integral.
    Scene scene;
    scene.object(quad({0, -50, 0}, {50, -50, 0}, {50, 50, 0}, {0, 50, 0}), scene.material([](TrpMaterialDesc& d) {
        d.emission = {{1, 1, 1}, TRP_NO_NODE};
    }));
    const float z = 10, focus = 5, aperture = 0.5f, radius = aperture * (z - focus) / focus;
    scene.camera(translation({0, 0, z}), [&](TrpCameraDesc& d) {
        d.aperture_radius = aperture;
        d.focus_distance = focus;
        d.field_of_view = 2 * std::atan(0.1f);  // 2 m across at 10 m
    });
    const Image image = render(scene, 40, 4, {{"samples", "1024"}, {"film.filter_width", "0"}});
    for (uint32_t x = 0; x < 40; ++x) {
        const double t = std::clamp(((x + 0.5) / 20 - 1) / radius, -1.0, 1.0);
        const double share = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPi;
        EXPECT_NEAR(image.at(x, 2)[0], share, 0.01) << x;
    }
}

}  // namespace
}  // namespace trp_test
