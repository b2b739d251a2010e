// What `triptych render` is asked to do, checked as far as the scene's file is not needed for it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "picture_job.h"

namespace triptych::cli {

// A rectangle of the picture, from the top left.
struct Tile {
    uint32_t x = 0, y = 0, width = 0, height = 0;
    bool given() const { return width > 0; }
};

struct RenderJob : PictureJob {
    std::string output, stats;
    std::string tile_text;
    Tile tile;
    std::vector<std::string> passes;
    std::string samples, seed;
};

// Splits the texts, and checks names, values and the output. Throws a UsageError for what is wrong in the call, and an
// Error where the output cannot be written.
void check_job(RenderJob& job);

// Throws a UsageError for a tile outside a picture of that size.
void check_tile(const RenderJob& job, uint32_t width, uint32_t height);

// Gives `render` the job's tile of a picture of that size.
void set_tile(TrpRender* render, const RenderJob& job, uint32_t width, uint32_t height);

}  // namespace triptych::cli
