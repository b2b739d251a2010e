// The passes that are parts of the picture add up to it, and counts are what was counted.
#include "support/bodies.h"

namespace trp_test {
namespace {

constexpr const char* kParts[] = {"Ambient",         "DiffuseDirect", "SpecularDirect", "Emission",
                                  "DiffuseIndirect", "Reflection",    "Transmission",   "Environment"};

bool has_pass(const char* name, const std::string& method) {
    for (uint32_t p = 0; p < trp_pass_count(); ++p) {
        TrpPassInfo info{};
        info.struct_size = sizeof info;
        check(trp_pass_info(p, &info));
        if (std::string(info.name) != name) continue;
        std::string methods(1, ' ');
        methods.append(info.methods).append(1, ' ');
        return methods.find(" " + method + " ") != std::string::npos;
    }
    return false;
}

TEST(LightParts, AddUpToThePicture) {
    Scene scene;
    scene.object(floor_square(4), scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.6f, 0.5f, 0.4f}, TRP_NO_NODE};
        d.specular = {{0.2f, 0.2f, 0.2f}, TRP_NO_NODE};
        d.emission = {{0.1f, 0, 0.05f}, TRP_NO_NODE};
    }));
    scene.object(sphere({-1, 0, 1}, 0.9f, 32), glass(scene, 1.5f, [](TrpMaterialDesc& d) { d.absorption[0] = 0.3f; }));
    scene.object(sphere({1, 0.5f, 1}, 0.9f, 32), scene.material([](TrpMaterialDesc& d) {
        d.specular = {{0.7f, 0.6f, 0.5f}, TRP_NO_NODE};
        d.alpha = {{0.75f, 0, 0}, TRP_NO_NODE};
    }));
    // All that is behind it is seen too.
    scene.object(quad({-2, -2, 0.5f}, {-1, -2, 0.5f}, {-1, -2, 1.5f}, {-2, -2, 1.5f}),
                 scene.material([](TrpMaterialDesc& d) {
                     d.diffuse = {{0.1f, 0.1f, 0.1f}, TRP_NO_NODE};
                     d.transmission = {{1, 1, 1}, TRP_NO_NODE};
                     d.emission = {{0.3f, 0.2f, 0.1f}, TRP_NO_NODE};
                     d.thin = 1;
                 }));
    scene.light(TRP_LIGHT_POINT, {60, 60, 60}, translation({2, -3, 5}));
    scene.light(TRP_LIGHT_AREA, {4, 4, 4}, look_at({0, 3, 1}, {0, -6, 1.5f}),
                [](TrpLightDesc& d) { d.visible_camera = 1; });
    scene.world({0.2f, 0.3f, 0.4f});
    scene.camera(look_at({0, -6, 2.5f}, {0, 0, 0.8f}));
    scene.commit();
    for (const char* method : {"ray_casting", "ray_tracing", "path_tracing"}) {
        std::vector<const char*> parts;
        for (const char* part : kParts)
            if (has_pass(part, method)) {
                parts.push_back(part);
            }
        EXPECT_GE(parts.size(), 5u);
        Render render(scene, 48, 32, {{"samples", "4"}, {"shading.ambient", "0.3,0.2,0.1"}}, parts, method);
        const Image picture = render.run().read();
        std::vector<double> sum(picture.values.size(), 0);
        for (const char* part : parts) {
            const Image image = render.read(part);
            double total = 0;
            for (size_t i = 0; i < size_t{48} * 32; ++i)
                for (size_t c = 0; c < 3; ++c) {
                    sum[4 * i + c] += image.values[3 * i + c];
                    total += image.values[3 * i + c];
                }
            EXPECT_GT(total, 0) << method << " " << part;
        }
        for (size_t i = 0; i < sum.size(); ++i) {
            if (i % 4 == 3) continue;
            ASSERT_NEAR(sum[i], picture.values[i], 2e-5 * (1 + picture.values[i])) << method << " " << i;
        }
    }
}

