#include "radiosity/clusters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

namespace trp {
namespace {

constexpr uint32_t kFewestClustered = 256;  // of fewer, each pair has its links
constexpr float kFlat = 1e-4f;              // of a cluster's radius
constexpr size_t kMostLanes = 16;

// The cone of the normals of a cluster's roots about their mean, and whether all lie in one plane.
void set_cone(const Elements& elements, std::span<const uint32_t> roots, ElementCluster& cluster) {
    Vec3 sum(0, 0, 0);
    for (const uint32_t root : roots) sum += elements.normal(root) * elements[root].area;
    const float length = sum.length();
    cluster.axis = length > 0 ? sum / length : elements.normal(roots[0]);
    float least = 1;
    cluster.flat = true;
    for (const uint32_t root : roots) {
        least = std::min(least, cluster.axis.dot(elements.normal(root)));
        const float height = (elements[root].centre - elements[roots[0]].centre).dot(cluster.axis);
        cluster.flat &= std::abs(height) <= kFlat * cluster.radius;
    }
    cluster.flat &= least > 1 - kFlat * kFlat;
    cluster.spread = std::acos(std::clamp(least, -1.0f, 1.0f));
}

// Halves by the middle of the longest side of the centres' box.
NodeId make_cluster(const Elements& elements, uint32_t first, uint32_t count, ElementClusters& out) {
    if (count == 1) return out.roots[first];
    const auto begin = out.roots.begin() + first, end = begin + count;
    Bounds box;
    for (auto root = begin; root != end; ++root) box.extend(elements[*root].centre);
    const Vec3 extent = box.max - box.min;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto middle = begin + count / 2;
    std::nth_element(begin, middle, end, [&](uint32_t a, uint32_t b) {
        const float x = elements[a].centre[axis], y = elements[b].centre[axis];
        return x != y ? x < y : a < b;
    });
    const auto number = static_cast<uint32_t>(out.clusters.size());
    ElementCluster cluster;
    cluster.first_root = first;
    cluster.root_count = count;
    cluster.centre = (box.min + box.max) / 2;
    std::vector<Vec3d> corners;
    for (auto root = begin; root != end; ++root) {
        cluster.area += elements[*root].area;
        elements.corners(*root, corners);
        for (const Vec3d& p : corners) {
            cluster.radius = std::max(cluster.radius, (Vec3(p) - cluster.centre).length());
            cluster.box.extend(Vec3(p));
        }
    }
    set_cone(elements, std::span(&*begin, count), cluster);
    out.clusters.push_back(cluster);
    const NodeId a = make_cluster(elements, first, count / 2, out),
                 b = make_cluster(elements, first + count / 2, count - count / 2, out);
    out.clusters[number].children[0] = a;
    out.clusters[number].children[1] = b;
    return number | kClusterBit;
}

void set_lanes(const Elements& elements, ElementClusters& out) {
    const size_t room = (out.roots.size() + 2 * kMostLanes - 1) / kMostLanes * kMostLanes;
    for (auto* lanes : {&out.places[0], &out.places[1], &out.places[2], &out.normals[0], &out.normals[1],
                        &out.normals[2], &out.radii, &out.exposed})
        lanes->assign(room, 0);
    for (size_t k = 0; k < out.roots.size(); ++k) {
        const Element& root = elements[out.roots[k]];
        const Vec3 normal = elements.normal(out.roots[k]);
        for (int axis = 0; axis < 3; ++axis) {
            out.places[axis][k] = root.centre[axis];
            out.normals[axis][k] = normal[axis];
        }
        out.radii[k] = elements.radius(out.roots[k]);
        out.exposed[k] = static_cast<float>(root.exposed_area());
    }
}

}  // namespace

ElementClusters make_element_clusters(const Elements& elements) {
    ElementClusters out;
    if (elements.size() < kFewestClustered) return out;
    out.roots.resize(elements.size());
    std::iota(out.roots.begin(), out.roots.end(), 0u);
    make_cluster(elements, 0, elements.size(), out);
    out.areas.push_back(0);
    for (const uint32_t root : out.roots) out.areas.push_back(out.areas.back() + elements[root].area);
    set_lanes(elements, out);
    return out;
}

bool ElementClusters::faces(const Elements& elements, NodeId from, NodeId to) const {
    const bool clustered = is_cluster(from);
    const Vec3 axis = clustered ? of(from).axis : elements.normal(from), origin = centre(elements, from),
               way = centre(elements, to) - origin;
    const float reach = radius(elements, to);
    if (!clustered && !is_cluster(to)) return way.dot(axis) > -reach;
    if (!clustered || of(from).flat) {
        // The highest corner of the box over the plane.
        const Vec3 on_plane = clustered ? elements[roots[of(from).first_root]].centre : origin;
        float height = way.dot(axis) + reach;
        if (is_cluster(to)) {
            height = -axis.dot(on_plane);
            for (int k = 0; k < 3; ++k) height += axis[k] * (axis[k] > 0 ? of(to).box.max[k] : of(to).box.min[k]);
        }
        return height > kFlat * reach;
    }
    const float both = reach + radius(elements, from), distance = way.length();
    if (distance <= both) return true;
    const float angle = std::acos(std::clamp(way.dot(axis) / distance, -1.0f, 1.0f));
    return angle - of(from).spread - std::asin(both / distance) < std::numbers::pi_v<float> / 2;
}

bool ElementClusters::may_see(const Elements& elements, NodeId a, NodeId b) const {
    return faces(elements, a, b) && faces(elements, b, a);
}

uint32_t ElementClusters::root_at(const ElementCluster& cluster, float share) const {
    const auto first = areas.begin() + cluster.first_root, last = first + cluster.root_count;
    const float at = *first + share * (*last - *first);
    const auto next = std::upper_bound(first, last, at);
    const auto place = std::clamp<ptrdiff_t>(next - areas.begin() - 1, cluster.first_root,
                                             static_cast<ptrdiff_t>(cluster.first_root + cluster.root_count) - 1);
    return roots[static_cast<size_t>(place)];
}

}  // namespace trp
