// Gouraud's and Phong's interpolations: along scan lines as the books have it, and the normals that are interpolated.
#include <algorithm>
#include <cmath>
#include <random>

#include "support/abi.h"

namespace trp_test {
namespace {

const Settings kScanLines = {{"raster.samples", "1"}, {"raster.interpolation", "scan_line"}};

// 64 × 64 pixels, 4 to the metre, whose middle is at the origin: numbers of 1/64 m lie on the film's grid.
constexpr uint32_t kSide = 64;
double film(double metres) {
    return metres * 4 + kSide / 2.0;
}

// A material that emits the vertex colours, nothing else.
uint32_t colored(Scene& scene) {
    return scene.material([](TrpMaterialDesc& d) {
        static TrpNode node;
        check(trp_node_init(&node, TRP_NODE_COLOR));
        d.nodes = &node;
        d.node_count = 1;
        d.emission = {{1, 1, 1}, 0};
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
    });
}

// One polygon in the plane z = 0 with a grey value at each vertex.
struct Polygon {
    std::vector<std::array<double, 2>> points;
    std::vector<float> values;

    MeshData mesh(uint32_t material) const {
        MeshData m;
        for (uint32_t k = 0; k < points.size(); ++k) {
            m.positions.insert(m.positions.end(),
                               {static_cast<float>(points[k][0]), static_cast<float>(points[k][1]), 0});
            m.corners.push_back(k);
        }
        m.offsets = {0, static_cast<uint32_t>(points.size())};
        m.materials = {material};
        return m;
    }
    std::vector<float> colors() const {
        std::vector<float> out;
        for (const float v : values) out.insert(out.end(), {v, v, v});
        return out;
    }
};

void show(Scene& scene, const Polygon& polygon) {
    const std::vector<float> colors = polygon.colors();
    const TrpAttribute layer = {"Col", floats(colors, 3), TRP_DOMAIN_VERTEX, 3};
    scene.instance(scene.mesh(polygon.mesh(colored(scene)), [&](TrpMeshDesc& d) {
        d.colors = &layer;
        d.color_count = 1;
    }));
    scene.camera_above(16);
    scene.commit();
}

TrpScanLine pick(Render& render, uint32_t x, uint32_t y) {
    TrpScanLine line{};
    line.struct_size = sizeof line;
    check(trp_render_pick_scan_line(render, x, y, &line));
    return line;
}

// α, β, γ and the value by hand; false outside of the polygon, or nearer than a hundredth of a pixel to its boundary.
struct ByHand {
    double alpha, beta, gamma, value;
    uint32_t ends[4];
};
bool by_hand(const Polygon& polygon, double x, double y, ByHand& out) {
    struct Cut {
        double x, share;
        uint32_t upper, lower;
    };
    std::vector<Cut> cuts;
    const auto count = static_cast<uint32_t>(polygon.points.size());
    for (uint32_t k = 0; k < count; ++k) {
        uint32_t a = k, b = (k + 1) % count;
        if (film(polygon.points[a][1]) < film(polygon.points[b][1])) std::swap(a, b);
        const double high = film(polygon.points[a][1]), low = film(polygon.points[b][1]);
        if (std::abs(high - y) < 0.01 || std::abs(low - y) < 0.01) return false;
        if (!(low < y && y < high)) continue;
        const double share = (y - low) / (high - low), x0 = film(polygon.points[b][0]), x1 = film(polygon.points[a][0]);
        cuts.push_back({x0 + (x1 - x0) * share, share, a, b});
    }
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.x < b.x; });
    for (size_t k = 0; k + 1 < cuts.size(); k += 2) {
        const Cut &a = cuts[k], &b = cuts[k + 1];
        if (x < a.x + 0.01 || x > b.x - 0.01) continue;
        out.alpha = a.share;
        out.beta = b.share;
        out.gamma = (x - a.x) / (b.x - a.x);
        const uint32_t ends[4] = {a.upper, a.lower, b.upper, b.lower};
        std::copy_n(ends, 4, out.ends);
        const double i1 = polygon.values[ends[0]], i2 = polygon.values[ends[1]], i3 = polygon.values[ends[2]],
                     i4 = polygon.values[ends[3]];
        out.value = (1 - out.gamma) * (out.alpha * i1 + (1 - out.alpha) * i2) +
                    out.gamma * (out.beta * i3 + (1 - out.beta) * i4);
        return true;
    }
    return false;
}

