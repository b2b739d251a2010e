// Materials: metallic-roughness as coefficients, textures, and extras. SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "loading.h"

namespace triptych::test {
namespace {

const Square square;

// A square with this material (and more attributes); gives the loaded scene.
struct MaterialScene : GltfBuilder {
    MaterialScene(json material, bool colors) {
        add("materials", std::move(material));
        json attributes = {{"POSITION", accessor(square.positions, float_type, "VEC3")},
                           {"TEXCOORD_0", accessor(square.uvs, float_type, "VEC2")},
                           {"TEXCOORD_1", accessor(square.uvs, float_type, "VEC2")}};
        if (colors) attributes["COLOR_0"] = accessor(std::vector<float>(16, 0.5f), float_type, "VEC4");
        add_mesh_node({{"attributes", attributes},
                       {"indices", accessor(square.indices, ushort_type, "SCALAR")},
                       {"material", 0}});
    }
    // A texture with an embedded picture (its bytes have no meaning here).
    int add_texture() {
        const std::vector<unsigned char> bytes = {1, 2, 3, 4};
        const int image = add("images", {{"bufferView", view(bytes)}, {"mimeType", "image/png"}});
        return add("textures", {{"source", image}});
    }
};

void expect_color(const std::array<float, 4>& color, float r, float g, float b) {
    EXPECT_NEAR(color[0], r, 1e-5f);
    EXPECT_NEAR(color[1], g, 1e-5f);
    EXPECT_NEAR(color[2], b, 1e-5f);
}

TEST(Material, ConstantsNeedNoNodes) {
    MaterialScene builder(
        {{"name", "paint"},
         {"doubleSided", true},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.8, 0.4, 0.2, 1}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.5}}}},
        false);
    const Loaded loaded = load(builder);
    const RecordedMaterial& material = loaded->materials[0];
    EXPECT_EQ(material.name, "paint");
    EXPECT_TRUE(material.nodes.empty());
    expect_color(evaluate(material, material.desc.diffuse), 0.6f, 0.3f, 0.15f);
    expect_color(evaluate(material, material.desc.mirror), 0.03f + 0.2f, 0.03f + 0.1f, 0.03f + 0.05f);
    // alpha = 1/4, alpha² = 1/16: Blinn 30, Phong 7.5, whose peak is (7.5 + 2)/2 times the mirror; at most 1
    EXPECT_NEAR(material.desc.shininess.value[0], 7.5f, 1e-4f);
    expect_color(evaluate(material, material.desc.specular), 1, 0.13f * 4.75f, 0.08f * 4.75f);
    EXPECT_EQ(material.desc.double_sided, 1);
    EXPECT_EQ(material.desc.mirror_is_specular, 0);
}

TEST(Material, ExtremesOfRoughness) {
    for (const float roughness : {0.0f, 1.0f}) {
        MaterialScene builder({{"pbrMetallicRoughness", {{"roughnessFactor", roughness}}}}, false);
        const Loaded loaded = load(builder);
        EXPECT_NEAR(loaded->materials[0].desc.shininess.value[0], roughness == 0.0f ? 399.5f : 0.0f, 0.1f);
    }
}

TEST(Material, TexturedMetalRoughness) {
    json pbr = {{"baseColorFactor", {0.5, 1, 1, 1}},
                {"baseColorTexture", {{"index", 0}}},
                {"metallicRoughnessTexture", {{"index", 1}}}};
    MaterialScene builder({{"pbrMetallicRoughness", pbr}}, true);
    builder.add_texture();
    builder.add_texture();
    const Loaded loaded = load(builder);
    const RecordedMaterial& material = loaded->materials[0];
    // The same value stands for both pictures: g = roughness 0.5, b = metal 0.25. Vertex colours of one half.
    const std::array<float, 4> image = {0.8f, 0.5f, 0.25f, 1.0f}, color = {0.5f, 0.5f, 0.5f, 1.0f};
    const float base[3] = {0.8f * 0.5f * 0.5f, 0.5f * 0.5f, 0.25f * 0.5f};
    expect_color(evaluate(material, material.desc.diffuse, image, color), base[0] * 0.75f, base[1] * 0.75f,
                 base[2] * 0.75f);
    expect_color(evaluate(material, material.desc.mirror, image, color), 0.03f + base[0] * 0.25f,
                 0.03f + base[1] * 0.25f, 0.03f + base[2] * 0.25f);
    EXPECT_NEAR(evaluate(material, material.desc.shininess, image, color)[0], 7.5f, 1e-3f);
    EXPECT_EQ(loaded->textures[0].desc.color_space, TRP_COLOR_SPACE_SRGB);
    EXPECT_EQ(loaded->textures[1].desc.color_space, TRP_COLOR_SPACE_LINEAR);
}

