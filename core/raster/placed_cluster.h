// A cluster where it stands, as the drawing functions take it.
#pragma once

#include <array>

#include "geometry/clusters.h"
#include "raster/projection.h"

namespace trp {

struct PlacedCluster {
    const Vec3* positions;
    const ClusterSet& set;
    uint32_t number;  // in the set
    FilmTransform transform;
    const Projection& projection;

    const Cluster& cluster() const { return set.clusters[number]; }
    // The mesh's vertex at a corner of the cluster's primitive k.
    uint32_t vertex(uint32_t k, int corner) const {
        return set.vertices[cluster().first_vertex + set.corners[corner][cluster().first + k]];
    }
};

// The film's x and y in pixels, times the depth through a perspective camera, and the depth.
using FilmPoint = std::array<double, 3>;

inline FilmPoint on_film(const FilmTransform& transform, const Vec3& p) {
    FilmPoint q;
    for (int r = 0; r < 3; ++r) {
        const float* row = transform.rows[r];
        q[r] = static_cast<double>(row[0]) * p.x + static_cast<double>(row[1]) * p.y +
               static_cast<double>(row[2]) * p.z + row[3];
    }
    return q;
}

// How far within a bound of what the film's grid can hold a point lies, times its depth; below 0 it is outside.
inline constexpr int kBoundCount = 5;
double within_bound(const Projection& projection, int bound, const FilmPoint& q);

}  // namespace trp
