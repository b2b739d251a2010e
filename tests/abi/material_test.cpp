// Materials: coefficients, programs of nodes, and the table that describes node types.
#include "abi/kinds.h"

using namespace trp_test;

namespace {

TrpNode node(int32_t type) {
    TrpNode n;
    check(trp_node_init(&n, type));
    return n;
}

testing::AssertionResult refused(const std::vector<TrpNode>& nodes, const std::function<void(TrpMaterialDesc&)>& change,
                                 std::vector<std::string> words) {
    Scene scene;
    TrpMaterialDesc desc = valid<MaterialKind>();
    desc.name = "Culprit";
    desc.nodes = nodes.data();
    desc.node_count = static_cast<uint32_t>(nodes.size());
    if (change) change(desc);
    uint32_t id = 77;
    words.emplace_back("material \"Culprit\"");
    return fails(trp_material_add(scene, &desc, &id), TRP_ERROR_ARGUMENT, words);
}

TEST(Material, Coefficients) {
    struct Field {
        const char* name;
        TrpCoefficient TrpMaterialDesc::*of;
        int channels;
        float beyond;
    };
    const Field fields[] = {{"emission", &TrpMaterialDesc::emission, 3, -1},
                            {"ambient", &TrpMaterialDesc::ambient, 3, -1},
                            {"diffuse", &TrpMaterialDesc::diffuse, 3, -0.1f},
                            {"specular", &TrpMaterialDesc::specular, 3, -1},
                            {"shininess", &TrpMaterialDesc::shininess, 1, -1},
                            {"mirror", &TrpMaterialDesc::mirror, 3, -1},
                            {"transmission", &TrpMaterialDesc::transmission, 3, -1},
                            {"ior", &TrpMaterialDesc::ior, 1, 0},
                            {"alpha", &TrpMaterialDesc::alpha, 1, 1.5f}};
    for (const Field& field : fields) {
        for (int k = 0; k < field.channels; ++k)
            for (const float bad : {kNaN, kInfinity, -kInfinity, field.beyond})
                EXPECT_TRUE(refused({},
                                    [&](TrpMaterialDesc& d) {
                                        d.ambient_is_diffuse = d.mirror_is_specular = 0;
                                        (d.*field.of).value[k] = bad;
                                    },
                                    {std::string(field.name) + ".value[" + std::to_string(k) + "]"}));
        for (const int32_t bad : {-2, 0, 5})
            EXPECT_TRUE(refused({},
                                [&](TrpMaterialDesc& d) {
                                    d.ambient_is_diffuse = d.mirror_is_specular = 0;
                                    (d.*field.of).node = bad;
                                },
                                {std::string(field.name) + ".node is " + std::to_string(bad), "0 nodes"}));
    }
}

TEST(Material, Nodes) {
    TrpNode bad = node(TRP_NODE_CONSTANT);
    EXPECT_TRUE(fails(trp_node_init(nullptr, TRP_NODE_CONSTANT), TRP_ERROR_ARGUMENT, {"node"}));
    EXPECT_TRUE(fails(trp_node_init(&bad, 16), TRP_ERROR_ARGUMENT, {"16"}));
    EXPECT_TRUE(fails(trp_node_init(&bad, -1), TRP_ERROR_ARGUMENT, {"-1"}));
    for (const int32_t type : {-1, 16, 1 << 30}) {
        bad.type = type;
        EXPECT_TRUE(refused({node(TRP_NODE_UV), bad}, {}, {"nodes[1]", "type is " + std::to_string(type)}));
    }
    for (const float value : {kNaN, kInfinity, -kInfinity}) {
        bad = node(TRP_NODE_MIX);
        bad.value3[2] = value;
        EXPECT_TRUE(refused({bad}, {}, {"nodes[0]", "value3[2]"}));
        bad = node(TRP_NODE_CONSTANT);
        bad.value[0] = value;
        EXPECT_TRUE(refused({bad}, {}, {"nodes[0]", "value[0]"}));
    }
    // A node reads only nodes before it.
    for (const int32_t input : {1, 2, -2, 1 << 30}) {
        bad = node(TRP_NODE_ADD);
        bad.inputs[1] = input;
        EXPECT_TRUE(refused({node(TRP_NODE_UV), bad}, {}, {"nodes[1].inputs[1] is " + std::to_string(input)}));
    }
    bad = node(TRP_NODE_CHANNEL);
    for (const float channel : {-1.0f, 4.0f}) {
        bad.value[0] = channel;
        EXPECT_TRUE(refused({bad}, {}, {"nodes[0]", "value[0]"}));
    }
    EXPECT_TRUE(refused({node(TRP_NODE_IMAGE)}, {}, {"nodes[0]", "texture"}));
    EXPECT_TRUE(refused({}, [](TrpMaterialDesc& d) { d.node_count = 2; }, {"nodes is null", "2"}));
    const TrpNode one = node(TRP_NODE_UV);
    EXPECT_TRUE(refused({},
                        [&](TrpMaterialDesc& d) {
                            d.nodes = &one;
                            d.node_count = 100000;
                        },
                        {"100000"}));
    for (const int32_t normal : {-2, 1, 99})
        EXPECT_TRUE(refused({one}, [&](TrpMaterialDesc& d) { d.normal = normal; },
                            {"normal is " + std::to_string(normal), "1 nodes"}));
    EXPECT_TRUE(refused({one}, [](TrpMaterialDesc& d) { d.normal = 0; }, {"normal names nodes[0]"}));
}

// Every type of node is described, and one that the table describes is taken and rendered.
TEST(Material, EveryNodeType) {
    EXPECT_EQ(trp_node_count(), 16u);
    TrpNodeInfo info{};
    EXPECT_TRUE(fails(trp_node_info(0, nullptr), TRP_ERROR_ARGUMENT, {"null"}));
    EXPECT_TRUE(fails(trp_node_info(0, &info), TRP_ERROR_ARGUMENT, {"struct_size is 0"}));
    info.struct_size = sizeof info;
    EXPECT_TRUE(fails(trp_node_info(trp_node_count(), &info), TRP_ERROR_ARGUMENT, {"16"}));
    SmallScene scene;
    const uint32_t texture = add_valid<TextureKind>(scene);
    for (uint32_t i = 0; i < trp_node_count(); ++i) {
        ASSERT_EQ(trp_node_info(i, &info), TRP_OK);
        EXPECT_EQ(info.type, static_cast<int32_t>(i));
        EXPECT_STRNE(info.name, "");
        EXPECT_STRNE(info.description, "");
        EXPECT_LE(info.input_count, static_cast<uint32_t>(TRP_NODE_INPUTS));
        std::vector<TrpNode> nodes = {node(TRP_NODE_UV), node(info.type)};
        for (uint32_t k = 0; k < info.input_count; ++k) nodes[1].inputs[k] = 0;
        nodes[1].texture = texture;
        TrpMaterialDesc desc = valid<MaterialKind>();
        desc.nodes = nodes.data();
        desc.node_count = 2;
        if (info.type == TRP_NODE_NORMAL_MAP)
            desc.normal = 1;
        else
            desc.diffuse.node = 1;
        ASSERT_EQ(trp_material_replace(scene, scene.red, &desc), TRP_OK) << info.name << ": " << trp_error_message();
        for (const float value : scene.picture().values) ASSERT_TRUE(std::isfinite(value)) << info.name;
    }
}

}  // namespace
