// Methods, settings and passes describe themselves, and a render takes what they say.
#include <thread>

#include "abi/expect.h"

using namespace trp_test;

namespace {

template <class Info>
void expect_guarded(uint32_t (*count)(void), TrpStatus (*read)(uint32_t, Info*)) {
    const uint32_t n = count();
    ASSERT_GT(n, 0u);
    Info info{};
    EXPECT_TRUE(fails(read(0, nullptr), TRP_ERROR_ARGUMENT, {"null"}));
    for (const uint32_t size : {0u, 4u, 12u, 1u << 20}) {
        info.struct_size = size;
        EXPECT_TRUE(fails(read(0, &info), TRP_ERROR_ARGUMENT, {"struct_size is " + std::to_string(size)}));
    }
    info.struct_size = sizeof info;
    for (const uint32_t index : {n, n + 1, ~0u})
        EXPECT_TRUE(fails(read(index, &info), TRP_ERROR_ARGUMENT, {std::to_string(index), std::to_string(n)}));
    // An older client's struct is filled as far as it goes, a newer one's ends in zeros.
    struct Wide {
        Info info;
        unsigned char more[32];
    } wide;
    std::memset(&wide, 0xab, sizeof wide);
    wide.info.struct_size = 8;
    ASSERT_EQ(read(0, &wide.info), TRP_OK);
    EXPECT_EQ(reinterpret_cast<unsigned char*>(&wide)[8], 0xab);
    EXPECT_EQ(wide.info.struct_size, 8u);
    wide.info.struct_size = sizeof wide;
    ASSERT_EQ(read(0, &wide.info), TRP_OK);
    for (const unsigned char byte : wide.more) EXPECT_EQ(byte, 0);
}

TEST(Tables, Guarded) {
    expect_guarded<TrpMethodInfo>(trp_method_count, trp_method_info);
    expect_guarded<TrpSettingInfo>(trp_setting_count, trp_setting_info);
    expect_guarded<TrpPassInfo>(trp_pass_count, trp_pass_info);
}

TEST(Tables, EveryMethodCanBeMade) {
    SmallScene scene;
    scene.commit();
    for (uint32_t i = 0; i < trp_method_count(); ++i) {
        TrpMethodInfo info{};
        info.struct_size = sizeof info;
        ASSERT_EQ(trp_method_info(i, &info), TRP_OK);
        EXPECT_STRNE(info.label, "");
        EXPECT_STRNE(info.description, "");
        TrpRender* render = nullptr;
        EXPECT_EQ(trp_render_create(scene, info.name, &render), TRP_OK) << info.name;
        trp_render_destroy(render);
    }
}

TEST(Tables, EveryPassIsRendered) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 24, 16, kFewSamples, {}, "path_tracing");  // which gives them all
    std::vector<std::string> names;
    for (uint32_t i = 0; i < trp_pass_count(); ++i) {
        TrpPassInfo info{};
        info.struct_size = sizeof info;
        ASSERT_EQ(trp_pass_info(i, &info), TRP_OK);
        EXPECT_EQ(std::strlen(info.channels), info.channel_count);
        EXPECT_GE(info.channel_count, 1u);
        EXPECT_LE(info.channel_count, 4u);
        EXPECT_STRNE(info.description, "");
        EXPECT_EQ(trp_render_add_pass(render, info.name), TRP_OK);
        EXPECT_EQ(trp_render_add_pass(render, info.name), TRP_OK) << "asking twice is no error";
        names.push_back(info.name);
    }
    render.run();
    for (const std::string& name : names)
        for (const float value : render.read(name.c_str()).values) ASSERT_TRUE(std::isfinite(value)) << name;
}

