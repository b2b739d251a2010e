// Form factors against reference values that are known by two independent ways to the digits given, and how the
// sampled ones converge to them.
#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

MeshData triangle(Vec a, Vec b, Vec c) {
    MeshData m;
    for (const Vec& p : {a, b, c}) m.positions.insert(m.positions.end(), p.begin(), p.end());
    m.offsets = {0, 3};
    m.corners = {0, 1, 2};
    return m;
}

// A regular polygon about a middle, of the area of the unit disc; it faces up or down.
MeshData disc(Vec middle, uint32_t sides, bool up) {
    MeshData m;
    const double radius = std::sqrt(2 * kPi / (sides * std::sin(2 * kPi / sides)));
    for (uint32_t k = 0; k < sides; ++k) {
        const double angle = 2 * kPi * k / sides;
        m.positions.push_back(middle[0] + static_cast<float>(radius * std::cos(angle)));
        m.positions.push_back(middle[1] + static_cast<float>(radius * std::sin(angle)));
        m.positions.push_back(middle[2]);
        m.corners.push_back(up ? k : sides - 1 - k);
    }
    m.offsets = {0, sides};
    return m;
}

// Squares of 1 m that look at each other at a distance, the one shifted along x and y.
const MeshData kFloor = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
MeshData ceiling(float distance, float x = 0, float y = 0) {
    return quad({x, y, distance}, {x, y + 1, distance}, {x + 1, y + 1, distance}, {x + 1, y, distance});
}
// A square that is hinged to the floor at x = 0, so far open.
MeshData hinged(float degrees) {
    const double angle = degrees / 180 * kPi;
    const auto x = static_cast<float>(std::cos(angle)), z = static_cast<float>(std::sin(angle));
    return quad({x, 0, z}, {0, 0, 0}, {0, 1, 0}, {x, 1, z});
}

Solution::Settings of_kind(const std::string& kind, const std::string& name, uint32_t value, uint32_t seed = 0) {
    Solution::Settings settings = by("matrix", kind);
    settings.insert(settings.end(), {{name, std::to_string(value)}, {"seed", std::to_string(seed)}});
    return settings;
}

// Two polygons that see each other, and nothing else.
struct Pair : Scene {
    Pair(const MeshData& a, const MeshData& b) {
        const uint32_t glow = wall(*this, 0.5f, 1, false);
        object(a, glow);
        object(b, glow);
    }
};

struct Known {
    const char* name;
    MeshData a, b;
    double forth, back, tolerance;
};

// The references' digits, where single precision holds the corners; else what their rounding, or so many sides for a
// disc, are worth.
const Known kKnown[] = {
    {"distance 0.5", kFloor, ceiling(0.5f), 0.4152532836, 0.4152532836, 1e-9},
    {"distance 1", kFloor, ceiling(1), 0.1998248957, 0.1998248957, 1e-9},
    {"distance 2", kFloor, ceiling(2), 0.0685895888, 0.0685895888, 1e-9},
    {"distance 10", kFloor, ceiling(10), 0.0031620568, 0.0031620568, 1e-9},
    {"shifted by (1, 0)", kFloor, ceiling(1, 1), 0.0860504892, 0.0860504892, 1e-9},
    {"shifted by (1, 1)", kFloor, ceiling(1, 1, 1), 0.0433274096, 0.0433274096, 1e-9},
    {"common edge", kFloor, hinged(90), 0.2000437761, 0.2000437761, 1e-9},
    {"a wall twice as high", kFloor, quad({0, 0, 2}, {0, 0, 0}, {0, 1, 0}, {0, 1, 2}), 0.2328526028, 0.1164263014,
     1e-9},
    {"30 degrees", kFloor, hinged(30), 0.6190283231, 0.6190283231, 5e-8},
    {"60 degrees", kFloor, hinged(60), 0.3709053212, 0.3709053212, 5e-8},
    {"120 degrees", kFloor, hinged(120), 0.0866150011, 0.0866150011, 5e-8},
    {"discs", disc({0, 0, 0}, 255, true), disc({0, 0, 1}, 255, false), 0.3819660113, 0.3819660113, 1e-7},
    {"triangles", triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), triangle({0, 0, 1}, {0, 2, 1}, {2, 0, 1}), 0.2843125210,
     0.0710781302, 1e-9},
};

TEST(FormFactorValues, OfContourIntegralsAreTheReferences) {
    for (const Known& known : kKnown) {
        Pair pair(known.a, known.b);
        Solution solution(pair, by("matrix"));
        solution.prepare();
        ASSERT_EQ(solution.info().element_count, 2u) << known.name;
        const std::vector<float> area = solution.read("area", 1);
        const double forth = solution.row(0)[1], back = solution.row(1)[0];
        EXPECT_NEAR(forth, known.forth, known.tolerance) << known.name;
        EXPECT_NEAR(back, known.back, known.tolerance) << known.name;
        EXPECT_NEAR(area[0] * forth, area[1] * back, 1e-10) << known.name;
    }
}

