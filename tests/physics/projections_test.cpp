// Pictures of what an element sees: a hemicube's unfolded faces, and Nusselt's analog by pixels and by outlines.
#include "support/radiosity.h"

namespace trp_test {
namespace {

constexpr double kUnderCentre = 0.2394564705, kUnderCorner = 0.1385316060;  // a unit square, 1 above a point
constexpr uint32_t kSide = 512;                                             // of pictures

Solution::Settings by(const char* form_factors) {
    return {{"radiosity.solver", "matrix"},
            {"radiosity.form_factors", form_factors},
            {"radiosity.hemicube_resolution", std::to_string(kSide / 2)}};
}

uint32_t one_sided(Scene& scene) {
    return scene.material([](TrpMaterialDesc& d) { d.double_sided = 0; });
}

// Element 0 is a small square about the origin that faces up; then those that are added.
struct Scenery : Scene {
    Scenery() { object(floor_square(0.01f), grey); }
    uint32_t grey = one_sided(*this);
    // A square of so many metres at height 1 that faces down, its least corner there.
    void add_above(float x, float y, float size) {
        object(quad({x, y, 1}, {x, y + size, 1}, {x + size, y + size, 1}, {x + size, y, 1}), grey);
    }
};

struct Outline {
    std::vector<std::array<double, 3>> corners;
    double form_factor = 0;
};

Outline outline_of(TrpRadiosity* solution, uint32_t seen) {
    Outline out;
    out.corners.resize(16);
    size_t used = 0;
    check(trp_radiosity_outline(solution, 0, seen, out.corners[0].data(), out.corners.size(), &used, &out.form_factor));
    out.corners.resize(used);
    return out;
}

// The area that it has on the base circle, and its length there, by many points on its arcs.
struct Measures {
    double area = 0, length = 0;
};
Measures measure(const Outline& outline) {
    constexpr int kPoints = 2000;
    Measures out;
    for (size_t k = 0; k < outline.corners.size(); ++k) {
        const auto &a = outline.corners[k], &b = outline.corners[(k + 1) % outline.corners.size()];
        const double angle = std::acos(std::min(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], 1.0));
        const auto at = [&](int i, size_t c) {
            const double s = static_cast<double>(i) / kPoints;
            return angle > 0 ? (std::sin((1 - s) * angle) * a[c] + std::sin(s * angle) * b[c]) / std::sin(angle) : a[c];
        };
        for (int i = 0; i < kPoints; ++i) {
            const double x0 = at(i, 0), y0 = at(i, 1), x1 = at(i + 1, 0), y1 = at(i + 1, 1);
            out.area += (x0 * y1 - x1 * y0) / 2;
            out.length += std::hypot(x1 - x0, y1 - y0);
        }
    }
    return out;
}

struct Pixels {
    std::vector<uint32_t> seen = std::vector<uint32_t>(kSide * kSide);
    std::vector<float> shares = std::vector<float>(kSide * kSide);
    explicit Pixels(TrpRadiosity* solution) {
        check(trp_radiosity_projection(solution, 0, seen.data(), shares.data(), seen.size()));
    }
    // At (−1, −1) to (1, 1) over the square.
    uint32_t at(double x, double y) const {
        const auto place = [](double t) { return std::min(static_cast<uint32_t>((t + 1) / 2 * kSide), kSide - 1); };
        return seen[size_t{place(y)} * kSide + place(x)];
    }
    double share_of(uint32_t element) const {
        double sum = 0;
        for (size_t k = 0; k < seen.size(); ++k) sum += seen[k] == element ? static_cast<double>(shares[k]) : 0;
        return sum;
    }
};

TEST(Projections, AnOutlineHoldsThePointsFormFactor) {
    Scenery scene;
    scene.add_above(-0.5f, -0.5f, 1);
    scene.add_above(0, 0, 1);
    Solution solution(scene, by("analytic"));
    solution.prepare();
    for (const auto& [element, factor] : {std::pair{1u, kUnderCentre}, std::pair{2u, kUnderCorner}}) {
        const Outline outline = outline_of(solution, element);
        ASSERT_EQ(outline.corners.size(), 4u);
        EXPECT_NEAR(outline.form_factor, factor, 1e-10);
        // 2000 chords to an arc miss at most (1/2000)² of it; counter-clockwise, the area is positive.
        EXPECT_NEAR(measure(outline).area / kPi, factor, 1e-6);
    }
}

TEST(Projections, AnOutlineIsCutAtTheHorizon) {
    // A wall that reaches below the floor, and what of it stands above; and one that faces away, and one that lies
    // below.
    Scenery scene;
    const auto wall = [&](float low, float high) {
        scene.object(quad({1, -0.5f, low}, {1, -0.5f, high}, {1, 0.5f, high}, {1, 0.5f, low}), scene.grey);
    };
    wall(-3, 1);
    wall(0, 1);
    scene.object(quad({1, 0.5f, 0}, {1, 0.5f, 1}, {1, -0.5f, 1}, {1, -0.5f, 0}), scene.grey);
    wall(-2, -1);
    Solution solution(scene, by("analytic"));
    solution.prepare();
    const Outline cut = outline_of(solution, 1), whole = outline_of(solution, 2);
    EXPECT_NEAR(cut.form_factor, whole.form_factor, 1e-12);
    EXPECT_GT(cut.form_factor, 0.05);
    EXPECT_NEAR(measure(cut).area / kPi, cut.form_factor, 1e-6);
    for (const auto& corner : cut.corners) EXPECT_GE(corner[2], 0);
    for (const uint32_t unseen : {3u, 4u}) {
        EXPECT_TRUE(outline_of(solution, unseen).corners.empty()) << unseen;
        EXPECT_EQ(outline_of(solution, unseen).form_factor, 0) << unseen;
    }
}

TEST(Projections, CoveredPixelsAreTheFormFactor) {
    for (const auto& [corner, factor] : {std::pair{-0.5f, kUnderCentre}, std::pair{0.0f, kUnderCorner}}) {
        Scenery scene;
        scene.add_above(corner, corner, 1);
        Solution circle(scene, by("hemisphere")), cross(scene, by("hemicube"));
        // Half a pixel all along the outline.
        const double most = measure(outline_of(circle.prepare(), 1)).length / kSide / kPi;
        const Pixels of_circle(circle), of_cross(cross.prepare());
        EXPECT_NEAR(of_circle.share_of(1), factor, most);
        EXPECT_NEAR(of_circle.share_of(1) + of_circle.share_of(TRP_NO_ELEMENT), 1, 1e-4);
        // The very pixels that the row is made of.
        EXPECT_NEAR(of_cross.share_of(1), cross.row(0)[1], 1e-6);
        EXPECT_NEAR(of_cross.share_of(1), factor, 1e-2);
        EXPECT_NEAR(of_cross.share_of(1) + of_cross.share_of(TRP_NO_ELEMENT), 1, 1e-4);
    }
}

TEST(Projections, CrossAndCircleShowTheSameDirections) {
    // Squares all around, each of another size, so that no turn and no mirror image of the whole is like it.
    Scenery scene;
    for (int k = 0; k < 12; ++k) {
        const float size = 0.2f + 0.06f * static_cast<float>(k);
        const double turn = 2 * kPi * k / 12, height = k % 3 == 0 ? 0.3 : k % 3 == 1 ? 0.9 : 2;
        const Vec at = {static_cast<float>(1.5 * std::cos(turn)), static_cast<float>(1.5 * std::sin(turn)),
                        static_cast<float>(height)};
        const Transform m = look_at(at, at + at);  // its +z towards the origin
        scene.object(floor_square(size / 2), scene.grey, m);
    }
    Solution by_circle(scene, by("hemisphere")), by_cross(scene, by("hemicube"));
    const Pixels circle(by_circle.prepare()), cross(by_cross.prepare());
    int compared = 0, different = 0, seen = 0;
    constexpr int kSteps = 100;
    for (int i = 1 - kSteps; i < kSteps; ++i)
        for (int j = 1 - kSteps; j < kSteps; ++j) {
            const double x = static_cast<double>(i) / kSteps, y = static_cast<double>(j) / kSteps;
            const double z2 = 1 - x * x - y * y;
            if (z2 < 1e-3) continue;
            const double z = std::sqrt(z2), top = std::max(std::abs(x), std::abs(y));
            // The sides are folded out about the top's edges.
            double a = x / z, b = y / z;
            if (std::abs(x) == top && top > z) a = std::copysign(2 - z / top, x), b = y / top;
            if (std::abs(y) == top && top > z) a = x / top, b = std::copysign(2 - z / top, y);
            ++compared;
            seen += circle.at(x, y) != TRP_NO_ELEMENT;
            different += circle.at(x, y) != cross.at(a / 2, b / 2);
        }
    EXPECT_GT(seen, compared / 10);
    // Pixels at the squares' edges, where a step of a pixel decides.
    EXPECT_LT(different, compared / 50);
    // And the outlines: where they are, that element is seen.
    for (uint32_t element = 1; element <= 12; ++element) {
        const Outline outline = outline_of(by_circle, element);
        ASSERT_GE(outline.corners.size(), 4u);
        double x = 0, y = 0;
        for (const auto& corner : outline.corners) x += corner[0], y += corner[1];
        const auto count = static_cast<double>(outline.corners.size());
        EXPECT_EQ(circle.at(x / count, y / count), element);
    }
}

TEST(Projections, ShowWhatIsNearestAndWhatIsBehindGlass) {
    // Where a slope of 0.4 lies: on the circle, and on the cross's top.
    for (const auto& [kind, beside] : {std::pair{"hemisphere", 0.4 / std::hypot(1, 0.4)}, {"hemicube", 0.4 / 2}}) {
        Scenery scene;
        scene.add_above(-0.5f, -0.5f, 1);
        scene.object(quad({-9, -9, 0.5f}, {9, -9, 0.5f}, {9, 9, 0.5f}, {-9, 9, 0.5f}),
                     scene.material([](TrpMaterialDesc& d) {
                         d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
                         d.transmission = {{0.25f, 0.25f, 0.25f}, TRP_NO_NODE};
                         d.thin = 1;
                     }));
        Solution through(scene, by(kind));
        EXPECT_EQ(Pixels(through.prepare()).at(0.1, 0.1), 1u) << kind;
        scene.object(quad({-0.2f, -0.2f, 0.8f}, {-0.2f, 0.2f, 0.8f}, {0.2f, 0.2f, 0.8f}, {0.2f, -0.2f, 0.8f}),
                     scene.grey);
        Solution before(scene, by(kind));
        const Pixels pixels(before.prepare());
        EXPECT_EQ(pixels.at(0.01, 0.01), 3u) << kind;
        EXPECT_EQ(pixels.at(beside, 0), 1u) << kind;
    }
}

}  // namespace
}  // namespace trp_test
