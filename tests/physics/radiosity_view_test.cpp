// A solution is seen the same from anywhere, and is the same bit for bit whoever computes it.
#include <cstring>

#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

// One ray through the middle of each pixel.
const Settings kSharp = {{"samples", "1"}, {"raster.samples", "1"}, {"film.filter_width", "0"}};
const char* const kSolvers[] = {"matrix", "progressive", "hierarchical"};

Solution::Settings coarse(const std::string& solver) {
    Solution::Settings settings = by(solver, "hemisphere");
    settings.insert(settings.end(), {{"radiosity.element_size", solver == "hierarchical" ? "0" : "0.2"},
                                     {"radiosity.iterations", "40"}});
    return settings;
}

TEST(RadiosityPictures, TwoCamerasSeeTheSame) {
    Random random{std::mt19937(5)};
    Scene scene;
    make_room(scene, random, true);
    for (const char* solver : kSolvers) {
        Solution solution(scene, coarse(solver));
        solution.solve();
        scene.camera(look_at(kEye, {0.6f, 0.5f, 0.35f}), [](TrpCameraDesc& d) { d.field_of_view = 1.6f; });
        scene.commit();
        constexpr uint32_t kSide = 9;
        Render first(scene, kSide, kSide, kSharp, {"Position"}, "radiosity");
        check(trp_render_set_radiosity(first, solution));
        const Image seen = first.run().read(), places = first.read("Position");
        uint32_t compared = 0;
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                const float* const p = places.at(x, y);
                const Vec place = {p[0], p[1], p[2]};
                scene.camera(look_at({0.9f, 0.1f, 0.6f}, place));
                scene.commit();
                Render second(scene, 1, 1, kSharp, {"Position"}, "radiosity");
                check(trp_render_set_radiosity(second, solution));
                const Image again = second.run().read();
                const Image found = second.read("Position");
                const float* const there = found.at(0, 0);
                const Vec off = Vec{there[0], there[1], there[2]} - place;
                if (dot(off, off) > 1e-8f) continue;  // something stands between
                ++compared;
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(again.at(0, 0)[c], seen.at(x, y)[c], 1e-4 * seen.at(x, y)[c])
                        << solver << ' ' << x << ' ' << y;
            }
        EXPECT_GT(compared, 40u);
    }
}

// An element's polygon, and radiosity at its vertices and in its middle, to be interpolated plainly.
struct Polygon {
    std::vector<Vec> loop;
    std::vector<float> values;
    Vec middle, normal;
    float value;

