// Renders: films, passes, reading, and calls at the wrong time.
#include "abi/expect.h"

using namespace trp_test;

namespace {

TEST(RenderCalls, NullArgumentsAndNames) {
    SmallScene scene;
    TrpRender* render = nullptr;
    EXPECT_TRUE(fails(trp_render_create(scene, "ray_casting", &render), TRP_ERROR_STATE, {"committed"}));
    EXPECT_EQ(render, nullptr);
    scene.commit();
    EXPECT_TRUE(fails(trp_render_create(nullptr, "ray_casting", &render), TRP_ERROR_ARGUMENT, {"scene"}));
    EXPECT_TRUE(fails(trp_render_create(scene, nullptr, &render), TRP_ERROR_ARGUMENT, {"method"}));
    EXPECT_TRUE(fails(trp_render_create(scene, "ray_casting", nullptr), TRP_ERROR_ARGUMENT, {"render"}));
    EXPECT_TRUE(
        fails(trp_render_create(scene, "ray_castin", &render), TRP_ERROR_ARGUMENT, {"\"ray_castin\"", "ray_casting"}));
    EXPECT_TRUE(fails(trp_render_create(scene, "", &render), TRP_ERROR_ARGUMENT));
    trp_render_destroy(nullptr);
    EXPECT_TRUE(fails(trp_render_set_film(nullptr, 4, 4, 0, 0, 0, 0), TRP_ERROR_ARGUMENT, {"render"}));
    EXPECT_TRUE(fails(trp_render_add_pass(nullptr, "Depth"), TRP_ERROR_ARGUMENT, {"render"}));
    EXPECT_TRUE(fails(trp_render_run(nullptr, nullptr), TRP_ERROR_ARGUMENT, {"render"}));
    EXPECT_TRUE(fails(trp_render_cancel(nullptr), TRP_ERROR_ARGUMENT, {"render"}));
    EXPECT_TRUE(fails(trp_render_write(nullptr, "a.exr"), TRP_ERROR_ARGUMENT, {"render"}));
    float buffer[4];
    EXPECT_TRUE(fails(trp_render_read(nullptr, "Combined", 0, 0, 1, 1, buffer, 4), TRP_ERROR_ARGUMENT, {"render"}));
    TrpStatistics statistics{};
    statistics.struct_size = sizeof statistics;
    EXPECT_TRUE(fails(trp_render_statistics(nullptr, &statistics), TRP_ERROR_ARGUMENT, {"render"}));
    EXPECT_TRUE(fails(trp_callbacks_init(nullptr, sizeof(TrpCallbacks)), TRP_ERROR_ARGUMENT));
    TrpCallbacks callbacks;
    EXPECT_TRUE(fails(trp_callbacks_init(&callbacks, 4), TRP_ERROR_ARGUMENT, {"4"}));

    Render made(scene, 8, 8, kFewSamples);
    EXPECT_TRUE(fails(trp_render_add_pass(made, nullptr), TRP_ERROR_ARGUMENT, {"name"}));
    EXPECT_TRUE(fails(trp_render_add_pass(made, "depth"), TRP_ERROR_ARGUMENT, {"\"depth\"", "Depth"}));
    Render lines(scene, 8, 8, {}, {}, "wireframe");
    EXPECT_TRUE(fails(trp_render_add_pass(lines, "Albedo"), TRP_ERROR_ARGUMENT, {"wireframe", "\"Albedo\"", "Depth"}));
    for (const uint32_t size : {0u, 4u, 12u, 1u << 20}) {
        callbacks = {};
        callbacks.struct_size = size;
        EXPECT_TRUE(fails(trp_render_run(made, &callbacks), TRP_ERROR_ARGUMENT,
                          {"callbacks", "struct_size is " + std::to_string(size)}));
    }
    callbacks.struct_size = 8;  // of a client that knows no callback yet
    EXPECT_EQ(trp_render_run(made, &callbacks), TRP_OK);
}

TEST(RenderCalls, BeforeTheFirstRun) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 8, 8, kFewSamples);
    float buffer[4] = {7, 7, 7, 7};
    EXPECT_TRUE(fails(trp_render_read(render, "Combined", 0, 0, 1, 1, buffer, 4), TRP_ERROR_STATE, {"not run"}));
    EXPECT_EQ(buffer[0], 7);
    EXPECT_TRUE(fails(trp_render_write(render, "never.exr"), TRP_ERROR_STATE, {"not run"}));
    TrpStatistics statistics{};
    statistics.struct_size = sizeof statistics;
    EXPECT_TRUE(fails(trp_render_statistics(render, &statistics), TRP_ERROR_STATE, {"not run"}));
    // A cancel that nothing hears.
    EXPECT_EQ(trp_render_cancel(render), TRP_OK);
    EXPECT_EQ(trp_render_run(render, nullptr), TRP_OK);
    EXPECT_EQ(trp_render_cancel(render), TRP_OK);
    EXPECT_EQ(trp_render_run(render, nullptr), TRP_OK);
}

