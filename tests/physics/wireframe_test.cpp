// Wireframes: coverage by the width of lines, which edges there are, and what colours them.
#include <algorithm>
#include <cmath>

#include "support/drawings.h"

namespace trp_test {
namespace {

int pixel(float metres, uint32_t size) {
    return static_cast<int>(std::floor(metres * 10 + static_cast<float>(size) / 2));
}
float ink_at(const Image& image, float x, float y) {
    return ink(image, pixel(x, kWidth), pixel(y, kHeight));
}

TEST(Wireframe, CoversAsMuchAsTheLineIsWide) {
    // Filters whose weights add up to 1 wherever the line lies between pixels.
    for (const auto& [filter, filter_width] : {std::pair{"box", "1"}, {"gaussian", "2.5"}, {"blackman_harris", "1.5"}})
        for (const double width : {0.3, 1.0, 2.5, 6.0})
            for (const Vec to : {Vec{3, 0.013f, 0}, Vec{0.031f, 3, 0}, Vec{2, 2.3f, 0}, Vec{-2.5f, 1, 0}}) {
                Scene scene;
                loose_edge(scene, to * -1, to);
                see_from_above(scene);
                const Image image = draw(scene, kWidth, kHeight, "wireframe",
                                         {{"lines.width", std::to_string(width)},
                                          {"film.filter", filter},
                                          {"film.filter_width", filter_width}});
                const double length = 20 * std::sqrt(dot(to, to));
                // The ends are round, and blurred by the filter. A box that turns with the line is not the pixel's.
                EXPECT_NEAR(total_ink(image), width * length + kPi * width * width / 4, 0.03 * width * length + 0.15)
                    << filter << ", width " << width << ", to " << to[0] << ", " << to[1];
            }
}

TEST(Wireframe, ACrossSectionHoldsTheWidthExactly) {
    // A box filter of one pixel: the coverage of a horizontal line is that of a strip, wherever it lies.
    for (const float y : {0.0f, 0.013f, 0.05f, -0.031f})
        for (const double width : {0.4, 1.0, 3.2}) {
            Scene scene;
            loose_edge(scene, {-3, y, 0}, {3, y, 0});
            see_from_above(scene);
            const Image image =
                draw(scene, kWidth, kHeight, "wireframe",
                     {{"lines.width", std::to_string(width)}, {"film.filter", "box"}, {"film.filter_width", "1"}});
            const double middle = y * 10 + kHeight / 2.0;
            for (int row = 0; row < static_cast<int>(kHeight); ++row) {
                const double covered =
                    std::max(0.0, std::min(row + 1.0, middle + width / 2) - std::max(row + 0.0, middle - width / 2));
                // Places on the film are multiples of 1/256 pixel.
                EXPECT_NEAR(ink(image, kWidth / 2, row), covered, 1 / 256.0 + 1e-3) << "row " << row << ", y " << y;
            }
        }
}

TEST(Wireframe, LinesThatMeetDoNotDarkenTheirVertex) {
    Scene scene;
    for (int k = 0; k < 12; ++k) {
        const double angle = 2 * kPi * k / 12;
        loose_edge(scene, {0, 0, 0},
                   {3 * static_cast<float>(std::cos(angle)), 3 * static_cast<float>(std::sin(angle)), 0});
    }
    see_from_above(scene);
    const Image image = draw(scene, kWidth, kHeight, "wireframe", {{"lines.width", "0.5"}});
    float along = 0;
    for (int y = -25; y < 25; ++y)
        for (int x = -25; x < 25; ++x)
            if (std::hypot(x, y) > 10) along = std::max(along, ink(image, kWidth / 2 + x, kHeight / 2 + y));
    for (int y = -2; y <= 1; ++y)
        for (int x = -2; x <= 1; ++x) EXPECT_LE(ink(image, kWidth / 2 + x, kHeight / 2 + y), along + 0.01f);
}

TEST(Wireframe, AFaceHasNoDiagonal) {
    Scene scene;
    scene.object(floor_square(3));
    see_from_above(scene);
    const Image image = draw(scene, kWidth, kHeight, "wireframe");
    for (int y = 14; y < 66; ++y)
        for (int x = 24; x < 76; ++x) EXPECT_EQ(ink(image, x, y), 0) << x << ", " << y;
    for (int y = 14; y < 66; ++y) EXPECT_GT(ink(image, 20, y) + ink(image, 19, y), 0.9f);
}

// Two squares side by side that a file has split: four vertices each.
MeshData split_squares(float turned) {
    MeshData m = quad({-2, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-2, 1, 0}),
             right = quad({0, -1, 0}, {2, -1, turned}, {2, 1, turned}, {0, 1, 0});
    m.positions.insert(m.positions.end(), right.positions.begin(), right.positions.end());
    m.corners = {0, 1, 2, 3, 4, 5, 6, 7};
    m.offsets = {0, 4, 8};
    m.uvs.clear();
    return m;
}

Settings only(std::initializer_list<std::pair<const char*, std::string>> more) {
    Settings settings = {{"lines.all", "off"},     {"lines.silhouettes", "off"},      {"lines.borders", "off"},
                         {"lines.creases", "off"}, {"lines.material_borders", "off"}, {"lines.marked", "off"}};
    settings.insert(settings.end(), more);
    return settings;
}

TEST(Wireframe, EdgesAreWeldedByPosition) {
    Scene scene;
    scene.object(split_squares(0));
    see_from_above(scene);
    const Image borders = draw(scene, kWidth, kHeight, "wireframe", only({{"lines.borders", "on"}}));
    EXPECT_GT(ink_at(borders, -2, 0), 0.3f);
    EXPECT_GT(ink_at(borders, 2, 0), 0.3f);
    EXPECT_EQ(ink_at(borders, 0, 0), 0) << "the edge between the squares has two faces";
    EXPECT_GT(ink_at(draw(scene, kWidth, kHeight, "wireframe"), 0, 0), 0.3f);
}

TEST(Wireframe, ClassesAreDrawnAlone) {
    Scene scene;
    MeshData bent = split_squares(1);  // by 26.6°
    bent.materials = {scene.diffuse(1, 0, 0), scene.diffuse(0, 1, 0)};
    const std::vector<uint32_t> edges = {1, 2, 5, 6}, face_materials = {0, 1};
    const std::vector<uint8_t> flags = {0, TRP_EDGE_MARKED};
    scene.instance(scene.mesh(bent));
    // Higher up, the same with its own edges, marks and materials.
    scene.instance(scene.mesh(bent,
                              [&](TrpMeshDesc& d) {
                                  d.edges = indices(edges, 2);
                                  d.edge_flags = {flags.data(), flags.size(), 0, TRP_FORMAT_UINT8};
                                  d.face_materials = indices(face_materials);
                              }),
                   translation({0, 2.5f, 0}));
    see_from_above(scene);
    const auto drawn = [&](const Settings& settings, float x, float y) {
        return ink_at(draw(scene, kWidth, kHeight, "wireframe", settings), x, y) > 0.3f;
    };
    const Settings creases = only({{"lines.creases", "on"}, {"lines.crease_angle", "0.46"}}),
                   sharper = only({{"lines.creases", "on"}, {"lines.crease_angle", "0.47"}}),
                   materials = only({{"lines.material_borders", "on"}}), marked = only({{"lines.marked", "on"}});
    EXPECT_TRUE(drawn(creases, 0, 0) && drawn(creases, 0, 2.5f));
    EXPECT_FALSE(drawn(sharper, 0, 0) || drawn(sharper, 0, 2.5f));
    EXPECT_TRUE(drawn(materials, 0, 2.5f));
    EXPECT_FALSE(drawn(materials, 0, 0));
    EXPECT_TRUE(drawn(marked, 2, 2.5f));
    EXPECT_FALSE(drawn(marked, 0, 2.5f) || drawn(marked, 2, 0));
    EXPECT_FALSE(drawn({}, -2, 2.5f)) << "a mesh that gives its edges has no others";
}

TEST(Wireframe, FacesWithoutAreaHaveNoEdges) {
    // Between the two squares of one plane, a triangle whose corners lie on their common side.
    Scene scene;
    MeshData m = split_squares(0);
    m.positions.insert(m.positions.end(), {0, 0, 0});
    m.corners = {0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 2};
    m.offsets = {0, 4, 8, 11};
    scene.object(m);
    see_from_above(scene);
    const Image image = draw(scene, kWidth, kHeight, "wireframe", {{"lines.all", "off"}});
    EXPECT_EQ(ink_at(image, 0, 0.5f), 0);
    EXPECT_GT(ink_at(image, 2, 0.5f), 0.3f);
}

TEST(Wireframe, SilhouettesAreTheOutlineOfAClosedMesh) {
    // Also with a mirrored transform, and with faces that are wound against each other.
    for (const bool flipped : {false, true})
        for (const float mirror : {1.0f, -1.0f}) {
            Scene scene;
            MeshData cube = box({-1, -1, -1}, {1, 1, 1});
            if (flipped) std::reverse(cube.corners.begin(), cube.corners.begin() + 4);
            scene.object(cube, 0, {mirror * 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0});
            scene.camera(look_at({6, 5, 4}, {0, 0, 0}), [](TrpCameraDesc& d) {
                d.type = TRP_CAMERA_ORTHOGRAPHIC;
                d.width = 10;
            });
            scene.commit();
            // The outline of a cube seen along (6, 5, 4) is a hexagon; the three inner edges meet in (2, 2, 2).
            const Image outline = draw(scene, 200, 160, "wireframe", only({{"lines.silhouettes", "on"}}));
            const auto at = [&](Vec p) {
                const Vec z = unit(Vec{6, 5, 4}), x = unit(cross({0, 0, 1}, z)), y = cross(z, x);
                return ink(outline, static_cast<int>(std::floor(dot(p, x) * 20 + 100)),
                           static_cast<int>(std::floor(dot(p, y) * 20 + 80)));
            };
            for (const Vec& middle : {Vec{0, 2, -2}, {2, 0, -2}, {-2, 2, 0}, {2, -2, 0}, {-2, 0, 2}, {0, -2, 2}})
                EXPECT_GT(at(middle), 0.3f) << flipped << mirror << ": " << middle[0] << ", " << middle[1];
            for (const Vec& middle : {Vec{2, 2, 0}, {2, 0, 2}, {0, 2, 2}, {-2, -2, 0}, {-2, 0, -2}, {0, -2, -2}})
                EXPECT_LT(at(middle), 0.05f) << flipped << mirror << ": " << middle[0] << ", " << middle[1];
        }
}

TEST(Wireframe, ColoursAndDepthCue) {
    Scene scene;
    MeshData square = floor_square(1);
    square.materials = {scene.diffuse(0, 0.5f, 0)};
    scene.instance(scene.mesh(square), translation({-2, 0, 4}), [](TrpInstanceDesc& d) {
        d.color[0] = 1, d.color[1] = d.color[2] = 0;
        d.index = 7;
    });
    square.materials = {scene.diffuse(0, 0, 0.5f)};
    scene.instance(scene.mesh(square), translation({2, 0, -4}), [](TrpInstanceDesc& d) {
        d.color[0] = d.color[1] = 0, d.color[2] = 1;
        d.index = 9;
    });
    see_from_above(scene);
    const int left = pixel(-3, kWidth), right = pixel(3, kWidth), middle = pixel(0, kHeight);
    const auto at = [](const Image& image, int x, int y) {
        return image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
    };
    const Settings thick = {{"lines.width", "3"}};
    const auto with = [&](const char* name, const char* value) {
        Settings settings = thick;
        settings.emplace_back(name, value);
        return settings;
    };
    const Image objects = draw(scene, kWidth, kHeight, "wireframe", with("lines.color_by", "object"));
    EXPECT_NEAR(at(objects, left, middle)[0], 1, 1e-5);
    EXPECT_NEAR(at(objects, left, middle)[2], 0, 0.02);
    EXPECT_NEAR(at(objects, right, middle)[2], 1, 1e-5);
    const Image materials = draw(scene, kWidth, kHeight, "wireframe", with("lines.color_by", "material"));
    EXPECT_NEAR(at(materials, left, middle)[1], 0.5, 0.02);
    EXPECT_NEAR(at(materials, right, middle)[2], 0.5, 0.02);
    const Image cue = draw(scene, kWidth, kHeight, "wireframe", with("lines.depth_cue", "0.75"));
    EXPECT_NEAR(at(cue, left, middle)[0], 0, 0.02);
    EXPECT_NEAR(at(cue, right, middle)[0], 0.75, 0.02);

    Render passes(scene, kWidth, kHeight, thick, {"Depth", "Position", "IndexOB"}, "wireframe");
    passes.run();
    EXPECT_NEAR(at(passes.read("Depth"), left, middle)[0], 6, 1e-4);
    EXPECT_NEAR(at(passes.read("Depth"), right, middle)[0], 14, 1e-4);
    EXPECT_NEAR(at(passes.read("Depth"), kWidth / 2, middle)[0], 1e10, 1e5);
    EXPECT_EQ(at(passes.read("IndexOB"), left, middle)[0], 7);
    EXPECT_EQ(at(passes.read("IndexOB"), right, middle)[0], 9);
    EXPECT_NEAR(at(passes.read("Position"), right, middle)[2], -4, 1e-4);
    EXPECT_NEAR(at(passes.read("Position"), right, middle)[0], 3, 0.06);
    const Image clear = draw(scene, kWidth, kHeight, "wireframe", with("film.transparent", "on"));
    EXPECT_EQ(at(clear, kWidth / 2, middle)[3], 0);
    EXPECT_NEAR(at(clear, left, middle)[3], 1, 0.02);
}

TEST(Wireframe, NearerLinesLieOnTop) {
    // A red line over a green one, both wide: no green within the red, and the red's rim mixed with green.
    Scene scene;
    MeshData m;
    m.positions = {-3, 0, 0, 3, 0, 0};
    const std::vector<uint32_t> edge = {0, 1};
    const uint32_t line = scene.mesh(m, [&](TrpMeshDesc& d) { d.edges = indices(edge, 2); });
    scene.instance(line, kIdentity, [](TrpInstanceDesc& d) { d.color[0] = d.color[2] = 0; });
    scene.instance(line, {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 5},
                   [](TrpInstanceDesc& d) { d.color[1] = d.color[2] = 0; });
    see_from_above(scene);
    const Image image = draw(scene, kWidth, kHeight, "wireframe", {{"lines.color_by", "object"}, {"lines.width", "9"}});
    for (int x = -9; x < 9; ++x) {
        const float* at = image.at(static_cast<uint32_t>(50 + x), 40);
        EXPECT_NEAR(at[0] + at[1], 1, 0.01) << "no paper shows where lines cross";
        if (std::abs(x + 0.5) < 3) {
            EXPECT_NEAR(at[0], 1, 0.01);
        }
        if (std::abs(x + 0.5) > 7) {
            EXPECT_NEAR(at[1], 1, 0.01);
        }
    }
}

}  // namespace
}  // namespace trp_test
