// Callbacks, cancelling, and what may be called from where.
#include <atomic>
#include <chrono>
#include <thread>

#include "abi/expect.h"

using namespace trp_test;

namespace {

using Clock = std::chrono::steady_clock;

// The calls of one run, and what they answer.
struct Recorder {
    TrpRender* render = nullptr;
    std::thread::id thread = std::this_thread::get_id();
    int progress_calls = 0, tile_calls = 0, cancel_at_progress = -1, cancel_at_tile = -1;
    bool other_thread = false, bad_values = false;
    double last_fraction = 0;
    uint64_t pixels = 0;
    std::function<void()> in_tile;

    TrpCallbacks callbacks() {
        TrpCallbacks c;
        check(trp_callbacks_init(&c, sizeof c));
        c.user = this;
        c.progress = [](void* user, const TrpProgress* p) -> int32_t {
            auto& self = *static_cast<Recorder*>(user);
            self.other_thread |= std::this_thread::get_id() != self.thread;
            self.bad_values |= p->struct_size != sizeof *p || !(p->fraction >= self.last_fraction) ||
                               !(p->fraction <= 1) || !(p->seconds >= 0) || p->pass >= p->pass_count || !p->stage;
            self.last_fraction = p->fraction;
            return self.progress_calls++ != self.cancel_at_progress;
        };
        c.tile = [](void* user, const TrpTile* tile) -> int32_t {
            auto& self = *static_cast<Recorder*>(user);
            self.other_thread |= std::this_thread::get_id() != self.thread;
            self.bad_values |= tile->struct_size != sizeof *tile || !tile->width || !tile->height;
            self.pixels += uint64_t{tile->width} * tile->height;
            std::vector<float> values(size_t{4} * tile->width * tile->height);
            self.bad_values |= self.render && trp_render_read(self.render, "Combined", tile->x, tile->y, tile->width,
                                                              tile->height, values.data(), values.size()) != TRP_OK;
            if (self.in_tile) self.in_tile();
            return self.tile_calls++ != self.cancel_at_tile;
        };
        return c;
    }
};

TEST(Callbacks, ComeOnTheCallersThread) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 100, 60, {{"samples", "130"}, {"film.tile_size", "32"}});
    Recorder recorder;
    recorder.render = render;
    const TrpCallbacks callbacks = recorder.callbacks();
    ASSERT_EQ(trp_render_run(render, &callbacks), TRP_OK) << trp_error_message();
    EXPECT_FALSE(recorder.other_thread);
    EXPECT_FALSE(recorder.bad_values);
    EXPECT_GT(recorder.progress_calls, 0);
    EXPECT_EQ(recorder.last_fraction, 1);
    EXPECT_EQ(recorder.pixels, 3u * 100 * 60) << "every pass over the film tells of every pixel once";
    const Image with = render.read();
    EXPECT_TRUE(same(render.run().read(), with)) << "callbacks change nothing";
}

TEST(Callbacks, ZeroCancels) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 200, 200, {{"samples", "4096"}}, {"SampleCount"});
    for (const bool by_tile : {false, true}) {
        Recorder recorder;
        (by_tile ? recorder.cancel_at_tile : recorder.cancel_at_progress) = 0;
        const TrpCallbacks callbacks = recorder.callbacks();
        EXPECT_EQ(trp_render_run(render, &callbacks), TRP_CANCELLED);
        EXPECT_EQ(by_tile ? recorder.tile_calls : recorder.progress_calls, 1) << "none after the refusal";
        for (const float value : render.read().values) ASSERT_TRUE(std::isfinite(value));
    }
    // What was cancelled runs anew, from nothing.
    check(trp_render_set(render, "samples", "1"));
    EXPECT_EQ(trp_render_run(render, nullptr), TRP_OK);
    for (const float count : render.read("SampleCount").values) ASSERT_EQ(count, 1);
}

