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
    // The ray starts off the surface, and is aimed from there; it ends before the other by as much: of close surfaces,
    // that is more than the share of the way by which rays to lights fall short.
    const float offset = clearance(from);
    const Vec3 way = to - (from + normal * offset);
    const float length = way.length();
    if (!(length > 0)) return;
    points_.slot[lane] = slot;
    points_.position.set(lane, from);
    points_.normal.set(lane, normal);
    points_.geometric_normal.set(lane, normal);
    points_.offset[lane] = offset;
    points_.time[lane] = 0;
    samples_.direction.set(lane, way / length);
    samples_.distance[lane] = std::max(length - clearance(to), length / 2);
    samples_.light.set(lane, {1, 1, 1});
    samples_.packets |= 1u << (lane >> 4);
}

uint64_t WayRays::trace() {
    return trace_shadows(snapshot_, points_, samples_, Coherence::incoherent, TransparentShadows::transmission,
                         visibility_, shadow_, program_);
}

}  // namespace trp
