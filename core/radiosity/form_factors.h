// Rows of form factors: F_ij is the share of what leaves element i that arrives at element j.
//
//   analytic    the contour integral for polygons, times the visibility that stratified rays find
//   hemisphere  Nusselt's projection, sampled: rays whose places in the base circle are uniform, so that the share of
//               rays that meet j is the share of the circle that j covers (Nusselt 1928; Malley 1988)
//   hemicube    five faces of a cube about the element's middle, drawn by the rasterizer (Cohen and Greenberg, "The
//               Hemi-Cube", 1985)
//
// What passes glass or comes by a mirror is tinted: a row has three channels. What mirrors hand on is sampled by rays,
// whichever kind the rest is. Where nothing is tinted, no row's sum is above 1, but for contour integrals of faces in
// one place, of which rays between points tell no one from the other.
#pragma once

#include <atomic>

#include "film/settings.h"
#include "radiosity/elements.h"

namespace trp {

struct FormFactorJob {
    const Elements& elements;
    const RadiositySettings& settings;
    uint32_t seed = 0;
    std::atomic<bool>* cancelled = nullptr;
    std::atomic<uint64_t>* rays = nullptr;
};

// Whether anything in the scene tints.
bool tints(const Snapshot& snapshot);

// Row `i` from column `first` on into out[0 … size − first); `out` is set to 0 first. Runs in the current arena.
void form_factor_row(const FormFactorJob& job, uint32_t i, uint32_t first, Vec3d* out);

}  // namespace trp
