// Shots by rays: what they meet side by side is what they meet one by one, whoever traces them, and the sums that a
// solution keeps are those of its elements.
#include <cstring>

#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

// Faces of every kind, seen from both sides if they have two: a room, a turned triangle, a quad that is no
// parallelogram, a pentagon, and the mirror image of a triangle and a quad. `glass`: they let next to nothing through,
// so that a ray goes on from each as from glass, and is lost there.
struct Faces : Scene {
    Faces(bool glass, bool double_sided) {
        const uint32_t grey = material([&](TrpMaterialDesc& d) {
            const float k_t = glass ? 1e-6f : 0;
            d.diffuse = {{0.5f, 0.5f, 0.5f}, TRP_NO_NODE};
            d.emission = {{1, 1, 1}, TRP_NO_NODE};
            d.transmission = {{k_t, k_t, k_t}, TRP_NO_NODE};
            d.thin = 1;
            d.double_sided = double_sided;
        });
        object(inwards(box({0, 0, 0}, {1, 1, 1})), grey);
        object(polygon({{0.1f, 0.2f, 0.3f}, {0.5f, 0.1f, 0.4f}, {0.2f, 0.6f, 0.8f}}), grey);
        object(polygon({{0.6f, 0.2f, 0.2f}, {0.9f, 0.2f, 0.2f}, {0.8f, 0.5f, 0.2f}, {0.65f, 0.5f, 0.2f}}), grey);
        object(
            polygon(
                {{0.6f, 0.6f, 0.7f}, {0.8f, 0.6f, 0.7f}, {0.9f, 0.8f, 0.7f}, {0.7f, 0.9f, 0.7f}, {0.55f, 0.8f, 0.7f}}),
            grey);
        const Transform flip = {-1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0};
        object(polygon({{0.7f, 0.6f, 0.3f}, {0.9f, 0.7f, 0.3f}, {0.8f, 0.9f, 0.4f}}), grey, flip);
        object(polygon({{0.6f, 0.3f, 0.6f}, {0.9f, 0.3f, 0.6f}, {0.9f, 0.5f, 0.9f}, {0.6f, 0.5f, 0.9f}}), grey, flip);
    }

  private:
    static MeshData polygon(const std::vector<Vec>& corners) {
        MeshData m;
        for (const Vec& p : corners) {
            m.positions.insert(m.positions.end(), p.begin(), p.end());
            m.corners.push_back(static_cast<uint32_t>(m.corners.size()));
        }
        m.offsets = {0, static_cast<uint32_t>(corners.size())};
        return m;
    }
};

TEST(RadiosityShots, MeetTheElementsThatRaysMeetOneByOne) {
    struct Case {
        const char *solver, *size, *levels;
    };
    for (const auto& [solver, size, levels] : {Case{"matrix", "0", "0"}, Case{"matrix", "0.13", "0"},
                                               Case{"progressive", "0.4", "2"}, Case{"progressive", "0", "3"}})
        for (const bool double_sided : {true, false}) {
            Faces plain(false, double_sided), glass(true, double_sided);
            Solution::Settings settings = by(solver, "hemisphere");
            settings.insert(
                settings.end(),
                {{"radiosity.element_size", size}, {"radiosity.patch_levels", levels}, {"radiosity.rays", "4096"}});
            Solution a(plain, settings), b(glass, settings);
            const uint32_t count = a.prepare().info().element_count;
            ASSERT_EQ(b.prepare().info().element_count, count);
            for (uint32_t element = 0; element < count; element += 1 + count / 50) {
                const std::vector<double> side_by_side = a.row(element), one_by_one = b.row(element);
                double sum = 0, differences = 0;
                for (uint32_t k = 0; k < count; ++k) {
                    sum += side_by_side[k];
                    differences += std::abs(side_by_side[k] - one_by_one[k]);
                }
                // But for rays that meet where two elements do, by rounding.
                EXPECT_LE(differences, 2.5 / 4096) << solver << ' ' << size << ' ' << levels << ' ' << element;
                EXPECT_LE(sum, 1 + 1e-9);
                EXPECT_GT(sum, double_sided ? 0.99 : 0.2);  // backs are black
            }
        }
}

TEST(RadiosityShots, AreTheSameForAnyThreads) {
    Random random{std::mt19937(4)};
    Scene scene;
    make_room(scene, random, true);
    for (const char* levels : {"0", "1"}) {
        std::vector<float> known;
        for (const char* threads : {"1", "2", "5"}) {
            // More elements and rays than a thread takes at a time.
            Solution::Settings settings = by("progressive", "hemisphere");
            settings.insert(settings.end(), {{"radiosity.element_size", "0.025"},
                                             {"radiosity.patch_levels", levels},
                                             {"radiosity.rays", "20000"},
                                             {"threads", threads}});
            Solution solution(scene, settings);
            std::vector<float> values = solution.step(6).read("radiosity", 3);
            const std::vector<float> unshot = solution.read("unshot", 3);
            values.insert(values.end(), unshot.begin(), unshot.end());
            EXPECT_GT(solution.info().element_count, 9000u);
            if (known.empty()) known = values;
            ASSERT_EQ(values.size(), known.size());
            EXPECT_EQ(std::memcmp(values.data(), known.data(), known.size() * sizeof(float)), 0) << threads;
        }
    }
}

TEST(RadiosityShots, TheShareThatIsLeftIsThatOfAllElements) {
    for (const char* order : {"sorted", "unsorted", "gathering"})
        for (const char* levels : {"0", "1"}) {
            Random random{std::mt19937(5)};
            Scene scene;
            make_room(scene, random, false);
            Solution::Settings settings = by("progressive", "hemisphere");
            settings.insert(settings.end(), {{"radiosity.element_size", "0.2"},
                                             {"radiosity.order", order},
                                             {"radiosity.patch_levels", levels},
                                             {"radiosity.rays", "512"}});
            Solution solution(scene, settings);
            for (int k = 0; k < 10; ++k) {
                solution.step(13);
                const std::vector<float> b = solution.read("radiosity", 3), unshot = solution.read("unshot", 3),
                                         area = solution.read("area", 1);
                double left = 0, all = 0;
                for (size_t i = 0; i < b.size(); ++i) {
                    const double weight = std::array{0.2126, 0.7152, 0.0722}[i % 3] * static_cast<double>(area[i / 3]);
                    left += weight * static_cast<double>(unshot[i]);
                    all += weight * static_cast<double>(b[i]);
                }
                EXPECT_NEAR(solution.info().residual, left / all, 1e-6) << order << ' ' << levels << ' ' << k;
            }
        }
}

}  // namespace
}  // namespace trp_test
