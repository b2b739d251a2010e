// Recursive ray tracing against the equation: a tracer of a few lines, closed forms of optics, mirrors at all scales.
#include <algorithm>
#include <random>

#include "support/bodies.h"

namespace trp_test {
namespace {

const Settings kOneRay = {{"samples", "1"},
                          {"film.filter_width", "0"},
                          {"trace.least_weight", "0"},
                          {"shading.transparent_shadows", "opaque"}};

Image traced(Scene& scene, uint32_t width, uint32_t height, const Settings& settings) {
    scene.commit();
    return Render(scene, width, height, settings, {}, "ray_tracing").run().read();
}

// ---- the equation, and nothing else, in double precision

using Point = std::array<double, 3>;
using trp_test::operator+, trp_test::operator-, trp_test::operator*, trp_test::dot, trp_test::cross, trp_test::unit;

Point operator+(const Point& a, const Point& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Point operator-(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point operator*(const Point& a, double s) {
    return {a[0] * s, a[1] * s, a[2] * s};
}
double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point unit(const Point& a) {
    return a * (1 / std::sqrt(dot(a, a)));
}

struct Substance {
    double diffuse, specular, transmission, ior, shininess;
    bool thin;
};
struct Triangle {
    Point p[3];
    Substance of;
};
struct PointLight {
    Point at;
    double intensity;
};

struct Reference {
    std::vector<Triangle> triangles;
    std::vector<PointLight> lights;
    double background = 0;

    const Triangle* hit(const Point& o, const Point& d, double least, double& t) const {
        const Triangle* nearest = nullptr;
        for (const Triangle& triangle : triangles) {
            const Point e1 = triangle.p[1] - triangle.p[0], e2 = triangle.p[2] - triangle.p[0], q = cross(d, e2);
            const double det = dot(e1, q);
            if (std::abs(det) < 1e-14) continue;
            const Point s = o - triangle.p[0], r = cross(s, e1);
            const double u = dot(s, q) / det, v = dot(d, r) / det, at = dot(e2, r) / det;
            if (u < 0 || v < 0 || u + v > 1 || at < least || (nearest && at >= t)) continue;
            nearest = &triangle;
            t = at;
        }
        return nearest;
    }
    double intensity(const Point& o, const Point& d, int depth) const {
        double t = 0;
        const Triangle* const seen = hit(o, d, 1e-9, t);
        if (!seen) return background;
        const Substance& m = seen->of;
        const Point p = o + d * t, v = d * -1;
        Point n = unit(cross(seen->p[1] - seen->p[0], seen->p[2] - seen->p[0]));
        const bool behind = dot(n, v) < 0;
        if (behind) n = n * -1;
        double sum = 0;
        for (const PointLight& light : lights) {
            const Point to = light.at - p, l = unit(to);
            double blocked = 0;
            if (dot(n, l) <= 0 || (hit(p, l, 1e-9, blocked) && blocked * blocked < dot(to, to))) continue;
            const Point r = n * (2 * dot(n, l)) - l;
            sum += (m.diffuse * dot(n, l) + m.specular * std::pow(std::max(dot(v, r), 0.0), m.shininess)) *
                   light.intensity / dot(to, to) / kPi;
        }
        if (depth == 0) return sum;
        const double cosine = dot(n, v), eta = behind ? m.ior : 1 / m.ior,
                     squared = 1 - eta * eta * (1 - cosine * cosine);
        double mirror = m.specular;
        if (m.transmission > 0) {
            if (m.thin)
                sum += m.transmission * intensity(p, d, depth - 1);
            else if (squared <= 0)
                mirror += m.transmission;
            else
                sum +=
                    m.transmission * intensity(p, unit(d * eta + n * (eta * cosine - std::sqrt(squared))), depth - 1);
        }
        if (mirror > 0) sum += mirror * intensity(p, n * (2 * cosine) - v, depth - 1);
        return sum;
    }
};

// A box or a tetrahedron, turned at random, about a centre; the faces outwards.
MeshData random_body(std::mt19937& random, Vec centre, float size) {
    std::uniform_real_distribution<float> number(-1, 1);
    const Vec x = unit(Vec{number(random), number(random), number(random)}),
              y = unit(cross(x, Vec{number(random), number(random), number(random)})), z = cross(x, y);
    MeshData m;
    const bool is_box = number(random) > 0;
    const auto add = [&](float a, float b, float c) {
        const Vec p = centre + (x * a + y * b + z * c) * size;
        m.positions.insert(m.positions.end(), p.begin(), p.end());
    };
    if (is_box) {
        for (int k = 0; k < 8; ++k) add(k & 1 ? 0.8f : -0.8f, k & 2 ? 0.6f : -0.6f, k & 4 ? 0.7f : -0.7f);
        m.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
        m.offsets = {0, 4, 8, 12, 16, 20, 24};
    } else {
        add(1, 1, 1), add(-1, -1, 1), add(-1, 1, -1), add(1, -1, -1);
        m.corners = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
        m.offsets = {0, 3, 6, 9, 12};
    }
    return m;
}

TEST(RayTracing, IsTheEquationOnRandomScenes) {
    size_t pixels = 0, wrong = 0;
    for (uint32_t seed = 1; seed <= 200; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> number(0, 1);
        Scene scene;
        Reference reference;
        const auto add = [&](const MeshData& mesh) {
            Substance s{number(random) * 0.5,
                        number(random) * 0.6,
                        number(random) < 0.6f ? number(random) * 0.9 : 0,
                        1 + number(random),
                        1 + 20 * double{number(random)},
                        number(random) < 0.25f};
            scene.object(mesh, scene.material([&](TrpMaterialDesc& d) {
                const auto set = [](TrpCoefficient& c, double& value) {
                    const auto f = static_cast<float>(value);
                    value = double{f};
                    c = {{f, f, f}, TRP_NO_NODE};
                };
                set(d.diffuse, s.diffuse), set(d.specular, s.specular), set(d.transmission, s.transmission);
                set(d.ior, s.ior), set(d.shininess, s.shininess);
                d.thin = s.thin;
            }));
            const auto point = [&](uint32_t corner) {
                const float* p = &mesh.positions[3 * size_t{mesh.corners[corner]}];
                return Point{p[0], p[1], p[2]};
            };
            for (size_t f = 0; f + 1 < mesh.offsets.size(); ++f)
                for (uint32_t c = mesh.offsets[f] + 2; c < mesh.offsets[f + 1]; ++c)
                    reference.triangles.push_back({{point(mesh.offsets[f]), point(c - 1), point(c)}, s});
        };
        add(floor_square(6, -1.5f));
        for (int k = 0; k < 6; ++k) {
            const Vec centre = {2.2f * static_cast<float>(k % 3 - 1), 2.2f * static_cast<float>(k / 3), 0};
            add(random_body(random, centre, 0.5f + 0.1f * number(random)));
        }
        for (int k = 0; k < 2; ++k) {
            const Vec at = {8 * number(random) - 4, -4 * number(random), 3 + 2 * number(random)};
            scene.light(TRP_LIGHT_POINT, {30, 30, 30}, translation(at));
            reference.lights.push_back({{at[0], at[1], at[2]}, 30});
        }
        reference.background = 0.25;
        scene.world({0.25f, 0.25f, 0.25f}, [](TrpWorldDesc& d) { d.light = 0; });
        const Transform camera = look_at({0.3f, -7, 1.7f}, {0, 1, 0});
        scene.camera(camera, [](TrpCameraDesc& d) { d.field_of_view = 0.9f; });
        constexpr int kSide = 12;
        const Image image = traced(scene, kSide, kSide, with(kOneRay, {{"trace.depth", "5"}}));
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const double half = std::tan(double{0.9f} / 2), px = ((x + 0.5) / kSide * 2 - 1) * half,
                             py = ((y + 0.5) / kSide * 2 - 1) * half;
                Point d;
                for (size_t k = 0; k < 3; ++k)
                    d[k] = px * double{camera[4 * k]} + py * double{camera[4 * k + 1]} - double{camera[4 * k + 2]};
                const double expected =
                    reference.intensity({double{camera[3]}, double{camera[7]}, double{camera[11]}}, unit(d), 5);
                const double is = image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y))[0];
                ++pixels;
                wrong += std::abs(is - expected) > 1e-5 * std::max(1.0, expected);
            }
    }
    // Rays that pass an edge within rounding may take another way.
    EXPECT_LE(wrong, pixels / 2000) << "of " << pixels;
}

// ---- optics

// What a single ray sees.
double seen(Scene& scene, Vec from, Vec to, const Settings& settings = {}) {
    scene.camera(look_at(from, to, {0.123f, 0.5f, 0.8f}), [](TrpCameraDesc& d) {
        d.field_of_view = 1e-4f;
        d.clip_start = 1e-4f;
    });
    return traced(scene, 1, 1, with(with(kOneRay, {{"shading.specular", "none"}, {"shadows", "off"}}), settings))
        .at(0, 0)[0];
}

double fresnel(double eta, double angle) {  // eta: of the other side over this one
    const double ci = std::cos(angle), st = std::sin(angle) / eta;
    if (st >= 1) return 1;
    const double ct = std::sqrt(1 - st * st), a = (ci - eta * ct) / (ci + eta * ct),
                 b = (eta * ci - ct) / (eta * ci + ct);
    return (a * a + b * b) / 2;
}

TEST(RayTracing, FresnelReflectsAndTransmits) {
    EXPECT_NEAR(fresnel(1.5, 0), 0.04, 1e-12);
    // A half space of glass below, and a sky above: only what is reflected comes from the sky.
    for (const double degrees : {0.0, 20.0, 45.0, 56.3099, 70.0, 85.0, 89.0}) {
        const double a = degrees * kPi / 180;
        const Vec from = {static_cast<float>(-5 * std::sin(a)), 0, static_cast<float>(5 * std::cos(a))};
        Scene scene;
        scene.object(floor_square(1000), glass(scene, 1.5f));
        scene.object(floor_square(1000, -1), glowing(scene, 0));
        scene.world({1, 1, 1}, [](TrpWorldDesc& d) { d.light = 0; });
        EXPECT_NEAR(seen(scene, from, {0, 0, 0}), fresnel(1.5, a), 2e-5) << degrees;
    }
    for (const double degrees : {10.0, 41.0, 41.81, 41.811, 43.0, 60.0}) {
        // A block of glass whose upper side the eye looks at from within; the sky shines through it.
        const double a = degrees * kPi / 180;
        Scene scene;
        scene.object(box({-100, -100, -5}, {100, 100, 0}), glass(scene, 1.5f));
        scene.object(floor_square(500, -2), glowing(scene, 0));
        scene.world({1, 1, 1}, [](TrpWorldDesc& d) { d.light = 0; });
        const Vec from = {static_cast<float>(-std::sin(a)), 0, static_cast<float>(-std::cos(a))};
        EXPECT_NEAR(seen(scene, from, {0, 0, 0}), 1 - fresnel(1 / 1.5, a), 5e-4) << degrees;
    }
}

TEST(RayTracing, ThinPanesSumTheirInnerReflections) {
    for (const double degrees : {0.0, 45.0, 80.0}) {
        const double a = degrees * kPi / 180, r = fresnel(1.5, a);
        Scene scene;
        scene.object(floor_square(1000), glass(scene, 1.5f, [](TrpMaterialDesc& d) { d.thin = 1; }));
        scene.object(floor_square(1000, -1), glowing(scene, 1));
        const Vec from = {static_cast<float>(-5 * std::sin(a)), 0, static_cast<float>(5 * std::cos(a))};
        EXPECT_NEAR(seen(scene, from, {0, 0, 0}), 1 - 2 * r / (1 + r), 2e-5) << degrees;
    }
}

// The shift of a ray by a slab: t sin a (1 − cos a / √(η² − sin² a)).
TEST(RayTracing, SlabsShiftRays) {
    const double eta = 1.5, thickness = 2;
    for (const double degrees : {0.0, 15.0, 40.0, 65.0}) {
        const double a = degrees * kPi / 180;
        const double shift =
            thickness * std::sin(a) * (1 - std::cos(a) / std::sqrt(eta * eta - std::sin(a) * std::sin(a)));
        // Below, a floor that glows to one side of where the shifted ray must arrive, to within a thousandth.
        for (const double side : {-1e-3, 1e-3}) {
            Scene scene;
            scene.object(box({-50, -50, -2}, {50, 50, 0}), glass(scene, 1.5f, [](TrpMaterialDesc& d) {
                             d.fresnel = 0;
                             d.mirror = {{0, 0, 0}, TRP_NO_NODE};
                         }));
            // Straight on, the ray would meet z = −3 at x = 3 tan a; the shift is across the ray.
            const auto x = static_cast<float>(3 * std::tan(a) - shift / std::cos(a) + side);
            scene.object(quad({x, -50, -3}, {50, -50, -3}, {50, 50, -3}, {x, 50, -3}), glowing(scene, 1));
            const Vec from = {static_cast<float>(-5 * std::sin(a)), 0, static_cast<float>(5 * std::cos(a))};
            EXPECT_NEAR(seen(scene, from, {0, 0, 0}), side < 0 ? 1 : 0, 1e-5) << degrees << ", " << side;
        }
    }
}

TEST(RayTracing, AbsorptionIsBeers) {
    Scene scene;
    scene.object(box({-50, -50, -2}, {50, 50, 0}), glass(scene, 1, [](TrpMaterialDesc& d) { d.absorption[0] = 0.7f; }));
    scene.object(floor_square(50, -3), glowing(scene, 1));
    EXPECT_NEAR(seen(scene, {0, 0, 5}, {0, 0, 0}), std::exp(-0.7 * 2), 1e-6);
    EXPECT_NEAR(seen(scene, {-4, 0, 3}, {0, 0, 0}), std::exp(-0.7 * 2 * 5 / 3.0), 1e-5);
    EXPECT_NEAR(seen(scene, {0, 0, -0.5f}, {0, 0, -1}), std::exp(-0.7 * 1.5), 1e-5) << "the eye within";
}

TEST(RayTracing, ABodyOfItsSurroundingsIndexIsInvisible) {
    Scene with_body, without;
    for (Scene* scene : {&with_body, &without}) {
        scene->object(floor_square(5), scene->diffuse(0.7f, 0.5f, 0.3f));
        scene->light(TRP_LIGHT_POINT, {30, 30, 30}, translation({1, -2, 4}),
                     [](TrpLightDesc& d) { d.cast_shadow = 0; });
        scene->world({0.2f, 0.3f, 0.4f}, [](TrpWorldDesc& d) { d.light = 0; });
        scene->camera(look_at({0, -6, 3}, {0, 0, 0.5f}));
    }
    with_body.object(sphere({0, 0, 1}, 0.9f), glass(with_body, 1));
    const Image a = traced(with_body, 60, 40, kOneRay), b = traced(without, 60, 40, kOneRay);
    for (size_t i = 0; i < a.values.size(); ++i) EXPECT_NEAR(a.values[i], b.values[i], 1e-5) << i;
}

// In a sealed cube of mirrors each level adds the walls' emission times one more reflection.
TEST(RayTracing, ASealedCubeOfMirrorsIsAGeometricSeries) {
    for (const float scale : {1e-3f, 1.0f, 1e6f}) {
        Scene scene;
        scene.object(inwards(box({-scale, -scale, -scale}, {scale, scale, scale})),
                     scene.material([](TrpMaterialDesc& d) {
                         d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
                         d.emission = {{0.1f, 0.1f, 0.1f}, TRP_NO_NODE};
                         d.mirror = {{0.8f, 0.8f, 0.8f}, TRP_NO_NODE};
                         d.mirror_is_specular = 0;
                     }));
        scene.camera(look_at({0.3f * scale, -0.2f * scale, 0.1f * scale}, {scale, 0.4f * scale, 0.2f * scale}),
                     [&](TrpCameraDesc& d) {
                         d.clip_start *= scale;
                         d.clip_end *= scale;
                     });
        for (const int depth : {0, 1, 2, 5, 20, 300}) {
            const Image image = traced(scene, 24, 16,
                                       with(kOneRay, {{"trace.depth", std::to_string(depth)},
                                                      {"trace.reflection_depth", std::to_string(depth)}}));
            const double expected = 0.1 * (1 - std::pow(0.8, depth + 1)) / 0.2;
            for (uint32_t y = 0; y < 16; ++y)
                for (uint32_t x = 0; x < 24; ++x)
                    ASSERT_NEAR(image.at(x, y)[0], expected, 2e-5) << scale << ", depth " << depth;
        }
    }
}

// In a furnace nothing of glass and mirrors is seen, but what absorbs.
TEST(RayTracing, AFurnaceOfGlassIsUniform) {
    Scene scene;
    scene.object(sphere({-1.2f, 0, 0}, 1, 48), glass(scene, 1.5f));
    scene.object(sphere({1.2f, 0, 0}, 1, 48), glass(scene, 1.33f, [](TrpMaterialDesc& d) { d.thin = 1; }));
    scene.object(floor_square(3, -1.5f), scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.mirror = {{1, 1, 1}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
    }));
    scene.world({1, 1, 1}, [](TrpWorldDesc& d) { d.light = 0; });
    scene.camera(look_at({0, -6, 1}, {0, 0, 0}));
    const Image image = traced(scene, 60, 40,
                               with(kOneRay, {{"trace.depth", "40"},
                                              {"trace.reflection_depth", "40"},
                                              {"trace.transmission_depth", "40"},
                                              {"trace.least_weight", "1e-7"}}));
    for (size_t i = 0; i < image.values.size(); ++i) EXPECT_NEAR(image.values[i], 1, 2e-3) << i;
}

