// Files: pictures that are written whole or not at all, and textures from files, memory and pixels.
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "abi/expect.h"

using namespace trp_test;
namespace fs = std::filesystem;

namespace {

// A folder of the test's own.
struct Folder {
    fs::path path = fs::temp_directory_path() / ("triptych_abi_" + std::to_string(getpid()));
    Folder() {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string operator/(const char* name) const { return (path / name).string(); }
    std::vector<std::string> names() const {
        std::vector<std::string> out;
        for (const auto& entry : fs::recursive_directory_iterator(path))
            out.push_back(entry.path().filename().string());
        std::sort(out.begin(), out.end());
        return out;
    }
};

std::string contents(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Files, PicturesAreWrittenWhole) {
    const Folder folder;
    SmallScene scene;
    scene.commit();
    Render render(scene, 40, 24, kFewSamples, {"Depth"});
    render.run();
    for (const char* name : {"picture.exr", "picture.png", "PICTURE.EXR"}) {
        const std::string path = folder / name;
        std::ofstream(path) << "old";
        ASSERT_EQ(trp_render_write(render, path.c_str()), TRP_OK) << trp_error_message();
        EXPECT_GT(fs::file_size(path), 100u);
    }
    EXPECT_EQ(contents(folder / "picture.exr").substr(0, 4), "\x76\x2f\x31\x01");
    EXPECT_EQ(contents(folder / "picture.png").substr(1, 3), "PNG");
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"PICTURE.EXR", "picture.exr", "picture.png"}));
}

TEST(Files, BadPathsLeaveNothingBehind) {
    const Folder folder;
    SmallScene scene;
    scene.commit();
    Render render(scene, 8, 8, kFewSamples);
    render.run();
    EXPECT_TRUE(fails(trp_render_write(render, nullptr), TRP_ERROR_ARGUMENT, {"path"}));
    for (const char* name : {"kept.jpg", "kept", "kept.exr.txt", ".exr"}) {
        const std::string path = folder / name;
        std::ofstream(path) << "old";
        EXPECT_TRUE(fails(trp_render_write(render, path.c_str()), TRP_ERROR_ARGUMENT, {path, ".exr"}));
        EXPECT_EQ(contents(path), "old");
        fs::remove(path);
    }
    EXPECT_TRUE(fails(trp_render_write(render, ""), TRP_ERROR_ARGUMENT));
    std::ofstream(folder / "file") << "old";
    fs::create_directory(folder / "folder.png");
    for (const char* name : {"missing/picture.exr", "missing/picture.png", "file/picture.exr", "folder.png"}) {
        const std::string path = folder / name;
        EXPECT_TRUE(fails(trp_render_write(render, path.c_str()), TRP_ERROR_FILE, {path}));
    }
    EXPECT_TRUE(fails(trp_render_write(render, "/proc/picture.exr"), TRP_ERROR_FILE, {"/proc/picture.exr"}));
    if (geteuid() != 0) {  // root writes everywhere
        fs::create_directory(folder / "closed");
        std::ofstream(folder / "closed/picture.exr") << "old";
        fs::permissions(folder / "closed", fs::perms::owner_read | fs::perms::owner_exec);
        const std::string path = folder / "closed/picture.exr";
        EXPECT_TRUE(fails(trp_render_write(render, path.c_str()), TRP_ERROR_FILE, {path}));
        EXPECT_EQ(contents(path), "old");
        fs::permissions(folder / "closed", fs::perms::owner_all);
        fs::remove_all(folder / "closed");
    }
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"file", "folder.png"}));
    EXPECT_EQ(contents(folder / "file"), "old");
}

// The disk is full half-way, as a limit on the size of files makes believe.
TEST(Files, FullDisk) {
    const Folder folder;
    Scene scene;
    scene.camera_above(4);
    scene.world({1, 2, 3});
    scene.commit();
    Render render(scene, 256, 256, {{"samples", "1"}}, {"Position", "Normal", "UV"});
    render.run();
    // The image library is loaded before the limit stands.
    ASSERT_EQ(trp_render_write(render, (folder / "first.png").c_str()), TRP_OK);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    for (const char* name : {"picture.exr", "picture.png"}) {
        const std::string path = folder / name;
        std::ofstream(path) << "old";
        const rlimit small{256, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
        const TrpStatus status = trp_render_write(render, path.c_str());
        setrlimit(RLIMIT_FSIZE, &before);
        EXPECT_TRUE(fails(status, TRP_ERROR_FILE, {path}));
        EXPECT_EQ(contents(path), "old");
    }
    std::signal(SIGXFSZ, old_handler);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"first.png", "picture.exr", "picture.png"}));
}

