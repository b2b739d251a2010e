// What a radiosity solution depends on, as one number: two scenes whose surfaces, materials, lamps and world are alike
// have the same, wherever their cameras are.
#pragma once

#include "shading/snapshot.h"

namespace trp {

uint64_t scene_hash(const Snapshot& snapshot);

}  // namespace trp