// What each light group gives is the picture of its lamps alone; all of them, with what no group gives, the picture.
TEST(LightParts, GroupsArePicturesOfTheirLamps) {
    const auto build = [](Scene& scene, uint32_t only) {
        scene.object(floor_square(4), scene.material([](TrpMaterialDesc& d) {
            d.diffuse = {{0.6f, 0.5f, 0.4f}, TRP_NO_NODE};
            d.mirror = {{0.3f, 0.3f, 0.3f}, TRP_NO_NODE};
            d.mirror_is_specular = 0;
        }));
        scene.object(sphere({-1, 0, 1}, 0.9f, 24), glass(scene, 1.5f));
        const auto lamp = [&](uint32_t group, int32_t type, Vec at) {
            const bool dark = only != 0 && only != group;
            scene.light(type, dark ? Vec{1e-20f, 1e-20f, 1e-20f} : Vec{20, 15, 10}, look_at(at, {0, 0, 0.5f}),
                        [&](TrpLightDesc& d) {
                            d.group = group;
                            d.radius = 0;
                            d.visible_camera = type == TRP_LIGHT_AREA;
                        });
        };
        lamp(1, TRP_LIGHT_POINT, {2, -3, 5});
        lamp(2, TRP_LIGHT_AREA, {0.5f, 3, 1.5f});
        lamp(2, TRP_LIGHT_POINT, {-2, -2, 3});
        lamp(7, TRP_LIGHT_SUN, {-3, 1, 5});
        scene.camera(look_at({0, -6, 2.5f}, {0, 0, 0.8f}));
        scene.commit();
    };
    for (const char* method : {"ray_casting", "ray_tracing", "path_tracing"}) {
        const Settings settings = {{"samples", "4"}, {"trace.least_weight", "0"}};
        Scene scene;
        build(scene, 0);
        Render render(scene, 48, 32, settings, {"LightGroup1", "LightGroup2", "LightGroup3", "LightGroup7"}, method);
        const Image picture = render.run().read();
        std::vector<double> sum(size_t{48} * 32 * 3, 0);
        for (const uint32_t group : {1u, 2u, 3u, 7u}) {
            const Image part = render.read(("LightGroup" + std::to_string(group)).c_str());
            for (size_t i = 0; i < sum.size(); ++i) sum[i] += part.values[i];
            if (std::string(method) == "path_tracing") continue;  // whose paths go where there is light
            Scene alone;
            build(alone, group);
            const Image its = Render(alone, 48, 32, settings, {}, method).run().read();
            for (size_t i = 0; i < sum.size(); ++i)
                ASSERT_NEAR(part.values[i], its.values[i / 3 * 4 + i % 3], 1e-4 * (1 + part.values[i]))
                    << method << ", group " << group << ", " << i;
        }
        for (size_t i = 0; i < sum.size(); ++i) {
            const double whole = picture.values[i / 3 * 4 + i % 3];
            ASSERT_NEAR(sum[i], whole, 1e-4 * (1 + whole)) << method << " " << i;
        }
    }
}

// In a sealed cube of mirrors each pixel's tree has a ray to each level.
TEST(LightParts, RaysAndDepthAreCounted) {
    Scene scene;
    scene.object(inwards(box({-1, -1, -1}, {1, 1, 1})), scene.material([](TrpMaterialDesc& d) {
        d.mirror = {{0.8f, 0.8f, 0.8f}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
    }));
    scene.camera(look_at({0.3f, -0.2f, 0.1f}, {1, 0.4f, 0.2f}));
    scene.commit();
    for (const int depth : {0, 1, 5}) {
        Render render(scene, 24, 16,
                      {{"samples", "3"}, {"trace.depth", std::to_string(depth)}, {"trace.least_weight", "0"}},
                      {"RayCount", "TreeDepth"}, "ray_tracing");
        render.run();
        for (const float value : render.read("RayCount").values) ASSERT_EQ(value, 3.0f * (1 + depth));
        for (const float value : render.read("TreeDepth").values) ASSERT_EQ(value, depth);
    }
}

}  // namespace
}  // namespace trp_test