TEST(ScanLine, ASquareIsAHalfAtItsCentre) {
    // Corners 0, 1, 0, 1, the face begun at each of them, so that its diagonal lies both ways.
    for (uint32_t first = 0; first < 4; ++first) {
        const std::array<double, 2> corners[4] = {{-4, -4}, {4, -4}, {4, 4}, {-4, 4}};
        Polygon square;
        for (uint32_t k = 0; k < 4; ++k) {
            square.points.push_back(corners[(first + k) % 4]);
            square.values.push_back(static_cast<float>((first + k) % 2));
        }
        Scene scene;
        show(scene, square);
        const auto centre = [&](const char* interpolation) {
            // 63 pixels across 16 m: a pixel's centre at the square's.
            return Render(scene, 63, 63, {{"raster.samples", "1"}, {"raster.interpolation", interpolation}}, {},
                          "gouraud")
                .run()
                .read()
                .at(31, 31)[0];
        };
        EXPECT_NEAR(centre("scan_line"), 0.5, 1e-3) << first;
        const float triangles = centre("perspective");
        EXPECT_LT(std::min(triangles, 1 - triangles), 1e-3) << "triangles show their diagonal";
        Render render(scene, 63, 63, {}, {}, "gouraud");
        const TrpScanLine line = pick(render, 31, 31);
        EXPECT_NEAR(line.alpha, 0.5, 1e-3);
        EXPECT_NEAR(line.beta, 0.5, 1e-3);
        EXPECT_NEAR(line.gamma, 0.5, 1e-3);
        EXPECT_NEAR(line.value[0], 0.5, 1e-3);
    }
}

TEST(ScanLine, FollowsAlphaBetaAndGammaByHand) {
    std::mt19937 random(17);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    uint32_t compared = 0;
    for (int round = 0; round < 100; ++round) {
        // Star-shaped about the origin, mostly concave.
        Polygon polygon;
        const int count = 3 + round % 8;
        for (int k = 0; k < count; ++k) {
            const double angle = 2 * kPi * (k + uniform(0.1, 0.9)) / count, radius = uniform(1.5, 7);
            polygon.points.push_back(
                {std::round(radius * std::cos(angle) * 64) / 64, std::round(radius * std::sin(angle) * 64) / 64});
            polygon.values.push_back(static_cast<float>(uniform(0, 1)));
        }
        Scene scene;
        show(scene, polygon);
        const Image image = Render(scene, kSide, kSide, kScanLines, {}, "gouraud").run().read();
        Render render(scene, kSide, kSide, {}, {}, "gouraud");
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                ByHand hand{};
                if (!by_hand(polygon, x + 0.5, y + 0.5, hand)) continue;
                ++compared;
                ASSERT_NEAR(image.at(x, y)[0], hand.value, 2e-4) << "round " << round << ", pixel " << x << ", " << y;
                if ((x + 3 * y + static_cast<uint32_t>(round)) % 97) continue;
                const TrpScanLine line = pick(render, x, y);
                ASSERT_TRUE(line.seen);
                for (int k = 0; k < 4; ++k) {
                    EXPECT_EQ(line.vertices[k], hand.ends[k]);
                    EXPECT_NEAR(line.values[k][1], polygon.values[hand.ends[k]], 1e-5);
                }
                EXPECT_NEAR(line.alpha, hand.alpha, 1e-4);
                EXPECT_NEAR(line.beta, hand.beta, 1e-4);
                EXPECT_NEAR(line.gamma, hand.gamma, 1e-4);
                EXPECT_NEAR(line.value[2], hand.value, 2e-4);
            }
    }
    EXPECT_GT(compared, 40000u);
}

TEST(ScanLine, DependsOnRotation) {
    // The square turned by 45°: its middle scan line goes through two corners of one value.
    Polygon diamond;
    diamond.points = {{5, 0}, {0, 5}, {-5, 0}, {0, -5}};
    diamond.values = {1, 0, 1, 0};
    Scene scene;
    show(scene, diamond);
    const Image image = Render(scene, 63, 63, kScanLines, {}, "gouraud").run().read();
    EXPECT_NEAR(image.at(31, 31)[0], 1, 0.02);
}

