// The solids that a ray is in, one within another or across each other. Of several, the one with the greatest priority
// fills the space (Schmidt and Budge, "Simple Nested Dielectrics in Ray Traced Images", 2002), of equal ones the one
// entered last.
#pragma once

#include <cstdint>
#include <vector>

#include "shading/snapshot.h"

namespace trp {

// States of rays as numbers: each says which solids, in the order in which they were entered. A state is stored once.
class Media {
  public:
    using State = uint32_t;
    static constexpr State kOutside = 0;

    explicit Media(const Snapshot& snapshot) : snapshot_(snapshot) { clear(); }
    // Forgets all states but kOutside.
    void clear();
    // Within the solid of a placed surface, too.
    State enter(State state, uint32_t slot, uint32_t material);
    // Out of it: of its last entry, where it was entered several times; the same state where it never was.
    State leave(State state, uint32_t slot);
    // What fills the space; null: nothing.
    const CompiledMaterial* filling(State state) const;

    // What a ray meets at the surface of a solid.
    struct Crossing {
        State beyond;                          // of what goes through
        const CompiledMaterial *here, *there;  // on this side and beyond; null: nothing
        bool is_real;                          // false: the solid is not there, as another fills its space
    };
    Crossing cross(State state, uint32_t slot, uint32_t material, bool from_behind);

  private:
    struct Solid {
        State within;
        uint32_t slot, material;
    };
    const Snapshot& snapshot_;
    std::vector<Solid> solids_;
};

}  // namespace trp
