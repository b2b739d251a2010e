// The random sequence of a block's pixels.
#pragma once

#include <cstdint>

namespace trp {

// A pair of well-distributed numbers in [0, 1) for each pixel of the block, as lanes. Pair 0 places the sample in its
// pixel, 1 on the lens; kFirstLightPair and up belong to the lights.
void random_pair(uint32_t block_x, uint32_t block_y, uint32_t seed, uint32_t sample, uint32_t pair, float* u, float* v);

// The same for lanes that each have a key (a hash of pixel, seed and path) and a sample of their own.
void random_pair_of(const uint32_t* keys, const uint32_t* samples, uint32_t pair, float* u, float* v);

}  // namespace trp
