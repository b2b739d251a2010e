// Rows of form factors by rays: their places in the base circle of an element's hemisphere are uniform, so that the
// share of rays that meet j is the share of the circle that j covers (Nusselt 1928; Malley 1988).
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include "radiosity/element_rays.h"
#include "radiosity/form_factors.h"

namespace trp {

// A row, kept as counts of rays by each thread, whose sums are the same in any order; used for one row after another.
class HemisphereRow {
  public:
    explicit HemisphereRow(const Elements& elements) : elements_(elements) {}
    // Fills the row of element `i`, of which nothing may be left; `mirrored`: with what comes by mirrors alone. Returns
    // whether it was not cancelled, which leaves the row empty. Runs in the current arena.
    bool trace(const FormFactorJob& job, uint32_t i, bool mirrored);
    // Takes the factor of element `j` out of the row.
    Vec3d take(uint32_t j) {
        uint32_t rays = 0;
        for (uint32_t* const row : used_) rays += row[j], row[j] = 0;
        Vec3d sum(rays, rays, rays);
        if (any_tinted_) sum += tinted_[j], tinted_[j] = Vec3d(0, 0, 0);
        return sum * share_;
    }

  private:
    const Elements& elements_;
    double share_ = 0;                                               // of a ray
    tbb::enumerable_thread_specific<std::vector<uint32_t>> counts_;  // of those that took part
    std::vector<uint32_t*> used_;
    std::vector<Vec3d> tinted_;  // of rays that went on from where they met something
    bool any_tinted_ = false;
};

}  // namespace trp
