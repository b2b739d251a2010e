// Links of the hierarchy: what a node gives another, found at a few points of the receiver.
#pragma once

#include <atomic>
#include <span>

#include "radiosity/clusters.h"
#include "radiosity/way_rays.h"

namespace trp {

struct Link {
    NodeId receiver, source;
    Vec3 factor{0, 0, 0};  // mean irradiance at the receiver for a radiosity of 1 at the source, visibility included
    float spread = 0;      // what it is wrong by for what it differs by over the receiver, as luminance; with a
                           // cluster, the most that the factor may be
};

inline constexpr uint32_t kLinkPoints = 4;       // of the receiver: the middles of its quarters
inline constexpr uint32_t kRaysOfLinkPoint = 4;  // to points of the source

// One to a thread.
class LinkEvaluator {
  public:
    LinkEvaluator(const Elements& elements, const ElementClusters& clusters, uint32_t seed)
        : elements_(elements), clusters_(clusters), seed_(seed), ways_(elements.snapshot()) {}
    // Fills in factor and spread. Returns the number of rays.
    uint64_t evaluate(std::span<Link> links);

  private:
    struct Place {
        Vec3 point, normal;
        uint32_t slot;
    };
    Place receiver_place(NodeId node, uint32_t k) const;
    Place source_place(NodeId node, uint32_t k, float u, float v) const;
    double factor_at(const Place& place, NodeId source);
    float greatest_factor(const Link& link) const;
    float unseen_share(const Link& link) const;
    uint64_t group(std::span<Link> links);

    const Elements& elements_;
    const ElementClusters& clusters_;
    uint32_t seed_;
    WayRays ways_;
    std::vector<Vec3d> polygon_, receiver_;
    uint32_t polygon_of_ = ~0u;
};

}  // namespace trp