TEST(Material, OnePictureInTwoColorSpaces) {
    MaterialScene builder({{"pbrMetallicRoughness",
                            {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 0}}}}}},
                          false);
    builder.add_texture();
    EXPECT_EQ(load(builder)->textures.size(), 2u);
}

// A point of the picture, from glTF's uv through the transform, must be the same point seen with v up.
TEST(Material, TextureTransform) {
    const float offset[2] = {0.3f, -0.2f}, scale[2] = {2.0f, 0.5f}, rotation = 0.7f;
    json info = {
        {"index", 0},
        {"extensions",
         {{"KHR_texture_transform", {{"offset", offset}, {"scale", scale}, {"rotation", rotation}, {"texCoord", 1}}}}}};
    MaterialScene builder({{"pbrMetallicRoughness", {{"baseColorTexture", info}}}}, false);
    builder.add_texture();
    const Loaded loaded = load(builder);
    const RecordedMaterial& material = loaded->materials[0];
    int transform = -1;
    for (size_t i = 0; i < material.nodes.size(); ++i) {
        if (material.nodes[i].type == TRP_NODE_UV_TRANSFORM) transform = static_cast<int>(i);
        if (material.nodes[i].type == TRP_NODE_UV) {
            EXPECT_EQ(material.nodes[i].text, "TEXCOORD_1");
        }
    }
    ASSERT_GE(transform, 0);
    const float u = 0.4f, v = 0.9f;
    const auto up = evaluate_node(material, transform, {1, 1, 1, 1}, {1, 1, 1, 1}, {u, 1.0f - v});
    // Counter-clockwise on the screen, where v runs down.
    const float su = scale[0] * u, sv = scale[1] * v, c = std::cos(rotation), s = std::sin(rotation);
    EXPECT_NEAR(up[0], c * su + s * sv + offset[0], 1e-5f);
    EXPECT_NEAR(1.0f - up[1], -s * su + c * sv + offset[1], 1e-5f);
}

TEST(Material, Alpha) {
    const json pbr = {{"baseColorFactor", {1, 1, 1, 0.5}}, {"baseColorTexture", {{"index", 0}}}};
    for (const char* mode : {"OPAQUE", "BLEND", "MASK"}) {
        MaterialScene builder({{"alphaMode", mode}, {"alphaCutoff", 0.25}, {"pbrMetallicRoughness", pbr}}, false);
        builder.add_texture();
        const Loaded loaded = load(builder);
        const RecordedMaterial& material = loaded->materials[0];
        const auto alpha = [&](float picture) {
            return evaluate(material, material.desc.alpha, {1, 1, 1, picture})[0];
        };
        const std::string name = mode;
        EXPECT_FLOAT_EQ(alpha(0.75f), name == "BLEND" ? 0.375f : 1.0f) << mode;
        EXPECT_FLOAT_EQ(alpha(0.5f), name == "BLEND" ? 0.25f : 1.0f) << mode << ": opaque at the cutoff itself";
        EXPECT_FLOAT_EQ(alpha(0.4f), name == "BLEND" ? 0.2f : name == "MASK" ? 0.0f : 1.0f) << mode;
    }
}

TEST(Material, Extensions) {
    MaterialScene builder(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0.5, 1, 1, 1}}}},
         {"emissiveFactor", {1, 0.5, 0}},
         {"extensions",
          {{"KHR_materials_ior", {{"ior", 2.0}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.75}}},
           {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 2}}},
           {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 0}}}},
           {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}},
        false);
    const Loaded loaded = load(builder);
    const RecordedMaterial& material = loaded->materials[0];
    const float f0 = 1.0f / 9.0f;
    EXPECT_FLOAT_EQ(material.desc.ior.value[0], 2.0f);
    expect_color(evaluate(material, material.desc.specular), 0.5f * f0, 0.25f * f0, 0);
    expect_color(evaluate(material, material.desc.transmission), 0.375f, 0.75f, 0.75f);
    expect_color(evaluate(material, material.desc.diffuse), 0.125f, 0.25f, 0.25f);
    expect_color(evaluate(material, material.desc.emission), 4, 2, 0);
    EXPECT_EQ(material.desc.thin, 0);
    EXPECT_EQ(material.desc.double_sided, 1);
    EXPECT_EQ(material.desc.fresnel, 1);
    EXPECT_FLOAT_EQ(material.desc.mirror.value[0], 1);
    EXPECT_EQ(material.desc.absorption[0], 0) << "no colour: clear at every distance";
    EXPECT_FALSE(loaded.scene.needs_light) << "what emits is a light";
}

