// One mesh shown many times against a copy of the mesh for each instance: the same picture up to rounding, and no hang
// (coherent occlusion packets of the ray library can fail to return from an instance).
#include "abi/expect.h"

using namespace trp_test;

namespace {

struct Crowd : Scene {
    explicit Crowd(bool shared) {
        // So large that twenty copies are dearer than instances.
        MeshData ball = sphere({0, 0, 0}, 0.4f, 48);
        // Uneven, so that a turn or a mirror image is seen.
        for (size_t i = 0; i < ball.positions.size(); i += 3)
            if (ball.positions[i] > 0.1f) ball.positions[i] *= 1.5f;
        ball.normals.clear();
        ball.materials = {diffuse(0.7f, 0.5f, 0.3f)};
        uint32_t one = TRP_NO_ID;
        for (int i = 0; i < 20; ++i) {
            if (!shared || one == TRP_NO_ID) one = mesh(ball);
            instance(one, placed(i));
        }
        object(floor_square(4, -0.8f));
        light(TRP_LIGHT_AREA, {6, 6, 6}, translation({0, 0, 4}));
        light(TRP_LIGHT_SUN, {1, 1, 1}, look_at({2, -1, 3}, {0, 0, 0}), [](TrpLightDesc& d) { d.angle = 0.05f; });
        world({0.3f, 0.4f, 0.5f});
        camera(look_at({5, -6, 5}, {0, 0, 0}));
    }
    // On a grid; scaled, turned and mirrored in turn.
    static Transform placed(int i) {
        const float angle = 0.7f * static_cast<float>(i), c = std::cos(angle), s = std::sin(angle);
        const float scale = 0.5f + 0.1f * static_cast<float>(i % 7), mirror = i % 3 == 0 ? -scale : scale;
        const float stretch = i % 4 == 0 ? 2 * scale : scale;
        return {c * mirror, -s * scale, 0,       static_cast<float>(i % 5) - 2,
                s * mirror, c * scale,  0,       static_cast<float>(i / 5) - 1.5f,
                0,          0,          stretch, 0.1f * static_cast<float>(i % 2)};
    }
};

TEST(Instances, LookLikeCopies) {
    const Settings settings = {{"samples", "8"}};
    Crowd shared(true), copied(false);
    const Image a = render(shared, 96, 64, settings), b = render(copied, 96, 64, settings);
    double difference = 0, sum = 0;
    for (size_t i = 0; i < a.values.size(); ++i) {
        difference += std::abs(a.values[i] - b.values[i]);
        sum += std::abs(b.values[i]);
    }
    ASSERT_GT(sum, 0);
    std::printf("relative mean difference %.2g\n", difference / sum);
    EXPECT_LT(difference / sum, 1e-3);

    TrpSceneInfo info{};
    info.struct_size = sizeof info;
    check(trp_scene_info(shared, &info));
    EXPECT_EQ(info.mesh_count, 2u);
    EXPECT_EQ(info.instance_count, 21u);
}

// Many shadow rays from grazing angles, over several seeds.
TEST(Instances, Return) {
    Crowd crowd(true);
    crowd.light(TRP_LIGHT_POINT, {5, 5, 5}, translation({-3, 0, 0.2f}));
    crowd.light(TRP_LIGHT_SPOT, {9, 9, 9}, look_at({0, -3, 0.5f}, {0, 0, 0}));
    crowd.commit();
    for (const char* seed : {"1", "2", "3"}) {
        Render render(crowd, 128, 96, {{"samples", "8"}, {"seed", seed}});
        for (const float value : render.run().read().values) ASSERT_TRUE(std::isfinite(value));
    }
}

}  // namespace
