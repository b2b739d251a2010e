// How many samples the pixels of a block get: as many as were asked for, or fewer where the picture is free of noise.
//
// Samples are taken in rounds. The variance between the sums of rounds estimates that of a pixel's mean, whatever way
// samples within a round depend on each other (the method of batch means; Asmussen and Glynn, "Stochastic Simulation",
// 2007, ch. IV.5). Packets of 4 × 4 pixels go on until no pixel of theirs, nor of their neighbours in the block, has a
// standard error above the threshold; packets that see an edge of an object, or a crease, go on four times as long
// before they are trusted (Whitted, "An Improved Illumination Model for Shaded Display", 1980, looks at contrast
// alone). Decisions are the block's own, so that a picture does not depend on tiles and threads.
#pragma once

#include <functional>

#include "film/tiles.h"

namespace trp {

// Calls sample(number) for every sample of the work in the block, with the lanes that are wanted set in `active`, and
// finish() where all sums are to be in the film. sample() returns the packets, a bit to each, that see an edge.
void take_samples(const RenderJob& job, const TileWork& work, uint32_t block_x, uint32_t block_y, uint8_t* active,
                  const std::function<uint32_t(uint32_t)>& sample, const std::function<void()>& finish);

// The packets whose lanes see different surfaces, or normals that differ by more than 25 degrees.
uint32_t packets_at_edges(const Points& points);

}  // namespace trp
