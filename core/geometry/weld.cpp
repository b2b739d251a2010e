#include "geometry/weld.h"

#include <bit>

namespace trp {

uint64_t position_hash(const Vec3& position) {
    uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) hash = (hash ^ std::bit_cast<uint32_t>(position[k] + 0.0f)) * 0x9E3779B97F4A7C15u;
    return hash ^ (hash >> 32);
}

std::vector<uint32_t> weld_vertices(const Mesh& mesh) {
    // Open addressing, at most half full.
    const size_t size = std::bit_ceil(2 * size_t{mesh.vertex_count} + 1);
    std::vector<uint32_t> table(size, ~0u), first(mesh.vertex_count);
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
        const Vec3& p = mesh.positions[v];
        size_t at = position_hash(p) & (size - 1);
        while (table[at] != ~0u && mesh.positions[table[at]] != p) at = (at + 1) & (size - 1);
        if (table[at] == ~0u) table[at] = v;
        first[v] = table[at];
    }
    return first;
}

}  // namespace trp
