// The rasterizer's line drawings: edges as they are, and with the parts that faces hide taken out (Roberts, "Machine
// Perception of Three-Dimensional Solids", 1963; here by a visibility buffer).
#pragma once

#include "film/tiles.h"

namespace trp {

// Each fills the job's film. Returns false where it was cancelled.
bool wireframe(RenderJob& job, const RenderEvents& events);
bool hidden_line(RenderJob& job, const RenderEvents& events);

}  // namespace trp