// Coefficients of extras stand for those that the PBR fields make, with what belongs to them.
TEST(Material, ExtrasReplaceMirrorsOfPbr) {
    MaterialScene builder(
        {{"extras", {{"triptych", {{"specular", {0.3, 0.2, 0.1}}, {"transmission", 0.5}}}}},
         {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
         {"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {0.5, 1, 0.25}}}}}}},
        false);
    const Loaded loaded = load(builder);
    const TrpMaterialDesc& desc = loaded->materials[0].desc;
    EXPECT_EQ(desc.mirror_is_specular, 1);
    EXPECT_EQ(desc.fresnel, 0);
    EXPECT_NEAR(desc.absorption[0], -std::log(0.5) / 2, 1e-6) << "half of the light is left after two metres";
    EXPECT_EQ(desc.absorption[1], 0);
    EXPECT_NEAR(desc.absorption[2], -std::log(0.25) / 2, 1e-6);
}

TEST(Material, ThinWithoutVolumeAndUnlit) {
    MaterialScene thin({{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}}, false);
    EXPECT_EQ(load(thin)->materials[0].desc.thin, 1);
    MaterialScene unlit({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}},
                         {"extensions", {{"KHR_materials_unlit", json::object()}}}},
                        false);
    const Loaded loaded = load(unlit);
    expect_color(evaluate(loaded->materials[0], loaded->materials[0].desc.emission), 0.5f, 0.25f, 1);
    expect_color(evaluate(loaded->materials[0], loaded->materials[0].desc.diffuse), 0, 0, 0);
}

// Labels that glow are no reason to leave the rest of the scene dark.
TEST(Material, GlowIsNoLight) {
    const auto needs_light = [](const json& material) {
        MaterialScene builder(material, false);
        builder.add_texture();
        return load(builder).scene.needs_light;
    };
    const json glow = {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 0}}}};
    json strong = glow;
    strong["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 5;
    EXPECT_TRUE(needs_light(glow));
    EXPECT_TRUE(needs_light({{"extensions", {{"KHR_materials_unlit", json::object()}}}}));
    EXPECT_FALSE(needs_light(strong));
    EXPECT_FALSE(needs_light({{"emissiveFactor", {1, 1, 1}}}));
    EXPECT_FALSE(needs_light({{"extras", {{"triptych", {{"emission", {5, 5, 5}}}}}}}));
    EXPECT_TRUE(needs_light({{"extras", {{"triptych", {{"emission", {0, 0, 0}}}}}}}));
}

TEST(Material, NormalMap) {
    MaterialScene builder({{"normalTexture", {{"index", 0}, {"scale", 0.5}, {"texCoord", 1}}}}, false);
    builder.add_texture();
    const Loaded loaded = load(builder);
    const RecordedMaterial& material = loaded->materials[0];
    ASSERT_GE(material.desc.normal, 0);
    const RecordedNode& node = material.nodes[static_cast<size_t>(material.desc.normal)];
    EXPECT_EQ(node.type, TRP_NODE_NORMAL_MAP);
    EXPECT_FLOAT_EQ(node.value[0], 0.5f);
    EXPECT_EQ(node.text, "TEXCOORD_1");
    EXPECT_EQ(material.nodes[static_cast<size_t>(node.inputs[0])].type, TRP_NODE_IMAGE);
}

TEST(Material, ClassicExtras) {
    MaterialScene builder({{"extras",
                            {{"triptych",
                              {{"ambient", {0.1, 0.2, 0.3}},
                               {"diffuse", {0.7, 0.6, 0.5}},
                               {"specular", 0.9},
                               {"shininess", 50},
                               {"mirror", {0, 0, 0}},
                               {"transmission", {0.25, 0.25, 0.25}},
                               {"ior", 1.33},
                               {"thin", true},
                               {"diffuze", 1}}}}}},
                          false);
    const Loaded loaded = load(builder);
    const TrpMaterialDesc& desc = loaded->materials[0].desc;
    EXPECT_FLOAT_EQ(desc.ambient.value[2], 0.3f);
    EXPECT_EQ(desc.ambient_is_diffuse, 0);
    EXPECT_FLOAT_EQ(desc.diffuse.value[0], 0.7f);
    EXPECT_FLOAT_EQ(desc.specular.value[1], 0.9f);
    EXPECT_FLOAT_EQ(desc.shininess.value[0], 50.0f);
    EXPECT_EQ(desc.mirror_is_specular, 0);
    EXPECT_FLOAT_EQ(desc.transmission.value[0], 0.25f);
    EXPECT_FLOAT_EQ(desc.ior.value[0], 1.33f);
    EXPECT_EQ(desc.thin, 1);
    EXPECT_TRUE(loaded.warns("materials[0].extras.triptych: unknown key 'diffuze'"));
}

