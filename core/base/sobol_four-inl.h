// Four random numbers at once that are well distributed together, over any lane width.
//
// An Owen-scrambled Sobol' sequence, as the pairs of sobol-inl.h are, of which the third and the fourth dimension come
// from direction numbers (Joe and Kuo, "Constructing Sobol Sequences with Better Two-Dimensional Projections", 2008).
// Included once for each instruction set.
#if defined(TRIPTYCH_SOBOL_FOUR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIPTYCH_SOBOL_FOUR_INL
#undef TRIPTYCH_SOBOL_FOUR_INL
#else
#define TRIPTYCH_SOBOL_FOUR_INL
#endif

#include <bit>
#include <cstdint>

#include "base/sobol-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A Sobol' dimension by its direction numbers, which are added without carry where the index has a bit.
struct SobolDimension {
    // Of the polynomial x^Degree + … + 1, whose other coefficients are the bits of `middle`, and its first odd numbers.
    template <int Degree>
    constexpr SobolDimension(uint32_t middle, const uint32_t (&first)[Degree]) : directions{} {
        uint32_t m[32] = {};  // odd; direction i is m[i] / 2^(i + 1)
        for (int i = 0; i < 32; ++i) {
            m[i] = i < Degree ? first[i] : m[i - Degree] ^ m[i - Degree] << Degree;
            for (int k = 1; k < Degree && i >= Degree; ++k)
                if (middle >> (Degree - 1 - k) & 1) m[i] ^= m[i - k] << k;
            // The last of the i + 1 bits behind the point is the first when reversed.
            for (int bit = 0; bit <= i; ++bit) directions[i] |= (m[i] >> (i - bit) & 1) << bit;
        }
        for (uint32_t index = 0; index < kMostLanes; ++index) of_lanes[index] = at(index);
    }
    // Bits reversed.
    constexpr uint32_t at(uint32_t index) const {
        uint32_t sum = 0;
        for (; index; index &= index - 1) sum ^= directions[std::countr_zero(index)];
        return sum;
    }

    static constexpr uint32_t kMostLanes = HWY_MAX_BYTES / sizeof(uint32_t);
    uint32_t directions[32];  // bits reversed
    alignas(HWY_MAX_BYTES) uint32_t of_lanes[kMostLanes];
};

// Four numbers at as many indices of a sequence as there are lanes, the first of them a multiple of that: well
// distributed together, which pairs are not with each other.
template <class D>
void sobol_four(D d, uint32_t key, uint32_t first, hn::Vec<D>& u, hn::Vec<D>& v, hn::Vec<D>& s, hn::Vec<D>& t) {
    static constexpr SobolDimension kThird(1, {1, 3}), kFourth(1, {1, 3, 1});
    const hn::RebindToUnsigned<D> du;
    using VU = hn::Vec<decltype(du)>;
    // Neighbours' keys may differ by what dimensions do.
    const VU index = hn::Iota(du, first), mixed = mix_bits(du, hn::Set(du, key));
    uint32_t number = 0;
    const auto scrambled = [&](VU reversed) {
        const VU seed = mix_bits(du, hn::Add(mixed, hn::Set(du, ++number * 0x9E3779B9u)));
        return unit_float(d, reverse_bits(du, laine_karras(du, reversed, seed)));
    };
    const auto at = [&](const SobolDimension& dimension) {
        return hn::Xor(hn::Set(du, dimension.at(first)), hn::Load(du, dimension.of_lanes));
    };
    u = scrambled(index);
    v = scrambled(pascal(du, index));
    s = scrambled(at(kThird));
    t = scrambled(at(kFourth));
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
