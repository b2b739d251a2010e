// Groups of elements that lie close together, over the roots of all quad-trees: the upper part of the hierarchy (Smits,
// Arvo and Greenberg, "A Clustering Algorithm for Radiosity in Complex Environments", 1994; Sillion, "A Unified
// Hierarchical Algorithm for Global Illumination with Scattering Volumes and Object Clusters", 1995), so that surfaces
// that hardly light each other need no links one by one.
#pragma once

#include <vector>

#include "radiosity/elements.h"

namespace trp {

// A node of the hierarchy: an element, or a cluster where the highest bit is set.
using NodeId = uint32_t;
inline constexpr NodeId kClusterBit = 1u << 31;
inline bool is_cluster(NodeId node) {
    return (node & kClusterBit) != 0;
}

inline constexpr float kApart = 0.7f;  // of their distance, what the radii of ends that are apart are less than

struct ElementCluster {
    NodeId children[2] = {0, 0};
    uint32_t first_root = 0, root_count = 0;  // in ElementClusters::roots
    Vec3 centre{0, 0, 0};
    float radius = 0, area = 0;
    // A cone that holds the normals of its roots, radians; and its box. Where it is flat, all roots are in one plane.
    Vec3 axis{0, 0, 1};
    float spread = 0;
    Bounds box;
    bool flat = false;
};

struct ElementClusters {
    std::vector<ElementCluster> clusters;  // each before all within it, in a row; the first holds all
    std::vector<uint32_t> roots;           // elements, cluster by cluster
    std::vector<float> areas;              // of the roots before each, and of all
    // Of roots, in lanes with room after the last: middles, normals, radii, and the area that is not covered.
    std::vector<float> places[3], normals[3], radii, exposed;

    const ElementCluster& of(NodeId cluster) const { return clusters[cluster & ~kClusterBit]; }
    // Of any node.
    float area(const Elements& elements, NodeId node) const {
        return is_cluster(node) ? of(node).area : elements[node].area;
    }
    Vec3 centre(const Elements& elements, NodeId node) const {
        return is_cluster(node) ? of(node).centre : elements[node].centre;
    }
    float radius(const Elements& elements, NodeId node) const {
        return is_cluster(node) ? of(node).radius : elements.radius(node);
    }
    // Whether they are so small for their distance that light may be taken to come from one point.
    bool apart(const Elements& elements, NodeId a, NodeId b) const {
        return radius(elements, a) + radius(elements, b) <
               kApart * (centre(elements, a) - centre(elements, b)).length();
    }
    // False where no part of one node can lie before a part of the other, and after it.
    bool may_see(const Elements& elements, NodeId a, NodeId b) const;
    // The root that a share of a cluster's area, in [0, 1), falls into.
    uint32_t root_at(const ElementCluster& cluster, float share) const;

  private:
    bool faces(const Elements& elements, NodeId from, NodeId to) const;
};

// Of the elements that are there now; none where they are few.
ElementClusters make_element_clusters(const Elements& elements);

}  // namespace trp
