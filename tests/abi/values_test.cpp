// Every number of a descriptor: NaN, infinities, values out of range, enumerations. The message names item and value.
#include "abi/kinds.h"

using namespace trp_test;

namespace {

constexpr float kNotNumbers[] = {kNaN, kInfinity, -kInfinity};

template <class Desc>
struct FloatField {
    const char* name;
    float* (*of)(Desc&);
};

// Adding and replacing fail with the item's name, and its id where it has one; the scene keeps what it had.
template <class Kind>
void expect_refused(typename Kind::Desc desc, std::vector<std::string> words) {
    Scene scene;
    desc.name = "Culprit";
    words.push_back(std::string(Kind::kName) + " \"Culprit\"");
    uint32_t id = 77;
    EXPECT_TRUE(fails(Kind::add(scene, &desc, &id), TRP_ERROR_ARGUMENT, words));
    EXPECT_EQ(id, 77u);
    id = add_valid<Kind>(scene);
    words.back() = std::string(Kind::kName) + " " + std::to_string(id) + " \"Culprit\"";
    EXPECT_TRUE(fails(Kind::replace(scene, id, &desc), TRP_ERROR_ARGUMENT, words));
}

template <class Kind>
void expect_finite(const std::vector<FloatField<typename Kind::Desc>>& fields) {
    for (const auto& field : fields)
        for (const float bad : kNotNumbers) {
            auto desc = valid<Kind>();
            *field.of(desc) = bad;
            expect_refused<Kind>(desc, {field.name, std::isnan(bad) ? "nan" : "inf"});
        }
}

template <class Kind, class Set>
void expect_refused_with(const char* word, const char* value, Set&& set) {
    auto desc = valid<Kind>();
    set(desc);
    expect_refused<Kind>(desc, {word, value});
}

// A transform with one bad number, at every place.
template <class Kind>
void expect_finite_transform(const float* Kind::Desc::*transform) {
    for (int i = 0; i < 12; ++i)
        for (const float bad : kNotNumbers) {
            Transform rows = kIdentity;
            rows[static_cast<size_t>(i)] = bad;
            auto desc = valid<Kind>();
            desc.*transform = rows.data();
            expect_refused<Kind>(desc, {"number " + std::to_string(i) + " of the transform"});
        }
    auto desc = valid<Kind>();
    for (const uint32_t count : {0u, 130u, ~0u}) {
        desc.time_count = count;
        expect_refused<Kind>(desc, {"time_count", std::to_string(count)});
    }
}

TEST(Values, Instance) {
    expect_finite<InstanceKind>({{"color[0]", [](TrpInstanceDesc& d) { return &d.color[0]; }},
                                 {"color[1]", [](TrpInstanceDesc& d) { return &d.color[1]; }},
                                 {"color[2]", [](TrpInstanceDesc& d) { return &d.color[2]; }}});
    expect_finite_transform<InstanceKind>(&TrpInstanceDesc::world_from_object);
    expect_refused_with<InstanceKind>("materials is null", "3", [](TrpInstanceDesc& d) { d.material_count = 3; });
    expect_refused_with<InstanceKind>("material_count", "70000", [](TrpInstanceDesc& d) {
        static const std::vector<uint32_t> many(70000, TRP_NO_ID);
        d.materials = many.data();
        d.material_count = 70000;
    });
}

TEST(Values, InstanceMove) {
    SmallScene scene;
    const Image before = scene.picture();
    Transform bad = kIdentity;
    bad[7] = kNaN;
    const std::string name = "instance " + std::to_string(scene.box_instance);
    EXPECT_TRUE(fails(trp_instance_move(scene, scene.box_instance, bad.data(), 1), TRP_ERROR_ARGUMENT,
                      {name, "number 7", "nan"}));
    EXPECT_TRUE(fails(trp_instance_move(scene, scene.box_instance, bad.data(), 0), TRP_ERROR_ARGUMENT,
                      {name, "time_count is 0"}));
    EXPECT_TRUE(fails(trp_instance_move(scene, scene.box_instance, nullptr, 1), TRP_ERROR_ARGUMENT, {"null"}));
    EXPECT_TRUE(fails(trp_instance_move(nullptr, scene.box_instance, kIdentity.data(), 1), TRP_ERROR_ARGUMENT));
    EXPECT_TRUE(fails(trp_instance_move(scene, scene.box_mesh, kIdentity.data(), 1), TRP_ERROR_ID,
                      {"instance " + std::to_string(scene.box_mesh)}));
    EXPECT_TRUE(same(scene.picture(), before));
}

TEST(Values, Light) {
    expect_finite<LightKind>({{"emission[0]", [](TrpLightDesc& d) { return &d.emission[0]; }},
                              {"emission[1]", [](TrpLightDesc& d) { return &d.emission[1]; }},
                              {"emission[2]", [](TrpLightDesc& d) { return &d.emission[2]; }},
                              {"radius", [](TrpLightDesc& d) { return &d.radius; }},
                              {"angle", [](TrpLightDesc& d) { return &d.angle; }},
                              {"blend", [](TrpLightDesc& d) { return &d.blend; }},
                              {"size", [](TrpLightDesc& d) { return &d.size[0]; }},
                              {"size", [](TrpLightDesc& d) { return &d.size[1]; }}});
    expect_finite_transform<LightKind>(&TrpLightDesc::world_from_light);
    expect_refused_with<LightKind>("type", "4", [](TrpLightDesc& d) { d.type = 4; });
    expect_refused_with<LightKind>("type", "-1", [](TrpLightDesc& d) { d.type = -1; });
    expect_refused_with<LightKind>("falloff", "3", [](TrpLightDesc& d) { d.falloff = 3; });
    expect_refused_with<LightKind>("shape", "2", [](TrpLightDesc& d) { d.shape = 2; });
    expect_refused_with<LightKind>("emission[1]", "-2", [](TrpLightDesc& d) { d.emission[1] = -2; });
    expect_refused_with<LightKind>("radius", "-0.5", [](TrpLightDesc& d) { d.radius = -0.5f; });
    expect_refused_with<LightKind>("angle", "3.5", [](TrpLightDesc& d) { d.angle = 3.5f; });
    expect_refused_with<LightKind>("blend", "1.5", [](TrpLightDesc& d) { d.blend = 1.5f; });
    expect_refused_with<LightKind>("size", "-1", [](TrpLightDesc& d) { d.size[1] = -1; });
}

TEST(Values, Camera) {
    expect_finite<CameraKind>({{"field_of_view", [](TrpCameraDesc& d) { return &d.field_of_view; }},
                               {"width", [](TrpCameraDesc& d) { return &d.width; }},
                               {"shift[0]", [](TrpCameraDesc& d) { return &d.shift[0]; }},
                               {"shift[1]", [](TrpCameraDesc& d) { return &d.shift[1]; }},
                               {"clip_start", [](TrpCameraDesc& d) { return &d.clip_start; }},
                               {"clip_end", [](TrpCameraDesc& d) { return &d.clip_end; }},
                               {"aperture_radius", [](TrpCameraDesc& d) { return &d.aperture_radius; }},
                               {"focus_distance", [](TrpCameraDesc& d) { return &d.focus_distance; }},
                               {"blade_rotation", [](TrpCameraDesc& d) { return &d.blade_rotation; }},
                               {"shutter[0]", [](TrpCameraDesc& d) { return &d.shutter[0]; }},
                               {"shutter[1]", [](TrpCameraDesc& d) { return &d.shutter[1]; }},
                               {"pixel_aspect", [](TrpCameraDesc& d) { return &d.pixel_aspect; }}});
    expect_finite_transform<CameraKind>(&TrpCameraDesc::world_from_camera);
    expect_refused_with<CameraKind>("type", "2", [](TrpCameraDesc& d) { d.type = 2; });
    expect_refused_with<CameraKind>("fit", "-1", [](TrpCameraDesc& d) { d.fit = -1; });
    expect_refused_with<CameraKind>("field_of_view", "0", [](TrpCameraDesc& d) { d.field_of_view = 0; });
    expect_refused_with<CameraKind>("field_of_view", "3.2", [](TrpCameraDesc& d) { d.field_of_view = 3.2f; });
    expect_refused_with<CameraKind>("width", "-6", [](TrpCameraDesc& d) { d.width = -6; });
    expect_refused_with<CameraKind>("clip_start", "-1", [](TrpCameraDesc& d) { d.clip_start = -1; });
    expect_refused_with<CameraKind>("clip_end", "0.001", [](TrpCameraDesc& d) { d.clip_end = 0.001f; });
    expect_refused_with<CameraKind>("focus_distance", "0", [](TrpCameraDesc& d) { d.focus_distance = 0; });
    expect_refused_with<CameraKind>("blade_count", "1000", [](TrpCameraDesc& d) { d.blade_count = 1000; });
    expect_refused_with<CameraKind>("shutter[1]", "0.25", [](TrpCameraDesc& d) {
        d.shutter[0] = 0.5f;
        d.shutter[1] = 0.25f;
    });
    expect_refused_with<CameraKind>("pixel_aspect", "0", [](TrpCameraDesc& d) { d.pixel_aspect = 0; });
}

TEST(Values, World) {
    SmallScene scene;
    const Image before = scene.picture();
    TrpWorldDesc world;
    EXPECT_TRUE(fails(trp_world_desc_init(nullptr, sizeof world), TRP_ERROR_ARGUMENT));
    EXPECT_TRUE(fails(trp_world_desc_init(&world, 4), TRP_ERROR_ARGUMENT, {"4"}));
    check(trp_world_desc_init(&world, sizeof world));
    EXPECT_TRUE(fails(trp_scene_set_world(nullptr, &world), TRP_ERROR_ARGUMENT, {"scene"}));
    EXPECT_TRUE(fails(trp_scene_set_world(scene, nullptr), TRP_ERROR_ARGUMENT, {"desc"}));
    for (const float bad : {kNaN, kInfinity, -kInfinity, -1.0f})
        for (int k = 0; k < 3; ++k) {
            TrpWorldDesc d = world;
            d.radiance[k] = bad;
            EXPECT_TRUE(fails(trp_scene_set_world(scene, &d), TRP_ERROR_ARGUMENT,
                              {"world", "radiance[" + std::to_string(k) + "]"}));
        }
    for (size_t i = 0; i < 12; ++i) {
        Transform rows = kIdentity;
        rows[i] = kNaN;
        TrpWorldDesc d = world;
        d.world_from_texture = rows.data();
        EXPECT_TRUE(fails(trp_scene_set_world(scene, &d), TRP_ERROR_ARGUMENT, {"world", "nan"}));
    }
    {
        Transform rows = kIdentity;
        rows[0] = 2;
        TrpWorldDesc d = world;
        d.world_from_texture = rows.data();
        EXPECT_TRUE(fails(trp_scene_set_world(scene, &d), TRP_ERROR_ARGUMENT, {"world", "not a rotation"}));
    }
    world.struct_size = 4;
    EXPECT_TRUE(fails(trp_scene_set_world(scene, &world), TRP_ERROR_ARGUMENT, {"struct_size is 4"}));
    world.struct_size = sizeof world - 8;
    world.visible_camera = world.light = -1;
    EXPECT_EQ(trp_scene_set_world(scene, &world), TRP_OK);
    EXPECT_TRUE(same(scene.picture(), before));
}

TEST(Values, Texture) {
    for (const float bad : kNotNumbers) {
        const float pixels[3] = {0, bad, 0};
        expect_refused_with<TextureKind>("pixels[1]", std::isnan(bad) ? "nan" : "inf",
                                         [&](TrpTextureDesc& d) { d.pixels = pixels; });
    }
    expect_refused_with<TextureKind>("color_space", "3", [](TrpTextureDesc& d) { d.color_space = 3; });
    expect_refused_with<TextureKind>("wrap_u", "4", [](TrpTextureDesc& d) { d.wrap_u = 4; });
    expect_refused_with<TextureKind>("wrap_v", "-1", [](TrpTextureDesc& d) { d.wrap_v = -1; });
    expect_refused_with<TextureKind>("filter", "2", [](TrpTextureDesc& d) { d.filter = 2; });
    expect_refused_with<TextureKind>("width", "0", [](TrpTextureDesc& d) { d.width = 0; });
    expect_refused_with<TextureKind>("height", "1000000", [](TrpTextureDesc& d) { d.height = 1000000; });
    expect_refused_with<TextureKind>("channels", "5", [](TrpTextureDesc& d) { d.channels = 5; });
    expect_refused_with<TextureKind>("path, file_data and pixels", "0", [](TrpTextureDesc& d) { d.pixels = nullptr; });
    expect_refused_with<TextureKind>("path, file_data and pixels", "2", [](TrpTextureDesc& d) { d.path = "a.png"; });
    expect_refused_with<TextureKind>("path", "empty", [](TrpTextureDesc& d) {
        d.pixels = nullptr;
        d.path = "";
    });
    expect_refused_with<TextureKind>("file_size", "0", [](TrpTextureDesc& d) {
        d.pixels = nullptr;
        d.file_data = "bytes";
    });
}

}  // namespace