// Another thread cancels a render that would take hours; the best of a few tries, as the machine may be busy.
TEST(Callbacks, CancelFromAnotherThread) {
    SmallScene scene;
    scene.light(TRP_LIGHT_AREA, {1, 1, 1}, translation({0, 0, 4}));
    scene.world({0.5f, 0.5f, 0.5f});
    scene.commit();
    Render render(scene, 4096, 4096, {{"samples", "65536"}}, {"SampleCount"});
    double least = 1e9;
    for (int attempt = 0; attempt < 4 && least > 0.1; ++attempt) {
        std::atomic<bool> begun{false};
        Recorder recorder;
        recorder.in_tile = [&] { begun = true; };
        const TrpCallbacks callbacks = recorder.callbacks();
        Clock::time_point asked;
        std::thread other([&] {
            while (!begun) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            asked = Clock::now();
            trp_render_cancel(render);
        });
        const TrpStatus status = trp_render_run(render, &callbacks);
        const Clock::time_point returned = Clock::now();
        other.join();
        ASSERT_EQ(status, TRP_CANCELLED);
        least = std::min(least, std::chrono::duration<double>(returned - asked).count());
    }
    RecordProperty("milliseconds", std::to_string(1000 * least));
    std::printf("cancelled within %.1f ms\n", 1000 * least);
    EXPECT_LT(least, 0.1 * TRIPTYCH_TEST_SLOWNESS);
    // What was finished can be read; the rest is 0.
    double sampled = 0;
    for (uint32_t y = 0; y < 4096; y += 64) {
        std::vector<float> counts(4096), colors(4 * 4096);
        ASSERT_EQ(trp_render_read(render, "SampleCount", 0, y, 4096, 1, counts.data(), counts.size()), TRP_OK);
        ASSERT_EQ(trp_render_read(render, "Combined", 0, y, 4096, 1, colors.data(), colors.size()), TRP_OK);
        for (size_t x = 0; x < 4096; ++x) {
            sampled += counts[x] > 0;
            ASSERT_TRUE(counts[x] > 0 || colors[4 * x] == 0);
        }
    }
    EXPECT_GT(sampled, 0);
    TrpStatistics statistics{};
    statistics.struct_size = sizeof statistics;
    EXPECT_EQ(trp_render_statistics(render, &statistics), TRP_OK);
}

TEST(Callbacks, ARunningRenderCannotBeChanged) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 40, 24, kFewSamples);
    const Image expected = render.run().read();
    Recorder recorder;
    int tried = 0;
    recorder.in_tile = [&] {
        if (tried++) return;
        EXPECT_TRUE(fails(trp_render_run(render, nullptr), TRP_ERROR_STATE, {"running"}));
        EXPECT_TRUE(fails(trp_render_set_film(render, 8, 8, 0, 0, 0, 0), TRP_ERROR_STATE, {"running"}));
        EXPECT_TRUE(fails(trp_render_set(render, "samples", "1"), TRP_ERROR_STATE, {"running"}));
        EXPECT_TRUE(fails(trp_render_add_pass(render, "Depth"), TRP_ERROR_STATE, {"running"}));
        EXPECT_TRUE(fails(trp_render_write(render, "never.exr"), TRP_ERROR_STATE, {"running"}));
        // Another render, of the same scene, may run meanwhile; and the scene may be edited.
        EXPECT_TRUE(same(Render(scene, 40, 24, kFewSamples).run().read(), expected));
        EXPECT_EQ(trp_instance_remove(scene, scene.box_instance), TRP_OK);
        EXPECT_EQ(trp_scene_commit(scene, 0), TRP_OK);
    };
    const TrpCallbacks callbacks = recorder.callbacks();
    EXPECT_EQ(trp_render_run(render, &callbacks), TRP_OK);
    EXPECT_GT(tried, 0);
    EXPECT_TRUE(same(render.read(), expected));
}

TEST(Callbacks, RunFromTwoThreads) {
    SmallScene scene;
    scene.commit();
    Render render(scene, 40, 24, {{"samples", "4096"}});
    Recorder recorder;
    TrpStatus second = TRP_OK;
    std::string message;
    recorder.in_tile = [&] {
        std::thread([&] {
            second = trp_render_run(render, nullptr);
            message = trp_error_message();
        }).join();
    };
    recorder.cancel_at_tile = 0;
    const TrpCallbacks callbacks = recorder.callbacks();
    EXPECT_EQ(trp_render_run(render, &callbacks), TRP_CANCELLED);
    EXPECT_EQ(second, TRP_ERROR_STATE);
    EXPECT_NE(message.find("running"), std::string::npos);
}

}  // namespace
