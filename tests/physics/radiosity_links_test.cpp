// How many links the hierarchy needs for a certain error.
#include <array>
#include <map>

#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

TEST(RadiosityLinks, StayAsTheyAreWhereElementsMayBeSmaller) {
    // From 6144 to 393216 elements that there may be on the faces of a cube: they are as small as the error asks for,
    // and not one link is added.
    Scene scene;
    add_cube(scene, wall(scene, 0.3f, 1), wall(scene, 0.7f));
    scene.object(box({0.25f, 0.3f, 0.3f}, {0.55f, 0.7f, 0.7f}), wall(scene, 0.4f));
    uint64_t links = 0;
    for (int level = 5; level <= 8; ++level) {
        Solution::Settings settings = by("hierarchical");
        settings.insert(settings.end(), {{"radiosity.element_size", std::to_string(std::ldexp(1.0, -level))},
                                         {"radiosity.tolerance", "0.01"}});
        Solution solution(scene, settings);
        const TrpRadiosityInfo info = solution.solve().info();
        EXPECT_LE(info.residual, 0.01) << level;
        if (links > 0) {
            EXPECT_EQ(info.links, links) << level;
        }
        links = info.links;
    }
    EXPECT_LT(links, 6144u);
}

// Between two unit squares, each pair once; a link has its two directions.
uint64_t links_between_squares(bool touching, float ratio, int level) {
    Scene scene;
    scene.object(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), wall(scene, 0.5f, 1, false));
    if (touching)
        scene.object(quad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}), wall(scene, 0.5f, 0, false));
    else
        scene.object(quad({0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}), wall(scene, 0.5f, 0, false));
    char size[32];
    std::snprintf(size, sizeof size, "%.9g", std::ldexp(1.0, -level));
    Solution solution(scene, {{"radiosity.element_size", size}, {"radiosity.link_ratio", std::to_string(ratio)}});
    return solution.solve().info().links / 2;
}

TEST(RadiosityLinks, BySizeAndDistanceAreAsManyAsPublished) {
    // A link where side / distance < η, else the larger is divided: as many as were counted by hand, whatever the
    // finest level; between squares that touch, they grow with the elements along the edge.
    const float ratios[] = {1, 0.5f, 0.25f};
    const uint64_t known[] = {4, 28, 304};
    for (int k = 0; k < 3; ++k)
        for (const int level : {4, 6}) EXPECT_EQ(links_between_squares(false, ratios[k], level), known[k]) << level;
    EXPECT_EQ(links_between_squares(true, 0.5f, 4), 1504u);   // of 512 elements that there may be
    EXPECT_EQ(links_between_squares(true, 0.5f, 6), 7252u);   // 8192
    EXPECT_EQ(links_between_squares(true, 0.5f, 7), 15046u);  // 32768
    EXPECT_EQ(links_between_squares(true, 0.5f, 8), 30712u);  // 131072
}

// A wall of side² squares.
void add_grid(Scene& scene, uint32_t side, const Vec& corner, const Vec& x, const Vec& y, uint32_t material) {
    MeshData grid;
    for (uint32_t j = 0; j <= side; ++j)
        for (uint32_t i = 0; i <= side; ++i)
            for (size_t c = 0; c < 3; ++c)
                grid.positions.push_back(corner[c] + (x[c] * static_cast<float>(i) + y[c] * static_cast<float>(j)) /
                                                         static_cast<float>(side));
    for (uint32_t j = 0; j < side; ++j)
        for (uint32_t i = 0; i < side; ++i) {
            const uint32_t first = j * (side + 1) + i;
            grid.offsets.push_back(static_cast<uint32_t>(grid.corners.size()));
            grid.corners.insert(grid.corners.end(), {first, first + 1, first + side + 2, first + side + 1});
        }
    grid.offsets.push_back(static_cast<uint32_t>(grid.corners.size()));
    scene.object(grid, material);
}

