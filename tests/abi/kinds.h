// The kinds of items, for tests that hold for each of them: mesh, instance, texture, material, light, camera.
#pragma once

#include "abi/expect.h"

namespace trp_test {

struct MeshKind {
    using Desc = TrpMeshDesc;
    static constexpr const char* kName = "mesh";
    static constexpr auto init = trp_mesh_desc_init;
    static constexpr auto add = trp_mesh_add;
    static constexpr auto replace = trp_mesh_replace;
    static constexpr auto remove = trp_mesh_remove;
    static void fill(Desc& desc) {
        static const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
        static const uint32_t corners[3] = {0, 1, 2};
        desc.positions = {positions, 3, 0, TRP_FORMAT_FLOAT32};
        desc.corner_vertices = {corners, 3, 0, TRP_FORMAT_UINT32};
    }
};

struct InstanceKind {
    using Desc = TrpInstanceDesc;
    static constexpr const char* kName = "instance";
    static constexpr auto init = trp_instance_desc_init;
    static constexpr auto add = trp_instance_add;
    static constexpr auto replace = trp_instance_replace;
    static constexpr auto remove = trp_instance_remove;
    static void fill(Desc& desc) { desc.mesh = 1; }
};

struct TextureKind {
    using Desc = TrpTextureDesc;
    static constexpr const char* kName = "texture";
    static constexpr auto init = trp_texture_desc_init;
    static constexpr auto add = trp_texture_add;
    static constexpr auto replace = trp_texture_replace;
    static constexpr auto remove = trp_texture_remove;
    static void fill(Desc& desc) {
        static const float pixels[3] = {1, 0.5f, 0.25f};
        desc.pixels = pixels;
        desc.width = desc.height = 1;
        desc.channels = 3;
    }
};

struct MaterialKind {
    using Desc = TrpMaterialDesc;
    static constexpr const char* kName = "material";
    static constexpr auto init = trp_material_desc_init;
    static constexpr auto add = trp_material_add;
    static constexpr auto replace = trp_material_replace;
    static constexpr auto remove = trp_material_remove;
    static void fill(Desc&) {}
};

struct LightKind {
    using Desc = TrpLightDesc;
    static constexpr const char* kName = "light";
    static constexpr auto init = trp_light_desc_init;
    static constexpr auto add = trp_light_add;
    static constexpr auto replace = trp_light_replace;
    static constexpr auto remove = trp_light_remove;
    static void fill(Desc&) {}
};

struct CameraKind {
    using Desc = TrpCameraDesc;
    static constexpr const char* kName = "camera";
    static constexpr auto init = trp_camera_desc_init;
    static constexpr auto add = trp_camera_add;
    static constexpr auto replace = trp_camera_replace;
    static constexpr auto remove = trp_camera_remove;
    static void fill(Desc&) {}
};

// A descriptor that can be added.
template <class Kind>
typename Kind::Desc valid() {
    typename Kind::Desc desc;
    check(Kind::init(&desc, sizeof desc));
    Kind::fill(desc);
    return desc;
}

template <class Kind>
uint32_t add_valid(TrpScene* scene) {
    const auto desc = valid<Kind>();
    uint32_t id = TRP_NO_ID;
    check(Kind::add(scene, &desc, &id));
    return id;
}

}  // namespace trp_test
