// Form factors between polygons against closed forms, sums that must close, and plain numerical integration.
#include "radiosity/polygon_factors.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace trp {
namespace {

using std::numbers::pi;
using Polygon = std::vector<Vec3d>;

// The parallelogram (origin, origin + u, origin + u + v, origin + v), its front along u × v.
Polygon parallelogram(const Vec3d& origin, const Vec3d& u, const Vec3d& v) {
    return {origin, origin + u, origin + u + v, origin + v};
}

Polygon floor_rectangle(double x, double y, double width, double depth) {
    return parallelogram({x, y, 0}, {width, 0, 0}, {0, depth, 0});
}

Polygon ceiling_square(double x, double y, double z) {
    return parallelogram({x, y, z}, {0, 1, 0}, {1, 0, 0});
}

// On the y axis from 0 to 1, `degrees` from the floor.
Polygon hinged(double degrees) {
    const double angle = degrees * pi / 180;
    return parallelogram({0, 0, 0}, {0, 1, 0}, {std::cos(angle), 0, std::sin(angle)});
}

double area_of(const Polygon& polygon) {
    Vec3d sum(0, 0, 0);
    for (size_t i = 1; i + 1 < polygon.size(); ++i) sum += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
    return 0.5 * sum.length();
}

double factor(const Polygon& a, const Polygon& b) {
    return polygon_to_polygon(a, b) / area_of(a);
}

Polygon reversed(Polygon polygon) {
    return {polygon.rbegin(), polygon.rend()};
}

class Random {
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    Vec3d direction() {
        for (;;) {
            const Vec3d v(between(-1, 1), between(-1, 1), between(-1, 1));
            if (v.length2() < 1 && v.length2() > 0.01) return v.normalized();
        }
    }
    // Convex: on an ellipse.
    Polygon polygon(const Vec3d& centre, double radius, int corners) {
        const Vec3d normal = direction(), x = normal.cross(direction()).normalized();
        const Vec3d y = normal.cross(x) * std::pow(10, between(-0.7, 0));
        Polygon out;
        for (int i = 0; i < corners; ++i) {
            const double angle = (i + between(-0.3, 0.3)) * 2 * pi / corners;
            out.push_back(centre + (x * std::cos(angle) + y * std::sin(angle)) * radius);
        }
        return out;
    }

  private:
    std::mt19937 engine_;
};

// A rotation, a scale and a shift.
struct Motion {
    std::array<Vec3d, 3> axes;
    double scale = 1;
    Vec3d shift{0, 0, 0};

    Motion(Random& random, double by, double away) : scale(by), shift(random.direction() * (away * by)) {
        axes[0] = random.direction();
        axes[1] = axes[0].cross(random.direction()).normalized();
        axes[2] = axes[0].cross(axes[1]);
    }
    Vec3d vector(const Vec3d& v) const { return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z; }
    Vec3d point(const Vec3d& p) const { return vector(p) * scale + shift; }
    Polygon polygon(const Polygon& in) const {
        Polygon out;
        out.reserve(in.size());
        for (const Vec3d& p : in) out.push_back(point(p));
        return out;
    }
};

// Visits the middles of n × n cells of a convex quad, with their areas.
template <typename Visit>
void visit_cells(const Polygon& quad, int n, const Visit& visit) {
    const Vec3d u0 = quad[1] - quad[0], v0 = quad[3] - quad[0], uv = quad[2] - quad[3] - u0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double u = (i + 0.5) / n, v = (j + 0.5) / n;
            visit(quad[0] + (u0 + uv * v) * u + v0 * v, (u0 + uv * v).cross(v0 + uv * u).length() / (n * n));
        }
}

Vec3d normal_of(const Polygon& p) {
    return (p[1] - p[0]).cross(p[2] - p[0]).normalized();
}

// cos cos / (π r²), 0 where either looks away.
double kernel(const Vec3d& x, const Vec3d& normal_x, const Vec3d& y, const Vec3d& normal_y) {
    const Vec3d r = y - x;
    const double r2 = r.length2();
    return std::max(0.0, normal_x.dot(r)) * std::max(0.0, -normal_y.dot(r)) / (pi * r2 * r2);
}

