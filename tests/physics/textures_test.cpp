// Closed forms of texture mapping: coordinates, wrapping, filtering, nodes, normal maps.
#include <array>
#include <cmath>
#include <random>

#include "support/abi.h"

namespace trp_test {
namespace {

// A floor square with a texture.
struct Textured {
    Textured(const std::vector<float>& pixels, uint32_t width,
             const std::function<void(TrpTextureDesc&)>& change = {}) {
        TrpTextureDesc desc;
        check(trp_texture_desc_init(&desc, sizeof desc));
        desc.pixels = pixels.data();
        desc.channels = 3;
        desc.width = width;
        desc.height = static_cast<uint32_t>(pixels.size() / 3 / width);
        if (change) change(desc);
        check(trp_texture_add(scene, &desc, &texture));
    }
    void show(const std::function<void(TrpMaterialDesc&, std::vector<TrpNode>&)>& make) {
        std::vector<TrpNode> nodes;
        scene.object(floor_square(1), scene.material([&](TrpMaterialDesc& d) {
            d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
            make(d, nodes);
            d.nodes = nodes.data();
            d.node_count = static_cast<uint32_t>(nodes.size());
        }));
    }
    // Emits what the texture says, its coordinates scaled and moved.
    void show_emission(float scale_u = 1, float scale_v = 1, float offset_u = 0, float offset_v = 0) {
        show([&](TrpMaterialDesc& d, std::vector<TrpNode>& nodes) {
            nodes = {node(TRP_NODE_UV_TRANSFORM), node(TRP_NODE_IMAGE)};
            const float transform[4] = {scale_u, scale_v, offset_u, offset_v};
            std::copy_n(transform, 4, nodes[0].value);
            nodes[1].inputs[0] = 0;
            nodes[1].texture = texture;
            d.emission = {{1, 1, 1}, 1};
        });
    }
    static TrpNode node(int32_t type) {
        TrpNode n;
        check(trp_node_init(&n, type));
        return n;
    }
    Scene scene;
    uint32_t texture = 0;
};

TEST(Textures, LieAsTheirCoordinatesSay) {
    // Row 0 of the pixels is v = 0: red, green below; blue, white above.
    Textured t({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, 2, [](TrpTextureDesc& d) { d.filter = TRP_FILTER_NEAREST; });
    t.show([&](TrpMaterialDesc& d, std::vector<TrpNode>& nodes) {
        nodes.push_back(Textured::node(TRP_NODE_IMAGE));
        nodes[0].texture = t.texture;
        d.emission = {{2, 2, 2}, 0};
    });
    t.scene.camera_above(2);
    const Image image = render(t.scene, 4, 4, {{"samples", "1"}, {"film.filter_width", "0"}});
    const float expected[4][3] = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 2}};
    for (uint32_t y = 0; y < 2; ++y)
        for (uint32_t x = 0; x < 2; ++x)
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(image.at(3 * x, 3 * y)[k], expected[2 * y + x][k], 1e-3) << x << y;
}

TEST(Textures, EdgeSamplesOfTheRasterizerLieWhereTheyAreSaid) {
    // The boundary between two texels goes through pixel 15, three tenths of the way across. A veil that is all but
    // clear makes each sample count alone, instead of all that a surface covers of a pixel at once.
    Textured t({1, 1, 1, 0, 0, 0}, 2, [](TrpTextureDesc& d) { d.filter = TRP_FILTER_NEAREST; });
    t.show_emission(1, 1, -0.01f, 0);
    t.scene.object(floor_square(1, 1), t.scene.veil(0, 1e-3f));
    t.scene.camera_above(2);
    t.scene.commit();
    for (const char* method : {"visible_surface", "phong"}) {
        const Settings settings = {{"raster.samples", "32"}, {"film.filter", "box"}, {"film.filter_width", "1"}};
        const Image image = Render(t.scene, 30, 30, settings, {}, method).run().read();
        EXPECT_NEAR(image.at(14, 15)[0], 1, 2e-3) << method;
        EXPECT_NEAR(image.at(15, 15)[0], 0.3, 1 / 16.0) << method;
        EXPECT_NEAR(image.at(16, 15)[0], 0, 1e-3) << method;
    }
}

TEST(Textures, AreFilteredToTheirMeanFarAway) {
    // A checkerboard seen so small that a pixel covers many squares is its mean in linear light, with one sample.
    const uint32_t side = 256;
    std::vector<float> pixels;
    for (uint32_t i = 0; i < side * side; ++i)
        for (int k = 0; k < 3; ++k) pixels.push_back(static_cast<float>((i % side + i / side) & 1));
    Textured t(pixels, side);
    t.show([&](TrpMaterialDesc& d, std::vector<TrpNode>& nodes) {
        nodes.push_back(Textured::node(TRP_NODE_IMAGE));
        nodes[0].texture = t.texture;
        d.emission = {{1, 1, 1}, 0};
    });
    t.scene.camera_above(2);
    const Image image = render(t.scene, 8, 8, {{"samples", "1"}});
    for (uint32_t y = 2; y < 6; ++y)
        for (uint32_t x = 2; x < 6; ++x) EXPECT_NEAR(image.at(x, y)[0], 0.5, 0.02);
}

std::vector<float> random_pixels(uint32_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0, 1);
    std::vector<float> pixels(3 * size_t{count});
    for (float& p : pixels) p = value(random);
    return pixels;
}