TEST(ScanLine, PhongInterpolatesNormals) {
    Scene scene;
    MeshData square = floor_square(4);
    square.normals.clear();
    const Vec normals[4] = {unit({-0.6f, -0.2f, 1}), unit({0.9f, 0, 1}), unit({0.1f, 0.7f, 1}), unit({0, 0, 1})};
    for (const Vec& n : normals) square.normals.insert(square.normals.end(), n.begin(), n.end());
    // Turned and mirrored, so that normals are too.
    scene.instance(scene.mesh(square, [](TrpMeshDesc& d) { d.normal_domain = TRP_DOMAIN_VERTEX; }),
                   {-1, 0, 0, 0, 0, 1.5f, 0, 0, 0, 0, 1, 0});
    scene.camera_above(16);
    scene.commit();
    Render render(scene, kSide, kSide, kScanLines, {"Normal"}, "phong");
    const Image normal = render.run().read("Normal");
    for (const auto& [x, y] : {std::pair{20u, 30u}, {32u, 40u}, {45u, 12u}}) {
        const TrpScanLine line = pick(render, x, y);
        const Vec value = unit({line.value[0], line.value[1], line.value[2]});
        for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(normal.at(x, y)[k], value[k], 1e-5);
        // By hand: the square's film corners are x = ±16, y = ±24 pixels about the middle, mirrored in x.
        const double alpha = (y + 0.5 - 8) / 48, gamma = (x + 0.5 - 16) / 32;
        EXPECT_NEAR(line.alpha, alpha, 1e-4);
        EXPECT_NEAR(line.gamma, gamma, 1e-4);
        // Cofactors of the transform, with the side kept: x and z by 1.5, y by 1, x mirrored.
        const auto turned = [&](int k) { return unit({-1.5f * normals[k][0], normals[k][1], 1.5f * normals[k][2]}); };
        const Vec upper_left = turned(2), lower_left = turned(1);
        for (size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(line.values[0][k], upper_left[k], 1e-5);
            EXPECT_NEAR(line.values[1][k], lower_left[k], 1e-5);
        }
    }
}

TEST(ScanLine, PolygonsThroughTheEyePlaneAreCut) {
    Polygon polygon;
    polygon.points = {{-3, -3}, {3, -3}, {3, 3}, {-3, 3}};
    polygon.values = {0, 0.25f, 1, 0.5f};
    Scene scene;
    show(scene, polygon);
    scene.camera(look_at({0.2f, -1, 0.7f}, {0.2f, 3, 0}), [](TrpCameraDesc& d) { d.clip_start = 0.05f; });
    scene.commit();
    for (const char* method : {"gouraud", "phong"}) {
        Render render(scene, 60, 50, kScanLines, {}, method);
        for (const float value : render.run().read().values) {
            ASSERT_GE(value, 0);
            ASSERT_LE(value, 1.0001f);
        }
        const TrpScanLine line = pick(render, 30, 10);
        EXPECT_TRUE(line.seen);
        EXPECT_EQ(std::count(line.vertices, line.vertices + 4, TRP_NO_VERTEX), 2)
            << "its sides begin at the near plane";
    }
}

TEST(ScanLine, RepeatedCornersChangeNothing) {
    Scene scene;
    MeshData m = floor_square(4);
    m.uvs.clear();
    m.corners = {0, 1, 1, 2, 3, 0};
    m.offsets = {0, 6};
    m.materials = {scene.material([](TrpMaterialDesc& d) { d.emission = {{1, 1, 1}, TRP_NO_NODE}; })};
    scene.instance(scene.mesh(m));
    scene.camera_above(16);
    scene.commit();
    Settings settings = kScanLines;
    settings.emplace_back("samples", "1");
    const Image image = Render(scene, kSide, kSide, settings, {}, "gouraud").run().read();
    for (uint32_t y = 18; y < 46; ++y)
        for (uint32_t x = 18; x < 46; ++x) ASSERT_GE(image.at(x, y)[0], 1) << x << ", " << y;
    Render render(scene, kSide, kSide, {}, {}, "gouraud");
    const TrpScanLine line = pick(render, 20, 20);
    EXPECT_EQ(line.vertices[0], 3u);
    EXPECT_EQ(line.vertices[1], 0u) << "vertex 0 is a vertex";
}

TEST(ScanLine, PickingIsGuarded) {
    Scene scene;
    scene.object(floor_square(1));
    scene.camera_above(16);
    scene.commit();
    Render gouraud(scene, 20, 10, {}, {}, "gouraud"), flat(scene, 20, 10, {}, {}, "flat");
    TrpScanLine line{};
    line.struct_size = sizeof line;
    EXPECT_EQ(trp_render_pick_scan_line(nullptr, 0, 0, &line), TRP_ERROR_ARGUMENT);
    EXPECT_EQ(trp_render_pick_scan_line(gouraud, 0, 0, nullptr), TRP_ERROR_ARGUMENT);
    EXPECT_EQ(trp_render_pick_scan_line(gouraud, 20, 0, &line), TRP_ERROR_ARGUMENT);
    EXPECT_EQ(trp_render_pick_scan_line(gouraud, 0, 10, &line), TRP_ERROR_ARGUMENT);
    EXPECT_EQ(trp_render_pick_scan_line(flat, 0, 0, &line), TRP_ERROR_STATE);
    EXPECT_EQ(pick(gouraud, 0, 0).seen, 0);
    EXPECT_EQ(pick(gouraud, 10, 5).seen, 1);
    line.struct_size = 3;
    EXPECT_EQ(trp_render_pick_scan_line(gouraud, 0, 0, &line), TRP_ERROR_ARGUMENT);
}