// Slabs of glass from x = 0 to 2 and of water from 1.5 to 4, where one of them fills what both do: by priority.
TEST(RayTracing, PrioritiesNestBodies) {
    for (const bool glass_fills : {true, false}) {
        const auto medium = [](Scene& scene, float ior, int32_t priority, bool by_fresnel) {
            return glass(scene, ior, [&](TrpMaterialDesc& d) {
                d.priority = priority;
                d.fresnel = by_fresnel;
            });
        };
        // At right angles three surfaces reflect: from air to glass, to water, to air.
        Scene straight;
        straight.object(box({0, -9, -9}, {2, 9, 9}), medium(straight, 1.5f, glass_fills ? 2 : 0, true));
        straight.object(box({1.5f, -9, -9}, {4, 9, 9}), medium(straight, 1.33f, 1, true));
        straight.object(quad({5, -5, -5}, {5, 5, -5}, {5, 5, 5}, {5, -5, 5}), glowing(straight, 1));
        EXPECT_NEAR(seen(straight, {-4, 0.1f, 0.2f}, {0, 0.1f, 0.2f}, {{"trace.reflection_depth", "0"}}),
                    (1 - fresnel(1.5, 0)) * (1 - fresnel(1.33 / 1.5, 0)) * (1 - fresnel(1 / 1.33, 0)), 1e-5);
        // Oblique rays go as through two slabs with next to no gap between them, which shifts nothing.
        Scene overlapping, apart;
        const float border = glass_fills ? 2 : 1.5f;
        overlapping.object(box({0, -9, -9}, {2, 9, 9}), medium(overlapping, 1.5f, glass_fills ? 2 : 0, false));
        overlapping.object(box({1.5f, -9, -9}, {4, 9, 9}), medium(overlapping, 1.33f, 1, false));
        apart.object(box({0, -9, -9}, {border, 9, 9}), medium(apart, 1.5f, 0, false));
        apart.object(box({border + 1e-4f, -9, -9}, {4, 9, 9}), medium(apart, 1.33f, 0, false));
        for (Scene* scene : {&overlapping, &apart}) {
            for (int k = 0; k < 6; ++k) {
                const float y = static_cast<float>(k) - 3;
                scene->object(quad({5, y, -5}, {5, y, 5}, {5, y + 1, 5}, {5, y + 1, -5}),
                              glowing(*scene, 0.3f + 0.2f * static_cast<float>(k)));
            }
            scene->camera(look_at({-4, 1, 0.5f}, {0, 0, 0}), [](TrpCameraDesc& d) { d.field_of_view = 0.5f; });
        }
        const Settings settings = with(kOneRay, {{"trace.reflection_depth", "0"}});
        const Image a = traced(overlapping, 40, 30, settings), b = traced(apart, 40, 30, settings);
        size_t differ = 0, bright = 0;
        for (size_t i = 0; i < a.values.size(); i += 4) {
            differ += std::abs(a.values[i] - b.values[i]) > 2e-5;
            bright += a.values[i] > 0.2f;
        }
        EXPECT_GT(bright, 600u);
        EXPECT_LE(differ, 3u) << "pixels at the border of two strips";
    }
}

