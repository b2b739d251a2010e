// The rasterizer's shaded methods: visible surfaces, flat (Bouknight 1970), Gouraud (1971) and Phong (1975) shading.
// They see the same surfaces and differ in where the equation is evaluated.
#pragma once

#include "film/tiles.h"
#include "raster/scan_line.h"

namespace trp {

// Each fills the job's film. Returns false where it was cancelled.
bool visible_surface(RenderJob& job, const RenderEvents& events);  // nowhere: emission and ambient light alone
bool flat_shading(RenderJob& job, const RenderEvents& events);     // once for each polygon
bool gouraud_shading(RenderJob& job, const RenderEvents& events);  // at each vertex
bool phong_shading(RenderJob& job, const RenderEvents& events);    // at each pixel

// What a solution that was found before gives surfaces: the radiance that leaves points, towards any eye, where
// locate() has found them and their coefficients are known. From any thread.
using SurfaceRadiance = std::function<void(const Points& points, const Coefficients& coefficients, LaneVec3& radiance)>;
bool draw_radiance(RenderJob& job, const RenderEvents& events, const char* method, const SurfaceRadiance& radiance);

// The scan line through the centre of a pixel, as Gouraud shading interpolates radiance on it, and Phong shading unit
// normals; whatever interpolation the job's settings name. `surface` is null where nothing is seen.
enum class ScannedValue { radiance, normal };
struct PickedScanLine {
    const PlacedSurface* surface = nullptr;
    uint32_t face = 0;
    ScanLine line;
    ScanValues values;
};
PickedScanLine pick_scan_line(const RenderJob& job, ScannedValue value, uint32_t x, uint32_t y);

}  // namespace trp