TEST(Tables, SettingsTakeTheirDefaultsAndRefuseTheRest) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 24, 16);
    const auto set = [&](const char* name, const std::string& value) {
        return trp_render_set(render, name, value.c_str());
    };
    for (uint32_t i = 0; i < trp_setting_count(); ++i) {
        TrpSettingInfo info{};
        info.struct_size = sizeof info;
        ASSERT_EQ(trp_setting_info(i, &info), TRP_OK);
        SCOPED_TRACE(info.name);
        EXPECT_STRNE(info.label, "");
        EXPECT_STRNE(info.description, "");
        EXPECT_STRNE(info.methods, "");
        EXPECT_NE(info.unit, nullptr);
        EXPECT_EQ(set(info.name, info.default_value), TRP_OK) << trp_error_message();
        for (const char* bad :
             {"", " ", "nonsense", "nan", "inf", "1e999", "1,2", "1,2,3,4", "1 2", "0x10", "--1", "1;"})
            EXPECT_TRUE(fails(set(info.name, bad), TRP_ERROR_ARGUMENT, {info.name, bad})) << "\"" << bad << "\"";
        EXPECT_TRUE(fails(trp_render_set(render, info.name, nullptr), TRP_ERROR_ARGUMENT, {"value"}));
        switch (info.type) {
            case TRP_TYPE_BOOL:
                for (const char* good : {"on", "off", "true", "false", "1", "0"})
                    EXPECT_EQ(set(info.name, good), TRP_OK);
                EXPECT_TRUE(fails(set(info.name, "2"), TRP_ERROR_ARGUMENT, {info.name, "2"}));
                break;
            case TRP_TYPE_INT:
                EXPECT_TRUE(fails(set(info.name, "2.5"), TRP_ERROR_ARGUMENT, {info.name, "2.5"}));
                [[fallthrough]];
            case TRP_TYPE_FLOAT:
                EXPECT_LT(info.minimum, info.maximum);
                EXPECT_TRUE(fails(set(info.name, "-1"), TRP_ERROR_ARGUMENT, {info.name, "-1"}));
                EXPECT_TRUE(fails(set(info.name, "99999999999"), TRP_ERROR_ARGUMENT, {info.name, "99999999999"}));
                break;
            case TRP_TYPE_COLOR:
                EXPECT_EQ(set(info.name, "0.1, 0.2, 0.3"), TRP_OK);
                EXPECT_TRUE(fails(set(info.name, "0,-1,0"), TRP_ERROR_ARGUMENT, {info.name, "-1"}));
                EXPECT_TRUE(fails(set(info.name, "0,nan,0"), TRP_ERROR_ARGUMENT, {info.name, "nan"}));
                break;
            case TRP_TYPE_ENUM:
                ASSERT_NE(info.choices, nullptr);
                for (const char* const* choice = info.choices; *choice; ++choice)
                    EXPECT_EQ(set(info.name, *choice), TRP_OK) << *choice;
                break;
            default:
                ADD_FAILURE() << "type " << info.type;
        }
        EXPECT_EQ(set(info.name, info.default_value), TRP_OK);
    }
    EXPECT_TRUE(fails(set("smaples", "16"), TRP_ERROR_ARGUMENT, {"smaples"}));
    EXPECT_TRUE(fails(set("", "16"), TRP_ERROR_ARGUMENT));
    EXPECT_TRUE(fails(trp_render_set(render, nullptr, "16"), TRP_ERROR_ARGUMENT, {"name"}));
    EXPECT_TRUE(fails(trp_render_set(nullptr, "samples", "16"), TRP_ERROR_ARGUMENT, {"render"}));
}

TEST(Tables, Version) {
    EXPECT_EQ(trp_version(), static_cast<uint32_t>(TRP_VERSION));
}

TEST(Errors, BelongToTheirThread) {
    EXPECT_TRUE(fails(trp_scene_commit(nullptr, 0), TRP_ERROR_ARGUMENT, {"scene"}));
    const std::string here = trp_error_message();
    std::string there_before, there_after;
    std::thread([&] {
        there_before = trp_error_message();
        trp_node_init(nullptr, 0);
        there_after = trp_error_message();
    }).join();
    EXPECT_EQ(there_before, "");
    EXPECT_NE(there_after, here);
    EXPECT_EQ(trp_error_message(), here);
    Scene scene;
    EXPECT_EQ(trp_error_message(), here) << "a call that succeeds leaves the message";
}

TEST(Errors, AreOneLineWhateverTheName) {
    Scene scene;
    TrpLightDesc desc;
    check(trp_light_desc_init(&desc, sizeof desc));
    desc.name = "two\r\nlines";
    desc.type = 99;
    uint32_t id = 0;
    EXPECT_TRUE(fails(trp_light_add(scene, &desc, &id), TRP_ERROR_ARGUMENT, {"two", "lines", "99"}));
}

}  // namespace