// A ball lens of radius R and index η has its focus η R / (2 (η − 1)) from its centre, for rays near its axis.
TEST(RayTracing, ABallLensHasItsFocus) {
    const float eta = 1.5f, focus = eta / (2 * (eta - 1));
    Scene scene;
    scene.object(sphere({0, 0, 0}, 1, 256), glass(scene, eta, [](TrpMaterialDesc& d) { d.fresnel = 0; }));
    // A small disc at the focus that glows: all parallel rays near the axis meet it.
    const float half = 0.004f, z = -focus;
    scene.object(quad({-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}), glowing(scene, 1));
    scene.camera_above(0.2f);
    const Image image = traced(scene, 16, 16, with(kOneRay, {{"trace.reflection_depth", "0"}, {"shadows", "off"}}));
    for (uint32_t y = 4; y < 12; ++y)
        for (uint32_t x = 4; x < 12; ++x) EXPECT_NEAR(image.at(x, y)[0], 1, 1e-4) << x << ", " << y;
}

// ---- the tree of a pixel

std::vector<TrpRay> tree_of(TrpRender* render, uint32_t x, uint32_t y) {
    uint32_t count = 0;
    check(trp_render_trace_tree(render, x, y, &count));
    std::vector<TrpRay> rays(count);
    for (uint32_t k = 0; k < count; ++k) {
        rays[k].struct_size = sizeof(TrpRay);
        check(trp_render_ray(render, k, &rays[k]));
    }
    return rays;
}

