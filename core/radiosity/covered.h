// Where one body stands on another, or reaches into it: the places of elements that no light can come to and that
// nobody sees. Elements leave them out of their means, or a floor would be dark around all that stands on it.
#pragma once

#include "radiosity/element_light.h"

namespace trp {

// Marks, in elements from number `first` on, of which Element::covered says that they have to be looked at, the places
// from which all rays meet sides that take no part. Runs in the current arena.
void find_covered(Elements& elements, const LightingJob& job, uint32_t first);

}  // namespace trp
