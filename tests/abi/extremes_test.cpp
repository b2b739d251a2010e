// The greatest and the least numbers that are taken: no call may abort or fail, whatever the picture. One test to a
// kind of item, as an abort ends the process.
#include "abi/expect.h"

using namespace trp_test;

namespace {

constexpr float kSizes[] = {1e10f, 1e16f, 1e19f, 1e30f, 3e38f};

Transform far_away(float x) {
    return translation({x, -x, x});
}
Transform scale(float s) {
    return {s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0};
}

void expect_survival(const std::function<void(SmallScene&)>& change) {
    SmallScene scene;
    change(scene);
    EXPECT_EQ(trp_scene_commit(scene, 0), TRP_OK) << trp_error_message();
    Render render(scene, 24, 16, {{"samples", "2"}});
    EXPECT_EQ(trp_render_run(render, nullptr), TRP_OK) << trp_error_message();
}

TEST(Extremes, CameraPosition) {
    for (const float size : kSizes) expect_survival([&](SmallScene& s) { s.camera(far_away(size)); });
    expect_survival([](SmallScene& s) { s.camera(Transform{}); });
}

TEST(Extremes, CameraScale) {
    for (const float size : kSizes)
        for (const float factor : {size, 1 / size, -size})
            expect_survival([&](SmallScene& s) { s.camera(scale(factor)); });
}

// The camera's own numbers are bounded where rays would leave the range of floats.
TEST(Extremes, OrthographicWidth) {
    for (const float pixel_aspect : {1e-3f, 1e3f})
        expect_survival([&](SmallScene& s) {
            s.camera(translation({0, 0, 9}), [&](TrpCameraDesc& d) {
                d.type = TRP_CAMERA_ORTHOGRAPHIC;
                d.width = 1e9f;
                d.shift[0] = d.shift[1] = 1e6f;
                d.pixel_aspect = pixel_aspect;
            });
        });
    SmallScene scene;
    for (const float size : kSizes) EXPECT_THROW(scene.camera_above(size), std::runtime_error);
}

TEST(Extremes, Lens) {
    for (const float size : kSizes)
        for (const float focus : {1e-9f, size})
            expect_survival([&](SmallScene& s) {
                s.camera(translation({0, 0, 5}), [&](TrpCameraDesc& d) {
                    d.aperture_radius = 1e6f;
                    d.focus_distance = focus;
                    d.clip_end = d.blade_rotation = size;
                    d.blade_count = 5;
                    d.field_of_view = 3.14f;
                    d.shift[0] = d.shift[1] = 1e6f;
                });
            });
    SmallScene scene;
    for (const float size : kSizes)
        EXPECT_THROW(scene.camera(kIdentity, [&](TrpCameraDesc& d) { d.aperture_radius = size; }), std::runtime_error);
}

void expect_light_survival(int32_t type) {
    for (const float size : kSizes) {
        expect_survival([&](SmallScene& s) { s.light(type, {1, 1, 1}, far_away(size)); });
        expect_survival([&](SmallScene& s) { s.light(type, {size, size, size}, translation({0, 0, 4})); });
        expect_survival([&](SmallScene& s) { s.light(type, {1, 1, 1}, scale(size)); });
        expect_survival([&](SmallScene& s) {
            s.light(type, {1, 1, 1}, translation({0, 0, 4}),
                    [&](TrpLightDesc& d) { d.radius = d.size[0] = d.size[1] = size; });
        });
    }
    expect_survival([&](SmallScene& s) { s.light(type, {1, 1, 1}, Transform{}); });
}

TEST(Extremes, PointLight) {
    expect_light_survival(TRP_LIGHT_POINT);
}
TEST(Extremes, SpotLight) {
    expect_light_survival(TRP_LIGHT_SPOT);
}
TEST(Extremes, Sun) {
    expect_light_survival(TRP_LIGHT_SUN);
}
TEST(Extremes, AreaLight) {
    expect_light_survival(TRP_LIGHT_AREA);
}

TEST(Extremes, World) {
    for (const float size : kSizes) expect_survival([&](SmallScene& s) { s.world({size, size, size}); });
}

TEST(Extremes, CopyFarAway) {
    for (const float size : kSizes) expect_survival([&](SmallScene& s) { s.object(box(1), s.red, far_away(size)); });
}

TEST(Extremes, CopyScaled) {
    for (const float size : kSizes)
        expect_survival([&](SmallScene& s) {
            s.object(box(1), s.red, scale(size));
            s.object(box(1), s.red, scale(1 / size));
        });
}

// Of so many triangles that two of them are instanced and not copied.
const MeshData kLargeMesh = sphere({0, 0, 0}, 1, 96);

TEST(Extremes, InstanceFarAway) {
    for (const float size : kSizes)
        expect_survival([&](SmallScene& s) {
            const uint32_t ball = s.mesh(kLargeMesh);
            s.instance(ball);
            s.instance(ball, far_away(size));
        });
}

TEST(Extremes, InstanceScaled) {
    for (const float size : kSizes)
        expect_survival([&](SmallScene& s) {
            const uint32_t ball = s.mesh(kLargeMesh);
            s.instance(ball, scale(size));
            s.instance(ball, scale(1 / size));
        });
}

TEST(Extremes, Vertices) {
    for (const float size : kSizes)
        expect_survival([&](SmallScene& s) {
            MeshData stray = box(1);
            stray.positions[4] = size;
            s.object(stray, s.red);
            s.object(box(size), s.red);
            s.object(floor_square(1 / size, 1), s.red);
        });
}

}  // namespace
