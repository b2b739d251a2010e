// read_uv(): texture coordinates and their derivatives from barycentrics and theirs.
#include "shading/program.h"
#include "shading/snapshot.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/texture_coordinates.cpp"
#include "hwy/foreach_target.h"

#include "shading/surface_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

void read_uv_lanes(const Snapshot& snapshot, const std::string& uv_set, const Points& points, const int32_t* lanes,
                   int count, ProgramScratch::Register& out) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    using VI = hn::Vec<decltype(di)>;
    const V zero = hn::Zero(d);
    for (int j = 0; j < count; j += static_cast<int>(hn::Lanes(d))) {
        const VI lane = hn::LoadU(di, lanes + j);
        auto pick_integers = [&](const uint32_t* values) {
            return hn::GatherIndex(di, reinterpret_cast<const int32_t*>(values), lane);
        };
        const VI slots = pick_integers(points.slot), triangles = pick_integers(points.triangle);
        // At the first vertex, and from there to the second and third.
        V u0 = zero, v0 = zero, u1 = zero, v1 = zero, u2 = zero, v2 = zero;
        const auto left = hn::FirstN(di, static_cast<size_t>(count - j));
        for_each_surface(di, snapshot, slots, left, [&](const PlacedSurface& surface, auto here) {
            const Attribute* layer = find_layer(surface.mesh->uv_sets, uv_set);
            if (!layer) return;
            for_each_number(di, triangles, here, [&](uint32_t triangle, auto these) {
                const auto mask = hn::RebindMask(d, these);
                const float* corners[3];
                for (int k = 0; k < 3; ++k) {
                    const uint32_t element = layer->domain == TRP_DOMAIN_CORNER ? surface.corner(triangle, k)
                                                                                : surface.vertices[3 * triangle + k];
                    corners[k] = &layer->values[size_t{element} * layer->components];
                }
                const auto set = [&](V& value, float number) {
                    value = hn::IfThenElse(mask, hn::Set(d, number), value);
                };
                set(u0, corners[0][0]), set(v0, corners[0][1]);
                set(u1, corners[1][0] - corners[0][0]), set(v1, corners[1][1] - corners[0][1]);
                set(u2, corners[2][0] - corners[0][0]), set(v2, corners[2][1] - corners[0][1]);
            });
        });
        auto combine = [&](const float* b1, const float* b2, V u, V v, float* out_u, float* out_v) {
            const V w1 = hn::GatherIndex(d, b1, lane), w2 = hn::GatherIndex(d, b2, lane);
            hn::Store(hn::MulAdd(w1, u1, hn::MulAdd(w2, u2, u)), d, out_u + j);
            hn::Store(hn::MulAdd(w1, v1, hn::MulAdd(w2, v2, v)), d, out_v + j);
        };
        combine(points.b1, points.b2, u0, v0, out.value[0], out.value[1]);
        combine(points.b1_dx, points.b2_dx, zero, zero, out.ddx[0], out.ddx[1]);
        combine(points.b1_dy, points.b2_dy, zero, zero, out.ddy[0], out.ddy[1]);
        hn::Store(zero, d, out.value[2] + j);
        hn::Store(zero, d, out.value[3] + j);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(read_uv_lanes);

void read_uv(const Snapshot& snapshot, const std::string& uv_set, const Points& points, const int32_t* lanes, int count,
             ProgramScratch::Register& out) {
    HWY_DYNAMIC_DISPATCH(read_uv_lanes)(snapshot, uv_set, points, lanes, count, out);
}

}  // namespace trp
#endif