TEST(RenderCalls, Film) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 20, 10, kFewSamples);
    const Image before = render.run().read();
    const auto refused = [&](uint32_t w, uint32_t h, uint32_t x, uint32_t y, uint32_t ww, uint32_t wh,
                             const std::vector<std::string>& words) {
        return fails(trp_render_set_film(render, w, h, x, y, ww, wh), TRP_ERROR_ARGUMENT, words);
    };
    EXPECT_TRUE(refused(0, 0, 0, 0, 0, 0, {"0 x 0"}));
    EXPECT_TRUE(refused(0, 8, 0, 0, 0, 0, {"0 x 8"}));
    EXPECT_TRUE(refused(8, 0, 0, 0, 4, 4, {"8 x 0"}));
    EXPECT_TRUE(refused(1000000, 1000000, 0, 0, 0, 0, {"1000000 x 1000000"}));
    EXPECT_TRUE(refused(~0u, ~0u, 0, 0, 16, 16, {"4294967295"}));
    EXPECT_TRUE(refused(20, 10, 15, 0, 6, 10, {"6 x 10", "(15, 0)", "20 x 10"}));
    EXPECT_TRUE(refused(20, 10, 0, 9, 20, 2, {"20 x 2", "(0, 9)"}));
    EXPECT_TRUE(refused(20, 10, 20, 10, 1, 1, {"(20, 10)"}));
    EXPECT_TRUE(refused(20, 10, ~0u, 0, 2, 2, {"4294967295"}));
    EXPECT_TRUE(refused(20, 10, 0, 0, ~0u, ~0u, {"4294967295"}));
    EXPECT_TRUE(refused(20, 10, 0, 0, 0, 4, {"0 x 4"}));
    EXPECT_TRUE(fails(trp_render_set_film(render, 65536, 65536, 0, 0, 0, 0), TRP_ERROR_MEMORY, {"65536 x 65536"}));
    // None of them changed the film.
    EXPECT_TRUE(same(render.run().read(), before));

    // A window is the same pixels of the same picture.
    ASSERT_EQ(trp_render_set_film(render, 20, 10, 3, 2, 9, 7), TRP_OK);
    render.run();
    std::vector<float> part(9 * 7 * 4);
    ASSERT_EQ(trp_render_read(render, "Combined", 3, 2, 9, 7, part.data(), part.size()), TRP_OK);
    for (uint32_t y = 0; y < 7; ++y)
        for (uint32_t x = 0; x < 9 * 4; ++x) ASSERT_EQ(part[y * 36 + x], before.at(3, y + 2)[x]);
    EXPECT_TRUE(fails(trp_render_read(render, "Combined", 0, 0, 20, 10, part.data(), 800), TRP_ERROR_ARGUMENT,
                      {"20 x 10", "9 x 7", "(3, 2)"}));
}

TEST(RenderCalls, Read) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 20, 10, kFewSamples, {"Depth"});
    render.run();
    std::vector<float> buffer(20 * 10 * 4, 7.0f);
    const auto read = [&](const char* pass, uint32_t x, uint32_t y, uint32_t w, uint32_t h, size_t count) {
        return trp_render_read(render, pass, x, y, w, h, buffer.data(), count);
    };
    EXPECT_TRUE(fails(read("Normal", 0, 0, 20, 10, 600), TRP_ERROR_STATE, {"Normal", "asked"}));
    EXPECT_TRUE(fails(read("Nonsense", 0, 0, 20, 10, 600), TRP_ERROR_ARGUMENT, {"\"Nonsense\"", "Combined"}));
    EXPECT_TRUE(fails(read(nullptr, 0, 0, 20, 10, 600), TRP_ERROR_ARGUMENT, {"pass"}));
    EXPECT_TRUE(fails(trp_render_read(render, "Depth", 0, 0, 20, 10, nullptr, 200), TRP_ERROR_ARGUMENT, {"buffer"}));
    for (const size_t count : {size_t{0}, size_t{799}, size_t{801}, size_t{200}, ~size_t{0}})
        EXPECT_TRUE(fails(read("Combined", 0, 0, 20, 10, count), TRP_ERROR_ARGUMENT, {std::to_string(count), "800"}));
    EXPECT_TRUE(fails(read("Depth", 0, 0, 20, 10, 800), TRP_ERROR_ARGUMENT, {"800", "200"}));
    EXPECT_TRUE(fails(read("Depth", 20, 0, 1, 1, 1), TRP_ERROR_ARGUMENT, {"(20, 0)"}));
    EXPECT_TRUE(fails(read("Depth", ~0u, 0, 2, 1, 2), TRP_ERROR_ARGUMENT, {"4294967295"}));
    EXPECT_TRUE(fails(read("Depth", 0, 0, ~0u, ~0u, 1), TRP_ERROR_ARGUMENT, {"4294967295"}));
    for (const float value : buffer) ASSERT_EQ(value, 7.0f) << "a call that fails writes nothing";
    EXPECT_EQ(read("Depth", 0, 0, 20, 10, 200), TRP_OK);
    EXPECT_EQ(buffer[200], 7.0f);
    EXPECT_EQ(read("Depth", 5, 5, 0, 0, 0), TRP_OK) << "nothing is also a rectangle";

    // A pass asked for after the run is there after the next.
    ASSERT_EQ(trp_render_add_pass(render, "Normal"), TRP_OK);
    EXPECT_TRUE(fails(read("Normal", 0, 0, 20, 10, 600), TRP_ERROR_STATE, {"Normal"}));
    render.run();
    EXPECT_EQ(read("Normal", 0, 0, 20, 10, 600), TRP_OK);
}