void build_mixed(Scene& scene) {
    scene.object(floor_square(4), scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.6f, 0.5f, 0.4f}, TRP_NO_NODE};
        d.specular = {{0.2f, 0.2f, 0.2f}, TRP_NO_NODE};
    }));
    scene.object(sphere({-1, 0, 1}, 0.9f, 32), glass(scene, 1.5f, [](TrpMaterialDesc& d) {
                     d.diffuse = {{0.1f, 0.1f, 0.1f}, TRP_NO_NODE};
                     d.absorption[0] = 0.3f;
                 }));
    scene.object(sphere({1, 0.5f, 1}, 0.9f, 32), scene.material([](TrpMaterialDesc& d) {
        d.specular = {{0.7f, 0.6f, 0.5f}, TRP_NO_NODE};
        d.alpha = {{0.75f, 0, 0}, TRP_NO_NODE};
    }));
    scene.light(TRP_LIGHT_POINT, {60, 60, 60}, translation({2, -3, 5}));
    scene.light(TRP_LIGHT_AREA, {4, 4, 4}, look_at({-3, -3, 4}, {0, 0, 0}));
    scene.world({0.2f, 0.3f, 0.4f});
    scene.camera(look_at({0, -6, 2.5f}, {0, 0, 0.8f}));
    scene.commit();
}

