// The hemicube (Cohen and Greenberg, "The Hemi-Cube: A Radiosity Solution for Complex Environments", 1985): the scene
// drawn by the rasterizer on the top and the upper halves of the sides of a cube about an element's middle; a pixel's
// share of the form factor is its delta form factor.
#pragma once

#include "radiosity/form_factors.h"

namespace trp {

// As form_factor_row().
void hemicube_row(const FormFactorJob& job, uint32_t i, uint32_t first, Vec3d* out);

inline constexpr int kHemicubeFaces = 5;  // the top, then the sides towards +x, +y, −x and −y
// What a pixel of a face sees, one layer after the other where surfaces are seen through.
struct HemicubePixel {
    uint32_t x, y, element;
    Vec3 weight;
};
void draw_hemicube_face(const FormFactorJob& job, uint32_t i, int face, std::vector<HemicubePixel>& out);
// Of the pixel (x, y) of a face of `resolution`² pixels; sides have their upper half alone, y ≥ resolution / 2.
double delta_form_factor(int face, uint32_t resolution, uint32_t x, uint32_t y);

}  // namespace trp
