// Reading placed surfaces for lanes that may each see another one: surface by surface, which is mostly one, and
// triangle by triangle. Included once for each instruction set.
#if defined(TRIPTYCH_SURFACE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIPTYCH_SURFACE_LANES_INL
#undef TRIPTYCH_SURFACE_LANES_INL
#else
#define TRIPTYCH_SURFACE_LANES_INL
#endif

#include "hwy/highway.h"
#include "shading/equation-inl.h"
#include "shading/snapshot.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls visit(number, those of the lanes in `left` that have it) for every number among `numbers`, of triangles or the
// like. Neighbours mostly see few, of which what is needed is read once and not gathered lane by lane.
template <class DI, class VI, class M, class Visit>
void for_each_number(DI di, VI numbers, M left, Visit&& visit) {
    alignas(64) int32_t all[HWY_MAX_BYTES / sizeof(int32_t)];
    hn::Store(numbers, di, all);
    while (!hn::AllFalse(di, left)) {
        const int32_t number = all[hn::FindFirstTrue(di, left)];
        const M here = hn::And(left, hn::Eq(numbers, hn::Set(di, number)));
        visit(static_cast<uint32_t>(number), here);
        left = hn::AndNot(here, left);
    }
}

// Calls visit(surface, those of the lanes in `left` that see it) for every surface among `slots`.
template <class DI, class VI, class M, class Visit>
void for_each_surface(DI di, const Snapshot& snapshot, VI slots, M left, Visit&& visit) {
    for_each_number(di, slots, left, [&](uint32_t slot, M here) { visit(snapshot.surfaces[slot], here); });
}

// What each of `steps`, evenly spaced over the times 0 to 1, counts for at the lanes' times: linear between two.
template <class D, class V>
V step_weight(D d, V time, size_t step, size_t steps) {
    const V at = hn::Mul(time, hn::Set(d, static_cast<float>(steps - 1)));
    const V away = hn::Abs(hn::Sub(at, hn::Set(d, static_cast<float>(step))));
    return hn::Max(hn::Sub(hn::Set(d, 1.0f), away), hn::Zero(d));
}

// Unit length; where there is next to none left, what it was `before` it moved.
template <class D, class V>
Vector3<V> unit_or(D d, const Vector3<V>& v, const Vec3& before) {
    const V squared = dot3(v, v);
    const auto lost = hn::Lt(squared, hn::Set(d, 1e-6f));
    const V inverse = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(hn::Max(squared, hn::Set(d, 1e-6f))));
    return select3(lost, broadcast(d, before), v * inverse);
}

// A vector of a frame that moves, at the lanes' times; `motion`: the frame at each time sample, or empty where it
// stands still as `first` has it.
template <class D, class V, class Frame>
Vector3<V> vector_at(D d, const Frame& first, const std::vector<Frame>& motion, Vec3 Frame::*vector, V time) {
    if (motion.empty()) return broadcast(d, first.*vector);
    Vector3<V> out = broadcast(d, Vec3(0, 0, 0));
    for (size_t step = 0; step < motion.size(); ++step)
        out = add_scaled(out, broadcast(d, motion[step].*vector), step_weight(d, time, step, motion.size()));
    return out;
}

// An axis of a frame that moves, as vector_at().
template <class D, class V, class Frame>
Vector3<V> axis_at(D d, const Frame& first, const std::vector<Frame>& motion, Vec3 Frame::*axis, V time) {
    const Vector3<V> v = vector_at(d, first, motion, axis, time);
    return motion.empty() ? v : unit_or(d, v, first.*axis);
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
