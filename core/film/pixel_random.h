// The random sequence of a block's pixels.
//
// Squares of 128 × 128 pixels share one sequence, through which they go in Z-order: each pixel takes as many numbers in
// a row as a power of two that its samples need. So what four neighbours take together is well distributed too, and
// what sixteen do: errors of neighbours make up for each other, and the noise is fine ("blue"; Ahmed and Wonka,
// "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", 2020, whose
// random order of quadrants is that of the sequence's shuffled indices).
#pragma once

#include <bit>
#include <cstdint>

namespace trp {

struct SampleSequence {
    SampleSequence(uint32_t seed, uint32_t samples)
        : seed(seed), bits(static_cast<uint32_t>(std::bit_width(samples - 1))) {}
    uint32_t seed;
    uint32_t bits;  // of a sample's number; at most 17
};

// A pair of well-distributed numbers in [0, 1) for each pixel of the block, as lanes. Pair 0 places the sample in its
// pixel, 1 on the lens; kFirstLightPair and up belong to the lights.
void random_pair(uint32_t block_x, uint32_t block_y, const SampleSequence& sequence, uint32_t sample, uint32_t pair,
                 float* u, float* v);

// The same for lanes that each have a key (a hash of square, seed and path) and an index in its sequence of their own.
void random_pair_of(const uint32_t* keys, const uint32_t* indices, uint32_t pair, float* u, float* v);

}  // namespace trp
