#include "radiosity/links.h"

#include <algorithm>
#include <numbers>

#include "film/pixel_random.h"
#include "radiosity/element_rays.h"
#include "radiosity/polygon_factors.h"

namespace trp {
namespace {

constexpr float kInterpolated = 0.25f;  // of a smooth difference over an element, what is left as an error
constexpr float kNear = 0.1f;           // points of the receiver differ by more of their sum: it is close to the source
constexpr double kRelativeError = 1e-3;
constexpr float kUnseen = 0.1f;  // what so few rays may miss of what stands in the way, of a receiver as large as
                                 // it is far away

}  // namespace

uint64_t LinkEvaluator::evaluate(std::span<Link> links) {
    constexpr size_t kInGroup = kBatch / (kLinkPoints * kRaysOfLinkPoint);
    uint64_t rays = 0;
    for (size_t first = 0; first < links.size(); first += kInGroup)
        rays += group(links.subspan(first, std::min(kInGroup, links.size() - first)));
    return rays;
}

// Point k of a receiver: the middle of a quarter, or of one of four roots of a cluster by area.
LinkEvaluator::Place LinkEvaluator::receiver_place(NodeId node, uint32_t k) const {
    if (is_cluster(node)) {
        const ElementCluster& cluster = clusters_.of(node);
        const uint32_t root = clusters_.root_at(cluster, (static_cast<float>(k) + 0.5f) / kLinkPoints);
        return {elements_[root].centre, elements_.normal(root), elements_.facet_of(root).slot};
    }
    const float u = k % 2 ? 0.75f : 0.25f, v = k / 2 ? 0.75f : 0.25f;
    return {elements_.point_in(node, u, v), elements_.normal(node), elements_.facet_of(node).slot};
}

// A point of the k-th quarter of a source.
LinkEvaluator::Place LinkEvaluator::source_place(NodeId node, uint32_t k, float u, float v) const {
    if (is_cluster(node)) {
        const ElementCluster& cluster = clusters_.of(node);
        const uint32_t root = clusters_.root_at(cluster, (static_cast<float>(k) + u) / kRaysOfLinkPoint);
        return {elements_.point_in(root, u, v), elements_.normal(root), elements_.facet_of(root).slot};
    }
    u = (static_cast<float>(k % 2) + u) / 2;
    v = (static_cast<float>(k / 2) + v) / 2;
    return {elements_.point_in(node, u, v), elements_.normal(node), elements_.facet_of(node).slot};
}

// The form factor from a point to a source, with nothing between them.
double LinkEvaluator::factor_at(const Place& place, NodeId source) {
    if (!is_cluster(source)) {
        // Rounding lifts points of one plane over it.
        const float height = (place.point - elements_[source].centre).dot(elements_.normal(source));
        if (!(height > 2 * clearance(place.point))) return 0;
        if (polygon_of_ != source) elements_.corners(polygon_of_ = source, polygon_);
        return point_to_polygon(Vec3d(place.point), Vec3d(place.normal), polygon_);
    }
    const ElementCluster& cluster = clusters_.of(source);
    double sum = 0;
    for (uint32_t k = 0; k < kRaysOfLinkPoint; ++k) {
        const Place of = source_place(source, k, 0.5f, 0.5f);
        const Vec3 way = of.point - place.point;
        const float d2 = std::max(way.length2(), 1e-37f);
        const float cosines = std::max(way.dot(place.normal), 0.0f) * std::max(-way.dot(of.normal), 0.0f) / d2;
        // Never more than a half space full of it.
        sum += static_cast<double>(cosines) /
               (std::numbers::pi * static_cast<double>(d2) + static_cast<double>(cluster.area));
    }
    return sum * static_cast<double>(cluster.area) / kRaysOfLinkPoint;
}

// A bound whatever way the surfaces of a cluster are turned: a source that fills as much of the sky as it can.
float LinkEvaluator::greatest_factor(const Link& link) const {
    const NodeId receiver = link.receiver, source = link.source;
    const float gap = (clusters_.centre(elements_, source) - clusters_.centre(elements_, receiver)).length() -
                      clusters_.radius(elements_, receiver) - clusters_.radius(elements_, source),
                area = clusters_.area(elements_, source);
    return gap > 0 ? std::min(1.0f, area / (std::numbers::pi_v<float> * gap * gap)) : 1;
}

// Between elements, the smaller the receiver the less.
float LinkEvaluator::unseen_share(const Link& link) const {
    const float distance = (elements_[link.source].centre - elements_[link.receiver].centre).length();
    return kUnseen * std::min(1.0f, std::sqrt(elements_[link.receiver].area) / std::max(distance, 1e-37f));
}

uint64_t LinkEvaluator::group(std::span<Link> links) {
    constexpr uint32_t kOfLink = kLinkPoints * kRaysOfLinkPoint;
    alignas(64) uint32_t keys[kBatch], indices[kBatch];
    alignas(64) Lanes u, v;
    double factors[kBatch / kRaysOfLinkPoint] = {};
    float weights[kBatch] = {};  // of the ways: what light would go along them
    for (uint32_t lane = 0; lane < kBatch; ++lane) {
        const Link& link = links[std::min<size_t>(lane / kOfLink, links.size() - 1)];
        keys[lane] = (link.receiver * 0x9E3779B9u + link.source) * 0x85EBCA6Bu ^ seed_;
        indices[lane] = lane % kOfLink;
    }
    random_pair_of(keys, indices, 0, u, v);
    ways_.clear();
    for (uint32_t number = 0; number < links.size(); ++number) {
        const Link& link = links[number];
        polygon_of_ = ~0u;
        for (uint32_t k = 0; k < kLinkPoints; ++k) {
            const Place place = receiver_place(link.receiver, k);
            double& factor = factors[number * kLinkPoints + k];
            factor = factor_at(place, link.source);
            if (!(factor > 0)) continue;
            for (uint32_t ray = 0; ray < kRaysOfLinkPoint; ++ray) {
                const auto lane = static_cast<int>(number * kOfLink + k * kRaysOfLinkPoint + ray);
                // Another quarter of the source first for each point.
                const Place to = source_place(link.source, (ray + k) % kRaysOfLinkPoint, u[lane], v[lane]);
                const Vec3 way = to.point - place.point;
                const float d2 = std::max(way.length2(), 1e-37f);
                weights[lane] = std::max(way.dot(place.normal), 0.0f) * std::max(-way.dot(to.normal), 0.0f) /
                                (d2 * std::max(d2, clusters_.area(elements_, link.source) / kRaysOfLinkPoint));
                if (weights[lane] > 0) ways_.set(lane, place.slot, place.point, place.normal, to.point);
            }
        }
    }
    const uint64_t rays = ways_.trace();
    for (uint32_t number = 0; number < links.size(); ++number) {
        Link& link = links[number];
        Vec3 sum(0, 0, 0);
        float least = 1e30f, most = 0, seen = 0, seen2 = 0, noise = 0;
        double all = 0;
        for (uint32_t k = 0; k < kLinkPoints; ++k) {
            Vec3 free(0, 0, 0);
            float weight = 0;
            for (uint32_t ray = 0; ray < kRaysOfLinkPoint; ++ray) {
                const auto lane = static_cast<int>(number * kOfLink + k * kRaysOfLinkPoint + ray);
                free += ways_.free(lane) * weights[lane];
                weight += weights[lane];
            }
            const uint32_t place = number * kLinkPoints + k;
            if (weight > 0) free = free / weight;
            sum += free * static_cast<float>(factors[place]);
            all += factors[place];
            least = std::min(least, static_cast<float>(factors[place]));
            most = std::max(most, static_cast<float>(factors[place]));
            const float share = luminance(free);
            seen += share / kLinkPoints;
            seen2 += share * share / kLinkPoints;
            noise += share * (1 - share) / (kLinkPoints * kRaysOfLinkPoint);
        }
        link.factor = sum / kLinkPoints;
        // Four points are too few where the two are close: the contour integral says how much light there is.
        const bool clustered = is_cluster(link.receiver) || is_cluster(link.source);
        if (!clustered && most - least > kNear * static_cast<float>(all)) {
            elements_.corners(link.receiver, receiver_);
            elements_.corners(link.source, polygon_);
            const double exact = polygon_to_polygon(receiver_, polygon_, kRelativeError) /
                                 static_cast<double>(elements_[link.receiver].area);
            link.factor *= static_cast<float>(exact * kLinkPoints / all);
        }
        // What differs smoothly is interpolated between elements later, and mostly right then; shadows' edges are not.
        // Of what points differ in how much they see, chance explains a part: few rays went to each.
        const float mean = static_cast<float>(all) / kLinkPoints, smooth = (most - least) / 2,
                    shadow = std::sqrt(std::max(seen2 - seen * seen - 1.5f * noise, 0.0f));
        link.spread =
            clustered ? greatest_factor(link) : kInterpolated * smooth * seen + mean * (shadow + unseen_share(link));
    }
    return rays;
}

}  // namespace trp