TEST(PolygonFactors, ClosedForms) {
    const Polygon square = floor_rectangle(0, 0, 1, 1);
    EXPECT_NEAR(factor(square, ceiling_square(0, 0, 0.5)), 0.4152532836, 1e-10);
    EXPECT_NEAR(factor(square, ceiling_square(0, 0, 1)), 0.1998248957, 1e-10);
    EXPECT_NEAR(factor(square, ceiling_square(0, 0, 2)), 0.0685895888, 1e-10);
    EXPECT_NEAR(factor(square, ceiling_square(0, 0, 10)), 0.0031620568, 1e-10);
    EXPECT_NEAR(factor(square, ceiling_square(1, 0, 1)), 0.0860504892, 1e-10);
    EXPECT_NEAR(factor(square, ceiling_square(1, 1, 1)), 0.0433274096, 1e-10);
    const Polygon wall = parallelogram({0, 0, 0}, {0, 1, 0}, {0, 0, 1});
    const Polygon tall = parallelogram({0, 0, 0}, {0, 1, 0}, {0, 0, 2});
    EXPECT_NEAR(factor(square, wall), 0.2000437761, 1e-10);
    EXPECT_NEAR(factor(square, tall), 0.2328526028, 1e-10);
    EXPECT_NEAR(factor(tall, square), 0.1164263014, 1e-10);
    EXPECT_NEAR(factor(square, hinged(30)), 0.6190283231, 1e-10);
    EXPECT_NEAR(factor(square, hinged(60)), 0.3709053212, 1e-10);
    EXPECT_NEAR(factor(square, hinged(120)), 0.0866150011, 1e-10);
    const Polygon triangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, twice = {{0, 0, 1}, {0, 2, 1}, {2, 0, 1}};
    EXPECT_NEAR(factor(triangle, twice), 0.2843125210, 1e-10);
    EXPECT_NEAR(factor(twice, triangle), 0.0710781302, 1e-10);
    EXPECT_NEAR(point_to_polygon({0.5, 0.5, 0}, {0, 0, 1}, ceiling_square(0, 0, 1)), 0.2394564705, 1e-10);
    EXPECT_NEAR(point_to_polygon({0, 0, 0}, {0, 0, 1}, ceiling_square(0, 0, 1)), 0.1385316060, 1e-10);
}

TEST(PolygonFactors, ACubeCloses) {
    const std::array<Polygon, 6> faces = {
        parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), parallelogram({0, 0, 1}, {0, 1, 0}, {1, 0, 0}),
        parallelogram({0, 0, 0}, {0, 1, 0}, {0, 0, 1}), parallelogram({1, 0, 0}, {0, 0, 1}, {0, 1, 0}),
        parallelogram({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), parallelogram({0, 1, 0}, {1, 0, 0}, {0, 0, 1})};
    Random random(1);
    for (int turn = 0; turn < 10; ++turn) {
        const Motion motion(random, 1, 3);
        for (const Polygon& a : faces) {
            double sum = 0;
            for (const Polygon& b : faces) {
                const double there = factor(motion.polygon(a), motion.polygon(b));
                sum += there;
                EXPECT_NEAR(there, factor(motion.polygon(b), motion.polygon(a)), 1e-12);
            }
            EXPECT_NEAR(sum, 1, 1e-10);
        }
    }
}

// Every pair of faces shares an edge, and no two edges that matter are parallel.
TEST(PolygonFactors, RandomTetrahedraClose) {
    Random random(2);
    for (int i = 0; i < 10; ++i) {
        std::array<Vec3d, 4> p;
        do
            for (Vec3d& corner : p) corner = random.direction() * random.between(0.5, 1.5);
        while ((p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) < 0.3);
        const Polygon faces[] = {{p[0], p[1], p[2]}, {p[0], p[3], p[1]}, {p[0], p[2], p[3]}, {p[1], p[3], p[2]}};
        for (const Polygon& a : faces) {
            double sum = 0;
            for (const Polygon& b : faces) sum += factor(a, b);
            EXPECT_NEAR(sum, 1, 1e-10);
        }
    }
}