// The sum at the root is the pixel, and each ray's intensity what its local terms and children add up to.
TEST(RayTree, AddsUpToThePixel) {
    Scene scene;
    build_mixed(scene);
    Render render(scene, 48, 32, with(kOneRay, {{"trace.depth", "5"}}), {}, "ray_tracing");
    const Image image = render.run().read();
    size_t longest = 0;
    bool kinds[3] = {}, ends[5] = {};
    for (uint32_t y = 0; y < 32; ++y)
        for (uint32_t x = 0; x < 48; ++x) {
            const std::vector<TrpRay> rays = tree_of(render, x, y);
            longest = std::max(longest, rays.size());
            ASSERT_EQ(rays[0].parent, TRP_NO_PARENT);
            for (size_t c = 0; c < 3; ++c) {
                ASSERT_NEAR(rays[0].intensity[c], image.at(x, y)[c], 1e-5) << x << ", " << y;
                std::vector<double> sums;
                for (const TrpRay& ray : rays) {
                    sums.push_back(ray.local[c]);
                    kinds[ray.kind] = ends[ray.end] = true;
                    EXPECT_TRUE((ray.end == TRP_END_SURFACE) == (ray.instance != TRP_NO_ID));
                }
                for (size_t k = 1; k < rays.size(); ++k) {
                    ASSERT_LT(rays[k].parent, k);
                    sums[rays[k].parent] += double{rays[k].weight[c]} * double{rays[k].intensity[c]};
                }
                for (size_t k = 0; k < rays.size(); ++k) ASSERT_NEAR(rays[k].intensity[c], sums[k], 1e-5);
            }
        }
    EXPECT_GT(longest, 20u);
    for (const bool kind : kinds) EXPECT_TRUE(kind);
    for (const int end : {TRP_END_SURFACE, TRP_END_LIGHT, TRP_END_BACKGROUND, TRP_END_DEPTH})
        EXPECT_TRUE(ends[end]) << end;
    EXPECT_FALSE(ends[TRP_END_WEIGHT]) << "all are traced";
}

