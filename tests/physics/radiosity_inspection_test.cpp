// What shows a radiosity solution to those who learn: rows of form factors and their sums, links, false colours.
#include "support/bodies.h"
#include "support/radiosity.h"

namespace trp_test {
namespace {

// A closed unit cube, seen from within, whose floor emits.
struct Room : Scene {
    Room() {
        const auto wall = [&](float radiance) {
            return material([&](TrpMaterialDesc& d) {
                d.diffuse = {{0.5f, 0.5f, 0.5f}, TRP_NO_NODE};
                d.emission = {{radiance, radiance, radiance}, TRP_NO_NODE};
                d.double_sided = 0;
            });
        };
        MeshData cube = inwards(box({0, 0, 0}, {1, 1, 1}));
        cube.materials = {wall(1), wall(0)};
        cube.face_materials = {0, 1, 1, 1, 1, 1};
        object(cube);
        camera(look_at({0.1f, 0.15f, 0.9f}, {0.6f, 0.55f, 0.3f}), [](TrpCameraDesc& d) { d.field_of_view = 1.5f; });
    }
};

const Solution::Settings kMatrix = {{"radiosity.solver", "matrix"}, {"radiosity.element_size", "0.25"}};
const Solution::Settings kHierarchical = {{"radiosity.solver", "hierarchical"}, {"radiosity.tolerance", "0.02"}};

std::vector<uint64_t> links_to(TrpRadiosity* solution, uint32_t element) {
    size_t count = 0;
    check(trp_radiosity_element_links(solution, element, nullptr, 0, &count));
    std::vector<uint64_t> out(count);
    check(trp_radiosity_element_links(solution, element, out.data(), out.size(), &count));
    return out;
}

TrpRadiosityLink link_of(TrpRadiosity* solution, uint64_t number) {
    TrpRadiosityLink link{};
    link.struct_size = sizeof link;
    check(trp_radiosity_link(solution, number, &link));
    return link;
}

// Where the middles of the elements lie in a render's picture: pixels, and those out of it left out.
struct SeenElement {
    uint32_t element, x, y;
};
std::vector<SeenElement> seen_elements(const Solution& solution, const Render& render, uint32_t width,
                                       uint32_t height) {
    const std::vector<float> centres = solution.read("centre", 3);
    std::vector<float> film(centres.size());
    check(trp_render_project(render, centres.data(), centres.size() / 3, film.data()));
    std::vector<SeenElement> out;
    for (uint32_t k = 0; k < film.size() / 3; ++k) {
        const float x = film[3 * k], y = film[3 * k + 1], depth = film[3 * k + 2];
        if (depth > 0 && x >= 0 && y >= 0 && x < static_cast<float>(width) && y < static_cast<float>(height))
            out.push_back({k, static_cast<uint32_t>(x), static_cast<uint32_t>(y)});
    }
    return out;
}

TEST(RadiosityInspection, RowsOfAClosedRoomSumToOne) {
    Room room;
    Solution matrix(room, kMatrix), hierarchical(room, kHierarchical),
        progressive(room, {{"radiosity.solver", "progressive"}});
    for (const float sum : matrix.solve().read("row_sum", 1)) EXPECT_NEAR(sum, 1, 1e-6);
    const std::vector<float> sums = hierarchical.solve().read("row_sum", 1), areas = hierarchical.read("area", 1);
    double mean = 0, by_links = 0, area = 0;
    for (uint32_t k = 0; k < sums.size(); ++k) {
        mean += static_cast<double>(sums[k] * areas[k]);
        area += static_cast<double>(areas[k]);
        for (const uint64_t number : links_to(hierarchical, k))
            by_links += static_cast<double>(link_of(hierarchical, number).factor[0] * areas[k]);
    }
    // A link is right in the mean to what its few points see of it.
    EXPECT_NEAR(mean / area, 1, 0.02);
    // What changes over a whole leaves the mean of its parts as it is.
    EXPECT_NEAR(by_links / area, mean / area, 1e-5);
    float none = 0;
    progressive.solve();
    EXPECT_EQ(trp_radiosity_read(progressive, "row_sum", &none, progressive.info().element_count), TRP_ERROR_STATE);
}

TEST(RadiosityInspection, VerticesOfAFurnaceHaveTheRadiosityOfAll) {
    Scene scene;
    scene.object(inwards(box({0, 0, 0}, {1, 1, 1})), scene.material([](TrpMaterialDesc& d) {
        d.diffuse = {{0.5f, 0.5f, 0.5f}, TRP_NO_NODE};
        const auto radiance = static_cast<float>(1 / kPi);
        d.emission = {{radiance, radiance, radiance}, TRP_NO_NODE};
    }));
    Solution solution(scene, kMatrix);
    solution.solve();
    for (const float radiosity : solution.read("vertex_radiosity", 3)) EXPECT_NEAR(radiosity, 2, 1e-4);
    for (const float irradiance : solution.read("vertex_irradiance", 3)) EXPECT_NEAR(irradiance, 2, 1e-4);
}

TEST(RadiosityInspection, AnElementsLinksAreItsOwnAndThoseOfItsWholes) {
    Room room;
    Solution solution(room, kHierarchical);
    const TrpRadiosityInfo info = solution.solve().info();
    ASSERT_GT(info.element_count, 100u);
    std::vector<uint32_t> own(info.element_count, 0);
    int deepest = 0;
    for (uint64_t k = 0; k < info.links; ++k) {
        const TrpRadiosityLink link = link_of(solution, k);
        deepest = std::max(deepest, link.level);
        EXPECT_GE(link.level, 0) << "six faces need no groups";
        if (link.receiver != TRP_NO_ELEMENT) ++own[link.receiver];
    }
    // Each division halves the sides.
    const std::vector<float> areas = solution.read("area", 1);
    EXPECT_NEAR(std::pow(4.0, -deepest), *std::min_element(areas.begin(), areas.end()), 1e-6);
    for (uint32_t element = 0; element < info.element_count; ++element) {
        uint32_t found = 0;
        int level = 99;
        for (const uint64_t number : links_to(solution, element)) {
            const TrpRadiosityLink link = link_of(solution, number);
            found += link.receiver == element;
            EXPECT_TRUE(link.receiver == element || link.receiver == TRP_NO_ELEMENT);
            // From the element up: the wholes have lower levels and larger areas.
            EXPECT_LE(link.level, level);
            level = link.level;
            EXPECT_GE(std::pow(4.0, -link.level), static_cast<double>(areas[element]) * 0.999);
        }
        EXPECT_EQ(found, own[element]);
    }
}

TEST(RadiosityInspection, PixelsKnowTheirElements) {
    Room room;
    for (const bool perspective : {true, false}) {
        if (!perspective) room.camera_above(0.9f, {0.5f, 0.5f, -9.5f});
        Solution solution(room, kMatrix);
        solution.prepare();
        Render render(room, 160, 120, {}, {}, "radiosity");
        const auto seen = seen_elements(solution, render, 160, 120);
        ASSERT_GT(seen.size(), perspective ? 30u : 15u);
        for (const auto& [element, x, y] : seen) {
            // From above, of all elements under each other that of the floor is seen.
            if (!perspective && solution.read("centre", 3)[3 * element + 2] > 0) continue;
            uint32_t picked = 0;
            check(trp_radiosity_pick(solution, render, x, y, &picked));
            EXPECT_EQ(picked, element) << x << ' ' << y;
        }
    }
    // Past everything.
    Scene open;
    open.object(floor_square(1));
    open.camera_above(8);
    Solution solution(open, kMatrix);
    solution.prepare();
    Render render(open, 40, 40, {}, {}, "radiosity");
    uint32_t picked = 0;
    check(trp_radiosity_pick(solution, render, 1, 1, &picked));
    EXPECT_EQ(picked, TRP_NO_ELEMENT);
}

// Blue, cyan, green, yellow, red.
Vec color_of(double share) {
    const double at = 4 * std::min(share, 1.0);
    const auto ramp = [](double t) { return static_cast<float>(std::clamp(t, 0.0, 1.0)); };
    return {ramp(at - 2), at < 3 ? ramp(at) : ramp(4 - at), ramp(2 - at)};
}

TEST(RadiosityInspection, ARowOfFormFactorsIsPainted) {
    Room room;
    Solution solution(room, kMatrix);
    solution.solve();
    const double scale = 0.02;
    Render render(room, 160, 120,
                  {{"radiosity.view", "form_factors"}, {"radiosity.view_scale", "0.02"}, {"radiosity.legend", "off"}},
                  {}, "radiosity");
    const uint32_t chosen = seen_elements(solution, render, 160, 120).back().element;
    ASSERT_GT(chosen, 0u);
    const std::vector<double> row = solution.row(chosen);
    check(trp_render_set(render, "radiosity.view_element", std::to_string(chosen).c_str()));
    check(trp_render_set_radiosity(render, solution));
    const Image image = render.run().read();
    for (const auto& [element, x, y] : seen_elements(solution, render, 160, 120)) {
        const Vec wanted = element == chosen ? Vec{1, 1, 1} : color_of(row[element] / scale);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(image.at(x, y)[c], wanted[c], 1e-4) << "element " << element << " channel " << c;
    }
    check(trp_render_set(render, "radiosity.view_element", "100000"));
    EXPECT_EQ(trp_render_run(render, nullptr), TRP_ERROR_ARGUMENT);
    EXPECT_NE(std::string(trp_error_message()).find("no element 100000"), std::string::npos);
}

TEST(RadiosityInspection, LuxAreWattsInAnotherUnit) {
    Room room;
    Solution solution(room, kMatrix);
    solution.solve();
    const auto picture = [&](const char* view, const char* scale) {
        Render render(room, 64, 48,
                      {{"radiosity.view", view}, {"radiosity.view_scale", scale}, {"radiosity.legend", "off"}}, {},
                      "radiosity");
        check(trp_render_set_radiosity(render, solution));
        return render.run().read();
    };
    const Image watts = picture("false_color", "2"), lux = picture("illuminance", "1366");
    for (size_t k = 0; k < watts.values.size(); ++k) EXPECT_NEAR(watts.values[k], lux.values[k], 1e-5);
    // And not the same whatever the scale.
    EXPECT_GT(std::abs(mean(picture("illuminance", "683"), 2) - mean(lux, 2)), 0.01);
}

// What divided elements have is nothing that is shown.
TEST(RadiosityInspection, TheScaleEndsAtTheBrightestElement) {
    Room room;
    Solution solution(room, {{"radiosity.tolerance", "0.02"}});
    solution.solve();
    const std::vector<double> irradiance = [&] {
        std::vector<double> out;
        const std::vector<float> all = solution.read("irradiance", 3);
        for (size_t k = 0; k < all.size(); k += 3)
            out.push_back(0.2126 * static_cast<double>(all[k]) + 0.7152 * static_cast<double>(all[k + 1]) +
                          0.0722 * static_cast<double>(all[k + 2]));
        return out;
    }();
    const auto picture = [&](const std::string& scale) {
        Render render(room, 64, 48,
                      {{"radiosity.view", "false_color"}, {"radiosity.view_scale", scale}, {"radiosity.legend", "off"}},
                      {}, "radiosity");
        check(trp_render_set_radiosity(render, solution));
        return render.run().read();
    };
    const Image known = picture(std::to_string(*std::max_element(irradiance.begin(), irradiance.end())));
    const Image found = picture("0");
    for (size_t k = 0; k < known.values.size(); ++k) EXPECT_NEAR(found.values[k], known.values[k], 1e-3);
}

TEST(RadiosityInspection, TheLegendShowsTheColoursAndLeavesTheRest) {
    Room room;
    Solution solution(room, kMatrix);
    solution.solve();
    const auto picture = [&](uint32_t width, uint32_t height, const char* legend) {
        Render render(room, width, height, {{"radiosity.view", "false_color"}, {"radiosity.legend", legend}}, {},
                      "radiosity");
        check(trp_render_set_radiosity(render, solution));
        return render.run().read();
    };
    // Of the picture's width and height, what is free of it.
    const auto look = [&](uint32_t width, uint32_t height, double free_width, double free_height) {
        const Image with = picture(width, height, "on"), without = picture(width, height, "off");
        uint32_t left = width, top = 0;
        int red = 0, blue = 0, white = 0;
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                const float *a = with.at(x, y), *b = without.at(x, y);
                if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) continue;
                left = std::min(left, x), top = std::max(top, y);
                red += a[0] == 1 && a[1] < 0.1f && a[2] == 0;
                blue += a[0] == 0 && a[1] < 0.1f && a[2] == 1;
                white += a[0] == 1 && a[1] == 1 && a[2] == 1;
            }
        EXPECT_GT(left, free_width * width) << width;
        EXPECT_LT(top, (1 - free_height) * height) << width;
        EXPECT_GT(red, 0) << width;
        EXPECT_GT(blue, 0) << width;
        EXPECT_GT(white, 100) << width << ": words";
    };
    look(640, 480, 0.85, 0.75);
    look(1920, 1080, 0.85, 0.75);
    look(200, 113, 0.6, 0.25);
    // Where words could not be read there are none.
    EXPECT_EQ(picture(64, 48, "on").values, picture(64, 48, "off").values);
}

}  // namespace
}  // namespace trp_test