// One sample in the middle of each pixel.
const Settings kMiddle = {{"samples", "1"}, {"film.filter_width", "0"}};

TEST(Textures, OddSizesKeepTheirMean) {
    for (const auto& [width, height] : {std::pair{37u, 23u}, {5u, 1u}, {1u, 7u}, {64u, 64u}, {3u, 255u}}) {
        const std::vector<float> pixels = random_pixels(width * height, width);
        Textured t(pixels, width);
        t.show_emission();
        t.scene.camera_above(2000);  // the footprint holds the whole picture
        double expected = 0;
        for (size_t i = 0; i < pixels.size(); i += 3) expected += 3 * pixels[i] / static_cast<double>(pixels.size());
        EXPECT_NEAR(render(t.scene, 1, 1, kMiddle).at(0, 0)[0], expected, 1e-5) << width << " x " << height;
    }
}

TEST(Textures, InterpolateALineExactly) {
    const uint32_t side = 8;
    std::vector<float> pixels;
    for (uint32_t i = 0; i < side * side; ++i) {
        const float u = (static_cast<float>(i % side) + 0.5f) / side, v = (static_cast<float>(i / side) + 0.5f) / side;
        pixels.insert(pixels.end(), {u, v, 0.25f * u + 0.5f * v});
    }
    Textured t(pixels, side, [](TrpTextureDesc& d) { d.wrap_u = d.wrap_v = TRP_WRAP_CLAMP; });
    t.show_emission();
    t.scene.camera_above(2);
    const Image image = render(t.scene, 64, 64, kMiddle);
    for (uint32_t y = 4; y < 60; ++y)
        for (uint32_t x = 4; x < 60; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / 64, v = (static_cast<float>(y) + 0.5f) / 64;
            EXPECT_NEAR(image.at(x, y)[0], u, 1e-5);
            EXPECT_NEAR(image.at(x, y)[1], v, 1e-5);
            EXPECT_NEAR(image.at(x, y)[2], 0.25f * u + 0.5f * v, 1e-5);
        }
}

TEST(Textures, WrapAsAsked) {
    // Four texels in a row, seen from u = −1 to 2: what wrap mode shows which.
    const std::vector<float> pixels = {1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0};
    const struct {
        int32_t wrap;
        std::array<float, 12> expected;
    } modes[] = {{TRP_WRAP_REPEAT, {1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4}},
                 {TRP_WRAP_MIRROR, {4, 3, 2, 1, 1, 2, 3, 4, 4, 3, 2, 1}},
                 {TRP_WRAP_CLAMP, {1, 1, 1, 1, 1, 2, 3, 4, 4, 4, 4, 4}},
                 {TRP_WRAP_BLACK, {0, 0, 0, 0, 1, 2, 3, 4, 0, 0, 0, 0}}};
    for (const auto& mode : modes)
        for (const int32_t filter : {TRP_FILTER_NEAREST, TRP_FILTER_SMOOTH}) {
            Textured t(pixels, 4, [&](TrpTextureDesc& d) { d.wrap_u = mode.wrap, d.filter = filter; });
            t.show_emission(3, 1, -1);
            t.scene.camera_above(2);
            const Image image = render(t.scene, 12, 12, kMiddle);  // pixels lie on texels
            for (uint32_t x = 0; x < 12; ++x)
                EXPECT_NEAR(image.at(x, 6)[0], mode.expected[x], 1e-4) << mode.wrap << ", column " << x;
        }
}

TEST(Textures, LongFootprintsBlurAlongThemselvesAlone) {
    // Stripes across u; v runs twelve times as fast, so that footprints are long in v and must not be so in u.
    const uint32_t side = 64;
    std::vector<float> pixels;
    for (uint32_t i = 0; i < side * side; ++i) pixels.insert(pixels.end(), 3, static_cast<float>(i % side & 1));
    Image images[2];
    for (const bool is_long : {false, true}) {
        Textured t(pixels, side);
        t.show_emission(1, is_long ? 12 : 1);
        t.scene.camera_above(2);
        images[is_long] = render(t.scene, 128, 128, kMiddle);
    }
    for (size_t i = 0; i < images[0].values.size(); ++i) ASSERT_NEAR(images[1].values[i], images[0].values[i], 1e-5);
}