// Edges that are all but parallel.
TEST(PolygonFactors, PrismsThatAreNearlyCubesClose) {
    Random random(10);
    for (int power = -14; power <= -1; ++power) {
        std::array<Vec3d, 4> low = {Vec3d(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, high = low;
        const Vec3d lean = Vec3d(0, 0, 1) + random.direction() * std::pow(10, power);
        for (size_t i = 0; i < 4; ++i) {
            const Vec3d off = random.direction() * std::pow(10, power);
            low[i] += Vec3d(off.x, off.y, 0), high[i] = low[i] + lean;
        }
        const Motion motion(random, 1, 1);
        std::vector<Polygon> faces = {{low.begin(), low.end()}, {high.rbegin(), high.rend()}};
        for (size_t i = 0; i < 4; ++i) faces.push_back({low[(i + 1) % 4], low[i], high[i], high[(i + 1) % 4]});
        for (const Polygon& a : faces) {
            double sum = 0;
            for (const Polygon& b : faces) sum += factor(motion.polygon(a), motion.polygon(b));
            EXPECT_NEAR(sum, 1, 1e-10) << power;
        }
    }
}

TEST(PolygonFactors, PartsAddUp) {
    Random random(3);
    int counted = 0;
    for (int i = 0; i < 300; ++i) {
        const Polygon a = random.polygon({0, 0, 0}, 1, 4);
        const Polygon b = random.polygon(random.direction() * random.between(0.3, 6), random.between(0.1, 1), 4);
        const double whole = polygon_to_polygon(a, b);
        const double s = random.between(0.05, 0.95), t = random.between(0.05, 0.95);
        const Vec3d p = b[0] + (b[1] - b[0]) * s, q = b[3] + (b[2] - b[3]) * t;
        const double parts =
            polygon_to_polygon(a, Polygon{b[0], p, q, b[3]}) + polygon_to_polygon(a, Polygon{p, b[1], b[2], q});
        EXPECT_NEAR(parts, whole, 1e-11 * std::min(area_of(a), area_of(b))) << i;
        EXPECT_NEAR(polygon_to_polygon(b, a), whole, 1e-11 * std::min(area_of(a), area_of(b))) << i;
        counted += whole > 0;
    }
    EXPECT_GT(counted, 50);
}

TEST(PolygonFactors, TurningMovingAndScalingChangeNothing) {
    const Polygon triangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, twice = {{0, 0, 1}, {0, 2, 1}, {2, 0, 1}};
    const Polygon square = floor_rectangle(0, 0, 1, 1), far = ceiling_square(3, 5, 9);
    Random random(4);
    for (int power = -6; power <= 6; ++power) {
        const double scale = std::pow(10, power);
        const Motion motion(random, scale, 2);
        const double area = scale * scale;
        const auto moved = [&](const Polygon& a, const Polygon& b) {
            return polygon_to_polygon(motion.polygon(a), motion.polygon(b)) / area;
        };
        EXPECT_NEAR(moved(triangle, twice), 0.5 * 0.2843125210, 1e-10);
        EXPECT_NEAR(moved(square, hinged(90)), 0.2000437761, 1e-10);
        EXPECT_NEAR(moved(square, hinged(30)), 0.6190283231, 1e-10);
        EXPECT_NEAR(moved(square, far) / polygon_to_polygon(square, far), 1, 1e-10);
        EXPECT_NEAR(point_to_polygon(motion.point({0, 0, 0}), motion.vector({0, 0, 1}),
                                     motion.polygon(ceiling_square(0, 0, 1))),
                    0.1385316060, 1e-10);
    }
}

// A patch of a wall on the edge of a floor; the values by the same contour integral to 50 digits.
TEST(PolygonFactors, SmallOnesBesideLargeOnes) {
    const Polygon square = floor_rectangle(0, 0, 1, 1);
    const struct {
        double size, value;
    } patches[] = {{0.1, 0.004606320789157934798}, {0.01, 4.9607882221326922269e-5}, {0.001, 4.9960789814412512945e-7}};
    Random random(12);
    for (const auto& [size, value] : patches) {
        const Polygon patch = parallelogram({0, 0.5, 0}, {0, size, 0}, {0, 0, size});
        const Motion motion(random, 1, 0);
        EXPECT_NEAR(polygon_to_polygon(square, patch), value, 2e-12 * size * size) << size;
        EXPECT_NEAR(polygon_to_polygon(patch, square, 1e-6), value, 1e-6 * value) << size;
        EXPECT_NEAR(polygon_to_polygon(motion.polygon(square), motion.polygon(patch)), value, 2e-12 * size * size);
    }
}

// A wall through a floor: what counts is the quarter of the cross in front of both.
TEST(PolygonFactors, CrossingPolygons) {
    const Polygon wide = floor_rectangle(-1, 0, 2, 1), wall = parallelogram({0, 0, -2}, {0, 1, 0}, {0, 0, 4});
    EXPECT_NEAR(polygon_to_polygon(wide, wall), 0.2328526028, 1e-10);
    EXPECT_NEAR(polygon_to_polygon(wall, wide), 0.2328526028, 1e-10);
    EXPECT_NEAR(polygon_to_polygon(reversed(wide), wall), 0.2328526028, 1e-10);
    EXPECT_NEAR(polygon_to_polygon(wide, wall, 1e-4), 0.2328526028, 1e-4);
}

TEST(PolygonFactors, CutByEachOthersPlanes) {
    Random random(5);
    int counted = 0;
    for (int tries = 0; tries < 1000 && counted < 12; ++tries) {
        const Polygon a = random.polygon({0, 0, 0}, 1, 4), b = random.polygon(random.direction() * 2.5, 1, 4);
        const Vec3d normal_a = normal_of(a), normal_b = normal_of(b);
        int before_a = 0, before_b = 0;
        for (const Vec3d& p : b) before_a += normal_a.dot(p - a[0]) > 0;
        for (const Vec3d& p : a) before_b += normal_b.dot(p - b[0]) > 0;
        if (before_a % 4 == 0 || before_b % 4 == 0) continue;
        ++counted;
        double sum = 0;
        visit_cells(a, 28, [&](const Vec3d& x, double area_x) {
            visit_cells(b, 28, [&](const Vec3d& y, double area_y) {
                sum += kernel(x, normal_a, y, normal_b) * area_x * area_y;
            });
        });
        const double exact = polygon_to_polygon(a, b);
        EXPECT_NEAR(sum, exact, 0.01 * exact + 1e-5) << tries;
        EXPECT_GT(exact, 0) << tries;
    }
    EXPECT_EQ(counted, 12);
}

TEST(PolygonFactors, ConcavePolygonsAreTheSumOfTheirParts) {
    // A U with its opening upwards, upright at y = 2 and looking at −y; a line at mid-height leaves its two arms.
    const auto upright = [](double x0, double x1, double z0, double z1) {
        return Polygon{{x0, 2, z0}, {x1, 2, z0}, {x1, 2, z1}, {x0, 2, z1}};
    };
    const Polygon u = {{0, 2, -1}, {3, 2, -1}, {3, 2, 1}, {2, 2, 1}, {2, 2, -0.5}, {1, 2, -0.5}, {1, 2, 1}, {0, 2, 1}};
    const Polygon parts[] = {upright(0, 3, -1, -0.5), upright(0, 1, -0.5, 1), upright(2, 3, -0.5, 1)};
    const Polygon others[] = {floor_rectangle(0, 0, 1, 1),           // cuts it into its arms
                              floor_rectangle(0, 0, 1, 2),           // and touches it
                              {{0, 0, -3}, {2, 0, -3}, {1, 1, -3}},  // sees it whole
                              {{1, -9, -8}, {3, -9, -8}, {2, -8, -8}}};
    for (const Polygon& other : others)
        for (const double error : {1e-12, 1e-4}) {
            double sum = 0;
            for (const Polygon& part : parts) sum += polygon_to_polygon(other, part);
            EXPECT_GT(sum, 1e-4);
            EXPECT_NEAR(polygon_to_polygon(other, u, error), sum, error * sum + 1e-12);
            EXPECT_NEAR(polygon_to_polygon(u, other, error), sum, error * sum + 1e-12);
        }
    double sum = 0;
    const Vec3d point(1.2, 0.3, 0.1), normal = Vec3d(0.1, 0.5, 0.7).normalized();
    for (const Polygon& part : parts) sum += point_to_polygon(point, normal, part);
    EXPECT_NEAR(point_to_polygon(point, normal, u), sum, 1e-14);
}

TEST(PolygonFactors, CoplanarAndAvertedPairsAreZero) {
    const Polygon square = floor_rectangle(0, 0, 1, 1);
    const Polygon coplanar[] = {floor_rectangle(1, 0, 1, 1), floor_rectangle(0.5, 0.5, 1, 1), square,
                                reversed(floor_rectangle(3, 0, 1, 1)), reversed(square)};
    Random random(6);
    for (int turn = 0; turn < 20; ++turn) {
        const Motion motion(random, std::pow(10, random.between(-3, 3)), 1);
        const Polygon a = motion.polygon(square);
        for (const Polygon& other : coplanar) {
            const Polygon b = motion.polygon(other);
            EXPECT_EQ(polygon_to_polygon(a, b), 0);
            EXPECT_EQ(polygon_to_polygon(a, b, 1e-3), 0);
            EXPECT_EQ(point_to_polygon((a[0] + a[2]) * 0.5, motion.vector({0, 0, 1}), b), 0);
        }
        for (const double height : {1e-9, 1e-3, 1.0, 100.0}) {
            const Polygon b = motion.polygon(ceiling_square(0, 0, height));
            EXPECT_EQ(polygon_to_polygon(reversed(a), b), 0);
            EXPECT_EQ(polygon_to_polygon(a, reversed(b)), 0);
            EXPECT_EQ(polygon_to_polygon(reversed(a), reversed(b), 1e-4), 0);
        }
        EXPECT_EQ(polygon_to_polygon(a, motion.polygon(reversed(hinged(60)))), 0);
    }
}

TEST(PolygonFactors, GapsCloseContinuously) {
    const Polygon square = floor_rectangle(0, 0, 1, 1);
    // A corner on the square's edge and an edge askew to all of its edges.
    const auto askew = [](double x, double z) { return Polygon{{x, 0.3, z}, {x, 0.9, z}, {x - 0.2, 0.5, z + 0.7}}; };
    const double wall = factor(square, hinged(90)), touching = polygon_to_polygon(square, askew(0, 0));
    EXPECT_GT(touching, 0.01);
    Random random(7);
    for (int power = -12; power <= -3; ++power) {
        const double gap = std::pow(10, power);
        const double change = 4 * gap * (1 - std::log(gap)) + 1e-11;
        Polygon lifted = hinged(90), moved = hinged(90);
        for (Vec3d& p : lifted) p.z += gap;
        for (Vec3d& p : moved) p.x -= gap;
        EXPECT_NEAR(factor(square, lifted), wall, change) << gap;
        EXPECT_NEAR(factor(square, moved), wall, change) << gap;
        EXPECT_NEAR(polygon_to_polygon(square, askew(-gap, 0)), touching, change) << gap;
        EXPECT_NEAR(polygon_to_polygon(square, askew(0, gap)), touching, change) << gap;
        EXPECT_NEAR(polygon_to_polygon(square, askew(-gap, gap), 1e-4), touching, 1e-4 * touching + change) << gap;
        // Face to face, shifted, turned: what overlaps sees nothing else.
        const double a = factor(square, ceiling_square(0, 0, gap)), b = factor(square, ceiling_square(0.5, 0, gap));
        EXPECT_NEAR(a, 1, change) << gap;
        EXPECT_LT(a, 1) << gap;
        EXPECT_NEAR(b, 0.5, change) << gap;
        const Polygon turned = {{0.5, 0, gap}, {0, 0.5, gap}, {0.5, 1, gap}, {1, 0.5, gap}};
        EXPECT_NEAR(factor(turned, square), 1, change) << gap;
        EXPECT_NEAR(polygon_to_polygon(square, turned, 1e-4), 0.5, 1e-4 + change) << gap;
        const Motion motion(random, 1, 0);  // as large, turned by an eighth: a regular octagon overlaps
        Polygon star;
        for (const Vec3d& p : turned) star.push_back(p * std::sqrt(2.0) + Vec3d(1, 1, 0) * (0.5 - std::sqrt(0.5)));
        for (Vec3d& p : star) p.z = gap;
        EXPECT_NEAR(polygon_to_polygon(star, square), 2 * std::sqrt(2.0) - 2, change) << gap;
        EXPECT_NEAR(polygon_to_polygon(motion.polygon(star), motion.polygon(square)), 2 * std::sqrt(2.0) - 2,
                    change + 1e-15 / gap)
            << gap;
    }
}

// Hottel's strings: across a plane, per metre, of strips so long that their ends count for 1e-4.
TEST(PolygonFactors, LongStripsAreTwoDimensional) {
    const double length = 2e4;
    const Polygon below = parallelogram({0, 0, 0}, {1, 0, 0}, {0, length, 0});
    const Polygon above = parallelogram({0, 0, 1}, {0, length, 0}, {1, 0, 0});
    EXPECT_NEAR(factor(below, above), std::sqrt(2.0) - 1, 1e-4);
}

TEST(PolygonFactors, QuickOnesKeepTheirError) {
    Random random(8);
    int counted = 0;
    std::array<int, 3> over{};
    const double errors[] = {1e-2, 1e-4, 1e-7};
    while (counted < 2000) {
        const double s = std::pow(10, random.between(-2, 0)), t = std::pow(10, random.between(-2, 0));
        const Polygon a = random.polygon({0, 0, 0}, s, 3 + counted % 3);
        const Polygon b =
            random.polygon(random.direction() * ((s + t) * std::pow(10, random.between(0, 1.5))), t, 3 + counted % 2);
        const double exact = polygon_to_polygon(a, b);
        if (exact == 0) continue;
        ++counted;
        for (size_t i = 0; i < 3; ++i) {
            const double off = std::abs(polygon_to_polygon(a, b, errors[i]) / exact - 1);
            over[i] += off > errors[i];
            EXPECT_LT(off, 20 * errors[i]) << counted;
        }
    }
    for (const int count : over) EXPECT_LE(count, 10);
}

TEST(PolygonFactors, QuickOnesKeepTheirErrorNearby) {
    Random random(11);
    int counted = 0;
    while (counted < 300) {
        const Polygon a = random.polygon({0, 0, 0}, 1, 4), b = random.polygon(random.direction() * 0.7, 0.3, 3);
        const double exact = polygon_to_polygon(a, b);
        if (exact == 0) continue;
        ++counted;
        EXPECT_NEAR(polygon_to_polygon(a, b, 1e-5) / exact, 1, 1e-5);
    }
}

TEST(PolygonFactors, APointSeesWhatIntegrationSees) {
    Random random(9);
    int cut = 0;
    for (int i = 0; i < 40; ++i) {
        const Polygon quad = random.polygon(random.direction() * 1.5, 1, 4);
        const Vec3d normal = random.direction(), normal_quad = normal_of(quad);
        double sum = 0;
        visit_cells(quad, 150, [&](const Vec3d& y, double area) {
            sum += kernel({0, 0, 0}, normal, y, normal_quad) * area;
        });
        const double exact = point_to_polygon({0, 0, 0}, normal, quad);
        EXPECT_NEAR(sum, exact, 2e-4) << i;
        int above = 0;
        for (const Vec3d& p : quad) above += normal.dot(p) > 0;
        cut += exact > 0 && above < 4;
    }
    EXPECT_GT(cut, 5);
    // The horizon through the middle.
    EXPECT_NEAR(point_to_polygon({0, 0, 0}, {1, 0, 0}, parallelogram({-1, -1, 1}, {0, 2, 0}, {2, 0, 0})),
                point_to_polygon({0, 0, 0}, {1, 0, 0}, parallelogram({0, -1, 1}, {0, 2, 0}, {1, 0, 0})), 1e-15);
}

TEST(PolygonFactors, APointAtThePolygon) {
    const Polygon square = floor_rectangle(0, 0, 1, 1);
    const Vec3d down(0, 0, -1);
    for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(0.3, 0, 0), Vec3d(1, 0.7, 0), Vec3d(0.4, 0.4, 0), Vec3d(2, 0, 0)}) {
        EXPECT_EQ(point_to_polygon(p, down, square), 0);
        EXPECT_EQ(point_to_polygon(p, {1, 0, 0}, square), 0);
        EXPECT_EQ(point_to_polygon(p - Vec3d(0, 0, 1e-9), {0, 0, 1}, square), 0) << "behind it";
    }
    for (int power = -12; power <= -5; ++power) {
        const double above = std::pow(10, power);
        EXPECT_NEAR(point_to_polygon({0.4, 0.4, above}, down, square), 1, 1e-9 + 10 * above);
        EXPECT_NEAR(point_to_polygon({0.3, 0, above}, down, square), 0.5, 1e-9 + 10 * above);
        EXPECT_NEAR(point_to_polygon({1, 1, above}, down, square), 0.25, 1e-9 + 10 * above);
        EXPECT_NEAR(point_to_polygon({0.3, 0, above}, {0, 1, 0}, square), 0.5, 1e-9 + 10 * above);
        EXPECT_NEAR(point_to_polygon({0.3, 0, above}, {0, -1, 0}, square), 0, 1e-15);
    }
}

