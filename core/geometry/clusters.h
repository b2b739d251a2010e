// A mesh's triangles or edges in small groups that lie close together, for projection: what a group has in common is
// done once (its bounds, its vertices).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace trp {

struct Bounds {
    Vec3 min{1e38f, 1e38f, 1e38f}, max{-1e38f, -1e38f, -1e38f};
    bool empty() const { return min.x > max.x; }
    void extend(const Vec3& p) {
        for (int k = 0; k < 3; ++k) min[k] = std::min(min[k], p[k]), max[k] = std::max(max[k], p[k]);
    }
};

struct Cluster {
    static constexpr uint32_t kMostPrimitives = 128, kMostVertices = 192;
    Bounds bounds;
    uint32_t first = 0, count = 0;  // in ClusterSet's arrays
    uint32_t first_vertex = 0, vertex_count = 0;
};

struct ClusterSet {
    std::vector<Cluster> clusters;
    std::vector<uint32_t> primitives;  // triangles of the surface, or edges
    std::vector<uint32_t> vertices;    // of the mesh
    // Of triangles, roughly: the directions of their normals, times 127, and 0.
    struct alignas(4) Normal : std::array<int8_t, 4> {};
    std::vector<Normal> normals;
    // Per primitive, which of the cluster's vertices its corners are. Padded, to be read in whole vectors.
    std::vector<uint8_t> corners[3];

    uint64_t bytes() const {
        return sizeof(Cluster) * clusters.size() + sizeof(uint32_t) * (primitives.size() + vertices.size()) +
               sizeof(Normal) * normals.size() + corners[0].size() + corners[1].size() + corners[2].size();
    }
};

// Clusters of primitives with so many corners (2 or 3), which are given in `vertices`, in Morton order of their
// centres.
ClusterSet make_clusters(const Mesh& mesh, uint32_t corners, const uint32_t* vertices, uint32_t count,
                         const Bounds& bounds);

}  // namespace trp