TEST(Material, NodesOfExtras) {
    const json nodes = json::array({{{"type", "uv"}, {"name", "UVMap"}},
                                    {{"type", "image"}, {"inputs", {0}}, {"texture", 0}},
                                    {{"type", "multiply"}, {"inputs", {1, -1}}, {"value2", {0.5, 0.5, 0.5, 1}}},
                                    {{"type", "normal_map"}, {"inputs", {1}}, {"value", {0.25}}, {"name", "UVMap"}}});
    MaterialScene builder(
        {{"extras",
          {{"triptych",
            {{"nodes", nodes}, {"diffuse", {{"value", {1, 1, 1}}, {"node", 2}}}, {"normal", 3}, {"index", 4}}}}}},
        false);
    builder.add_texture();
    const Loaded loaded = load(builder);
    const RecordedMaterial& material = loaded->materials[0];
    ASSERT_EQ(material.nodes.size(), 4u);
    EXPECT_EQ(material.nodes[0].text, "UVMap");
    EXPECT_EQ(material.nodes[1].texture, 1u);
    expect_color(evaluate(material, material.desc.diffuse, {0.8f, 0.4f, 0.2f, 1}), 0.4f, 0.2f, 0.1f);
    EXPECT_FLOAT_EQ(material.nodes[3].value[0], 0.25f);
    EXPECT_EQ(material.desc.normal, 3);
    EXPECT_EQ(material.desc.index, 4);
    expect_color(evaluate(material, material.desc.specular), 0, 0, 0);
    EXPECT_EQ(material.desc.double_sided, 1) << "the core's defaults, not glTF's";
}

TEST(Material, MistakesInExtras) {
    const auto error = [](const json& extras) {
        return error_of(MaterialScene({{"extras", {{"triptych", extras}}}}, false));
    };
    EXPECT_CONTAINS(error({{"diffuse", {1, 2}}}),
                    "materials[0].extras.triptych.diffuse: expected an array of 3 numbers");
    EXPECT_CONTAINS(error({{"shininess", "x"}}), "shininess");
    EXPECT_CONTAINS(error({{"diffuse", {{"node", 0}}}}), "diffuse.node: 0 is not an index below 0");
    EXPECT_CONTAINS(error({{"nodes", {{{"type", "noise"}}}}}), "there is no node 'noise'");
    EXPECT_CONTAINS(error({{"nodes", {{{"type", "add"}, {"inputs", {0, 0}}}}}}),
                    "inputs[0]: 0 is not an index below 0");
}

TEST(Material, Pictures) {
    const std::filesystem::path folder = test_folder("Material.Pictures");
    write_bytes(folder / "a picture.png", {9, 8, 7});
    MaterialScene builder({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                           {"emissiveTexture", {{"index", 1}}},
                           {"emissiveFactor", {1, 1, 1}},
                           {"normalTexture", {{"index", 2}}}},
                          false);
    builder.add("images", {{"uri", "a%20picture.png"}});
    builder.add("images", {{"uri", "data:image/png;base64," + base64({5, 6, 7, 8, 9})}});
    builder.add("images", {{"uri", "missing.png"}});
    builder.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    builder.add("textures", {{"source", 0}, {"sampler", 0}});
    builder.add("textures",
                {{"source", 1}, {"extras", {{"triptych", {{"color_space", "linear"}, {"wrap", {"black", "clamp"}}}}}}});
    builder.add("textures", {{"source", 2}});
    const Loaded loaded = load(builder.write(folder, "scene.gltf"));
    ASSERT_EQ(loaded->textures.size(), 3u);
    const auto find = [&](const std::string& part) {
        return *std::find_if(loaded->textures.begin(), loaded->textures.end(), [&](const RecordedTexture& texture) {
            return texture.name.find(part) != std::string::npos;
        });
    };
    const RecordedTexture external = find("picture.png");
    EXPECT_EQ(std::filesystem::path(external.path), folder / "a picture.png");
    EXPECT_EQ(external.desc.wrap_u, TRP_WRAP_CLAMP);
    EXPECT_EQ(external.desc.wrap_v, TRP_WRAP_MIRROR);
    EXPECT_EQ(external.desc.filter, TRP_FILTER_NEAREST);
    const RecordedTexture embedded = find("images[1]");
    EXPECT_EQ(embedded.bytes, (std::vector<unsigned char>{5, 6, 7, 8, 9}));
    EXPECT_EQ(embedded.desc.color_space, TRP_COLOR_SPACE_LINEAR);
    EXPECT_EQ(embedded.desc.wrap_u, TRP_WRAP_BLACK);
    const RecordedTexture missing = find("missing.png");
    EXPECT_EQ(missing.pixels, (std::vector<float>{1, 0, 1}));
    EXPECT_TRUE(loaded.warns("picture 'missing.png': no such file; magenta stands in"));
}

}  // namespace
}  // namespace triptych::test