    Vec side(size_t k) const { return loop[(k + 1) % loop.size()] - loop[k]; }
    bool holds(Vec point) const {
        for (size_t k = 0; k < loop.size(); ++k)
            if (dot(cross(normal, unit(side(k))), point - loop[k]) < 1e-4f) return false;
        return std::abs(dot(normal, point - middle)) < 1e-5f;
    }
    // Without the vertices of smaller neighbours.
    std::vector<Vec> corners() const {
        std::vector<Vec> out;
        for (size_t k = 0; k < loop.size(); ++k)
            if (dot(cross(unit(side(k)), unit(side((k + 1) % loop.size()))), normal) > 0.01f)
                out.push_back(loop[(k + 1) % loop.size()]);
        return out;
    }
    bool is_skewed() const {
        const std::vector<Vec> c = corners();
        if (c.size() != 4) return false;
        const Vec off = c[0] + c[2] - c[1] - c[3];
        return dot(off, off) > 1e-10f;
    }
    // Of three points with values, at one in their plane; the least weight goes to `least`.
    float in_triangle(const Vec (&p)[3], const float (&v)[3], Vec point, float& least) const {
        float weights[3], sum = 0;
        for (int k = 0; k < 3; ++k) {
            const Vec a = p[(k + 1) % 3], b = p[(k + 2) % 3];
            sum += weights[k] = dot(normal, cross(b - a, point - a));
        }
        least = std::min({weights[0], weights[1], weights[2]}) / sum;
        return (weights[0] * v[0] + weights[1] * v[1] + weights[2] * v[2]) / sum;
    }
    // By Newton's method.
    float in_quad(Vec point) const {
        float u = 0.5f, v = 0.5f;
        const auto bilinear = [&](auto a, auto b, auto c, auto d) {
            return (a * (1 - u) + b * u) * (1 - v) + (d * (1 - u) + c * u) * v;
        };
        for (int step = 0; step < 20; ++step) {
            const Vec off = point - bilinear(loop[0], loop[1], loop[2], loop[3]), du = side(0) * (1 - v) - side(2) * v,
                      dv = side(1) * u - side(3) * (1 - u);
            const float determinant = dot(cross(du, dv), normal);
            u += dot(cross(off, dv), normal) / determinant;
            v += dot(cross(du, off), normal) / determinant;
        }
        return bilinear(values[0], values[1], values[2], values[3]);
    }
    float at(Vec point) const {
        float least, best = -1, out = 0;
        if (loop.size() == 3)
            return in_triangle({loop[0], loop[1], loop[2]}, {values[0], values[1], values[2]}, point, least);
        if (loop.size() == corners().size()) return in_quad(point);
        for (size_t k = 0; k < loop.size(); ++k) {
            const size_t next = (k + 1) % loop.size();
            const float here =
                in_triangle({middle, loop[k], loop[next]}, {value, values[k], values[next]}, point, least);
            if (least > best) best = least, out = here;
        }
        return out;
    }
};

std::vector<Polygon> polygons_of(const Solution& solution) {
    const TrpRadiosityInfo info = solution.info();
    std::vector<uint32_t> offsets(info.element_count + 1), vertices(info.corner_count);
    check(trp_radiosity_polygons(solution, offsets.data(), offsets.size(), vertices.data(), vertices.size()));
    const std::vector<float> positions = solution.read("vertex_position", 3), centres = solution.read("centre", 3),
                             normals = solution.read("normal", 3);
    const std::vector<double> at_vertices = solution.red("vertex_radiosity"), at_elements = solution.red("radiosity");
    const auto vector = [](const std::vector<float>& all, size_t k) {
        return Vec{all[3 * k], all[3 * k + 1], all[3 * k + 2]};
    };
    std::vector<Polygon> out(info.element_count);
    for (size_t k = 0; k < out.size(); ++k) {
        out[k].middle = vector(centres, k);
        out[k].normal = vector(normals, k);
        out[k].value = static_cast<float>(at_elements[k]);
        for (uint32_t corner = offsets[k]; corner < offsets[k + 1]; ++corner) {
            out[k].loop.push_back(vector(positions, vertices[corner]));
            out[k].values.push_back(static_cast<float>(at_vertices[vertices[corner]]));
        }
    }
    return out;
}

