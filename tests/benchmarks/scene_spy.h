// What the core hands to Embree, overheard: the triangles of an Embree scene in its world space. It stands between the
// core and Embree, and forwards every call unchanged.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "geometry/embree.h"

namespace trp_bench {

// Triangles of one mask, as one mesh. Positions have room for the 4 bytes that Embree reads beyond the last.
struct FlatMesh {
    std::vector<float> positions;   // 3 to a vertex
    std::vector<uint32_t> indices;  // 3 to a triangle
    size_t vertex_count() const { return positions.size() / 3; }
    size_t triangle_count() const { return indices.size() / 3; }
};
using FlatMeshes = std::map<unsigned, FlatMesh>;  // by the geometries' mask

// The triangles of `scene`, instances moved into place. Throws where the scene holds what is not known here.
FlatMeshes overheard_triangles(RTCScene scene);

// The scene made last that is nobody's instance: the core's top level after a commit.
RTCScene overheard_top_scene();

}  // namespace trp_bench