TEST(RayTree, IsGuarded) {
    Scene scene;
    build_mixed(scene);
    Render render(scene, 8, 8, kOneRay, {}, "ray_tracing"), cast(scene, 8, 8, {}, {}, "ray_casting");
    const auto fails = [](TrpStatus status, TrpStatus expected, const char* word) {
        EXPECT_EQ(status, expected);
        EXPECT_NE(std::string(trp_error_message()).find(word), std::string::npos) << trp_error_message();
    };
    uint32_t count = 0;
    TrpRay ray{};
    fails(trp_render_trace_tree(nullptr, 0, 0, &count), TRP_ERROR_ARGUMENT, "render");
    fails(trp_render_trace_tree(render, 0, 0, nullptr), TRP_ERROR_ARGUMENT, "count");
    fails(trp_render_trace_tree(render, 8, 0, &count), TRP_ERROR_ARGUMENT, "(8, 0)");
    fails(trp_render_trace_tree(cast, 0, 0, &count), TRP_ERROR_STATE, "ray_casting");
    fails(trp_render_ray(render, 0, &ray), TRP_ERROR_ARGUMENT, "there are 0");
    Scene two_ways;
    const auto pane = [](TrpMaterialDesc& d) {
        d.thin = 1;
        d.fresnel = 0;
    };
    two_ways.object(box({-2, -2, -2}, {2, 2, 2}), glass(two_ways, 1.5f, pane));
    two_ways.object(box({-9, -9, -9}, {9, 9, 9}), glass(two_ways, 1.5f, pane));
    two_ways.camera(look_at({0, -1, 0}, {0.3f, 0, 0.1f}));
    two_ways.commit();
    Render endless(
        two_ways, 8, 8,
        with(kOneRay, {{"trace.depth", "300"}, {"trace.reflection_depth", "300"}, {"trace.transmission_depth", "300"}}),
        {}, "ray_tracing");
    fails(trp_render_trace_tree(endless, 4, 4, &count), TRP_ERROR_MEMORY, "trace.depth");
    check(trp_render_trace_tree(render, 4, 4, &count));
    fails(trp_render_ray(render, count, &ray), TRP_ERROR_ARGUMENT, "no ray");
    fails(trp_render_ray(render, 0, &ray), TRP_ERROR_ARGUMENT, "struct_size");
    fails(trp_render_ray(render, 0, nullptr), TRP_ERROR_ARGUMENT, "ray");
}

