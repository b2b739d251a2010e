// Batches of shading points among the leaves of elements: which leaf each lies in and where, and what a solution has
// there, as Elements::find() looks for a leaf.
#pragma once

#include "radiosity/vertices.h"
#include "shading/batch.h"

namespace trp {

struct LeafLanes {
    alignas(64) uint32_t leaf[kBatch];  // kNoElement where a lane sees none
    // The place in the leaf's own cell, from 0 to 1 as ElementVertices has it; without meaning in polygons.
    alignas(64) Lanes u, v;
};

// The leaves at points that locate() has found.
void find_leaves(const Elements& elements, const Points& points, LeafLanes& out);

// What vertices have, and the leaves, interpolated in the leaves; 0 where there is none.
void interpolate(const ElementVertices& vertices, const LeafLanes& places, const std::vector<Vec3>& at_vertices,
                 const std::vector<Vec3>& at_leaves, LaneVec3& out);

}  // namespace trp