TEST(RadiosityLinks, GrowSlowerThanTheFacesTheyAreFor) {
    // A cube with a lit floor, its walls cut into 384, 1536 and 6144 faces: clusters stand for many. Links from face to
    // face would be 16 times as many with 4 times the faces. In a closed room as much arrives as leaves.
    uint64_t before = 0;
    for (const uint32_t side : {8u, 16u, 32u}) {
        Scene scene;
        const uint32_t lit = wall(scene, 0.3f, 1), grey = wall(scene, 0.7f);
        add_grid(scene, side, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lit);
        add_grid(scene, side, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, grey);
        add_grid(scene, side, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, grey);
        add_grid(scene, side, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, grey);
        add_grid(scene, side, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, grey);
        add_grid(scene, side, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, grey);
        Solution::Settings settings = by("hierarchical");
        settings.emplace_back("radiosity.tolerance", "0.05");
        Solution solution(scene, settings);
        const TrpRadiosityInfo info = solution.solve().info();
        EXPECT_LE(info.residual, 0.05) << side;
        if (before > 0) {
            EXPECT_LT(info.links, 2.5 * static_cast<double>(before)) << side;
        }
        before = info.links;
        const std::vector<double> leaves = solution.red("radiosity"), arrives = solution.red("irradiance");
        const std::vector<float> area = solution.read("area", 1);
        double given = 0, got = 0;
        for (size_t k = 0; k < area.size(); ++k) given += leaves[k] * area[k], got += arrives[k] * area[k];
        EXPECT_NEAR(got / given, 1, 0.05) << side;
    }
}

TEST(RadiosityLinks, OfLooseTrianglesGiveWhatTheMatrixDoes) {
    // Triangles that are turned any way, in a room whose floor shines: each pair has its form factor in the matrix,
    // while the hierarchy has a fraction of the links, between clusters whose parts look in all directions.
    Scene scene;
    Random random{std::mt19937(7)};
    add_cube(scene, wall(scene, 0.4f, 1), wall(scene, 0.6f));
    MeshData soup;
    constexpr uint32_t kTriangles = 400;
    for (uint32_t k = 0; k < kTriangles; ++k) {
        const float middle[3] = {random.between(0.1f, 0.9f), random.between(0.1f, 0.9f), random.between(0.1f, 0.9f)};
        soup.offsets.push_back(3 * k);
        for (uint32_t corner = 0; corner < 3; ++corner) {
            for (const float c : middle) soup.positions.push_back(c + random.between(-0.02f, 0.02f));
            soup.corners.push_back(3 * k + corner);
        }
    }
    soup.offsets.push_back(3 * kTriangles);
    scene.object(soup, wall(scene, 0.5f));
    constexpr double kTolerance = 0.02;
    Solution::Settings coarse = by("hierarchical"), fine = by("matrix", "hemisphere");
    coarse.emplace_back("radiosity.tolerance", std::to_string(kTolerance));
    fine.emplace_back("radiosity.rays", "4096");
    fine.emplace_back("radiosity.element_size", "0.1");
    Solution links(scene, coarse), matrix(scene, fine);
    links.solve();
    matrix.solve();
    // The mean over each face.
    const auto by_face = [](Solution& solution) {
        const std::vector<double> radiosity = solution.red("radiosity");
        const std::vector<float> area = solution.read("area", 1), face = solution.read("face", 1),
                                 instance = solution.read("instance", 1);
        std::map<std::pair<float, float>, std::array<double, 2>> sums;
        for (size_t k = 0; k < area.size(); ++k) {
            auto& sum = sums[{instance[k], face[k]}];
            sum[0] += area[k] * radiosity[k], sum[1] += area[k];
        }
        return sums;
    };
    const auto a = by_face(links), b = by_face(matrix);
    ASSERT_EQ(a.size(), b.size());
    double squares = 0, area = 0, difference = 0;
    for (const auto& [key, sum] : b) {
        const double other = a.at(key)[0] / a.at(key)[1], own = sum[0] / sum[1];
        squares += sum[1] * (other - own) * (other - own), area += sum[1];
        difference += sum[1] * (other - own);
    }
    EXPECT_LT(std::sqrt(squares / area), 2 * kTolerance);
    EXPECT_LT(std::abs(difference / area), kTolerance / 2);
    EXPECT_LT(links.info().links, 20 * links.info().element_count);
}

}  // namespace
}  // namespace trp_test
