// Line drawings: coverage by the width of lines, which edges there are, and which parts of them faces hide.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "support/bodies.h"

namespace trp_test {
namespace {

// Coverage is 1 − the picture: black lines on white paper.
float ink(const Image& image, int x, int y) {
    if (x < 0 || y < 0 || x >= static_cast<int>(image.width) || y >= static_cast<int>(image.height)) return 0;
    return 1 - image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y))[0];
}

double total_ink(const Image& image) {
    return (1 - mean(image)) * image.width * image.height;
}

Image draw(Scene& scene, uint32_t width, uint32_t height, const char* method, const Settings& settings = {}) {
    return Render(scene, width, height, settings, {}, method).run().read();
}

// An edge without a face.
uint32_t loose_edge(Scene& scene, Vec a, Vec b) {
    MeshData m;
    for (const Vec& p : {a, b}) m.positions.insert(m.positions.end(), p.begin(), p.end());
    const std::vector<uint32_t> edge = {0, 1};
    return scene.instance(scene.mesh(m, [&](TrpMeshDesc& d) { d.edges = indices(edge, 2); }));
}

// A picture seen from above, 10 pixels to the metre, whose middle is at the world's origin.
constexpr uint32_t kWidth = 100, kHeight = 80;
void see_from_above(Scene& scene) {
    scene.camera_above(10);
    scene.commit();
}
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

// ------------------------------------------------------------------------------------------------------- hidden lines

using Point = std::array<double, 3>;

// A random scene of boxes, open squares and triangles, in one mesh each.
std::vector<MeshData> random_bodies(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> u(-1, 1);
    std::vector<MeshData> bodies;
    for (int k = 0; k < 10; ++k) {
        MeshData m = box({-1, -1, -1}, {1, 1, 1});
        // Faces stay flat under an affine map.
        Vec axes[3];
        for (Vec& axis : axes) axis = {u(random), u(random), u(random)};
        const Vec centre = {2.5f * u(random), 2 * u(random), -7 + 2 * u(random)};
        for (size_t v = 0; v < 8; ++v) {
            Vec p = centre;
            for (size_t a = 0; a < 3; ++a) p = p + axes[a] * (0.7f * m.positions[3 * v + a]);
            std::copy(p.begin(), p.end(), m.positions.begin() + static_cast<ptrdiff_t>(3 * v));
        }
        if (k % 3 == 0) {  // open
            m.corners.resize(12);
            m.offsets.resize(4);
        }
        bodies.push_back(std::move(m));
    }
    return bodies;
}

