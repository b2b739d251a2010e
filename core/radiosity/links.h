// Links of the hierarchy: what a node gives another, found at a few points of the receiver.
#pragma once

#include <array>
#include <atomic>
#include <span>

#include "radiosity/cluster_light.h"
#include "radiosity/way_rays.h"

namespace trp {

// Irradiance that arrives at the receiver for what leaves the source, both as Linear: the mean and the change along x
// and y of the one (rows) for those of the other (columns), visibility included. With a cluster, only the first, the
// mean, is there: cluster_light.h says what each root gets, and `share` how much of it.
struct Link {
    NodeId receiver, source;
    Vec3 tint{1, 1, 1};  // of what passes glass; its luminance is 1
    std::array<float, 9> transfer{};
    float share = 0;       // with a cluster: of what its light would be,
    float room = 0;        // with this added to the squares of distances
    float spread = 0;      // what the irradiance is wrong by over the receiver for a radiosity of 1
    float hidden = 0;      // of the source, against the part that is seen: √((1 − V) / V)
    float unresolved = 1;  // of how the source's radiosity differs within it, what the link knows nothing of
    float chance = 0;      // what the irradiance is wrong by, by chance, for a radiosity of 1
    float agreed = 0;      // rays that all found the same, those of links above that it is a part of too
    float allowed = 0;     // of what chance may do to the factor: more rays are traced until it is less

    Vec3 factor() const { return tint * transfer[0]; }
};

inline bool has_cluster(const Link& link) {
    return is_cluster(link.receiver) || is_cluster(link.source);
}

inline constexpr uint32_t kLinkPoints = 4;  // of each end: the middles of its quarters; rays go from each to each

// One to a thread.
class LinkEvaluator {
  public:
    LinkEvaluator(const Elements& elements, const ElementClusters& clusters, uint32_t seed)
        : elements_(elements), clusters_(clusters), seed_(seed), rays_(elements.snapshot()) {}
    // Fills in all but the ends and what is allowed; `agreed` is that of the link above. Returns the number of rays.
    uint64_t evaluate(std::span<Link> links);

  private:
    // A point that stands for a part of a node; x and y: from the node's middle, along its facet's axes; the share of
    // the part that is not covered.
    struct Place {
        Vec3 point, normal;
        uint32_t slot;
        float x, y, exposed;
        Element part;  // of an element
    };
    using Places = std::array<Place, kLinkPoints>;
    Places places_of(NodeId node) const;
    Place place_of(uint32_t root) const;
    double factor_at(const Place& place, uint32_t source);
    NodeLight light_between(NodeId source, NodeId receiver) const;
    double distance(const Link& link) const;
    double factor_per_kernel(const Link& link) const;
    double greatest_factor(const Link& link) const;
    double unseen_share(const Link& link) const;
    static constexpr uint32_t kOfLink = kLinkPoints * kLinkPoints, kInGroup = kBatch / kOfLink;
    // Of a group of links, between the parts of their ends: what light would go there, and how much rays found free.
    struct Ways {
        Places receivers[kInGroup], sources[kInGroup];
        NodeLight lights[kInGroup];                 // of the sources, where one end is a cluster
        double factors[kBatch / kLinkPoints] = {};  // of the receivers' points, with nothing in the way
        bool open[kBatch] = {};                     // light may go there
        // Sums over rays of what light each stands for, and of what of it found its way free.
        float kernels[kBatch] = {};
        LaneVec3 free;
        uint32_t looks[kBatch] = {};
        uint32_t tries[kInGroup] = {};  // of pairs of points, by link
    };
    // What rays have found of a link: how much of it is seen, and what chance may do to that.
    struct Seen {
        double mean = 0, seen = 0;  // the factor with nothing in the way, and the share
        double uneven = 0;          // the standard deviation of what the receiver's points see, but for chance
        double within = 0;          // of the points' variances by chance
        uint32_t looks = 0;
        bool alike = false;                 // all rays found the same
        double chance(float agreed) const;  // of `seen`
    };
    Seen seen_of(const Link& link, uint32_t number, const Ways& ways) const;
    uint32_t first_rounds(const Link& link) const;
    uint32_t more_rounds(const Link& link, const Seen& seen) const;
    uint64_t group(std::span<Link> links);
    struct Round {
        uint32_t number, round;  // of the link, and its rounds
    };
    uint64_t look(std::span<const Link> links, std::span<const Round> rounds, Ways& ways);
    void finish(Link& link, uint32_t number, const Ways& ways);
    void finish_cluster(Link& link, uint32_t number, const Ways& ways);
    double point_factor(const Link& link, const NodeLight& light, const Places& receivers) const;
    double monopole_error(const Link& link, const NodeLight& light, const Places& receivers);
    static void set_seen(Link& link, const Seen& found, double mean);

    const Elements& elements_;
    const ElementClusters& clusters_;
    uint32_t seed_;
    WayRays rays_;
    std::vector<Vec3d> polygon_, receiver_;
    uint32_t polygon_of_ = ~0u;
};

}  // namespace trp
