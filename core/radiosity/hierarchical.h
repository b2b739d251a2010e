// Hierarchical radiosity (Hanrahan, Salzman and Aupperle, "A Rapid Hierarchical Radiosity Algorithm", 1991): light goes
// over links between nodes of quad-trees, each as high up as the tolerance allows, and clusters above them.
//
// Light is linear over elements (Linear); of clusters each root gets and gives its own (cluster_light.h). A link's
// error is what no line follows of its irradiance over the receiver and of the source's radiosity within it, for
// clusters what one point for all of the source leaves out, and what chance may have done; times the receiver's
// reflectance. The squares of all errors that come to an element are added up, and over the scene weighed by area. That
// is an estimate of the solution's error, in W/m², and each step refines the links that have more than an equal share
// of what the tolerance allows, along with the elements on which lamps shine unevenly, until it is below the tolerance.
// As light is gathered between the steps, links are refined for what they carry then (multigridding).
#pragma once

#include <array>

#include "radiosity/linear.h"
#include "radiosity/link_tree.h"
#include "radiosity/mirror_rows.h"
#include "radiosity/solver.h"

namespace trp {

inline constexpr double kUnevenness = 0.5;  // of a lamp's light over an element, what is left as an error
inline constexpr size_t kLinkGrain = 1024;  // links that a thread takes at a time
// Links and elements; then the solution is left as it is, and its residual says how good. Eight times the elements that
// it begins with, where that is more.
inline constexpr size_t kMostLinks = 1 << 19;

class HierarchicalSolver : public Solver {
  public:
    bool step(const SolverJob& job) override;
    void links(const Elements& elements, std::vector<ElementLink>& out) const override;
    std::vector<uint64_t> links_to(const Elements& elements, uint32_t leaf) const override {
        return links_to_leaf({elements, clusters_, links_}, leaf);
    }
    std::vector<double> row_sums(const Elements&) const override { return sums_; }

  private:
    struct Node {
        Linear radiosity;
        PlaneCell cell;         // of an element
        float x = 0, y = 0;     // from the middle of the element above, along the facet's axes
        float variance = 0;     // of the brightness of its parts, from the linear one
        float reflectance = 0;  // the mean, of the brightest colour
        float error = 0;        // of what its leaves give, the mean of its squares
        // Of what its own links bring: the squares of what is wrong by chance, and what is wrong the same way.
        float own_error = 0, own_coherent = 0;
        float coherent = 0;  // with that of the nodes above
    };

    bool begin(const SolverJob& job);
    std::vector<Link> first_links(const Elements& elements) const;
    void evaluate(const SolverJob& job, std::vector<Link>& links) const;
    void solve(const SolverJob& job);
    void gather(const Elements& elements);
    void find_sums(const Elements& elements);
    void light_clusters(const Elements& elements);
    float shown(NodeId source, const NodeLight& light) const;
    NodeLight light_of_link(const Elements& elements, const Link& link) const;
    // Of nodes above, as Node has them.
    struct ErrorAbove {
        double squares = 0, coherent = 0;
    };
    void push_pull(const SolverJob& job, NodeId id, const Linear& above, ErrorAbove error);
    void set_leaf(const SolverJob& job, uint32_t leaf, Linear arriving, double error);
    void add_nodes(const SolverJob& job);
    // Irradiance that a link may be wrong by: for what no line follows over the receiver and within the source, and for
    // what of the source is hidden, which is likely darker than the rest, so that many links err the same way.
    struct LinkError {
        double over_receiver, within_source, coherent, chance;
        double squares() const {
            return (over_receiver + within_source) * (over_receiver + within_source) + chance * chance;
        }
    };
    LinkError link_error(size_t link) const;
    float allowed(NodeId receiver, double bright) const;
    double measure(const SolverJob& job);
    // What of a link is divided when it is refined.
    enum class Part : uint8_t { none, receiver, source };
    Part part_of_clusters(const Elements& elements, const Link& link) const;
    Part part_by_error(const SolverJob& job, const Link& link, const LinkError& error) const;
    // Whether an end is in two rooms, and a part of it hidden: that is the other room, and nothing like the rest.
    bool leads_across_walls(const Link& link) const {
        return link.hidden > 0 && (is_across(link.receiver) || is_across(link.source));
    }
    bool is_across(NodeId id) const { return !is_cluster(id) && id < across_walls_.size() && across_walls_[id]; }
    Part part_by_ratio(const Elements& elements, const Link& link, float ratio) const;
    struct Marks {
        std::vector<Part> parts;      // by link
        std::vector<uint8_t> uneven;  // by element: lamps shine on it so unevenly that it is divided
    };
    Marks mark(const SolverJob& job) const;
    void add_parts(const Elements& elements, const Link& link, Part part, int times, std::vector<Link>& out) const;
    void balance(Elements& elements) const;
    bool add_elements(const SolverJob& job, uint32_t first, std::vector<Link>& fresh);
    bool refine(const SolverJob& job);
    bool is_done(const SolverJob& job) const;  // as well as the tolerance asks for
    bool is_full() const { return links_.size() + element_nodes_.size() > most_; }
    float extent(const Elements& elements, NodeId id) const;
    struct Children {
        NodeId ids[4];
        uint32_t count;
    };
    Children children(const Elements& elements, NodeId id) const;  // not of leaves
    bool may_divide(const Elements& elements, uint32_t element) const {
        return elements.facet_of(element).shape != Facet::Shape::polygon && elements[element].area > 4 * least_area_;
    }
    Node& node(NodeId id) { return is_cluster(id) ? cluster_nodes_[id & ~kClusterBit] : element_nodes_[id]; }
    const Node& node(NodeId id) const {
        return is_cluster(id) ? cluster_nodes_[id & ~kClusterBit] : element_nodes_[id];
    }
    size_t place(NodeId id) const { return is_cluster(id) ? id & ~kClusterBit : clusters_.clusters.size() + id; }

    ElementClusters clusters_;
    std::vector<Node> cluster_nodes_, element_nodes_;
    std::vector<NodeId> tops_;            // of the hierarchy
    std::vector<Link> links_;             // by receiver
    std::vector<size_t> first_link_;      // by place of the receiver, and the end
    std::vector<float> brightness_;       // by link, of what its source shows to its receiver
    std::vector<NodeLight> to_clusters_;  // by link, of the first ones
    std::vector<double> sums_;            // by element, of leaves the sums of their form factors
    RootColors root_colors_;
    RootLight root_light_;
    MirrorRows mirrors_;
    std::vector<Linear> gathered_;       // irradiance by links and clusters, by element
    std::vector<Vec3d> mirrored_;        // and by mirrors
    std::vector<uint8_t> across_walls_;  // by element, of the first ones: 1 where it reaches into two rooms
    float least_area_ = 0;
    size_t most_ = kMostLinks;
    bool begun_ = false;
    double tolerance_ = 0;
};

}  // namespace trp
