// Elements::find() for what a packet of rays has met.
#pragma once

#include "geometry/embree.h"
#include "radiosity/elements.h"

namespace trp {

// Where a ray is not at its end: the surface may have a hole or a mirror there, or be of glass.
inline constexpr uint32_t kGoesOn = kNoElement - 1;

// The 16 elements that the rays meet, as Embree has traced them; kNoElement or kGoesOn where they meet none. Returns
// whether any goes on. `eye`: the rays are its own, and go on from the backs of one-sided surfaces.
bool find_elements(const Elements& elements, const RTCRayHit16& packet, bool eye, uint32_t* out);

}  // namespace trp
