// Well-distributed random numbers, keyed by sequence, index and dimension, over any lane width.
//
// Pairs of dimensions are Owen-scrambled (0,2)-sequences with shuffled indices (Burley, "Practical Hash-based Owen
// Scrambling", 2020), hashed by Laine and Karras's function with Vegdahl's constants. The second Sobol' dimension comes
// from Pascal's triangle modulo 2 in five steps (Ahmed, "An Implementation Algorithm of 2D Sobol Sequence Fast,
// Elegant, and Compact", 2024). Included once for each instruction set.
#if defined(TRIPTYCH_SOBOL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIPTYCH_SOBOL_INL
#undef TRIPTYCH_SOBOL_INL
#else
#define TRIPTYCH_SOBOL_INL
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class DU, class V = hn::Vec<DU>>
V reverse_bits(DU du, V x) {
#if HWY_TARGET == HWY_SCALAR
    auto swap = [&](V v, uint32_t mask, auto shift) {
        constexpr int kShift = decltype(shift)::value;
        const V m = hn::Set(du, mask);
        return hn::Or(hn::And(hn::ShiftRight<kShift>(v), m), hn::ShiftLeft<kShift>(hn::And(v, m)));
    };
    x = swap(x, 0x55555555u, std::integral_constant<int, 1>{});
    x = swap(x, 0x33333333u, std::integral_constant<int, 2>{});
    x = swap(x, 0x0F0F0F0Fu, std::integral_constant<int, 4>{});
    x = swap(x, 0x00FF00FFu, std::integral_constant<int, 8>{});
    return hn::Or(hn::ShiftRight<16>(x), hn::ShiftLeft<16>(x));
#else
    // The bytes of each number from its last, and in them each half by a table.
    const hn::Repartition<uint8_t, DU> d8;
    alignas(16) static constexpr uint8_t kBytes[16] = {3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12};
    alignas(16) static constexpr uint8_t kHalf[16] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
    const auto bytes = hn::TableLookupBytes(hn::BitCast(d8, x), hn::LoadDup128(d8, kBytes));
    const auto low = hn::And(bytes, hn::Set(d8, uint8_t{0x0F}));
    const auto high = hn::BitCast(d8, hn::And(hn::ShiftRight<4>(hn::BitCast(du, bytes)), hn::Set(du, 0x0F0F0F0Fu)));
    const auto table = hn::LoadDup128(d8, kHalf);
    const V new_high = hn::ShiftLeft<4>(hn::BitCast(du, hn::TableLookupBytes(table, low)));
    return hn::Or(new_high, hn::BitCast(du, hn::TableLookupBytes(table, high)));
#endif
}

// Laine-Karras: bits depend only on lower ones, which is Owen scrambling of reversed bits.
template <class DU, class V = hn::Vec<DU>>
V laine_karras(DU du, V x, V seed) {
    x = hn::Xor(x, hn::Mul(x, hn::Set(du, 0x3d20adeau)));
    x = hn::Add(x, seed);
    x = hn::Mul(x, hn::Or(hn::ShiftRight<16>(seed), hn::Set(du, 1u)));
    x = hn::Xor(x, hn::Mul(x, hn::Set(du, 0x05526c56u)));
    return hn::Xor(x, hn::Mul(x, hn::Set(du, 0x53a22864u)));
}

// Pascal's matrix modulo 2 times the bits of x: the second Sobol' dimension, bits reversed.
template <class DU, class V = hn::Vec<DU>>
V pascal(DU du, V x) {
    x = hn::Xor(x, hn::ShiftRight<16>(x));
    x = hn::Xor(x, hn::ShiftRight<8>(hn::And(x, hn::Set(du, 0xFF00FF00u))));
    x = hn::Xor(x, hn::ShiftRight<4>(hn::And(x, hn::Set(du, 0xF0F0F0F0u))));
    x = hn::Xor(x, hn::ShiftRight<2>(hn::And(x, hn::Set(du, 0xCCCCCCCCu))));
    return hn::Xor(x, hn::ShiftRight<1>(hn::And(x, hn::Set(du, 0xAAAAAAAAu))));
}

// A hash of 32 bits (Wellons's lowbias32).
template <class DU, class V = hn::Vec<DU>>
V mix_bits(DU du, V x) {
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<16>(x)), hn::Set(du, 0x7feb352du));
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<15>(x)), hn::Set(du, 0x846ca68bu));
    return hn::Xor(x, hn::ShiftRight<16>(x));
}

// Bits to [0, 1).
template <class D, class VU>
hn::Vec<D> unit_float(D d, VU bits) {
    const hn::RebindToSigned<D> di;
    return hn::Mul(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<8>(bits))), hn::Set(d, 0x1p-24f));
}

// The pair of numbers at an index of a sequence: `key` says which sequence, `reversed` is the index with its bits
// reversed, `pair` counts the pairs of dimensions.
template <class D, class VU>
void sobol_pair(D d, VU key, VU reversed, uint32_t pair, hn::Vec<D>& u, hn::Vec<D>& v) {
    const hn::RebindToUnsigned<D> du;
    const VU seed = mix_bits(du, hn::Xor(key, hn::Set(du, pair * 0x9E3779B9u + 0x7F4A7C15u)));
    const VU seed_u = hn::Xor(hn::Mul(seed, hn::Set(du, 0x2C1B3C6Du)), hn::Set(du, 0x297A2D39u));
    const VU seed_v = hn::Xor(hn::Mul(seed, hn::Set(du, 0x9E3779B1u)), hn::Set(du, 0x1B56C4E9u));
    const VU index = reverse_bits(du, laine_karras(du, reversed, seed));
    u = unit_float(d, reverse_bits(du, laine_karras(du, index, seed_u)));
    v = unit_float(d, reverse_bits(du, laine_karras(du, pascal(du, index), seed_v)));
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