TEST(FormFactorValues, FromAPointAreTheReferences) {
    // A square of a millimetre under the middle of a square of a metre, and under its corner: as from a point, but for
    // the square of its size.
    for (const auto& [at, known] : {std::pair{0.5f, 0.2394564705}, {0.0f, 0.1385316060}}) {
        const float s = 0.5f / 1024;
        Pair pair(quad({at - s, at - s, 0}, {at + s, at - s, 0}, {at + s, at + s, 0}, {at - s, at + s, 0}), ceiling(1));
        EXPECT_NEAR(Solution(pair, by("matrix")).prepare().row(0)[1], known, 1e-7);
        // A hemicube's pixels have their middles: where faces end between pixels, its error falls with their area.
        double before = 0;
        for (const uint32_t resolution : {64u, 128u, 256u, 512u}) {
            Solution solution(pair, of_kind("hemicube", "radiosity.hemicube_resolution", resolution));
            const double error = std::abs(solution.prepare().row(0)[1] - known);
            if (before > 0) {
                EXPECT_NEAR(before / error, 4, 0.1) << resolution;
            }
            before = error;
        }
        EXPECT_LT(before, 1e-6);
    }
}

TEST(FormFactorValues, OfRaysFromATrapezoidAreThoseOfItsContour) {
    // Its points are uniform in area, not in its coordinates.
    for (const MeshData& trapezoid : {quad({0, 0, 0}, {1, 0, 0}, {0.6f, 1, 0}, {0.5f, 1, 0}),
                                      quad({0.5f, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0.6f, 1, 0})}) {
        Pair pair(trapezoid, ceiling(0.5f, 0, 0.5f));
        const double known = Solution(pair, by("matrix")).prepare().row(0)[1];
        Solution rays(pair, of_kind("hemisphere", "radiosity.rays", 1 << 16));
        EXPECT_NEAR(rays.prepare().row(0)[1], known, 1e-3);
    }
}

TEST(FormFactorValues, OfContoursConvergeWithTheirRaysWhereMuchIsHidden) {
    Pair pair(kFloor, ceiling(0.25f));
    pair.object(quad({0, 0, 0.125f}, {0.5f, 0, 0.125f}, {0.3f, 1, 0.125f}, {0, 1, 0.125f}), wall(pair, 0));
    const double known = Solution(pair, of_kind("hemisphere", "radiosity.rays", 1 << 18)).prepare().row(0)[1];
    double few = 0, many = 0;  // sums of squares
    for (uint32_t seed = 0; seed < 16; ++seed) {
        const auto error = [&](uint32_t rays) {
            Solution solution(pair, of_kind("analytic", "radiosity.rays", rays, seed));
            return solution.prepare().row(0)[1] - known;
        };
        few += error(64) * error(64);
        many += error(1 << 14) * error(1 << 14);
    }
    EXPECT_LT(std::sqrt(many / 16), 0.006);
    EXPECT_LT(many, few / 64);
}

TEST(FormFactorValues, OfRaysConvergeAsThoseOfIndependentOnesOrFaster) {
    // The mean over all pairs of the squares of errors over those of so many independent rays, F (1 - F) / N.
    for (const uint32_t rays : {256u, 2048u, 16384u}) {
        double sum = 0, count = 0;
        for (const Known& known : kKnown) {
            Pair pair(known.a, known.b);
            for (uint32_t seed = 0; seed < 8; ++seed, ++count) {
                Solution solution(pair, of_kind("hemisphere", "radiosity.rays", rays, seed));
                sum +=
                    std::pow(solution.prepare().row(0)[1] - known.forth, 2) / (known.forth * (1 - known.forth) / rays);
            }
        }
        EXPECT_LT(sum / count, 1) << rays;
    }
}

TEST(FormFactorValues, OfHemicubesConvergeFasterThanTheirPixelsShrink) {
    // Squares at random places, turned at random: pixels on the rim are all or nothing, and there are N of N² of them,
    // of errors by chance: N^-1.5 at least.
    const auto error = [](uint32_t resolution) {
        Random random{std::mt19937(1)};
        double squares = 0;
        constexpr int kSquares = 24;
        for (int k = 0; k < kSquares; ++k) {
            const float s = 0.5f / 1024, angle = random.between(0, 6), c = std::cos(angle) / 2, d = std::sin(angle) / 2,
                        x = random.between(-1, 1), y = random.between(-1, 1);
            Pair pair(quad({-s, -s, 0}, {s, -s, 0}, {s, s, 0}, {-s, s, 0}),
                      quad({x - c, y - d, 1}, {x - d, y + c, 1}, {x + c, y + d, 1}, {x + d, y - c, 1}));
            Solution exact(pair, by("matrix")),
                solution(pair, of_kind("hemicube", "radiosity.hemicube_resolution", resolution));
            squares += std::pow(solution.prepare().row(0)[1] - exact.prepare().row(0)[1], 2) / kSquares;
        }
        return std::sqrt(squares);
    };
    const double coarse = error(32), fine = error(512);
    EXPECT_GT(std::log(coarse / fine) / std::log(16), 1.5);
    EXPECT_LT(coarse, 2e-3);
}

