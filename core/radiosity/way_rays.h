// Whether points of surfaces see each other: a batch of ways, stopped by what is opaque, and tinted by glass where they
// pass it straight.
#pragma once

#include "shading/shadow_rays.h"

namespace trp {

// One to a thread.
class WayRays {
  public:
    explicit WayRays(const Snapshot& snapshot) : snapshot_(snapshot) {}
    void clear();
    // From a point on the side of a surface that `normal` shows to; a way that starts below the surface is not free.
    void set(int lane, uint32_t slot, const Vec3& from, const Vec3& normal, const Vec3& to);
    // Returns the number of rays.
    uint64_t trace();
    // How much comes through, from 0 to 1 by colour; 0 for lanes that were not set.
    Vec3 free(int lane) const { return visibility_.get(lane); }

  private:
    const Snapshot& snapshot_;
    Points points_;
    LightSamples samples_;
    LaneVec3 visibility_;
    ShadowScratch shadow_;
    ProgramScratch program_;
};

}  // namespace trp