TEST(Textures, FilteringAgreesWithManySamples) {
    // A floor of noise towards the horizon: one filtered sample in the middle of a pixel against the mean of many
    // unfiltered ones. The filter is no exact box, and noise shows every difference: its own deviation is 0.29.
    const std::vector<float> pixels = random_pixels(64 * 64, 5);
    Image images[2];
    for (const bool filtered : {false, true}) {
        Textured t(pixels, 64,
                   [&](TrpTextureDesc& d) { d.filter = filtered ? TRP_FILTER_SMOOTH : TRP_FILTER_NEAREST; });
        t.show_emission(4, 4);
        t.scene.camera(look_at({0.2f, -1.4f, 0.25f}, {0, 0, 0}));
        t.scene.commit();
        const Settings many = {{"samples", "1024"}, {"film.filter", "box"}, {"film.filter_width", "1"}};
        images[filtered] = Render(t.scene, 64, 32, filtered ? kMiddle : many, {"Albedo"}).run().read();
    }
    double error2 = 0, bias = 0, count = 0;
    for (uint32_t y = 0; y < 32; ++y)
        for (uint32_t x = 0; x < 64; ++x) {
            if (images[0].at(x, y)[3] < 1) continue;
            const double difference = images[1].at(x, y)[0] - images[0].at(x, y)[0];
            error2 += difference * difference, bias += difference, ++count;
        }
    EXPECT_GT(count, 1000);
    EXPECT_LT(std::sqrt(error2 / count), 0.05);
    EXPECT_NEAR(bias / count, 0, 0.005);
}

TEST(Textures, NodesCompute) {
    // (image · 0.5 + 0.25) raised to 2, mixed half with 1: constants are folded, the rest runs.
    Textured t(std::vector<float>(2 * 2 * 3, 0.5f), 2);
    t.show([&](TrpMaterialDesc& d, std::vector<TrpNode>& nodes) {
        auto add = [&](int32_t type, int a, int b, float value, float value2) {
            TrpNode n = Textured::node(type);
            n.inputs[0] = a;
            n.inputs[1] = b;
            std::fill_n(n.value, 4, value);
            std::fill_n(n.value2, 4, value2);
            nodes.push_back(n);
            return static_cast<int>(nodes.size()) - 1;
        };
        TrpNode image = Textured::node(TRP_NODE_IMAGE);
        image.texture = t.texture;
        nodes.push_back(image);
        const int quarter = add(TRP_NODE_MULTIPLY, -1, -1, 0.5f, 0.5f);
        const int scaled = add(TRP_NODE_MULTIPLY, 0, -1, 0, 0.5f);
        const int sum = add(TRP_NODE_ADD, scaled, quarter, 0, 0);
        const int power = add(TRP_NODE_POWER, sum, -1, 0, 2);
        TrpNode mix = Textured::node(TRP_NODE_MIX);
        mix.inputs[0] = power;
        std::fill_n(mix.value2, 4, 1.0f);
        std::fill_n(mix.value3, 4, 0.5f);
        nodes.push_back(mix);
        d.emission = {{1, 1, 1}, static_cast<int32_t>(nodes.size()) - 1};
    });
    t.scene.camera_above(1);
    EXPECT_NEAR(mean(render(t.scene, 4, 4, {{"samples", "1"}})), (0.25 + 1) / 2, 2e-3);
}

TEST(Textures, NormalMapTurnsTheNormal) {
    // A constant map tilted along +u. On a floor whose u runs along +x, and on its mirror image where u runs along −x.
    const Vec tilted = unit({0.5f, 0.2f, 1});
    std::vector<float> pixels;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) pixels.push_back(tilted[static_cast<size_t>(k)] * 0.5f + 0.5f);
    for (const bool mirrored : {false, true}) {
        Textured t(pixels, 2, [](TrpTextureDesc& d) { d.color_space = TRP_COLOR_SPACE_LINEAR; });
        std::vector<TrpNode> nodes = {Textured::node(TRP_NODE_IMAGE), Textured::node(TRP_NODE_NORMAL_MAP)};
        nodes[0].texture = t.texture;
        nodes[1].inputs[0] = 0;
        MeshData floor = floor_square(1);
        if (mirrored) floor.uvs = {1, 0, 0, 0, 0, 1, 1, 1};
        t.scene.object(floor, t.scene.material([&](TrpMaterialDesc& d) {
            d.nodes = nodes.data();
            d.node_count = 2;
            d.normal = 1;
        }));
        t.scene.camera_above(1);
        t.scene.commit();
        Render r(t.scene, 2, 2, {{"samples", "1"}}, {"Normal"});
        const Image normal = r.run().read("Normal");
        EXPECT_NEAR(normal.at(0, 0)[0], mirrored ? -tilted[0] : tilted[0], 1e-3);
        EXPECT_NEAR(normal.at(0, 0)[1], tilted[1], 1e-3);
        EXPECT_NEAR(normal.at(0, 0)[2], tilted[2], 1e-3);
    }
}

}  // namespace
}  // namespace trp_test