TEST(FormFactorValues, OfAHemicubeAddUp) {
    // The pixels' delta form factors miss 1 by what their middles stand for.
    for (const auto& [resolution, miss] : {std::pair{64u, 1.323e-4}, {256u, 8.27e-6}, {1024u, 5.17e-7}}) {
        Scene scene;
        const uint32_t grey = wall(scene, 0.5f, 1);
        add_cube(scene, grey, grey);
        Solution solution(scene, of_kind("hemicube", "radiosity.hemicube_resolution", resolution));
        double sum = 0;
        for (const double f : solution.prepare().row(0)) sum += f;
        EXPECT_NEAR(sum - 1, miss, 0.01 * miss);
    }
}

TEST(FormFactorValues, OfFacesCloseTogetherAreWhole) {
    // Plates of a side of x distances: F = 2 / (π x²) [ln((1 + x²) / √(1 + 2 x²)) + 2 x √(1 + x²) atan(x / √(1 + x²))
    // − 2 x atan x].
    for (const float side : {1.0f, 10.0f, 100.0f, 1000.0f}) {
        const double x = side, root = std::sqrt(1 + x * x),
                     known = 2 / (kPi * x * x) *
                             (std::log((1 + x * x) / std::sqrt(1 + 2 * x * x)) + 2 * x * root * std::atan(x / root) -
                              2 * x * std::atan(x));
        Pair pair(quad({0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}),
                  quad({0, 0, 1}, {0, side, 1}, {side, side, 1}, {side, 0, 1}));
        EXPECT_NEAR(Solution(pair, by("matrix")).prepare().row(0)[1], known, 1e-6) << side;
    }
    // Squares hinged at acute angles: nothing stands between them, close to the hinge either.
    for (const auto& [degrees, known] : {std::pair{20.0f, 0.725725}, {10.0f, 0.849606}, {5.0f, 0.920256}})
        for (uint32_t seed = 0; seed < 4; ++seed) {
            Pair pair(kFloor, hinged(degrees));
            Solution solution(pair, of_kind("analytic", "radiosity.rays", 1, seed));
            solution.prepare();
            EXPECT_NEAR(solution.row(0)[1], known, 1e-5) << degrees;
            EXPECT_NEAR(solution.row(1)[0], known, 1e-5) << degrees;
        }
}

TEST(FormFactorValues, OfAClosedSceneAddUp) {
    // A prism of twelve sides that differ, of polygons; nothing stands between any two.
    constexpr uint32_t kSides = 12;
    MeshData prism;
    for (uint32_t k = 0; k < kSides; ++k) {
        const double angle = 2 * kPi * (k + 0.3 * std::sin(k)) / kSides;
        for (const float z : {0.0f, 1.0f}) {
            const Vec p = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), z};
            prism.positions.insert(prism.positions.end(), p.begin(), p.end());
        }
    }
    prism.offsets = {0};
    for (uint32_t k = 0; k < kSides; ++k) {
        const uint32_t next = (k + 1) % kSides;
        for (const uint32_t v : {2 * k, 2 * k + 1, 2 * next + 1, 2 * next}) prism.corners.push_back(v);
        prism.offsets.push_back(static_cast<uint32_t>(prism.corners.size()));
    }
    for (const uint32_t z : {0u, 1u}) {
        for (uint32_t k = 0; k < kSides; ++k) prism.corners.push_back(2 * (z ? kSides - 1 - k : k) + z);
        prism.offsets.push_back(static_cast<uint32_t>(prism.corners.size()));
    }
    Scene scene;
    scene.object(prism, wall(scene, 0.5f, 1, false));
    // Contour integrals to the relative error that rows are made with, rays but for the rounding of their sum, pixels
    // of hemicubes but for what falls between faces.
    for (const auto& [kind, tolerance] : {std::pair{"analytic", 1e-6}, {"hemisphere", 1e-12}, {"hemicube", 1e-4}}) {
        Solution solution(scene, by("matrix", kind));
        solution.prepare();
        const uint32_t count = solution.info().element_count;
        ASSERT_EQ(count, kSides + 2);
        const std::vector<float> area = solution.read("area", 1);
        std::vector<std::vector<double>> rows;
        for (uint32_t i = 0; i < count; ++i) {
            rows.push_back(solution.row(i));
            double sum = 0;
            for (const double f : rows[i]) sum += f;
            EXPECT_NEAR(sum, 1, tolerance) << kind << ' ' << i;
        }
        for (uint32_t i = 0; i < count && std::string(kind) == "analytic"; ++i)
            for (uint32_t j = 0; j < i; ++j) EXPECT_NEAR(area[i] * rows[i][j], area[j] * rows[j][i], 1e-10);
    }
}

}  // namespace
}  // namespace trp_test
