// What must not change a picture: threads, tiles, windows, the order of vertices and faces, rotation, scale,
// instancing.
#include <algorithm>
#include <numeric>
#include <random>

#include "support/abi.h"

namespace trp_test {
namespace {

struct Options {
    float scale = 1;
    Transform turn = kIdentity;  // of the whole scene
    uint32_t shuffle = 0;        // a seed: vertices and faces in another order
};

Vec apply(const Transform& m, Vec p, float w) {
    Vec q;
    for (int r = 0; r < 3; ++r) q[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + w * m[4 * r + 3];
    return q;
}

MeshData arranged(MeshData mesh, const Options& o) {
    for (size_t i = 0; i < mesh.positions.size(); i += 3) {
        const Vec p = apply(o.turn, {mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]}, 1);
        for (size_t k = 0; k < 3; ++k) mesh.positions[i + k] = p[k] * o.scale;
        if (mesh.normals.empty()) continue;
        const Vec n = apply(o.turn, {mesh.normals[i], mesh.normals[i + 1], mesh.normals[i + 2]}, 0);
        std::copy(n.begin(), n.end(), mesh.normals.begin() + static_cast<ptrdiff_t>(i));
    }
    if (!o.shuffle) return mesh;
    std::mt19937 random(o.shuffle);
    std::vector<uint32_t> place(mesh.positions.size() / 3), faces(mesh.offsets.size() - 1);
    std::iota(place.begin(), place.end(), 0u);
    std::iota(faces.begin(), faces.end(), 0u);
    std::shuffle(place.begin(), place.end(), random);
    std::shuffle(faces.begin(), faces.end(), random);
    MeshData out = mesh;
    for (size_t v = 0; v < place.size(); ++v)
        for (size_t k = 0; k < 3; ++k) {
            out.positions[3 * place[v] + k] = mesh.positions[3 * v + k];
            if (!mesh.normals.empty()) out.normals[3 * place[v] + k] = mesh.normals[3 * v + k];
        }
    out.corners.clear();
    out.offsets = {0};
    for (const uint32_t f : faces) {
        for (uint32_t c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) out.corners.push_back(place[mesh.corners[c]]);
        out.offsets.push_back(static_cast<uint32_t>(out.corners.size()));
    }
    out.uvs.clear();
    return out;
}

Transform arranged(const Transform& m, const Options& o) {
    Transform out;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) {
            double sum = c == 3 ? o.turn[4 * r + 3] : 0;
            for (int k = 0; k < 3; ++k) sum += o.turn[4 * r + k] * m[4 * k + c];
            out[4 * r + c] = static_cast<float>(c == 3 ? sum * o.scale : sum);
        }
    return out;
}

// A floor, two balls and a light of each kind; power goes with the square of the scale.
void build(Scene& scene, const Options& o) {
    MeshData floor = floor_square(4);
    floor.uvs.clear();
    scene.object(arranged(floor, o), scene.diffuse(0.7f, 0.6f, 0.5f));
    scene.object(arranged(sphere({-0.8f, 0, 0.7f}, 0.7f, 24), o), scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.2f, 0.4f, 0.6f}, TRP_NO_NODE};
        d.specular = {{0.3f, 0.3f, 0.3f}, TRP_NO_NODE};
    }));
    scene.object(arranged(sphere({0.9f, -0.4f, 0.5f}, 0.5f, 24), o), scene.diffuse(0.8f, 0.2f, 0.2f));
    const float s2 = o.scale * o.scale;
    scene.light(TRP_LIGHT_POINT, {60 * s2, 50 * s2, 40 * s2}, arranged(translation({2, -2, 4}), o));
    scene.light(TRP_LIGHT_SUN, {0.5f, 0.5f, 0.8f}, arranged(look_at({-3, -1, 4}, {0, 0, 0}), o));
    scene.light(TRP_LIGHT_AREA, {3, 3, 3}, arranged(look_at({-2, -3, 3}, {0, 0, 0}), o),
                [&](TrpLightDesc& d) { d.size[0] = d.size[1] = o.scale; });
    scene.camera(arranged(look_at({0, -6, 3}, {0, 0, 0.5f}), o), [&](TrpCameraDesc& d) {
        d.clip_start *= o.scale;
        d.clip_end *= o.scale;
    });
}

constexpr uint32_t kWidth = 150, kHeight = 100;
const char* const kMethods[] = {"ray_casting", "wireframe", "hidden_line", "visible_surface",
                                "flat",        "gouraud",   "phong",       "ray_tracing"};

Image picture(const Options& o, const Settings& settings) {
    Scene scene;
    build(scene, o);
    return render(scene, kWidth, kHeight, settings);
}

// Pixels that differ by more than the tolerance and lie within a region of slow change: no edge of anything near.
size_t interior_differences(const Image& a, const Image& b, double tolerance) {
    size_t bad = 0;
    for (uint32_t y = 1; y + 1 < a.height; ++y)
        for (uint32_t x = 1; x + 1 < a.width; ++x) {
            bool interior = true;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    interior &= std::abs(a.at(x + static_cast<uint32_t>(dx), y + static_cast<uint32_t>(dy))[0] -
                                         a.at(x, y)[0]) < 0.02f;
            for (int k = 0; interior && k < 4; ++k) bad += std::abs(a.at(x, y)[k] - b.at(x, y)[k]) > tolerance;
        }
    return bad;
}