// ---- what is hard to trace ends, with numbers for pixels

void expect_finite(const Image& image) {
    for (size_t i = 0; i < image.values.size(); ++i) ASSERT_TRUE(std::isfinite(image.values[i])) << i;
}

TEST(RayTracing, GreatDepthsEnd) {
    // A box of perfect mirrors around glass, where no ray ever ends by itself.
    Scene scene;
    scene.object(inwards(box({-2, -2, -2}, {2, 2, 2})), scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
        d.mirror = {{1, 1, 1}, TRP_NO_NODE};
        d.mirror_is_specular = 0;
    }));
    scene.object(sphere({0, 0.5f, 0}, 0.7f, 16), glass(scene, 1.5f, [](TrpMaterialDesc& d) {
                     d.fresnel = 0;
                     d.mirror = {{0, 0, 0}, TRP_NO_NODE};
                 }));
    scene.light(TRP_LIGHT_POINT, {1, 1, 1}, translation({1, -1, 1}));
    scene.camera(look_at({0, -1.5f, 0}, {0, 0, 0}));
    const Settings deep = {
        {"trace.depth", "10000"}, {"trace.reflection_depth", "10000"}, {"trace.transmission_depth", "10000"}};
    expect_finite(traced(scene, 16, 16, with(kOneRay, deep)));
    Render render(scene, 16, 16, with(kOneRay, deep), {}, "ray_tracing");
    EXPECT_GT(tree_of(render, 8, 8).size(), 1000u);
}

