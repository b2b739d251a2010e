#include "geometry/normals.h"

#include <atomic>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

#include "base/parallel.h"
#include "geometry/triangulate.h"
#include "geometry/weld.h"
#include "triptych/triptych.h"

namespace trp {

Vec3 face_normal(const Mesh& mesh, uint32_t face) {
    std::vector<Vec3> polygon;
    for (uint32_t c = mesh.face_begin(face); c < mesh.face_end(face); ++c)
        polygon.push_back(mesh.positions[mesh.corner_vertices[c]]);
    return polygon.size() < 3 ? Vec3(0, 0, 0) : Vec3(newell(polygon).normalized());
}

namespace {

Vec3 unit_or_up(const Vec3d& v) {
    const double length = v.length();
    return length > 0 ? Vec3(v / length) : Vec3(0, 0, 1);
}

// Adds each face's normal, as it weighs, to sums[group(corner)].
template <class Group>
void add_face_normals(const Mesh& mesh, NormalWeight weight, std::vector<Vec3d>& sums, Group&& group) {
    std::vector<Vec3> polygon;
    for (uint32_t face = 0; face < mesh.face_count(); ++face) {
        const uint32_t begin = mesh.face_begin(face), n = mesh.face_end(face) - begin;
        if (n < 3) continue;
        polygon.clear();
        for (uint32_t k = 0; k < n; ++k) polygon.push_back(mesh.positions[mesh.corner_vertices[begin + k]]);
        const Vec3d twice_area = newell(polygon);
        const Vec3d normal = weight == NormalWeight::area ? twice_area : twice_area.normalized();
        Vec3 to_previous = (polygon[n - 1] - polygon[0]).normalized();
        for (uint32_t k = 0; k < n; ++k) {
            const Vec3 to_next = (polygon[(k + 1) % n] - polygon[k]).normalized();
            const float angle =
                weight == NormalWeight::angle ? std::acos(std::clamp(to_next.dot(to_previous), -1.0f, 1.0f)) : 1.0f;
            sums[group(begin + k)] += normal * static_cast<double>(angle);
            to_previous = -to_next;
        }
    }
}

// Union-find with path halving.
struct Groups {
    explicit Groups(size_t count) : parent(count) { std::iota(parent.begin(), parent.end(), 0u); }
    uint32_t find(uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) { parent[find(a)] = find(b); }
    std::vector<uint32_t> parent;
};

uint64_t edge_key(uint32_t a, uint32_t b) {
    return a < b ? (uint64_t{a} << 32 | b) : (uint64_t{b} << 32 | a);
}

// Corners that meet over an edge which is not sharp, between smooth faces, belong to one group.
Groups group_corners(const Mesh& mesh, const std::vector<uint32_t>& vertex_of) {
    const auto key_of = [&](uint32_t a, uint32_t b) { return edge_key(vertex_of[a], vertex_of[b]); };
    std::unordered_set<uint64_t> sharp;
    for (size_t e = 0; e < mesh.edge_flags.size(); ++e)
        if (mesh.edge_flags[e] & TRP_EDGE_SHARP) sharp.insert(key_of(mesh.edges[2 * e], mesh.edges[2 * e + 1]));
    // The map holds, for each edge, the corners of the first face seen at its lower and its upper vertex.
    struct Ends {
        uint32_t low, high;
    };
    std::unordered_map<uint64_t, Ends> seen;
    seen.reserve(mesh.corner_vertices.size());
    Groups groups(mesh.corner_vertices.size());
    for (uint32_t face = 0; face < mesh.face_count(); ++face) {
        const uint32_t begin = mesh.face_begin(face), end = mesh.face_end(face);
        const bool smooth = mesh.face_smooth.empty() || mesh.face_smooth[face];
        for (uint32_t c = begin; smooth && c < end; ++c) {
            const uint32_t d = c + 1 < end ? c + 1 : begin;
            const uint32_t a = vertex_of[mesh.corner_vertices[c]], b = vertex_of[mesh.corner_vertices[d]];
            const uint64_t key = edge_key(a, b);
            if (a == b || sharp.contains(key)) continue;
            const Ends ends = a < b ? Ends{c, d} : Ends{d, c};
            const auto [it, fresh] = seen.emplace(key, ends);
            if (fresh) continue;
            groups.join(it->second.low, ends.low);
            groups.join(it->second.high, ends.high);
        }
    }
    return groups;
}

}  // namespace

std::vector<Vec3> unit_normals(const Mesh& mesh) {
    std::atomic<bool> all_unit = true;
    parallel_ranges(mesh.normals.size(), 1 << 16, [&](size_t begin, size_t end) {
        bool unit = true;
        for (size_t i = begin; i < end; ++i) unit &= std::abs(mesh.normals[i].length2() - 1) < 1e-3f;
        if (!unit) all_unit = false;
    });
    if (all_unit) return {};
    std::vector<Vec3> normals = mesh.normals;
    const bool corner_domain = mesh.normal_domain == TRP_DOMAIN_CORNER;
    for (uint32_t face = 0; face < mesh.face_count(); ++face)
        for (uint32_t c = mesh.face_begin(face); c < mesh.face_end(face); ++c) {
            Vec3& n = normals[corner_domain ? c : mesh.corner_vertices[c]];
            const float length = n.length();
            n = length > 0 ? n / length : face_normal(mesh, face);
        }
    return normals;
}

AveragedNormals averaged_normals(const Mesh& mesh, NormalWeight weight, bool weld) {
    std::vector<uint32_t> vertex_of;
    if (weld) {
        vertex_of = weld_vertices(mesh);
    } else {
        vertex_of.resize(mesh.vertex_count);
        std::iota(vertex_of.begin(), vertex_of.end(), 0u);
    }
    const bool by_corner = std::any_of(mesh.edge_flags.begin(), mesh.edge_flags.end(),
                                       [](uint8_t flags) { return flags & TRP_EDGE_SHARP; });
    if (!by_corner) {
        std::vector<Vec3d> sums(mesh.vertex_count, Vec3d(0, 0, 0));
        std::vector<Vec3> normals(mesh.vertex_count);
        add_face_normals(mesh, weight, sums, [&](uint32_t corner) { return vertex_of[mesh.corner_vertices[corner]]; });
        for (uint32_t v = 0; v < mesh.vertex_count; ++v) normals[v] = unit_or_up(sums[vertex_of[v]]);
        return {NormalLayer::Domain::vertex, std::move(normals)};
    }
    Groups groups = group_corners(mesh, vertex_of);
    std::vector<Vec3d> sums(mesh.corner_vertices.size(), Vec3d(0, 0, 0));
    std::vector<Vec3> normals(sums.size());
    add_face_normals(mesh, weight, sums, [&](uint32_t corner) { return groups.find(corner); });
    for (uint32_t c = 0; c < normals.size(); ++c) normals[c] = unit_or_up(sums[groups.find(c)]);
    return {NormalLayer::Domain::corner, std::move(normals)};
}

}  // namespace trp
