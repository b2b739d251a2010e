// Edits: renders keep the snapshot they were made from, and an edited scene looks, bit for bit, like one made fresh.
#include <map>
#include <random>
#include <thread>

#include "abi/expect.h"

using namespace trp_test;

namespace {

TEST(Edits, ARenderKeepsItsSnapshot) {
    SmallScene scene;
    const Image first = scene.picture();
    Render held(scene, 40, 24, kFewSamples);
    const auto expect_first = [&] { EXPECT_TRUE(same(held.run().read(), first)); };

    check(trp_instance_move(scene, scene.box_instance, translation({1, 1, 1}).data(), 1));
    expect_first();
    scene.commit();
    expect_first();
    const MeshData ball = sphere({0, 0, 0}, 0.7f, 8);
    const TrpMeshDesc desc = Scene::mesh_desc(ball);
    check(trp_mesh_replace(scene, scene.box_mesh, &desc));
    check(trp_material_remove(scene, scene.red));
    check(trp_light_remove(scene, scene.sun));
    scene.world({1, 1, 1});
    scene.camera_above(4);
    scene.commit();
    expect_first();
    check(trp_instance_remove(scene, scene.box_instance));
    check(trp_instance_remove(scene, scene.floor_instance));
    check(trp_mesh_remove(scene, scene.box_mesh));
    scene.commit();
    expect_first();
    scene.commit();
    expect_first();
}

TEST(Edits, CommitsWhileARenderRuns) {
    SmallScene scene;
    scene.commit();
    const Settings settings = {{"samples", "64"}, {"threads", "1"}};
    Render held(scene, 120, 80, settings);
    const Image expected = Render(scene, 120, 80, settings).run().read();
    std::thread other([&] { held.run(); });
    for (int i = 0; i < 20; ++i) {
        check(
            trp_instance_move(scene, scene.box_instance, translation({0.1f * static_cast<float>(i), 0, 1}).data(), 1));
        scene.commit(1);
    }
    other.join();
    EXPECT_TRUE(same(held.read(), expected));
}

// What a scene should hold. Ids grow with time here as in the scene, so that both are in the same order.
struct Wanted {
    struct Instance {
        uint32_t mesh;
        Transform transform;
    };
    std::map<uint32_t, int> meshes;  // by id: the shape's number
    std::map<uint32_t, Instance> instances;
};

MeshData shape(int number, uint32_t red, uint32_t lamp) {
    if (number % 8 == 3) return sphere({0, 0, 0}, 0.5f, 96);  // so large that two of them are instanced
    MeshData data = number % 3 == 0   ? box(0.3f + 0.05f * static_cast<float>(number % 5))
                    : number % 3 == 1 ? sphere({0, 0, 0}, 0.4f, 6 + number % 4)
                                      : floor_square(0.5f, 0.1f);
    if (number % 3 == 2) data.materials = {lamp};
    if (number % 3 == 0) data.materials = {red};
    return data;
}

struct Stage : Scene {
    uint32_t red = diffuse(0.8f, 0.2f, 0.2f);
    uint32_t lamp = material([](TrpMaterialDesc& d) { d.emission = {{3, 2, 1}, TRP_NO_NODE}; });
    Stage() {
        light(TRP_LIGHT_AREA, {5, 5, 5}, look_at({2, 2, 4}, {0, 0, 0}, {0, 1, 0}));
        camera(look_at({4, -5, 4}, {0, 0, 0}));
        world({0.1f, 0.1f, 0.2f});
    }
};

Image fresh_picture(const Wanted& wanted) {
    Stage stage;
    std::map<uint32_t, uint32_t> id_of;
    for (const auto& [id, number] : wanted.meshes) id_of[id] = stage.mesh(shape(number, stage.red, stage.lamp));
    for (const auto& [id, instance] : wanted.instances) stage.instance(id_of.at(instance.mesh), instance.transform);
    return render(stage, 40, 24, kFewSamples);
}

// `held`: renders of former commits are kept, so that commits cannot change the last snapshot in place.
void edit_at_random(uint32_t seed, bool held) {
    std::mt19937 random(seed);
    const auto below = [&](size_t n) { return static_cast<uint32_t>(random() % n); };
    const auto somewhere = [&] {
        const auto coordinate = [&] { return static_cast<float>(below(1000)) / 250 - 2; };
        Transform t = translation({coordinate(), coordinate(), coordinate() / 2 + 1});
        for (const size_t axis : {0u, 5u, 10u}) t[axis] = 0.5f + static_cast<float>(below(100)) / 100;
        if (below(4) == 0) t[0] = -t[0];
        return t;
    };
    const auto any = [&](const auto& map) { return std::next(map.begin(), below(map.size()))->first; };

    Stage stage;
    Wanted wanted;
    std::vector<std::unique_ptr<Render>> renders;
    int shapes = 0;
    const auto add_mesh = [&] {
        wanted.meshes[stage.mesh(shape(shapes, stage.red, stage.lamp))] = shapes;
        ++shapes;
    };
    const auto add_instance = [&] {
        const uint32_t mesh = any(wanted.meshes);
        const Transform transform = somewhere();
        wanted.instances[stage.instance(mesh, transform)] = {mesh, transform};
    };
    for (int i = 0; i < 4; ++i) add_mesh();
    for (int i = 0; i < 6; ++i) add_instance();
    for (int round = 0; round < 25; ++round) {
        for (uint32_t edit = 0; edit < 1 + below(3); ++edit) {
            switch (below(7)) {
                case 0:
                    add_mesh();
                    break;
                case 1:
                    add_instance();
                    break;
                case 2: {
                    const uint32_t id = any(wanted.meshes);
                    const MeshData data = shape(shapes, stage.red, stage.lamp);
                    const TrpMeshDesc desc = Scene::mesh_desc(data);
                    check(trp_mesh_replace(stage, id, &desc));
                    wanted.meshes[id] = shapes++;
                    break;
                }
                case 3:
                case 4: {
                    const uint32_t id = any(wanted.instances);
                    wanted.instances[id].transform = somewhere();
                    check(trp_instance_move(stage, id, wanted.instances[id].transform.data(), 1));
                    break;
                }
                case 5: {
                    const uint32_t id = any(wanted.instances);
                    TrpInstanceDesc desc;
                    check(trp_instance_desc_init(&desc, sizeof desc));
                    desc.mesh = wanted.instances[id].mesh = any(wanted.meshes);
                    desc.world_from_object = wanted.instances[id].transform.data();
                    check(trp_instance_replace(stage, id, &desc));
                    break;
                }
                default:
                    if (wanted.instances.size() < 3) break;
                    const uint32_t id = any(wanted.instances);
                    check(trp_instance_remove(stage, id));
                    wanted.instances.erase(id);
            }
        }
        stage.commit();
        auto now = std::make_unique<Render>(stage, 40, 24, kFewSamples);
        ASSERT_TRUE(same(now->run().read(), fresh_picture(wanted))) << "after round " << round << " of seed " << seed;
        if (held) renders.push_back(std::move(now));
    }
}

TEST(Edits, InPlaceLooksLikeFresh) {
    for (const uint32_t seed : {1u, 2u, 3u, 4u}) edit_at_random(seed, false);
}

TEST(Edits, BesideRendersLooksLikeFresh) {
    for (const uint32_t seed : {5u, 6u, 7u}) edit_at_random(seed, true);
}

}  // namespace