TEST(RayTracing, ThousandNestedSpheresEnd) {
    Scene scene;
    const uint32_t mesh = scene.mesh(sphere({0, 0, 0}, 1, 12)), clear = glass(scene, 1.1f, [](TrpMaterialDesc&d) {
                                                                    d.fresnel = 0;
                                                                    d.mirror = {{0, 0, 0}, TRP_NO_NODE};
                                                                });
    for (int k = 0; k < 1000; ++k) {
        const float r = 1 - 0.0009f * static_cast<float>(k);
        scene.instance(mesh, {r, 0, 0, 0, 0, r, 0, 0, 0, 0, r, 0}, [&](TrpInstanceDesc& d) {
            d.materials = &clear;
            d.material_count = 1;
        });
    }
    scene.world({1, 1, 1}, [](TrpWorldDesc& d) { d.light = 0; });
    scene.camera(look_at({0, -4, 0}, {0, 0, 0}));
    const Image image =
        traced(scene, 8, 8, with(kOneRay, {{"trace.depth", "3000"}, {"trace.transmission_depth", "3000"}}));
    expect_finite(image);
    EXPECT_NEAR(image.at(0, 0)[0], 1, 1e-3);
}

// Bodies that overlap, surfaces that lie in each other, bodies left open: any picture of them will do.
TEST(RayTracing, MeaninglessBodiesAreDrawn) {
    Scene scene;
    scene.object(sphere({0, 0, 0}, 1, 16), glass(scene, 1.5f));
    scene.object(sphere({0.5f, 0, 0}, 1, 16), glass(scene, 1.33f));
    scene.object(box({-1, -1, -2}, {1, 1, -1}), glass(scene, 1.2f));
    scene.object(box({-1, -1, -2}, {1, 1, -1}), glass(scene, 2.0f));
    scene.object(floor_square(3, 0.2f), glass(scene, 1.4f));
    scene.object(inwards(sphere({-1.5f, 0, 0}, 0.8f, 16)), glass(scene, 1e-3f));
    scene.object(sphere({1.5f, 1, 0}, 0.8f, 16), glass(scene, 1e3f));
    scene.light(TRP_LIGHT_POINT, {30, 30, 30}, translation({2, -3, 5}));
    scene.world({0.3f, 0.3f, 0.3f});
    for (const Vec& eye : {Vec{0, -5, 1}, Vec{0.2f, 0.1f, 0.1f}, Vec{0, 0, -1.5f}}) {
        scene.camera(look_at(eye, {0.1f, 0.3f, 0}));
        expect_finite(
            traced(scene, 24, 16, {{"samples", "4"}, {"trace.depth", "12"}, {"trace.transmission_depth", "12"}}));
    }
}

}  // namespace
}  // namespace trp_test
