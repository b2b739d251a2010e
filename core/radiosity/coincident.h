// Faces of which the scene has two or more in one place, so that chance decides which of them light meets.
#pragma once

#include "radiosity/elements.h"

namespace trp {

struct Coincident {
    uint32_t count = 0;  // facets that lie where an earlier one does, and can be seen from a side that it has, too
    uint32_t first[2] = {0, 0};
};
Coincident find_coincident(const Elements& elements);

}  // namespace trp