TEST(Invariance, ThreadsAndTilesGiveTheSameBits) {
    Scene scene;
    build(scene, {});
    scene.world({0.1f, 0.1f, 0.1f});
    scene.commit();
    for (const char* method : kMethods) {
        // The rasterizer's tiles have 256 pixels at least.
        const uint32_t scale = std::string(method).rfind("ray_", 0) == 0 ? 1 : 4;
        Image first;
        for (const auto& [threads, tile] :
             {std::pair{"1", "16"}, {"1", "64"}, {"2", "1000"}, {"5", "16"}, {"5", "64"}}) {
            const Settings settings = {{"samples", "5"},         {"raster.samples", "4"},    {"shadows", "on"},
                                       {"lines.hidden", "none"}, {"lines.depth_cue", "0.5"}, {"threads", threads},
                                       {"film.tile_size", tile}};
            const Image image = Render(scene, scale * kWidth, scale * kHeight, settings, {}, method).run().read();
            if (first.values.empty()) first = image;
            ASSERT_EQ(image.values, first.values) << method << ", " << threads << " threads, tiles of " << tile;
        }
    }
}

TEST(Invariance, AWindowIsAPieceOfThePicture) {
    Scene scene;
    build(scene, {});
    scene.commit();
    const Settings settings = {
        {"samples", "3"}, {"raster.samples", "2"}, {"raster.interpolation", "scan_line"}, {"lines.hidden", "dashed"}};
    for (const char* method : kMethods) {
        const Image whole = Render(scene, kWidth, kHeight, settings, {}, method).run().read();
        for (const auto& [x, y, w, h] :
             {std::array<uint32_t, 4>{0, 0, 1, 1}, {17, 33, 50, 41}, {149, 99, 1, 1}, {3, 0, 147, 100}}) {
            Render r(scene, kWidth, kHeight, settings, {}, method);
            check(trp_render_set_film(r, kWidth, kHeight, x, y, w, h));
            r.run();
            std::vector<float> window(size_t{w} * h * 4);
            check(trp_render_read(r, "Combined", x, y, w, h, window.data(), window.size()));
            for (uint32_t row = 0; row < h; ++row)
                for (uint32_t i = 0; i < 4 * w; ++i)
                    ASSERT_EQ(window[row * w * 4 + i], whole.at(x, y + row)[i]) << method;
        }
    }
}

TEST(Invariance, PassesOverTheFilmAddUp) {
    // 100 samples are two passes; the mean of what 64 and the rest give is the same as one render of all.
    Scene scene;
    build(scene, {});
    const Image a = render(scene, 32, 24, {{"samples", "100"}}),
                b = render(scene, 32, 24, {{"samples", "100"}, {"threads", "1"}});
    EXPECT_EQ(a.values, b.values);
    EXPECT_NEAR(mean(a), mean(render(scene, 32, 24, {{"samples", "64"}})), 2e-3);
}

TEST(Invariance, OrderOfVerticesAndFaces) {
    const Image a = picture({}, {{"samples", "4"}});
    for (const uint32_t seed : {1u, 2u}) {
        Options o;
        o.shuffle = seed;
        EXPECT_EQ(interior_differences(a, picture(o, {{"samples", "4"}}), 1e-4), 0u);
    }
}

TEST(Invariance, Scale) {
    const Image a = picture({}, {{"samples", "4"}});
    for (const float scale : {1e-3f, 0.37f, 1e3f}) {
        Options o;
        o.scale = scale;
        EXPECT_EQ(interior_differences(a, picture(o, {{"samples", "4"}}), 1e-4), 0u) << scale;
    }
}

TEST(Invariance, Rotation) {
    const Image a = picture({}, {{"samples", "4"}});
    Options o;
    const Vec x = unit({1, 2, -0.5f}), y = unit(cross({0.2f, -1, 3}, x)), z = cross(x, y);
    o.turn = {x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0};
    EXPECT_EQ(interior_differences(a, picture(o, {{"samples", "4"}}), 1e-4), 0u);
}

TEST(Invariance, FarFromTheOrigin) {
    // 100 km away, where floats step by 8 mm: geometry is relative to the camera, so only what was handed in rounds.
    const Vec far = {98304, -65536, 32768};  // exact in floats, as are sums with the numbers of a coarse scene
    Scene moved;
    MeshData floor = floor_square(4);
    moved.object(floor, moved.diffuse(0.7f, 0.6f, 0.5f), translation(far));
    moved.light(TRP_LIGHT_SUN, {1, 1, 1}, kIdentity);
    moved.camera(translation({far[0], far[1], far[2] + 8}));
    Scene near;
    near.object(floor, near.diffuse(0.7f, 0.6f, 0.5f));
    near.light(TRP_LIGHT_SUN, {1, 1, 1}, kIdentity);
    near.camera(translation({0, 0, 8}));
    const Image b = render(moved, 64, 64, {{"samples", "4"}}), c = render(near, 64, 64, {{"samples", "4"}});
    double worst = 0;
    for (size_t i = 0; i < b.values.size(); ++i)
        worst = std::max(worst, std::abs(static_cast<double>(b.values[i]) - c.values[i]));
    EXPECT_LT(worst, 1e-4);
}

}  // namespace
}  // namespace trp_test