TEST(RadiosityPictures, AreInterpolatedWithinTheElements) {
    Random random{std::mt19937(7)};
    Scene scene;
    make_room(scene, random, true);
    scene.object(quad({0.1f, 0.95f, 0.2f}, {0.6f, 0.95f, 0.2f}, {0.45f, 0.95f, 0.7f}, {0.2f, 0.95f, 0.7f}),
                 paint(scene, random));
    MeshData triangle;
    triangle.positions = {0.95f, 0.1f, 0.2f, 0.95f, 0.6f, 0.2f, 0.95f, 0.5f, 0.7f};
    triangle.offsets = {0, 3}, triangle.corners = {0, 1, 2};
    scene.object(triangle, paint(scene, random));
    for (const char* solver : kSolvers) {
        Solution solution(scene, coarse(solver));
        solution.solve();
        Render render(scene, 72, 48, with(kSharp, {{"radiosity.view", "radiosity"}}), {"Position"}, "radiosity");
        check(trp_render_set_radiosity(render, solution));
        const Image seen = render.run().read(), places = render.read("Position");
        const std::vector<Polygon> polygons = polygons_of(solution);
        size_t triangles = 0, quads = 0, skewed = 0, in_sectors = 0;
        for (uint32_t y = 0; y < seen.height; ++y)
            for (uint32_t x = 0; x < seen.width; ++x) {
                const float* const p = places.at(x, y);
                const Vec place = {p[0], p[1], p[2]};
                const auto here = std::find_if(polygons.begin(), polygons.end(), [&](const Polygon& of) {
                    return dot(of.normal, kEye - place) > 0 && of.holds(place);
                });
                if (here == polygons.end()) continue;  // too near to a side to say
                const bool has_neighbours = here->loop.size() > here->corners().size();
                if (has_neighbours && here->is_skewed()) continue;  // whose sectors are bent
                (has_neighbours           ? in_sectors
                 : here->loop.size() == 3 ? triangles
                 : here->is_skewed()      ? skewed
                                          : quads)++;
                EXPECT_NEAR(seen.at(x, y)[0] * kPiF, here->at(place), 1e-3f * here->at(place))
                    << solver << ' ' << x << ' ' << y;
            }
        const bool divides = std::string(solver) == "hierarchical";
        EXPECT_GT(quads, 700u);
        EXPECT_GT(triangles, 36u);
        EXPECT_GT(divides ? in_sectors : skewed, 36u);
    }
}

TEST(RadiosityPictures, FollowTheSolutionAndTheView) {
    Random random{std::mt19937(8)};
    Scene scene;
    make_room(scene, random, true);
    Solution solution(scene, coarse("progressive")), other(scene, coarse("progressive"));
    solution.step(2), other.step(6);
    Render render(scene, 30, 20, kSharp, {}, "radiosity"), fresh(scene, 30, 20, kSharp, {}, "radiosity");
    check(trp_render_set_radiosity(render, solution));
    check(trp_render_set_radiosity(fresh, other));
    const auto picture = [&](const char* view) {
        check(trp_render_set(render, "radiosity.view", view));
        return render.run().read().values;
    };
    const std::vector<float> before = picture("shaded");
    EXPECT_NE(picture("unshot"), before);
    EXPECT_EQ(picture("shaded"), before);
    solution.step(4);
    const std::vector<float> after = picture("shaded");
    EXPECT_NE(after, before);
    EXPECT_EQ(after, fresh.run().read().values);
}

TEST(RadiosityPictures, IsTheSameForAnyThreadsAndTiles) {
    Random random{std::mt19937(6)};
    Scene scene;
    make_room(scene, random, true);
    scene.light(TRP_LIGHT_POINT, {0.2f, 0.2f, 0.2f}, translation({0.5f, 0.5f, 0.5f}),
                [](TrpLightDesc& d) { d.radius = 0.05f; });
    scene.commit();
    for (const char* solver : kSolvers) {
        std::vector<float> values[3], pictures[3];
        const char* const threads[] = {"1", "2", "5"};
        const char* const tiles[] = {"64", "16", "40"};
        for (int k = 0; k < 3; ++k) {
            Solution::Settings settings = coarse(solver);
            settings.emplace_back("threads", threads[k]);
            Solution solution(scene, settings);
            values[k] = solution.solve().read("radiosity", 3);
            Render render(scene, 60, 40, {{"threads", threads[k]}, {"film.tile_size", tiles[k]}}, {}, "radiosity");
            check(trp_render_set_radiosity(render, solution));
            pictures[k] = render.run().read().values;
        }
        for (int k = 1; k < 3; ++k) {
            ASSERT_EQ(values[k].size(), values[0].size());
            EXPECT_EQ(std::memcmp(values[k].data(), values[0].data(), values[0].size() * sizeof(float)), 0) << solver;
            EXPECT_EQ(std::memcmp(pictures[k].data(), pictures[0].data(), pictures[0].size() * sizeof(float)), 0)
                << solver;
        }
    }
}

}  // namespace
}  // namespace trp_test
