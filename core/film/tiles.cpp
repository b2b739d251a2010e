#include "film/tiles.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "base/clock.h"
#include "base/parallel.h"

namespace trp {
namespace {

// Passes over the film of so many samples: a long render is seen whole early, a short one is a single pass.
constexpr uint32_t kPassSamples = 64;

struct Tile {
    TileWork work;
    TrpTile window;
};

// Tiles from the middle outwards, where the picture's subject mostly is.
std::vector<Tile> make_tiles(const Window& window, uint32_t tile_size) {
    const uint32_t side = std::max(1u, tile_size / kBlockSide);  // in blocks
    const uint32_t x1 = (window.x + window.w + kBlockSide - 1) / kBlockSide,
                   y1 = (window.y + window.h + kBlockSide - 1) / kBlockSide;
    std::vector<Tile> tiles;
    for (uint32_t ty = window.y / kBlockSide / side * side; ty < y1; ty += side)
        for (uint32_t tx = window.x / kBlockSide / side * side; tx < x1; tx += side) {
            Tile tile{};
            tile.work.block_x0 = std::max(tx, window.x / kBlockSide);
            tile.work.block_y0 = std::max(ty, window.y / kBlockSide);
            tile.work.block_x1 = std::min(tx + side, x1);
            tile.work.block_y1 = std::min(ty + side, y1);
            tile.window.struct_size = sizeof(TrpTile);
            tile.window.x = std::max(tile.work.block_x0 * kBlockSide, window.x);
            tile.window.y = std::max(tile.work.block_y0 * kBlockSide, window.y);
            tile.window.width = std::min(tile.work.block_x1 * kBlockSide, window.x + window.w) - tile.window.x;
            tile.window.height = std::min(tile.work.block_y1 * kBlockSide, window.y + window.h) - tile.window.y;
            tiles.push_back(tile);
        }
    auto distance2 = [&](const Tile& t) {
        const double dx = t.window.x + t.window.width / 2.0 - window.x - window.w / 2.0;
        const double dy = t.window.y + t.window.height / 2.0 - window.y - window.h / 2.0;
        return dx * dx + dy * dy;
    };
    std::stable_sort(tiles.begin(), tiles.end(),
                     [&](const Tile& a, const Tile& b) { return distance2(a) < distance2(b); });
    return tiles;
}

// What workers tell the caller's thread.
struct Mailbox {
    std::mutex mutex;
    std::condition_variable news;
    std::deque<TrpTile> finished;
    bool all_done = false;
    std::exception_ptr error;
};

}  // namespace

bool run_tiles(RenderJob& job, const RenderEvents& events, const std::function<void(const TileWork&)>& work,
               const std::function<void()>& prepare) {
    const std::vector<Tile> tiles = make_tiles(job.film->window(), job.settings.tile_size);
    const uint32_t samples = job.settings.samples, passes = (samples + kPassSamples - 1) / kPassSamples;
    std::atomic<bool>& cancelled = *job.cancelled;
    Mailbox mailbox;
    std::atomic<bool> prepared{false};

    // The driver takes a thread's place in the arena; the caller waits for the mail. A pass begins when the caller has
    // read all tiles of the one before, as the tiles are written again.
    std::thread driver([&] {
        try {
            Arena arena(job.settings.threads);
            arena.run([&] {
                if (prepare) prepare();
                prepared = true;
                for (uint32_t pass = 0; pass < passes && !cancelled; ++pass) {
                    std::atomic<size_t> next{0};
                    const unsigned workers = thread_count(job.settings.threads);
                    parallel_workers(workers, [&] {
                        const FlushDenormals flush;
                        for (size_t t; !cancelled && (t = next++) < tiles.size();) {
                            Tile tile = tiles[t];
                            tile.work.first_sample = pass * kPassSamples;
                            tile.work.end_sample = std::min(samples, (pass + 1) * kPassSamples);
                            tile.window.pass = pass;
                            work(tile.work);
                            if (cancelled) break;
                            const std::lock_guard lock(mailbox.mutex);
                            mailbox.finished.push_back(tile.window);
                            mailbox.news.notify_one();
                        }
                    });
                    std::unique_lock lock(mailbox.mutex);
                    mailbox.news.wait(lock, [&] { return mailbox.finished.empty() || cancelled; });
                }
            });
        } catch (...) {
            const std::lock_guard lock(mailbox.mutex);
            mailbox.error = std::current_exception();
            cancelled = true;
        }
        const std::lock_guard lock(mailbox.mutex);
        mailbox.all_done = true;
        mailbox.news.notify_all();
    });

    const auto start = Clock::now();
    const double total = static_cast<double>(tiles.size()) * passes;
    uint64_t finished = 0;
    try {
        std::unique_lock lock(mailbox.mutex);
        while (!mailbox.all_done || (!mailbox.finished.empty() && !cancelled)) {
            // The wake-up every 50 ms is for a progress callback that wants to cancel while tiles take long.
            mailbox.news.wait_for(lock, std::chrono::milliseconds(50),
                                  [&] { return mailbox.all_done || !mailbox.finished.empty(); });
            std::deque<TrpTile> batch = mailbox.finished;
            lock.unlock();
            for (const TrpTile& tile : batch) {
                ++finished;
                if (events.tile && !cancelled && !events.tile(tile)) cancelled = true;
            }
            if (events.progress && !cancelled) {
                TrpProgress progress{};
                progress.struct_size = sizeof progress;
                progress.fraction = static_cast<double>(finished) / total;
                progress.seconds = seconds_since(start);
                progress.seconds_left = finished ? progress.seconds * (total / static_cast<double>(finished) - 1) : -1;
                progress.pass = static_cast<uint32_t>(std::min<uint64_t>(finished / tiles.size(), passes - 1));
                progress.pass_count = passes;
                progress.stage = prepared ? "Rendering" : "Preparing";
                if (!events.progress(progress)) cancelled = true;
            }
            lock.lock();
            mailbox.finished.erase(mailbox.finished.begin(),
                                   mailbox.finished.begin() + static_cast<ptrdiff_t>(batch.size()));
            mailbox.news.notify_all();
        }
    } catch (...) {
        {
            const std::lock_guard lock(mailbox.mutex);  // so that the driver cannot miss it
            cancelled = true;
            mailbox.news.notify_all();
        }
        driver.join();
        throw;
    }
    driver.join();
    if (mailbox.error) std::rethrow_exception(mailbox.error);
    return !cancelled;
}

}  // namespace trp
