// Which sides of the facets take part.
//
// A surface that is seen from both sides has two, but mostly one of them only: the inside of a closed body, and the
// outside of a room in empty space, meet no light. Places on sides that see each other are joined to regions (a few
// rays from each), but not those of one side with each other, which may lie in two: the floor that a body stands on.
// The sides that have places in regions that some light reaches take part. Where none does for a facet, its front
// stands for it, unless that sees nothing and its back does, so that form factors can be had without a light.
#pragma once

#include "radiosity/element_light.h"

namespace trp {

// Makes the roots of all sides that take part, facet by facet, fronts first, with Element::covered
// as find_covered() wants it. Runs in the current arena.
void add_sides(Elements& elements, const LightingJob& job);

}  // namespace trp
