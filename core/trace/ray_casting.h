// Ray casting (Appel 1968; Goldstein and Nagel 1971): one primary ray to a sample, the equation with shadows, no
// recursion.
#pragma once

#include "film/tiles.h"

namespace trp {

// Fills the job's film. Returns false where it was cancelled.
bool ray_casting(RenderJob& job, const RenderEvents& events);

}  // namespace trp