// ------------------------------------------------------------------------------------------------- averaged normals

// Three faces around the origin, of different angles and areas; the vertices at the origin are split.
struct Fan {
    Vec ring[3] = {{3, 0, -1}, {0.5f, 1, -0.2f}, {-1, -1.5f, -0.7f}};
    MeshData mesh() const {
        MeshData m;
        for (size_t face = 0; face < 3; ++face)
            for (const Vec& p : {Vec{0, 0, 0}, ring[face], ring[(face + 1) % 3]}) {
                m.positions.insert(m.positions.end(), p.begin(), p.end());
                m.corners.push_back(static_cast<uint32_t>(m.corners.size()));
            }
        return m;
    }
    Vec normal(size_t face) const { return unit(cross(ring[face], ring[(face + 1) % 3])); }
    float area(size_t face) const {
        const Vec twice = cross(ring[face], ring[(face + 1) % 3]);
        return std::sqrt(dot(twice, twice)) / 2;
    }
    float angle(size_t face) const { return std::acos(dot(unit(ring[face]), unit(ring[(face + 1) % 3]))); }
};

// The shading normal that is seen at the origin, from above.
Vec normal_at_origin(Scene& scene, const Settings& settings) {
    scene.camera_above(0.01f);
    scene.commit();
    const Image normal = Render(scene, 3, 3, settings, {"Normal"}, "phong").run().read("Normal");
    return {normal.at(1, 1)[0], normal.at(1, 1)[1], normal.at(1, 1)[2]};
}

void expect_near(const Vec& a, const Vec& b, const char* what) {
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 2e-3) << what;
}

TEST(AveragedNormals, WeighFacesAsAsked) {
    const Fan fan;
    const auto expected = [&](const std::function<float(size_t)>& weight) {
        Vec sum = {0, 0, 0};
        for (size_t face = 0; face < 3; ++face) sum = sum + fan.normal(face) * weight(face);
        return unit(sum);
    };
    const std::pair<const char*, Vec> cases[] = {{"plain", expected([](size_t) { return 1.0f; })},
                                                 {"angle", expected([&](size_t face) { return fan.angle(face); })},
                                                 {"area", expected([&](size_t face) { return fan.area(face); })}};
    for (const auto& [averaging, normal] : cases) {
        Scene scene;
        scene.object(fan.mesh());
        expect_near(
            normal_at_origin(
                scene, {{"raster.samples", "1"}, {"shading.normals", "averaged"}, {"shading.averaging", averaging}}),
            normal, averaging);
    }
}

TEST(AveragedNormals, FlatFacesAndSharpEdgesStay) {
    const Fan fan;
    const Settings averaged = {
        {"raster.samples", "1"}, {"shading.normals", "averaged"}, {"shading.averaging", "plain"}};
    // The origin's pixel sees one of the faces: which, a flat scene tells.
    Scene flat;
    flat.object(fan.mesh());
    const Vec seen = normal_at_origin(flat, {{"raster.samples", "1"}});
    size_t face = 0;
    while (face < 3 && dot(seen, fan.normal(face)) < 0.9999f) ++face;
    ASSERT_LT(face, 3u);

    Scene flags;
    MeshData mesh = fan.mesh();
    mesh.smooth = {1, 1, 1};
    mesh.smooth[face] = 0;
    flags.object(mesh);
    expect_near(normal_at_origin(flags, averaged), fan.normal(face), "the face is flat");

    // Both edges of the face that is seen are sharp: the other two faces are one group, it is another.
    Scene sharp;
    mesh.smooth = {1, 1, 1};
    const auto first = static_cast<uint32_t>(3 * face);
    const std::vector<uint32_t> edges = {first, first + 1, first, first + 2};
    const std::vector<uint8_t> edge_flags = {TRP_EDGE_SHARP, TRP_EDGE_SHARP};
    sharp.instance(sharp.mesh(mesh, [&](TrpMeshDesc& d) {
        d.edges = indices(edges, 2);
        d.edge_flags = {edge_flags.data(), edge_flags.size(), 0, TRP_FORMAT_UINT8};
    }));
    expect_near(normal_at_origin(sharp, averaged), fan.normal(face), "its edges are sharp");

    // One sharp edge parts nothing: the way around the vertex is open.
    Scene open;
    const std::vector<uint32_t> one_edge = {first, first + 1};
    open.instance(open.mesh(mesh, [&](TrpMeshDesc& d) {
        d.edges = indices(one_edge, 2);
        d.edge_flags = {edge_flags.data(), 1, 0, TRP_FORMAT_UINT8};
    }));
    expect_near(normal_at_origin(open, averaged), unit(fan.normal(0) + fan.normal(1) + fan.normal(2)), "one edge");
}

}  // namespace
}  // namespace trp_test
