// Damaged files: cut off anywhere, and with bytes changed. Each must load or end in one line that names the file; run
// under the address sanitizer, nothing may be read beyond its end. SPDX-License-Identifier: Apache-2.0
#include <random>

#include "loading.h"

namespace triptych::test {
namespace {

// A file that has something of everything.
GltfBuilder rich_scene() {
    GltfBuilder builder;
    const Square square;
    builder.root["extensionsUsed"] = {"KHR_lights_punctual", "FB_ngon_encoding", "EXT_mesh_gpu_instancing"};
    const std::vector<uint16_t> sparse_indices = {1, 3};
    const std::vector<float> sparse_values = {5, 6, 7, 8, 9, 10};
    const int position = builder.accessor(square.positions, float_type, "VEC3");
    builder.root["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", builder.view(sparse_indices)}, {"componentType", ushort_type}}},
        {"values", {{"bufferView", builder.view(sparse_values)}}}};
    const std::vector<uint8_t> colors(16, 100);
    const json attributes = {{"POSITION", position},
                             {"NORMAL", builder.accessor(square.normals, float_type, "VEC3")},
                             {"TEXCOORD_0", builder.accessor(square.uvs, float_type, "VEC2")},
                             {"COLOR_0", builder.accessor(colors, ubyte_type, "VEC4", true)}};
    const int indices = builder.accessor(square.indices, ushort_type, "SCALAR");
    const std::vector<unsigned char> picture(64, 7);
    builder.add("images", {{"bufferView", builder.view(picture)}, {"mimeType", "image/png"}});
    builder.add("textures", {{"source", 0}});
    builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                              {"extras", {{"triptych", {{"specular", {0.5, 0.5, 0.5}}, {"shininess", 20}}}}}});
    builder.add("materials",
                {{"extras",
                  {{"triptych",
                    {{"nodes", {{{"type", "image"}, {"texture", 0}}, {{"type", "multiply"}, {"inputs", {0, -1}}}}},
                     {"diffuse", {{"node", 1}}}}}}}});
    const json primitives = json::array({{{"attributes", attributes},
                                          {"indices", indices},
                                          {"material", 0},
                                          {"extensions", {{"FB_ngon_encoding", json::object()}}}},
                                         {{"attributes", attributes}, {"material", 1}, {"mode", 5}},
                                         {{"attributes", attributes}, {"mode", 2}}});
    builder.add("meshes", {{"primitives", primitives}});
    const std::vector<uint32_t> corners = {0, 1, 2, 3}, offsets = {0, 4}, edges = {0, 1, 2, 3};
    builder.add("meshes", {{"primitives", json::array()},
                           {"extras",
                            {{"triptych",
                              {{"positions", position},
                               {"corner_vertices", builder.accessor(corners, uint_type, "SCALAR")},
                               {"face_offsets", builder.accessor(offsets, uint_type, "SCALAR")},
                               {"edges", builder.accessor(edges, uint_type, "SCALAR")},
                               {"uv_sets", {{{"name", "UVMap"}, {"accessor", 2}, {"domain", "vertex"}}}}}}}}});
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"type", "spot"}, {"intensity", 5}}});
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}});
    builder.add("nodes", {{"mesh", 1}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}}});
    builder.add_node({{"mesh", 0},
                      {"children", {0}},
                      {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", 0}}}}}}}});
    builder.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.add_node({{"camera", 0}});
    builder.root["scenes"][0]["extras"]["triptych"] = {{"world", {{"radiance", {1, 1, 1}}, {"texture", 0}}},
                                                       {"film", {{"width", 64}, {"height", 64}}}};
    return builder;
}

// Loads bytes; true where they load. Fails the test for anything but an Error of one line with the file's name.
bool try_load(const std::filesystem::path& path, const std::vector<unsigned char>& bytes) {
    write_bytes(path, bytes);
    try {
        load(path);
        return true;
    } catch (const cli::Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0u) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_GT(message.size(), path.string().size() + 2) << message;
    }
    return false;
}

TEST(Fuzz, WholeFileLoads) {
    const Loaded loaded = load(rich_scene());
    EXPECT_EQ(loaded->meshes.size(), 3u);
}

TEST(Fuzz, CutOffAnywhere) {
    const std::filesystem::path path = test_folder("Fuzz.CutOffAnywhere") / "cut.glb";
    const std::vector<unsigned char> whole = rich_scene().glb();
    for (size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 64) {
        EXPECT_FALSE(try_load(path, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
    }
    // The same with a header that claims the shorter length.
    for (size_t size = 12; size < whole.size(); size += 64) {
        std::vector<unsigned char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        for (size_t k = 0; k < 4; ++k) cut[8 + k] = static_cast<unsigned char>(size >> (8 * k));
        EXPECT_FALSE(try_load(path, cut)) << size;
    }
}

TEST(Fuzz, ChangedBytes) {
    const std::filesystem::path path = test_folder("Fuzz.ChangedBytes") / "changed.glb";
    const std::vector<unsigned char> whole = rich_scene().glb();
    std::mt19937 random(20240229);
    int loaded = 0;
    for (int round = 0; round < 2000; ++round) {
        std::vector<unsigned char> changed = whole;
        const int count = 1 + static_cast<int>(random() % 4);
        for (int i = 0; i < count; ++i) changed[random() % changed.size()] = static_cast<unsigned char>(random());
        loaded += try_load(path, changed) ? 1 : 0;
    }
    EXPECT_GT(loaded, 0);
}

// Digits exchanged for digits keep the JSON whole: indices, counts and offsets go wrong instead.
TEST(Fuzz, ChangedNumbers) {
    const std::filesystem::path path = test_folder("Fuzz.ChangedNumbers") / "changed.glb";
    const std::vector<unsigned char> whole = rich_scene().glb();
    std::vector<size_t> digits;
    for (size_t i = 20; i < whole.size() && whole[i] != 0; ++i) {
        if (whole[i] >= '0' && whole[i] <= '9') digits.push_back(i);
    }
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        std::vector<unsigned char> changed = whole;
        const int count = 1 + static_cast<int>(random() % 3);
        for (int i = 0; i < count; ++i) {
            changed[digits[random() % digits.size()]] = static_cast<unsigned char>("0123456789-."[random() % 12]);
        }
        try_load(path, changed);
    }
}

}  // namespace
}  // namespace triptych::test
