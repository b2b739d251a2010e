// Reading placed surfaces for lanes that may each see another one: surface by surface, which is mostly one.
// Included once for each instruction set.
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

// Calls visit(surface, those of the lanes in `left` that see it) for every surface among `slots`.
template <class DI, class VI, class M, class Visit>
void for_each_surface(DI di, const Snapshot& snapshot, VI slots, M left, Visit&& visit) {
    alignas(64) int32_t all[HWY_MAX_BYTES / sizeof(int32_t)];
    hn::Store(slots, di, all);
    while (!hn::AllFalse(di, left)) {
        const int32_t slot = all[hn::FindFirstTrue(di, left)];
        const M here = hn::And(left, hn::Eq(slots, hn::Set(di, slot)));
        visit(snapshot.surfaces[slot], here);
        left = hn::AndNot(here, left);
    }
}

template <class D, class VI, class V = hn::Vec<D>>
Vector3<V> gather3(D d, const Vec3* values, VI index) {
    const hn::RebindToSigned<D> di;
    const VI at = hn::Mul(index, hn::Set(di, 3));
    const float* first = &values[0].x;
    return {hn::GatherIndex(d, first, at), hn::GatherIndex(d, first + 1, at), hn::GatherIndex(d, first + 2, at)};
}

// The k-th vertex, and the k-th corner, of triangles; `first` is three times the triangle.
template <class DI, class VI>
VI triangle_vertex(DI di, const PlacedSurface& surface, VI first, int k) {
    return hn::GatherIndex(di, reinterpret_cast<const int32_t*>(surface.vertices) + k, first);
}
template <class DI, class VI>
VI triangle_corner(DI di, const PlacedSurface& surface, VI first, int k) {
    if (!surface.corners) return hn::Add(first, hn::Set(di, k));
    return hn::GatherIndex(di, reinterpret_cast<const int32_t*>(surface.corners) + k, first);
}

// Vertices of triangles in world space.
template <class V>
struct Corners {
    Vector3<V> p0, p1, p2;
    V greatest;  // a bound of all numbers that were added up for a coordinate
};

template <class D, class VI, class V = hn::Vec<D>>
Corners<V> load_corners(D d, const PlacedSurface& surface, VI v0, VI v1, VI v2) {
    Corners<V> c{gather3(d, surface.positions, v0), gather3(d, surface.positions, v1),
                 gather3(d, surface.positions, v2), hn::Zero(d)};
    Vector3<V>* const points[3] = {&c.p0, &c.p1, &c.p2};
    for (Vector3<V>* p : points) {
        if (surface.baked) {
            c.greatest = hn::Max(c.greatest, greatest_component(*p));
            continue;
        }
        V out[3];
        for (int r = 0; r < 3; ++r) {
            const float* row = surface.world_from_object.rows[r];
            const V x = hn::Mul(hn::Set(d, row[0]), p->x), y = hn::Mul(hn::Set(d, row[1]), p->y),
                    z = hn::Mul(hn::Set(d, row[2]), p->z), w = hn::Set(d, row[3]);
            out[r] = hn::Add(hn::Add(x, y), hn::Add(z, w));
            const V terms = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Add(hn::Abs(z), hn::Abs(w)));
            c.greatest = hn::Max(c.greatest, terms);
        }
        *p = {out[0], out[1], out[2]};
    }
    return c;
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
