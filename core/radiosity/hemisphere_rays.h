// Rays from elements into their hemispheres.
#pragma once

#include <algorithm>
#include <cmath>

#include "radiosity/elements.h"
#include "shading/batch.h"

namespace trp {

// How far from a surface rays start, so that they do not meet it (as Points::offset).
inline constexpr float kLeastClearance = 1e-3f, kClearance = 0x1p-18f;
inline float clearance(const Vec3& p) {
    return kClearance * std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), kLeastClearance});
}

// Directions about a normal.
class Hemisphere {
  public:
    explicit Hemisphere(const Vec3& normal);
    // For numbers in [0, 1), with a density of cosine over π (Malley's method).
    Vec3 direction(float u, float v) const;

    const Vec3 x, y, normal;
};

// An element's sequence of rays: from points of it, in directions that are uniform in the base circle of its
// hemisphere.
class HemisphereRays {
  public:
    HemisphereRays(const Elements& elements, uint32_t element, uint32_t seed);
    // kBatch of them, from number `first` on, a multiple of kBatch.
    void make(uint32_t first, LaneVec3& origins, LaneVec3& directions) const;

    // For the lanes: with s and t in [0, 1) points are corner + sides[0] s + sides[1] t + twist s t.
    struct Source {
        Hemisphere hemisphere;
        uint32_t key;
        Facet::Shape shape;
        Vec3 corner{0, 0, 0}, sides[2] = {{0, 0, 0}, {0, 0, 0}}, twist{0, 0, 0};
        QuadArea area{};
    };

  private:
    const Elements& elements_;
    uint32_t element_;
    Source source_;
};

}  // namespace trp
