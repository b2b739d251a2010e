// Where the hierarchical solver divides elements for more than their light: along walls, beside smaller neighbours, and
// where what glows has a texture.
#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

// A sealed room of 2 m with walls of 0.2 m, in a bright world, on a floor that goes on for 19 m on all sides.
void add_room_on_ground(Scene& scene, float sunk) {
    const uint32_t grey = wall(scene, 0.7f, 0, false);
    scene.object(floor_square(20), grey);
    scene.object(box({-1.2f, -1.2f, -sunk}, {-1, 1.2f, 2}), grey);
    scene.object(box({1, -1.2f, -sunk}, {1.2f, 1.2f, 2}), grey);
    scene.object(box({-1, -1.2f, -sunk}, {1, -1, 2}), grey);
    scene.object(box({-1, 1, -sunk}, {1, 1.2f, 2}), grey);
    scene.object(box({-1.2f, -1.2f, 2}, {1.2f, 1.2f, 2.2f}), grey);
    scene.world({1, 1, 1});
}

TEST(RadiosityMeshing, NoLightComesUnderWallsThatStandOnTheGround) {
    for (const float sunk : {0.0f, 0.15f}) {
        Scene scene;
        add_room_on_ground(scene, sunk);
        scene.camera(look_at({0.9f, 0.9f, 1.7f}, {-0.5f, -0.5f, 0.3f}));
        scene.commit();
        Render render(scene, 64, 48, {}, {}, "radiosity");
        const Image image = render.run().read();
        // The ground outside has a radiance of 0.7. What is left comes by links of groups whose parts are in both, and
        // of a wall that is sunk into the ground, by the lowest elements, which the world lights from below.
        EXPECT_LT(mean(image, 0), (sunk > 0 ? 0.02 : 0.002) * 0.7) << sunk;
        float most = 0;
        for (uint32_t y = 0; y < image.height; ++y)
            for (uint32_t x = 0; x < image.width; ++x) most = std::max(most, image.at(x, y)[0]);
        EXPECT_LT(most, (sunk > 0 ? 0.3 : 0.01) * 0.7) << sunk;
    }
}

TEST(RadiosityMeshing, GroundAroundTheRoomIsLitByTheWorld) {
    Scene scene;
    add_room_on_ground(scene, 0);
    Solution solution(scene, {});
    solution.solve();
    const std::vector<float> centres = solution.read("centre", 3), areas = solution.read("area", 1);
    const std::vector<double> radiosity = solution.red("radiosity");
    double power = 0, area = 0;
    for (size_t k = 0; k < areas.size(); ++k) {
        if (std::abs(centres[3 * k + 2]) > 1e-4f) continue;
        if (std::max(std::abs(centres[3 * k]), std::abs(centres[3 * k + 1])) < 4) continue;
        power += radiosity[k] * static_cast<double>(areas[k]);
        area += static_cast<double>(areas[k]);
    }
    EXPECT_NEAR(power / area, 0.7 * kPi, 0.01 * kPi);
}

TEST(RadiosityMeshing, NeighboursHaveHalfTheSizeAtLeast) {
    // A spot's edge on a large quad.
    Scene scene;
    scene.object(floor_square(1.5f), wall(scene, 0.5f));
    scene.object(box({-0.5f, -0.5f, 1}, {0.5f, 0.5f, 1.2f}), wall(scene, 0.5f));
    scene.light(TRP_LIGHT_SUN, {1, 1, 1}, look_at({0, 0, 9}, {0.3f, 0.2f, 0}));
    Solution solution(scene, {});
    const TrpRadiosityInfo info = solution.solve().info();
    ASSERT_GT(info.element_count, 300u);
    std::vector<uint32_t> offsets(info.element_count + 1), vertices(info.corner_count);
    check(trp_radiosity_polygons(solution, offsets.data(), offsets.size(), vertices.data(), vertices.size()));
    size_t between = 0;
    for (size_t k = 0; k < info.element_count; ++k) {
        const uint32_t corners = offsets[k + 1] - offsets[k];
        EXPECT_LE(corners, 8u);  // one more to a side
        between += corners > 4;
    }
    EXPECT_GT(between, 20u);
}

TEST(RadiosityMeshing, TexturesThatGlowLightAsTheirPartsDo) {
    // A wall before a screen of which one half glows: by a texture, and as two quads.
    const auto lit = [](bool textured) {
        Scene scene;
        const float on[3] = {1, 0, 0};
        if (textured) {
            TrpTextureDesc image;
            check(trp_texture_desc_init(&image, sizeof image));
            const std::vector<float> pixels = {on[0], on[1], on[2], 0, 0, 0};
            image.pixels = pixels.data();
            image.channels = 3, image.width = 2, image.height = 1;
            image.filter = TRP_FILTER_NEAREST;
            uint32_t texture = 0;
            check(trp_texture_add(scene, &image, &texture));
            TrpNode node;
            check(trp_node_init(&node, TRP_NODE_IMAGE));
            node.texture = texture;
            scene.object(quad({-1, 0, 0}, {1, 0, 0}, {1, 0, 1}, {-1, 0, 1}), scene.material([&](TrpMaterialDesc& d) {
                d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
                d.emission = {{1, 1, 1}, 0};
                d.nodes = &node;
                d.node_count = 1;
            }));
        } else {
            scene.object(quad({-1, 0, 0}, {0, 0, 0}, {0, 0, 1}, {-1, 0, 1}), wall(scene, 0, kPiF));
            scene.object(quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}), wall(scene, 0));
        }
        scene.object(quad({-1, -0.5f, 0}, {-1, -0.5f, 1}, {1, -0.5f, 1}, {1, -0.5f, 0}), wall(scene, 0.5f));
        Solution solution(scene, {{"radiosity.tolerance", "0.005"}});
        solution.solve();
        const std::vector<float> centres = solution.read("centre", 3), areas = solution.read("area", 1);
        const std::vector<double> irradiance = solution.red("irradiance");
        std::array<double, 2> power = {0, 0};
        for (size_t k = 0; k < areas.size(); ++k)
            if (centres[3 * k + 1] < -0.4f) power[centres[3 * k] > 0] += irradiance[k] * static_cast<double>(areas[k]);
        return power;
    };
    const auto known = lit(false), found = lit(true);
    EXPECT_GT(known[0], 2 * known[1]);
    for (int side = 0; side < 2; ++side) EXPECT_NEAR(found[side], known[side], 0.02 * known[0]) << side;
}

}  // namespace
}  // namespace trp_test
