// Radiosity solutions by the ABI: what their functions refuse.
#include <unistd.h>

#include <filesystem>

#include "abi/expect.h"
#include "support/radiosity.h"

using namespace trp_test;

namespace {

// A floor and a ceiling: four elements, as both have two sides.
struct TwoSquares : Scene {
    TwoSquares() {
        object(floor_square(1));
        object(floor_square(1, 1));
    }
};

Solution::Settings small() {
    return {{"radiosity.solver", "matrix"}, {"radiosity.hemicube_resolution", "32"}};
}

TEST(RadiosityProjections, RefuseMisuse) {
    TwoSquares scene;
    Solution solution(scene, small());
    ASSERT_EQ(solution.info().projection_side, 64u);
    EXPECT_EQ(Solution(scene, {}).info().projection_side, 2 * 256u) << "as the table of settings has it";
    std::vector<uint32_t> seen(64 * 64);
    std::vector<float> shares(64 * 64);
    double corners[24], factor = 0;
    size_t used = 0;
    const std::string path =
        (std::filesystem::temp_directory_path() / ("triptych_projection_" + std::to_string(getpid()))).string();
    EXPECT_TRUE(fails(trp_radiosity_projection(solution, 0, seen.data(), shares.data(), seen.size()), TRP_ERROR_STATE,
                      {"no elements"}));
    EXPECT_TRUE(fails(trp_radiosity_write_projection(solution, 0, (path + ".png").c_str()), TRP_ERROR_STATE));
    EXPECT_TRUE(fails(trp_radiosity_outline(solution, 0, 1, corners, 8, &used, &factor), TRP_ERROR_STATE));
    const uint32_t count = solution.prepare().info().element_count;

    EXPECT_EQ(trp_radiosity_projection(solution, 0, seen.data(), shares.data(), seen.size()), TRP_OK);
    EXPECT_TRUE(fails(trp_radiosity_projection(nullptr, 0, seen.data(), shares.data(), seen.size()), TRP_ERROR_ARGUMENT,
                      {"radiosity"}));
    EXPECT_TRUE(fails(trp_radiosity_projection(solution, 0, nullptr, shares.data(), seen.size()), TRP_ERROR_ARGUMENT,
                      {"seen"}));
    EXPECT_TRUE(fails(trp_radiosity_projection(solution, 0, seen.data(), nullptr, seen.size()), TRP_ERROR_ARGUMENT,
                      {"shares"}));
    EXPECT_TRUE(fails(trp_radiosity_projection(solution, 0, seen.data(), shares.data(), 9), TRP_ERROR_ARGUMENT,
                      {"9 pixels", "4096"}));
    EXPECT_TRUE(fails(trp_radiosity_projection(solution, count, seen.data(), shares.data(), seen.size()),
                      TRP_ERROR_ARGUMENT, {"element " + std::to_string(count)}));

    EXPECT_TRUE(fails(trp_radiosity_write_projection(solution, 0, nullptr), TRP_ERROR_ARGUMENT, {"path"}));
    EXPECT_TRUE(fails(trp_radiosity_write_projection(solution, ~0u, (path + ".png").c_str()), TRP_ERROR_ARGUMENT));
    EXPECT_TRUE(
        fails(trp_radiosity_write_projection(solution, 0, (path + ".gif").c_str()), TRP_ERROR_ARGUMENT, {".gif"}));
    EXPECT_TRUE(fails(trp_radiosity_write_projection(solution, 0, "/no/folder/p.png"), TRP_ERROR_FILE, {"/no/folder"}));
    for (const char* extension : {".png", ".exr"}) {
        EXPECT_EQ(trp_radiosity_write_projection(solution, 0, (path + extension).c_str()), TRP_OK)
            << trp_error_message();
        EXPECT_TRUE(std::filesystem::remove(path + extension));
    }

    // The floor's front and the ceiling's back see each other.
    uint32_t facing = 0;
    for (uint32_t k = 0; k < count; ++k) {
        EXPECT_EQ(trp_radiosity_outline(solution, 0, k, corners, 8, &used, &factor), TRP_OK);
        EXPECT_EQ(used > 0, factor > 0);
        if (used == 4) facing = k;
    }
    ASSERT_NE(facing, 0u);
    EXPECT_TRUE(fails(trp_radiosity_outline(solution, 0, facing, corners, 3, &used, &factor), TRP_ERROR_ARGUMENT,
                      {"3 corners", "4 are needed"}));
    EXPECT_TRUE(fails(trp_radiosity_outline(solution, count, 0, corners, 8, &used, &factor), TRP_ERROR_ARGUMENT));
    EXPECT_TRUE(fails(trp_radiosity_outline(solution, 0, count, corners, 8, &used, &factor), TRP_ERROR_ARGUMENT));
    EXPECT_TRUE(fails(trp_radiosity_outline(solution, 0, 1, nullptr, 8, &used, &factor), TRP_ERROR_ARGUMENT));
    EXPECT_TRUE(fails(trp_radiosity_outline(solution, 0, 1, corners, 8, nullptr, &factor), TRP_ERROR_ARGUMENT));
    EXPECT_TRUE(fails(trp_radiosity_outline(solution, 0, 1, corners, 8, &used, nullptr), TRP_ERROR_ARGUMENT));
}

TEST(RadiosityLinks, RefuseMisuse) {
    TwoSquares scene;
    scene.camera(look_at({0, 0, 0.5f}, {0.1f, 0, 0}));
    Solution solution(scene, {{"radiosity.solver", "hierarchical"}});
    Render render(scene, 40, 30, {}, {}, "radiosity");
    std::vector<uint64_t> links(1000);
    size_t count = 0;
    uint32_t element = 0;
    EXPECT_TRUE(fails(trp_radiosity_element_links(solution, 0, links.data(), 1, &count), TRP_ERROR_STATE));
    EXPECT_TRUE(fails(trp_radiosity_pick(solution, render, 1, 1, &element), TRP_ERROR_STATE));
    const uint32_t elements = solution.solve().info().element_count;

    ASSERT_EQ(trp_radiosity_element_links(solution, 0, nullptr, 0, &count), TRP_OK);
    ASSERT_GT(count, 0u);
    const size_t all = count;
    links[1] = 12345;
    EXPECT_EQ(trp_radiosity_element_links(solution, 0, links.data(), 1, &count), TRP_OK);
    EXPECT_EQ(count, all);
    EXPECT_EQ(links[1], 12345u) << "beyond the capacity";
    EXPECT_TRUE(fails(trp_radiosity_element_links(solution, 0, nullptr, 1, &count), TRP_ERROR_ARGUMENT, {"links"}));
    EXPECT_TRUE(fails(trp_radiosity_element_links(solution, 0, nullptr, 0, nullptr), TRP_ERROR_ARGUMENT, {"count"}));
    EXPECT_TRUE(fails(trp_radiosity_element_links(solution, elements, nullptr, 0, &count), TRP_ERROR_ARGUMENT,
                      {"element " + std::to_string(elements)}));

    EXPECT_EQ(trp_radiosity_pick(solution, render, 39, 29, &element), TRP_OK);
    EXPECT_TRUE(fails(trp_radiosity_pick(solution, render, 40, 29, &element), TRP_ERROR_ARGUMENT, {"40", "29"}));
    EXPECT_TRUE(fails(trp_radiosity_pick(solution, nullptr, 1, 1, &element), TRP_ERROR_ARGUMENT, {"render"}));
    EXPECT_TRUE(fails(trp_radiosity_pick(solution, render, 1, 1, nullptr), TRP_ERROR_ARGUMENT, {"element"}));
    float sum = 0;
    EXPECT_TRUE(fails(trp_radiosity_read(solution, "row_sum", &sum, elements + 1), TRP_ERROR_ARGUMENT));
}

TEST(RenderProject, RefusesMisuse) {
    TwoSquares scene;
    scene.commit();
    const float point[3] = {0, 0, 0};
    float film[3];
    {
        Render blind(scene, 40, 30, {}, {}, "radiosity");
        EXPECT_TRUE(fails(trp_render_project(blind, point, 1, film), TRP_ERROR_STATE, {"camera"}));
    }
    scene.camera_above(4);
    scene.commit();
    Render render(scene, 40, 40, {}, {}, "radiosity");
    EXPECT_TRUE(fails(trp_render_project(nullptr, point, 1, film), TRP_ERROR_ARGUMENT, {"render"}));
    EXPECT_TRUE(fails(trp_render_project(render, nullptr, 1, film), TRP_ERROR_ARGUMENT, {"positions"}));
    EXPECT_TRUE(fails(trp_render_project(render, point, 1, nullptr), TRP_ERROR_ARGUMENT, {"film"}));
    ASSERT_EQ(trp_render_project(render, point, 1, film), TRP_OK);
    EXPECT_NEAR(film[0], 20, 1e-4);
    EXPECT_NEAR(film[1], 20, 1e-4);
    EXPECT_NEAR(film[2], 10, 1e-5);
}

}  // namespace
