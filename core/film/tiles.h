// Runs a method over a film: tiles on all threads of an arena, callbacks on the caller's thread, cancel within a block.
#pragma once

#include <atomic>
#include <functional>

#include "film/film.h"
#include "film/settings.h"
#include "shading/snapshot.h"

namespace trp {

// Callbacks of a render, on the thread that runs it. Each may be empty; false cancels.
struct RenderEvents {
    std::function<bool(const TrpProgress&)> progress;
    std::function<bool(const TrpTile&)> tile;
    std::function<void(const std::string&)> log;
};

struct ShownSolution;  // radiosity/view.h

// What a method reads, and where it counts. Counts are atomic: methods add once for a tile.
struct RenderJob {
    std::shared_ptr<const Snapshot> snapshot;
    Settings settings;
    Film* film = nullptr;
    std::atomic<bool>* cancelled = nullptr;

    struct Counts {
        std::atomic<uint64_t> primary_rays{0}, shadow_rays{0}, reflection_rays{0}, transmission_rays{0},
            diffuse_rays{0};
        // Thread time in nanoseconds.
        std::atomic<uint64_t> primary_time{0}, shadow_time{0}, shading_time{0};
    };
    Counts* counts = nullptr;
    std::shared_ptr<const ShownSolution> solution;  // of radiosity, for methods that show one
};

// A tile's blocks, in grid units, and the samples of one pass over the film.
struct TileWork {
    uint32_t block_x0, block_y0, block_x1, block_y1;
    uint32_t first_sample, end_sample;
};

// Calls work(tile) for every tile and pass of the job, from the threads of an arena of its own, after `prepare` has run
// in that arena. Both return early when the job is cancelled. Returns false where it was. An exception of theirs stops
// all and is thrown here.
bool run_tiles(RenderJob& job, const RenderEvents& events, const std::function<void(const TileWork&)>& work,
               const std::function<void()>& prepare = {});

}  // namespace trp