// Films are used again: nothing of an earlier picture is seen in a later one, nor where a cancelled one has not drawn.
TEST(RenderCalls, RunsDoNotShowEachOther) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 70, 40, kFewSamples, {"Depth"}, "phong");
    const std::vector<float> first = render.run().read().values, depth = render.read("Depth").values;
    ASSERT_EQ(trp_render_set(render, "shading.ambient", "3,2,1"), TRP_OK);
    for (int run = 0; run < 3; ++run) EXPECT_NE(render.run().read().values, first);
    ASSERT_EQ(trp_render_set(render, "shading.ambient", "0,0,0"), TRP_OK);
    for (int run = 0; run < 3; ++run) {
        EXPECT_EQ(render.run().read().values, first);
        EXPECT_EQ(render.read("Depth").values, depth);
    }
    TrpCallbacks callbacks;
    ASSERT_EQ(trp_callbacks_init(&callbacks, sizeof callbacks), TRP_OK);
    callbacks.progress = [](void*, const TrpProgress*) { return 0; };
    ASSERT_EQ(trp_render_set(render, "threads", "1"), TRP_OK);
    while (trp_render_run(render, &callbacks) != TRP_CANCELLED) continue;
    const std::vector<float> cut = render.read().values;
    for (size_t i = 0; i < cut.size(); ++i) ASSERT_TRUE(cut[i] == 0 || cut[i] == first[i]) << i;
    EXPECT_EQ(render.run().read().values, first);
}

TEST(RenderCalls, Statistics) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 20, 10, {{"samples", "4"}, {"threads", "2"}});
    render.run();
    TrpStatistics s{};
    EXPECT_TRUE(fails(trp_render_statistics(render, nullptr), TRP_ERROR_ARGUMENT, {"statistics"}));
    EXPECT_TRUE(fails(trp_render_statistics(render, &s), TRP_ERROR_ARGUMENT, {"struct_size is 0"}));
    s.struct_size = sizeof s;
    ASSERT_EQ(trp_render_statistics(render, &s), TRP_OK);
    EXPECT_EQ(s.threads, 2u);
    EXPECT_EQ(s.triangles, 14u);
    EXPECT_GE(s.primary_rays, 800u);
    EXPECT_GT(s.shadow_rays, 0u);
    EXPECT_GT(s.render_seconds, 0);
    EXPECT_GT(s.peak_memory_bytes, 1u << 20);
}

TEST(RenderCalls, SceneMayGoFirst) {
    TrpRender* render = nullptr;
    std::vector<float> expected;
    std::vector<float> pixels(20 * 10 * 4);
    {
        SmallScene scene;
        scene.commit();
        expected = Render(scene, 20, 10, kFewSamples).run().read().values;
        check(trp_render_create(scene, "ray_casting", &render));
    }
    check(trp_render_set_film(render, 20, 10, 0, 0, 0, 0));
    check(trp_render_set(render, "samples", "4"));
    EXPECT_EQ(trp_render_run(render, nullptr), TRP_OK);
    EXPECT_EQ(trp_render_read(render, "Combined", 0, 0, 20, 10, pixels.data(), pixels.size()), TRP_OK);
    EXPECT_EQ(pixels, expected);
    trp_render_destroy(render);
}

TEST(RenderCalls, NoCamera) {
    Scene scene;
    scene.object(floor_square(1));
    scene.commit();
    Render render(scene, 8, 8, kFewSamples);
    EXPECT_TRUE(fails(trp_render_run(render, nullptr), TRP_ERROR_STATE, {"camera"}));
    float pixel[4];
    EXPECT_TRUE(fails(trp_render_read(render, "Combined", 0, 0, 1, 1, pixel, 4), TRP_ERROR_STATE, {"not run"}))
        << "a run that failed leaves the render as it was";
}

}  // namespace
