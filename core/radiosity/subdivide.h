// Elements that are divided where a solution of the whole ones asks for it (Cohen, Greenberg, Immel and Brock, "An
// Efficient Radiosity Approach for Realistic Image Synthesis", 1986): where radiosity changes too fast from an element
// to its neighbours to be interpolated, where the edge of a lamp's shadow crosses one, and where a body stands on a
// part of one. The parts get their light by gathering, B_e = E_e + ρ_e Σ_j F_ej B_j, over their own rows of form
// factors, so that the system is not solved again. Each level divides leaves of the level before.
#pragma once

#include "radiosity/solver.h"

namespace trp {

class Subdivision {
  public:
    // One level of a solved solution, in the current arena; a step of the solver that counts where anything was
    // divided. Returns whether there may be more to do. Where it was cancelled, all is as it was before.
    bool step(const SolverJob& job);
    bool is_whole(const Settings& settings) const { return level_ >= settings.radiosity.subdivisions; }
    // Of the elements that were made here, the sums of their form factors; those of others stay.
    void put_row_sums(std::vector<double>& sums) const;

  private:
    bool gather(const SolverJob& job, uint32_t first);

    uint32_t level_ = 0;
    uint32_t first_ = 0;  // element that was made here
    std::vector<double> sums_;
};

}  // namespace trp
