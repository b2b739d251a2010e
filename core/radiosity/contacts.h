// Where surfaces stand on each other: walls on a floor, shelves on a wall. An element that reaches past both faces of a
// wall would have one light for both rooms, and carry it from one to the other; such elements are divided until none
// does, and elements that bodies stand on until they are no larger than these, so that shadows are not missed (Baum,
// Mann, Smith and Winget, "Making Radiosity Usable: Automatic Preprocessing and Meshing Techniques for the Generation
// of Accurate Radiosity Solutions", 1991, cuts faces along these lines; here their quad-trees follow them).
#pragma once

#include "radiosity/element_light.h"

namespace trp {

// A piece of the line along which a face meets an element's surface.
struct Contact {
    uint32_t element;   // of the surface that is met, as it was when it was looked for
    Vec3 middle, half;  // from `middle` − `half` to `middle` + `half`
    float size;         // that elements may have there
    bool wall;          // parts what is on either side
};

// Between faces and the elements that are there now. Runs in the current arena.
std::vector<Contact> find_contacts(const LightingJob& job);

// Divides elements until those along a contact have no more than its size, or `least`, across. New ones have still to
// be looked at by find_covered(). Returns a 1 to each that reaches across a wall.
std::vector<uint8_t> divide_at(const std::vector<Contact>& contacts, float least, Elements& elements);

}  // namespace trp
