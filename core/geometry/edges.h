// The edges of a mesh, for drawing: its own or its faces' sides, without the diagonals of triangulation, each once,
// with the faces that meet there. Vertices at one position count as one.
#pragma once

#include "geometry/clusters.h"

namespace trp {

inline constexpr uint32_t kNoFace = ~0u;

struct Edge {
    uint32_t vertices[2];
    uint32_t faces[2];      // that have it as a side; kNoFace: none
    bool alike = false;     // both faces run along it in one direction: they are wound against each other
    bool manifold = false;  // it has exactly two faces
    bool marked = false;    // TRP_EDGE_MARKED
};

struct EdgeSet {
    std::vector<Edge> edges;
    std::vector<Vec3> face_normals;  // of unit length (Newell's), object space; 0 for faces without area
    ClusterSet clusters;
    Bounds bounds;
};

EdgeSet make_edges(const Mesh& mesh);

}  // namespace trp
