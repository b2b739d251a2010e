#include "geometry/edges.h"

#include "base/parallel.h"
#include "geometry/normals.h"
#include "geometry/weld.h"
#include "triptych/triptych.h"

namespace trp {
namespace {

// A face's side, or an edge that the mesh gives, at the lower of its vertices.
struct Side {
    uint32_t high;  // the other vertex
    uint32_t face;  // kNoFace: an edge of the mesh's own
    bool upwards;   // the face runs from the lower vertex to the higher
    bool marked;
    bool operator<(const Side& o) const { return high < o.high || (high == o.high && face < o.face); }
};

// Calls take(low, side) for every side of a face that has an area and every edge given.
template <class Take>
void for_each_side(const Mesh& mesh, const std::vector<Vec3>& face_normals, const std::vector<uint32_t>& welded,
                   Take&& take) {
    const auto give = [&](uint32_t from, uint32_t to, uint32_t face, bool marked) {
        const uint32_t a = welded[from], b = welded[to];
        if (a != b) take(std::min(a, b), Side{std::max(a, b), face, a < b, marked});
    };
    for (uint32_t face = 0; face < mesh.face_count(); ++face) {
        if (face_normals[face] == Vec3(0, 0, 0)) continue;
        for (uint32_t c = mesh.face_begin(face), end = mesh.face_end(face); c < end; ++c)
            give(mesh.corner_vertices[c], mesh.corner_vertices[c + 1 < end ? c + 1 : mesh.face_begin(face)], face,
                 false);
    }
    for (size_t e = 0; 2 * e < mesh.edges.size(); ++e)
        give(mesh.edges[2 * e], mesh.edges[2 * e + 1], kNoFace,
             !mesh.edge_flags.empty() && (mesh.edge_flags[e] & TRP_EDGE_MARKED));
}

// The edge of sides that have the same two vertices, those of faces first.
Edge make_edge(uint32_t low, const Side* begin, const Side* end) {
    Edge edge{{low, begin->high}, {kNoFace, kNoFace}};
    uint32_t faces = 0;
    for (const Side* side = begin; side != end; ++side) {
        edge.marked |= side->marked;
        if (side->face == kNoFace) continue;
        if (faces < 2) edge.faces[faces] = side->face;
        ++faces;
    }
    edge.manifold = faces == 2;
    edge.alike = faces > 1 && begin[0].upwards == begin[1].upwards;
    return edge;
}

}  // namespace

EdgeSet make_edges(const Mesh& mesh) {
    EdgeSet set;
    set.face_normals.resize(mesh.face_count());
    parallel_ranges(set.face_normals.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t face = begin; face < end; ++face)
            set.face_normals[face] = face_normal(mesh, static_cast<uint32_t>(face));
    });

    const std::vector<uint32_t> welded = weld_vertices(mesh);
    // Sides by their lower vertex: those of vertex v from first[v] to first[v + 1].
    std::vector<size_t> first(size_t{mesh.vertex_count} + 1, 0);
    for_each_side(mesh, set.face_normals, welded, [&](uint32_t low, const Side&) { ++first[low + 1]; });
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) first[v + 1] += first[v];
    std::vector<Side> sides(first.back());
    std::vector<size_t> next(first.begin(), first.end() - 1);
    for_each_side(mesh, set.face_normals, welded, [&](uint32_t low, const Side& side) { sides[next[low]++] = side; });

    const bool own = !mesh.edges.empty();
    set.edges.reserve(own ? mesh.edges.size() / 2 : sides.size() / 2);
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
        Side *at = sides.data() + first[v], *const end = sides.data() + first[v + 1];
        std::sort(at, end);
        while (at != end) {
            Side* last = at;
            while (last != end && last->high == at->high) ++last;
            if (!own || last[-1].face == kNoFace) set.edges.push_back(make_edge(v, at, last));
            at = last;
        }
    }

    std::vector<uint32_t> vertices;
    vertices.reserve(2 * set.edges.size());
    for (const Edge& edge : set.edges)
        for (const uint32_t v : edge.vertices) {
            vertices.push_back(v);
            set.bounds.extend(mesh.positions[v]);
        }
    set.clusters = make_clusters(mesh, 2, vertices.data(), static_cast<uint32_t>(set.edges.size()), set.bounds);
    return set;
}

}  // namespace trp
