// Hidden lines: which parts of edges faces hide.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "support/drawings.h"

namespace trp_test {
namespace {

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
    for (int step = 0; step <= 36; ++step) {
        const float x = -0.9f + 0.05f * static_cast<float>(step);
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
        for (int step = 0; step <= 92; ++step) {
            const float s = -0.9f + 0.02f * static_cast<float>(step);
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

// A floor of quads with sides of `cell` from −half to half, `apart`: each with vertices of its own.
MeshData fine_floor(int cells, float cell, bool apart) {
    MeshData m;
    const float half = static_cast<float>(cells) * cell / 2;
    const auto add = [&](int i, int j) {
        m.positions.insert(m.positions.end(),
                           {static_cast<float>(i) * cell - half, static_cast<float>(j) * cell - half, 0});
    };
    m.offsets = {0};
    if (!apart)
        for (int k = 0; k < (cells + 1) * (cells + 1); ++k) add(k % (cells + 1), k / (cells + 1));
    for (int k = 0; k < cells * cells; ++k) {
        const int i = k % cells, j = k / cells;
        for (const auto& [u, v] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
            m.corners.push_back(static_cast<uint32_t>(apart ? m.positions.size() / 3 : v * (cells + 1) + u));
            if (apart) add(u, v);
        }
        m.offsets.push_back(static_cast<uint32_t>(m.corners.size()));
    }
    return m;
}

TEST(HiddenLine, ShortEdgesAreHiddenByWhatLiesCloseBeforeThem) {
    // Edges of 0.7, 1.9 and 4.3 pixels under a square of another object, or of their own.
    for (const float cell : {0.07f, 0.19f, 0.43f})
        for (const float height : {0.001f, 0.05f, 2.0f})
            for (const bool same_object : {false, true}) {
                Scene scene;
                MeshData floor = fine_floor(static_cast<int>(9 / cell), cell, false);
                const MeshData cover = floor_square(2, height);
                if (same_object) {
                    const auto first = static_cast<uint32_t>(floor.positions.size() / 3);
                    floor.positions.insert(floor.positions.end(), cover.positions.begin(), cover.positions.end());
                    for (const uint32_t corner : {0u, 1u, 2u, 3u}) floor.corners.push_back(first + corner);
                    floor.offsets.push_back(static_cast<uint32_t>(floor.corners.size()));
                } else {
                    scene.object(cover);
                }
                scene.object(floor);
                see_from_above(scene);
                const Image image = draw(scene, kWidth, kHeight, "hidden_line", {{"lines.width", "1"}});
                double within = 0, outside = 0;
                for (int y = 22; y < 58; ++y)
                    for (int x = 32; x < 68; ++x) within += ink(image, x, y);
                for (int y = 5; y < 15; ++y)
                    for (int x = 32; x < 68; ++x) outside += ink(image, x, y) / 360;
                const auto which = ::testing::Message() << cell << " m, " << height << " m above, " << same_object;
                EXPECT_EQ(within, 0) << which;
                EXPECT_GT(outside, 0.3) << which;
            }
}

TEST(HiddenLine, VerticesAtOnePlaceAreOne) {
    // Faces with vertices of their own, as game formats have them.
    for (const float cell : {0.07f, 0.19f, 0.43f}) {
        Image images[2];
        for (const bool apart : {false, true}) {
            Scene scene;
            scene.object(fine_floor(static_cast<int>(6 / cell), cell, apart));
            scene.camera(look_at({0, -6, 3}, {0, 0, 0}), [](TrpCameraDesc& d) { d.field_of_view = 0.9f; });
            scene.commit();
            images[apart] = draw(scene, 200, 100, "hidden_line");
        }
        EXPECT_GT(total_ink(images[0]), 2000);
        EXPECT_NEAR(total_ink(images[1]), total_ink(images[0]), 0.001 * total_ink(images[0])) << cell;
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

}  // namespace
}  // namespace trp_test
