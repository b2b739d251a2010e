#include "geometry/clusters.h"

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

ClusterSet make_clusters(const Mesh& mesh, uint32_t corners, const uint32_t* vertices, uint32_t count,
                         const Bounds& bounds) {
    ClusterSet set;
    if (count == 0) return set;
    const std::vector<Vec3>& positions = mesh.positions;
    std::vector<uint64_t> order(count);  // code above primitive, so that ties keep their order
    parallel_ranges(count, 4096, [&](size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) {
            Vec3 centre(0, 0, 0);
            for (uint32_t k = 0; k < corners; ++k) centre += positions[vertices[corners * p + k]];
            order[p] = uint64_t{morton_code(centre / static_cast<float>(corners), bounds)} << 32 | p;
        }
    });
    parallel_sort(order);

    constexpr size_t kPadding = 64;
    set.primitives.reserve(count);
    for (uint32_t k = 0; k < corners; ++k) set.corners[k].reserve(count + kPadding);
    std::vector<uint32_t> seen_by(mesh.vertex_count, ~0u);  // the last cluster that has the vertex
    std::vector<uint8_t> place(mesh.vertex_count);          // among that cluster's
    Cluster cluster;
    const auto finish = [&] {
        set.clusters.push_back(cluster);
        cluster = {};
        cluster.first = static_cast<uint32_t>(set.primitives.size());
        cluster.first_vertex = static_cast<uint32_t>(set.vertices.size());
    };
    for (const uint64_t entry : order) {
        const auto primitive = static_cast<uint32_t>(entry);
        const uint32_t* v = vertices + size_t{corners} * primitive;
        if (cluster.count == Cluster::kMostPrimitives || cluster.vertex_count + corners > Cluster::kMostVertices)
            finish();
        const auto number = static_cast<uint32_t>(set.clusters.size());
        for (uint32_t k = 0; k < corners; ++k) {
            if (seen_by[v[k]] != number) {
                seen_by[v[k]] = number;
                place[v[k]] = static_cast<uint8_t>(cluster.vertex_count++);
                set.vertices.push_back(v[k]);
                cluster.bounds.extend(positions[v[k]]);
            }
            set.corners[k].push_back(place[v[k]]);
        }
        set.primitives.push_back(primitive);
        ++cluster.count;
    }
    finish();
    for (uint32_t k = 0; k < corners; ++k) set.corners[k].resize(count + kPadding);
    return set;
}

}  // namespace trp
