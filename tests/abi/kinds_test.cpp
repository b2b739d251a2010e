// What holds for items of every kind: null arguments, struct sizes, ids.
#include "abi/kinds.h"

using namespace trp_test;

namespace {

template <class T>
class Items : public testing::Test {};
using Kinds = testing::Types<MeshKind, InstanceKind, TextureKind, MaterialKind, LightKind, CameraKind>;
struct KindName {
    template <class T>
    static std::string GetName(int) {
        return T::kName;
    }
};
TYPED_TEST_SUITE(Items, Kinds, KindName);

TYPED_TEST(Items, NullArgumentsAreNamed) {
    Scene scene;
    auto desc = valid<TypeParam>();
    uint32_t id = 77;
    EXPECT_TRUE(fails(TypeParam::init(nullptr, sizeof desc), TRP_ERROR_ARGUMENT, {"null"}));
    EXPECT_TRUE(fails(TypeParam::add(nullptr, &desc, &id), TRP_ERROR_ARGUMENT, {"scene is null"}));
    EXPECT_TRUE(fails(TypeParam::add(scene, nullptr, &id), TRP_ERROR_ARGUMENT, {"desc is null"}));
    EXPECT_TRUE(fails(TypeParam::add(scene, &desc, nullptr), TRP_ERROR_ARGUMENT, {"id is null"}));
    EXPECT_EQ(id, 77u) << "a call that fails writes nothing";
    id = add_valid<TypeParam>(scene);
    EXPECT_TRUE(fails(TypeParam::replace(nullptr, id, &desc), TRP_ERROR_ARGUMENT, {"scene is null"}));
    EXPECT_TRUE(fails(TypeParam::replace(scene, id, nullptr), TRP_ERROR_ARGUMENT, {"desc is null"}));
    EXPECT_TRUE(fails(TypeParam::remove(nullptr, id), TRP_ERROR_ARGUMENT, {"scene is null"}));
    EXPECT_EQ(TypeParam::remove(scene, id), TRP_OK);
}

TYPED_TEST(Items, InitWritesTheCallersBytesAlone) {
    using Desc = typename TypeParam::Desc;
    union {
        Desc desc;
        unsigned char bytes[sizeof(Desc) + 64];
    } memory;
    for (const size_t size : {size_t{0}, size_t{3}, size_t{4}, size_t{7}, sizeof(Desc) - 4, size_t{1} << 20}) {
        std::memset(&memory, 0xab, sizeof memory);
        EXPECT_TRUE(
            fails(TypeParam::init(&memory.desc, size), TRP_ERROR_ARGUMENT, {"struct_size", std::to_string(size)}));
        EXPECT_EQ(memory.bytes[0], 0xab);
    }
    // An older client's struct.
    std::memset(&memory, 0xab, sizeof memory);
    ASSERT_EQ(TypeParam::init(&memory.desc, sizeof(Desc) - 8), TRP_OK);
    EXPECT_EQ(memory.desc.struct_size, sizeof(Desc) - 8);
    for (size_t i = sizeof(Desc) - 8; i < sizeof memory; ++i) EXPECT_EQ(memory.bytes[i], 0xab) << i;
    // A newer client's: what this library does not know is 0.
    std::memset(&memory, 0xab, sizeof memory);
    ASSERT_EQ(TypeParam::init(&memory.desc, sizeof(Desc) + 56), TRP_OK);
    EXPECT_EQ(memory.desc.struct_size, sizeof(Desc) + 56);
    for (size_t i = sizeof(Desc); i < sizeof(Desc) + 56; ++i) EXPECT_EQ(memory.bytes[i], 0) << i;
    for (size_t i = sizeof(Desc) + 56; i < sizeof memory; ++i) EXPECT_EQ(memory.bytes[i], 0xab) << i;
}

TYPED_TEST(Items, StructSizesOfOtherVersionsWork) {
    using Desc = typename TypeParam::Desc;
    Scene scene;
    union {
        Desc desc;
        unsigned char bytes[sizeof(Desc) + 64];
    } memory;
    std::memset(&memory, 0xff, sizeof memory);
    memory.desc = valid<TypeParam>();
    uint32_t id = TRP_NO_ID;
    // A size within a pointer would let half of it be read.
    for (const uint32_t size : {0u, 1u, 4u, 9u, 12u, 20u, static_cast<uint32_t>(sizeof(Desc)) - 4, 1u << 20, ~0u}) {
        memory.desc.struct_size = size;
        EXPECT_TRUE(fails(TypeParam::add(scene, &memory.desc, &id), TRP_ERROR_ARGUMENT,
                          {"desc", "struct_size is " + std::to_string(size)}));
    }
    memory.desc.struct_size = sizeof memory;
    EXPECT_EQ(TypeParam::add(scene, &memory.desc, &id), TRP_OK) << trp_error_message();
    EXPECT_EQ(TypeParam::replace(scene, id, &memory.desc), TRP_OK);
    // What lies beyond an older client's struct is not ours to read: NaN and wild numbers.
    memory.desc.struct_size = sizeof(Desc) - 8;
    std::memset(memory.bytes + sizeof(Desc) - 8, 0xff, 8);
    EXPECT_EQ(TypeParam::add(scene, &memory.desc, &id), TRP_OK) << trp_error_message();
    EXPECT_EQ(TypeParam::replace(scene, id, &memory.desc), TRP_OK);
}

TYPED_TEST(Items, RemovedAndUnknownIds) {
    Scene scene;
    const auto desc = valid<TypeParam>();
    const uint32_t id = add_valid<TypeParam>(scene);
    EXPECT_NE(id, TRP_NO_ID);
    ASSERT_EQ(TypeParam::remove(scene, id), TRP_OK);
    for (const uint32_t bad : {id, TRP_NO_ID, 12345u, ~0u}) {
        const std::vector<std::string> words = {TypeParam::kName, std::to_string(bad)};
        EXPECT_TRUE(fails(TypeParam::remove(scene, bad), TRP_ERROR_ID, words));
        EXPECT_TRUE(fails(TypeParam::replace(scene, bad, &desc), TRP_ERROR_ID, words));
    }
    EXPECT_GT(add_valid<TypeParam>(scene), id) << "ids are never used again";
}

TYPED_TEST(Items, IdsOfAnotherKind) {
    Scene scene;
    const auto desc = valid<TypeParam>();
    const uint32_t own = add_valid<TypeParam>(scene);
    const uint32_t ids[] = {add_valid<MeshKind>(scene),    add_valid<InstanceKind>(scene),
                            add_valid<TextureKind>(scene), add_valid<MaterialKind>(scene),
                            add_valid<LightKind>(scene),   add_valid<CameraKind>(scene)};
    const char* const kinds[] = {"mesh", "instance", "texture", "material", "light", "camera"};
    for (int k = 0; k < 6; ++k) {
        if (std::string(kinds[k]) == TypeParam::kName) continue;
        const std::vector<std::string> words = {TypeParam::kName, std::to_string(ids[k])};
        EXPECT_TRUE(fails(TypeParam::replace(scene, ids[k], &desc), TRP_ERROR_ID, words));
        EXPECT_TRUE(fails(TypeParam::remove(scene, ids[k]), TRP_ERROR_ID, words));
    }
    EXPECT_EQ(TypeParam::remove(scene, own), TRP_OK);
}

}  // namespace