Point point_of(const MeshData& m, uint32_t vertex) {
    return {m.positions[3 * vertex], m.positions[3 * vertex + 1], m.positions[3 * vertex + 2]};
}
Point product(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double inner(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point minus(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// How clearly a point is hidden from the origin by one of the bodies' faces: above 0 hidden, below 0 seen; the size is
// the least change of a face's barycentric coordinates or of the distance along the way that would turn it.
double hidden_by(const std::vector<MeshData>& bodies, const Point& p, size_t own_body, uint32_t own_a, uint32_t own_b) {
    double most = -1;
    for (size_t b = 0; b < bodies.size(); ++b) {
        const MeshData& m = bodies[b];
        for (size_t face = 0; face + 1 < m.offsets.size(); ++face) {
            const uint32_t* corners = &m.corners[m.offsets[face]];
            if (b == own_body && std::count(corners, corners + 4, own_a) && std::count(corners, corners + 4, own_b))
                continue;
            // A parallelogram: p · s = a + u e1 + v e2.
            const Point a = point_of(m, corners[0]), e1 = minus(point_of(m, corners[1]), a),
                        e2 = minus(point_of(m, corners[3]), a), normal = product(e1, e2);
            const double facing = inner(p, normal);
            if (std::abs(facing) < 1e-9) continue;
            const double s = inner(a, normal) / facing;
            Point in;
            for (size_t c = 0; c < 3; ++c) in[c] = p[c] * s - a[c];
            const double area = inner(normal, normal), along1 = inner(product(in, e2), normal) / area,
                         along2 = inner(product(e1, in), normal) / area;
            most = std::max(most, std::min({along1, 1 - along1, along2, 1 - along2, 1 - s, s}));
        }
    }
    return most;
}

TEST(HiddenLine, DrawsWhatIsSeenOfEveryEdge) {
    constexpr uint32_t kW = 400, kH = 300;
    constexpr float kAngle = 1.0f;
    uint32_t seen = 0, hidden = 0, wrong = 0;
    for (uint32_t seed = 0; seed < 8; ++seed) {
        Scene scene;
        const std::vector<MeshData> bodies = random_bodies(seed);
        for (const MeshData& body : bodies) scene.object(body);
        scene.camera(kIdentity, [&](TrpCameraDesc& d) {
            d.field_of_view = kAngle;
            d.clip_start = 0.1f;
        });
        scene.commit();
        const Image image = draw(scene, kW, kH, "hidden_line");
        const double per_pixel = 2 * std::tan(kAngle / 2.0) / kW;
        // Ink within three pixels of edges that are seen, or not clearly hidden.
        std::vector<uint8_t> expected(size_t{kW} * kH, 0);
        struct Sample {
            int x, y;
            bool seen;
        };
        std::vector<Sample> samples;
        for (size_t b = 0; b < bodies.size(); ++b)
            for (size_t c = 0; c < bodies[b].corners.size(); ++c) {
                const uint32_t from = bodies[b].corners[c], to = bodies[b].corners[c % 4 == 3 ? c - 3 : c + 1];
                for (int k = 0; k <= 400; ++k) {
                    const double t = k / 400.0;
                    const Point p0 = point_of(bodies[b], from), p1 = point_of(bodies[b], to);
                    Point p;
                    for (size_t a = 0; a < 3; ++a) p[a] = p0[a] + (p1[a] - p0[a]) * t;
                    const double x = p[0] / -p[2] / per_pixel + kW / 2.0, y = p[1] / -p[2] / per_pixel + kH / 2.0;
                    if (x < 4 || y < 4 || x > kW - 5 || y > kH - 5) continue;
                    const double margin = hidden_by(bodies, p, b, from, to);
                    const int i = static_cast<int>(x), j = static_cast<int>(y);
                    if (margin < 0.02)
                        for (int dy = -3; dy <= 3; ++dy)
                            for (int dx = -3; dx <= 3; ++dx)
                                expected[static_cast<size_t>(j + dy) * kW + static_cast<size_t>(i + dx)] = 1;
                    if (std::abs(margin) > 0.02 && t > 0.02 && t < 0.98) samples.push_back({i, j, margin < 0});
                }
            }
        for (const Sample& s : samples) {
            if (s.seen) {
                ++seen;
                float most = 0;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx) most = std::max(most, ink(image, s.x + dx, s.y + dy));
                wrong += most < 0.4f;
            } else if (!expected[static_cast<size_t>(s.y) * kW + static_cast<size_t>(s.x)]) {
                ++hidden;
                wrong += ink(image, s.x, s.y) > 0.02f;
            }
        }
    }
    EXPECT_GT(seen, 10000u);
    EXPECT_GT(hidden, 3000u);
    EXPECT_EQ(wrong, 0u) << "of " << seen + hidden;
}

// The faces of a convex body that are seen from `eye`.
MeshData front_faces(const MeshData& body, Vec eye) {
    MeshData out;
    out.positions = body.positions;
    out.offsets = {0};
    for (size_t face = 0; face + 1 < body.offsets.size(); ++face) {
        Vec p[3];
        // Corners 0, 1, 2 may coincide at a pole.
        for (size_t k = 0; k < 3; ++k)
            for (size_t c = 0; c < 3; ++c)
                p[k][c] = body.positions[3 * body.corners[body.offsets[face] + k + (k > 0)] + c];
        if (dot(cross(p[1] - p[0], p[2] - p[0]), eye - p[0]) <= 0) {
            for (size_t k = 0; k < 3; ++k)
                for (size_t c = 0; c < 3; ++c) p[k][c] = body.positions[3 * body.corners[body.offsets[face] + k] + c];
            if (dot(cross(p[1] - p[0], p[2] - p[0]), eye - p[0]) <= 0) continue;
        }
        for (uint32_t c = body.offsets[face]; c < body.offsets[face + 1]; ++c) out.corners.push_back(body.corners[c]);
        out.offsets.push_back(static_cast<uint32_t>(out.corners.size()));
    }
    return out;
}

TEST(HiddenLine, AConvexBodyShowsTheEdgesOfItsFrontFaces) {
    // From faces of 30 pixels to such that are smaller than one.
    for (const int rings : {8, 40, 160}) {
        const MeshData body = sphere({0, 0, 0}, 1, rings);
        const Vec eye = {2.1f, 1.3f, 1.7f};
        Image images[2];
        for (int part = 0; part < 2; ++part) {
            Scene scene;
            MeshData mesh = part ? front_faces(body, eye) : body;
            mesh.normals.clear();
            scene.object(mesh);
            scene.camera(look_at(eye, {0, 0, 0}), [](TrpCameraDesc& d) { d.field_of_view = 0.9f; });
            scene.commit();
            images[part] = draw(scene, 300, 300, part ? "wireframe" : "hidden_line");
        }
        uint32_t differing = 0, covered = 0;
        for (int y = 0; y < 300; ++y)
            for (int x = 0; x < 300; ++x) {
                covered += ink(images[1], x, y) > 0.1f;
                differing += std::abs(ink(images[0], x, y) - ink(images[1], x, y)) > 0.1f;
            }
        EXPECT_GT(covered, 3000u);
        // Where faces at the silhouette are smaller than a pixel, some of their edges are lost; none leak.
        EXPECT_LT(differing, covered / 300) << rings << " rings";
    }
}

TEST(HiddenLine, PlatesSeenEdgeOnAreNotStippled) {
    // A plate a fraction of a pixel thick, slightly turned: its long edges are seen all along.
    for (const float thickness : {0.003f, 0.02f, 0.05f})
        for (const float slope : {0.0f, 0.02f, 0.1f}) {
            Scene scene;
            scene.object(box({-3, -1, -thickness / 2}, {3, 1, thickness / 2}), 0,
                         {1, 0, 0, 0, 0, 1, 0, 0, slope, 0, 1, 0});
            scene.camera(look_at({0, -10, 0.013f}, {0, 0, 0.013f}), [](TrpCameraDesc& d) {
                d.type = TRP_CAMERA_ORTHOGRAPHIC;
                d.width = 10;
            });
            scene.commit();
            const Image image = draw(scene, kWidth, kHeight, "hidden_line", {{"lines.width", "1"}});
            for (int x = 22; x < 78; ++x) {
                float most = 0;
                for (int y = 20; y < 60; ++y) most = std::max(most, ink(image, x, y));
                EXPECT_GT(most, 0.4f) << "column " << x << ", thickness " << thickness << ", slope " << slope;
            }
        }
}

TEST(HiddenLine, TouchingFacesKeepTheirEdges) {
    // A box that stands on a floor: the floor hides none of the lower edges before it, and the box hides those behind.
    Scene scene;
    scene.object(floor_square(4));
    scene.object(box({-1, -1, 0}, {1, 1, 1.5f}));
    scene.camera(look_at({0, -8, 5}, {0, 0, 0}), [](TrpCameraDesc& d) { d.field_of_view = 0.9f; });
    scene.commit();
    const Image image = draw(scene, 300, 200, "hidden_line");
    const auto ink_of = [&](Vec p) {
        const Vec eye = {0, -8, 5}, z = unit(eye), x = unit(cross({0, 0, 1}, z)), y = cross(z, x), to = p - eye;
        const float scale = 150 / std::tan(0.45f) / -dot(to, z);
        float most = 0;
        for (int dy = -1; dy <= 1; ++dy)
            most = std::max(most, ink(image, static_cast<int>(std::floor(dot(to, x) * scale + 150)),
                                      static_cast<int>(std::floor(dot(to, y) * scale + 100)) + dy));
        return most;
    };
    for (float x = -0.9f; x < 0.95f; x += 0.05f) {
        EXPECT_GT(ink_of({x, -1, 0}), 0.4f) << x;
        EXPECT_GT(ink_of({x, 1, 1.5f}), 0.4f) << x;
        EXPECT_LT(ink_of({x, 1, 0}), 0.02f) << x;
    }
}

TEST(HiddenLine, TouchingFacesKeepTheirEdgesFarAway) {
    // Boxes on one floor, seen at grazing angles, where a step of the film's grid is a long way on the floor.
    for (const float distance : {10.0f, 20.0f, 40.0f, 80.0f}) {
        Scene scene;
        scene.object(floor_square(200));
        scene.object(box({-1, distance, 0}, {1, distance + 2, 1.5f}), 0,
                     {0.97f, 0.2f, 0, 0, -0.2f, 0.97f, 0, 0, 0, 0, 1, 0});
        scene.camera(look_at({0.3f, 0, 1.7f}, {0.2f * distance, distance, 1}),
                     [](TrpCameraDesc& d) { d.field_of_view = 0.6f; });
        scene.commit();
        const Vec eye = {0.3f, 0, 1.7f}, z = unit(eye - Vec{0.2f * distance, distance, 1}),
                  x = unit(cross({0, 0, 1}, z)), y = cross(z, x);
        const Image image = draw(scene, 960, 540, "hidden_line");
        for (float s = -0.9f; s < 0.95f; s += 0.02f) {
            const Vec p = {0.97f * s + 0.2f * distance, -0.2f * s + 0.97f * distance, 0}, to = p - eye;
            const float scale = 480 / std::tan(0.3f) / -dot(to, z);
            float most = 0;
            for (int dy = -1; dy <= 1; ++dy)
                most = std::max(most, ink(image, static_cast<int>(std::floor(dot(to, x) * scale + 480)),
                                          static_cast<int>(std::floor(dot(to, y) * scale + 270)) + dy));
            EXPECT_GT(most, 0.3f) << "at " << s << " of the front edge, " << distance << " m away";
        }
    }
}

TEST(HiddenLine, EdgesThroughTheEyePlaneStraightOnTheFilm) {
    // The middle edge of a floor goes under the camera and stands upright on the film.
    Scene scene;
    MeshData floor;
    for (int k = 0; k < 9; ++k)
        floor.positions.insert(floor.positions.end(),
                               {static_cast<float>(k % 3 - 1) * 10, static_cast<float>(k / 3 - 1) * 10, 0});
    floor.corners = {0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, 7};
    floor.offsets = {0, 4, 8, 12, 16};
    scene.object(floor);
    scene.camera(look_at({0, 1, 1.7f}, {0, 6, 1}), [](TrpCameraDesc& d) { d.field_of_view = 0.9f; });
    scene.commit();
    const Image image = draw(scene, 1920, 1080, "hidden_line");
    for (int y = 20; y < 400; y += 10) EXPECT_GT(ink(image, 960, y) + ink(image, 959, y), 0.5f) << y;
}

TEST(HiddenLine, NothingLeaksAtTheFilmsBorder) {
    // A line half a pixel outside of the film, behind a face that reaches past it.
    for (const char* width : {"1.5", "20"}) {
        Scene scene;
        scene.object(floor_square(8, 1));
        loose_edge(scene, {-6, 4.05f, 0}, {6, 4.05f, 0});
        see_from_above(scene);
        EXPECT_NEAR(total_ink(draw(scene, kWidth, kHeight, "hidden_line", {{"lines.width", width}})), 0, 1e-3);
    }
}

TEST(HiddenLine, HiddenPartsMayBeFaintOrDashed) {
    Scene scene;
    scene.object(floor_square(2, 1));
    loose_edge(scene, {-4, 0.05f, 0}, {4, 0.05f, 0});
    see_from_above(scene);
    const auto inked = [&](const char* hidden, int from, int to) {
        const Image image = draw(scene, kWidth, kHeight, "hidden_line", {{"lines.hidden", hidden}});
        double sum = 0;
        for (int x = from; x < to; ++x) sum += ink(image, x, kHeight / 2);
        return sum / (to - from);
    };
    const double whole = inked("none", 12, 26);
    EXPECT_GT(whole, 0.6);
    EXPECT_LT(inked("none", 34, 66), 1e-3);
    EXPECT_NEAR(inked("faint", 34, 66), whole / 4, 0.02);
    // Dashes of four widths, with round ends, and gaps of four.
    EXPECT_NEAR(inked("dashed", 34, 66), whole * 5 / 8, 0.15);
    EXPECT_NEAR(inked("dashed", 12, 26), whole, 1e-3);
}

// ---------------------------------------------------------------------------------------------------------- bad input

TEST(Lines, AbsurdEdgesDoNoHarm) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> u(-1, 1);
    for (const int32_t type : {TRP_CAMERA_PERSPECTIVE, TRP_CAMERA_ORTHOGRAPHIC}) {
        Scene scene;
        MeshData m;
        const float sizes[] = {1e-30f, 1e-3f, 1, 50, 1e6f, 1e17f, 1e30f};
        for (uint32_t t = 0; t < 3000; ++t)
            for (uint32_t k = 0; k < 3; ++k) {
                const float size = sizes[random() % 7];
                for (int c = 0; c < 3; ++c) m.positions.push_back(size * u(random));
                m.corners.push_back(3 * t + k);
            }
        scene.object(m);
        for (int k = 0; k < 50; ++k)
            loose_edge(scene, {u(random) * 1e30f, 0, u(random)}, {u(random), u(random) * 1e30f, u(random) * 1e30f});
        scene.camera(kIdentity, [&](TrpCameraDesc& d) { d.type = type; });
        scene.commit();
        for (const char* method : {"wireframe", "hidden_line"})
            for (const float value : draw(scene, 120, 90, method, {{"lines.depth_cue", "0.5"}}).values)
                ASSERT_TRUE(value >= 0 && value <= 1) << method;
    }
}

TEST(Lines, EdgesThroughTheEyePlaneAreCut) {
    Scene scene;
    loose_edge(scene, {-1, -0.5f, -4}, {3, 1.5f, 4});
    scene.camera(kIdentity, [](TrpCameraDesc& d) { d.clip_start = 0.1f; });
    scene.commit();
    // The line goes through (0, 0, −2) and (0.95, 0.475, −0.1), far outside of the film.
    const Image image = draw(scene, 200, 160, "wireframe");
    EXPECT_GT(ink(image, 100, 80) + ink(image, 99, 79), 0.4f);
    EXPECT_LT(ink(image, 50, 150), 0.01f);
    EXPECT_GT(total_ink(image), 50);
}

TEST(Lines, EdgesEndAtTheFarEnd) {
    Scene scene;
    loose_edge(scene, {-2, -0.5f, -2}, {6, -0.5f, -18});  // straight on the film, to the right
    scene.camera(kIdentity, [](TrpCameraDesc& d) {
        d.clip_start = 0.1f;
        d.clip_end = 6;
        d.field_of_view = 1.6f;
    });
    scene.commit();
    // At depth 6 the edge is at (0, −0.5).
    const double per_pixel = 2 * std::tan(0.8) / 200;
    for (const char* method : {"wireframe", "hidden_line"}) {
        const Image image = draw(scene, 200, 160, method, {{"lines.width", "3"}});
        const auto inked = [&](double depth) {
            const double x = (-2 + (depth - 2) / 2) / depth / per_pixel + 100, y = -0.5 / depth / per_pixel + 80;
            return ink(image, static_cast<int>(x), static_cast<int>(y));
        };
        EXPECT_GT(inked(5.5), 0.5f) << method;
        EXPECT_LT(inked(6.8), 0.02f) << method;
        EXPECT_LT(inked(12), 0.02f) << method;
    }
}

TEST(Lines, ASceneWithoutEdgesIsPaper) {
    Scene scene;
    see_from_above(scene);
    for (const char* method : {"wireframe", "hidden_line"}) EXPECT_EQ(total_ink(draw(scene, 40, 30, method)), 0);
}

TEST(Lines, ManyEdgesInOnePixel) {
    Scene scene;
    MeshData tiny = sphere({0, 0, 0}, 1e-3f, 200);
    scene.object(tiny);
    see_from_above(scene);
    for (const char* method : {"wireframe", "hidden_line"}) {
        const Image image = draw(scene, kWidth, kHeight, method);
        EXPECT_GT(total_ink(image), 0.5) << method;
        EXPECT_LT(total_ink(image), 4) << method;
    }
}

TEST(Lines, DepthOfFieldIsRefused) {
    Scene scene;
    scene.object(floor_square(1));
    scene.camera(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}), [](TrpCameraDesc& d) { d.aperture_radius = 0.1f; });
    scene.commit();
    for (const char* method : {"wireframe", "hidden_line"}) {
        Render render(scene, 20, 20, {}, {}, method);
        EXPECT_EQ(trp_render_run(render, nullptr), TRP_ERROR_STATE);
        EXPECT_NE(std::string(trp_error_message()).find("ray_casting"), std::string::npos) << trp_error_message();
    }
}

}  // namespace
}  // namespace trp_test