// 2 × 2 pixels of 8 bits: red and green above blue and white.
const unsigned char kPng[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
                              0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00, 0x00, 0xfd,
                              0xd4, 0x9a, 0x73, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8,
                              0xcf, 0xc0, 0xc0, 0x00, 0xc2, 0x0c, 0xff, 0x81, 0x00, 0x00, 0x1f, 0xee, 0x05, 0xfb, 0xf1,
                              0xab, 0xba, 0x77, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

// A square of emission from a texture, 2 metres wide, seen from above.
struct Screen : Scene {
    uint32_t texture = TRP_NO_ID;
    explicit Screen(const std::function<void(TrpTextureDesc&)>& source) {
        TrpTextureDesc desc;
        check(trp_texture_desc_init(&desc, sizeof desc));
        desc.name = "Poster";
        desc.filter = TRP_FILTER_NEAREST;
        source(desc);
        check(trp_texture_add(*this, &desc, &texture));
        TrpNode node;
        check(trp_node_init(&node, TRP_NODE_IMAGE));
        node.texture = texture;
        const uint32_t glow = material([&](TrpMaterialDesc& d) {
            d.nodes = &node;
            d.node_count = 1;
            d.emission = {{1, 1, 1}, 0};
            d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        });
        object(floor_square(1), glow);
        camera_above(2);
    }
    Image picture() { return render(*this, 16, 16, {{"samples", "1"}, {"film.filter_width", "0"}}); }
    void expect_magenta(const char* word) {
        const Image image = picture();
        for (uint32_t y = 2; y < 16; y += 4)
            for (uint32_t x = 2; x < 16; x += 4) {
                EXPECT_NEAR(image.at(x, y)[0], 1, 1e-5);
                EXPECT_NEAR(image.at(x, y)[1], 0, 1e-5);
                EXPECT_NEAR(image.at(x, y)[2], 1, 1e-5);
            }
        ASSERT_EQ(trp_scene_warning_count(*this), 1u);
        TrpWarning warning{};
        warning.struct_size = sizeof warning;
        check(trp_scene_warning(*this, 0, &warning));
        EXPECT_EQ(warning.code, TRP_WARNING_TEXTURE);
        EXPECT_EQ(warning.item, texture);
        for (const char* part : {"Poster", "magenta", word})
            EXPECT_NE(std::string(warning.text).find(part), std::string::npos) << warning.text;
    }
};

void expect_color(const float* pixel, Vec color, float tolerance = 1e-3f) {
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(pixel[k], color[k], tolerance);
}

TEST(Textures, MissingFileIsMagentaWithAWarning) {
    Screen screen([](TrpTextureDesc& d) { d.path = "/nowhere/poster.png"; });
    screen.expect_magenta("/nowhere/poster.png");
    screen.expect_magenta("Poster");  // the next commit warns again
}

TEST(Textures, BrokenBytesAreMagentaWithAWarning) {
    static const char nonsense[] = "this is no picture";
    Screen screen([](TrpTextureDesc& d) {
        d.file_data = nonsense;
        d.file_size = sizeof nonsense;
    });
    screen.expect_magenta("Poster");
    Screen cut([](TrpTextureDesc& d) {
        d.file_data = kPng;
        d.file_size = 50;
    });
    cut.expect_magenta("Poster");
}

TEST(Textures, PngFromMemory) {
    std::vector<unsigned char> bytes(std::begin(kPng), std::end(kPng));
    Screen screen([&](TrpTextureDesc& d) {
        d.file_data = bytes.data();
        d.file_size = bytes.size();
    });
    std::fill(bytes.begin(), bytes.end(), static_cast<unsigned char>(0));  // the caller's again
    const Image image = screen.picture();
    EXPECT_EQ(trp_scene_warning_count(screen), 0u);
    expect_color(image.at(4, 12), {1, 0, 0});
    expect_color(image.at(12, 12), {0, 1, 0});
    expect_color(image.at(4, 4), {0, 0, 1});
    expect_color(image.at(12, 4), {1, 1, 1});
}

TEST(Textures, PngFromAFile) {
    const Folder folder;
    const std::string path = folder / "tëxture.png";
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(kPng), sizeof kPng);
    Screen screen([&](TrpTextureDesc& d) { d.path = path.c_str(); });
    const Image image = screen.picture();
    EXPECT_EQ(trp_scene_warning_count(screen), 0u);
    expect_color(image.at(4, 12), {1, 0, 0});
    expect_color(image.at(12, 4), {1, 1, 1});
}

TEST(Textures, PixelsAndReplacement) {
    const float pixels[] = {0.25f, 0.5f, 2, 4};  // one channel, row 0 at the bottom
    Screen screen([&](TrpTextureDesc& d) {
        d.pixels = pixels;
        d.width = d.height = 2;
        d.channels = 1;
    });
    const Image grey = screen.picture();
    expect_color(grey.at(4, 4), {0.25f, 0.25f, 0.25f});
    expect_color(grey.at(12, 12), {4, 4, 4});
    const Render held(screen, 16, 16, {{"samples", "1"}, {"film.filter_width", "0"}});
    TrpTextureDesc desc;
    check(trp_texture_desc_init(&desc, sizeof desc));
    const float blue[] = {0, 0, 3};
    desc.pixels = blue;
    desc.width = desc.height = 1;
    desc.channels = 3;
    check(trp_texture_replace(screen, screen.texture, &desc));
    expect_color(screen.picture().at(4, 4), {0, 0, 3});
    check(trp_render_run(held, nullptr));
    EXPECT_TRUE(same(held.read(), grey)) << "a render keeps its textures";
}

}  // namespace
