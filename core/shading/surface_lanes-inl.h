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

// The triangles that lanes see of one surface. Lanes of other surfaces are given one of its triangles too, so that all
// can be read; and where all see one triangle, which large ones make common, numbers are read once instead of gathered.
template <class VI>
struct SeenTriangles {
    VI first;     // three times the triangle
    bool single;  // it is one for all lanes
};

template <class DI, class VI, class M>
SeenTriangles<VI> triangles_of(DI di, VI triangles, M here, const uint32_t* all) {
    const VI one = hn::Set(di, static_cast<int32_t>(all[hn::FindFirstTrue(di, here)]));
    const VI triangle = hn::IfThenElse(here, triangles, one);
    return {hn::Mul(triangle, hn::Set(di, 3)), hn::AllTrue(di, hn::Eq(triangle, one))};
}

template <class D, class T, class VI>
hn::Vec<D> read_at(D d, const T* values, VI index, bool single) {
    using Lane = hn::TFromD<D>;
    const auto* lanes = reinterpret_cast<const Lane*>(values);
    if (single) return hn::Set(d, lanes[hn::GetLane(index)]);
    return hn::GatherIndex(d, lanes, index);
}

template <class D, class VI, class V = hn::Vec<D>>
Vector3<V> read3_at(D d, const Vec3* values, VI index, bool single) {
    if (single) return broadcast(d, values[hn::GetLane(index)]);
    const hn::RebindToSigned<D> di;
    const VI at = hn::Mul(index, hn::Set(di, 3));
    const float* first = &values[0].x;
    return {hn::GatherIndex(d, first, at), hn::GatherIndex(d, first + 1, at), hn::GatherIndex(d, first + 2, at)};
}

// The k-th vertex, and the k-th corner, of triangles.
template <class DI, class VI>
VI triangle_vertex(DI di, const PlacedSurface& surface, const SeenTriangles<VI>& seen, int k) {
    return read_at(di, surface.vertices + k, seen.first, seen.single);
}
template <class DI, class VI>
VI triangle_corner(DI di, const PlacedSurface& surface, const SeenTriangles<VI>& seen, int k) {
    if (!surface.corners) return hn::Add(seen.first, hn::Set(di, k));
    return read_at(di, surface.corners + k, seen.first, seen.single);
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