TEST(PolygonFactors, DegenerateInputIsZero) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    const Polygon square = floor_rectangle(0, 0, 1, 1), good = ceiling_square(0, 0, 1);
    Polygon broken = good, endless = good;
    broken[2].y = nan, endless[1].x = inf;
    for (const Polygon& bad : {Polygon{}, Polygon{{0, 0, 1}}, Polygon{{0, 0, 1}, {1, 0, 1}},
                               Polygon{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}, Polygon(5, Vec3d(1, 2, 3)), broken, endless}) {
        EXPECT_EQ(polygon_to_polygon(square, bad), 0);
        EXPECT_EQ(polygon_to_polygon(bad, square), 0);
        EXPECT_EQ(polygon_to_polygon(bad, bad, 1e-3), 0);
        EXPECT_EQ(point_to_polygon({0.5, 0.5, 0}, {0, 0, 1}, bad), 0);
    }
    EXPECT_EQ(point_to_polygon({nan, 0, 0}, {0, 0, 1}, good), 0);
    EXPECT_EQ(point_to_polygon({0, 0, 0}, {0, nan, 1}, good), 0);
    // Too large and too small for their squares.
    for (const double scale : {1e200, 1e-200}) {
        Polygon a = square, b = good;
        for (Vec3d& p : a) p *= scale;
        for (Vec3d& p : b) p *= scale;
        EXPECT_EQ(polygon_to_polygon(a, b), 0);
        EXPECT_EQ(point_to_polygon({0, 0, 0}, {0, 0, 1}, b), 0);
    }
    // Corners twice, and on a side.
    const Polygon more = {good[0], good[0], (good[0] + good[1]) * 0.5, good[1], good[2], good[2], good[3]};
    EXPECT_NEAR(polygon_to_polygon(square, more), 0.1998248957, 1e-10);
    EXPECT_NEAR(polygon_to_polygon(more, square, 1e-4), 0.1998248957, 2e-5);
    EXPECT_NEAR(point_to_polygon({0, 0, 0}, {0, 0, 1}, more), 0.1385316060, 1e-10);
}

}  // namespace
}  // namespace trp
