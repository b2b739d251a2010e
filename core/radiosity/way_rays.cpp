#include "radiosity/way_rays.h"

#include <algorithm>

#include "radiosity/element_rays.h"

namespace trp {

void WayRays::clear() {
    samples_.packets = 0;
    samples_.light.clear();
    std::fill_n(points_.slot, kBatch, kNoSlot);
}

void WayRays::set(int lane, uint32_t slot, const Vec3& from, const Vec3& normal, const Vec3& to) {
    // Rays start off the surface: aimed from there, or what lies close before the surface would seem to hide itself.
    const float offset = clearance(from);
    const Vec3 way = to - (from + normal * offset);
    const float distance = way.length();
    if (!(distance > 0)) return;
    points_.slot[lane] = slot;
    points_.position.set(lane, from);
    points_.normal.set(lane, normal);
    points_.geometric_normal.set(lane, normal);
    points_.offset[lane] = offset;
    points_.time[lane] = 0;
    samples_.direction.set(lane, way / distance);
    samples_.distance[lane] = distance;
    samples_.light.set(lane, {1, 1, 1});
    samples_.packets |= 1u << (lane >> 4);
}

uint64_t WayRays::trace() {
    return trace_shadows(snapshot_, points_, samples_, Coherence::incoherent, TransparentShadows::transmission,
                         visibility_, shadow_, program_);
}

}  // namespace trp
