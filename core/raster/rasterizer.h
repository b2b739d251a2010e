// The rasterizer's shaded methods: visible surfaces, flat (Bouknight 1970), Gouraud (1971) and Phong (1975) shading.
// They see the same surfaces and differ in where the equation is evaluated.
#pragma once

#include "film/tiles.h"

namespace trp {

// Each fills the job's film. Returns false where it was cancelled.
bool visible_surface(RenderJob& job, const RenderEvents& events);  // nowhere: emission and ambient light alone
bool flat_shading(RenderJob& job, const RenderEvents& events);     // once for each polygon
bool gouraud_shading(RenderJob& job, const RenderEvents& events);  // at each vertex
bool phong_shading(RenderJob& job, const RenderEvents& events);    // at each pixel

}  // namespace trp
