#include "geometry/clusters.h"

#include <tbb/parallel_sort.h>

#include "base/parallel.h"

namespace trp {
namespace {

// Every third bit, from the lowest.
uint32_t spread_bits(uint32_t x) {
    x &= 0x3FF;
    x = (x | x << 16) & 0x30000FF;
    x = (x | x << 8) & 0x300F00F;
    x = (x | x << 4) & 0x30C30C3;
    return (x | x << 2) & 0x9249249;
}

uint32_t morton_code(const Vec3& p, const Bounds& bounds) {
    uint32_t code = 0;
    for (int k = 0; k < 3; ++k) {
        const float extent = bounds.max[k] - bounds.min[k];
        const float place = extent > 0 ? (p[k] - bounds.min[k]) / extent * 1023 : 0;
        code |= spread_bits(static_cast<uint32_t>(std::clamp(place, 0.0f, 1023.0f))) << k;
    }
    return code;
}

}  // namespace

ClusterSet make_clusters(const Vec3* positions, uint32_t vertex_count, const uint32_t* vertices,
                         uint32_t triangle_count, const Bounds& bounds) {
    ClusterSet set;
    if (triangle_count == 0) return set;
    std::vector<uint64_t> order(triangle_count);  // code above triangle, so that ties keep their order
    parallel_ranges(triangle_count, 4096, [&](size_t begin, size_t end) {
        for (size_t t = begin; t < end; ++t) {
            const uint32_t* v = vertices + 3 * t;
            const Vec3 centre = (positions[v[0]] + positions[v[1]] + positions[v[2]]) / 3;
            order[t] = uint64_t{morton_code(centre, bounds)} << 32 | t;
        }
    });
    tbb::parallel_sort(order.begin(), order.end());

    constexpr size_t kPadding = 64;
    set.triangles.reserve(triangle_count + kPadding);
    for (auto& corners : set.corners) corners.reserve(triangle_count + kPadding);
    std::vector<uint32_t> seen_by(vertex_count, ~0u);  // the last cluster that has the vertex
    std::vector<uint8_t> place(vertex_count);          // among that cluster's
    Cluster cluster;
    const auto finish = [&] {
        set.clusters.push_back(cluster);
        cluster = {};
        cluster.first_triangle = static_cast<uint32_t>(set.triangles.size());
        cluster.first_vertex = static_cast<uint32_t>(set.vertices.size());
    };
    for (const uint64_t entry : order) {
        const auto triangle = static_cast<uint32_t>(entry);
        const uint32_t* v = vertices + 3 * size_t{triangle};
        if (cluster.triangle_count == Cluster::kMostTriangles || cluster.vertex_count + 3 > Cluster::kMostVertices)
            finish();
        const auto number = static_cast<uint32_t>(set.clusters.size());
        for (int k = 0; k < 3; ++k) {
            if (seen_by[v[k]] != number) {
                seen_by[v[k]] = number;
                place[v[k]] = static_cast<uint8_t>(cluster.vertex_count++);
                set.vertices.push_back(v[k]);
                cluster.bounds.extend(positions[v[k]]);
            }
            set.corners[k].push_back(place[v[k]]);
        }
        set.triangles.push_back(triangle);
        ++cluster.triangle_count;
    }
    finish();
    for (auto& corners : set.corners) corners.resize(triangle_count + kPadding);
    return set;
}

}  // namespace trp
