// Links that have a cluster at an end; see links.h and cluster_light.h.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/links.h"

namespace trp {
namespace {

constexpr double kMonopole = 0.3;  // of the square of what they measure of it, what halves of the source leave out
constexpr double kClose = 0.1;     // of all that could arrive, what may where ends are not apart
constexpr double kMostScale = 16;  // of what would come from one point, the most that rays make of it

}  // namespace

// Of a radiosity of 1.
NodeLight LinkEvaluator::light_between(NodeId source, NodeId receiver) const {
    if (!is_cluster(source)) return light_of(elements_, source, {1, 1, 1});
    const Vec3 way = clusters_.centre(elements_, receiver) - clusters_.centre(elements_, source);
    return light_of(clusters_, source, nullptr, way.normalized());
}

// The form factor that a ray from any point of the receiver to any of the source speaks for is this times its kernel.
double LinkEvaluator::factor_per_kernel(const Link& link) const {
    return static_cast<double>(clusters_.area(elements_, link.source)) / std::numbers::pi;
}

// A bound whatever way the surfaces of a cluster are turned: a source that fills as much of the sky as it can, of a
// part of the receiver that is as large as it is.
double LinkEvaluator::greatest_factor(const Link& link) const {
    const double gap = distance(link) - static_cast<double>(clusters_.radius(elements_, link.receiver) +
                                                            clusters_.radius(elements_, link.source)),
                 area = static_cast<double>(clusters_.area(elements_, link.source)),
                 most = std::min(1.0, std::sqrt(area / static_cast<double>(clusters_.area(elements_, link.receiver))));
    return gap > 0 ? std::min(most, area / (std::numbers::pi * gap * gap)) : most;
}

// The form factor where all light comes from one point.
double LinkEvaluator::point_factor(const Link& link, const NodeLight& light, const Places& receivers) const {
    if (is_cluster(link.receiver)) return static_cast<double>(mean_irradiance(clusters_, link.receiver, light));
    double sum = 0, exposed = 0;
    for (const Place& place : receivers) {
        sum += irradiance_at(light, place.point, place.normal) * static_cast<double>(place.exposed);
        exposed += static_cast<double>(place.exposed);
    }
    return exposed > 0 ? sum / exposed : 0;
}

// What the point that a source is taken for gets wrong, at the points of the receiver: against two points for its two
// halves, or against the polygon.
double LinkEvaluator::monopole_error(const Link& link, const NodeLight& light, const Places& receivers) {
    NodeLight halves[2];
    for (int k = 0; k < 2 && is_cluster(link.source); ++k)
        halves[k] = light_between(clusters_.of(link.source).children[k], link.receiver);
    double squares = 0;
    for (const Place& place : receivers) {
        const auto from = [&](const NodeLight& part) { return irradiance_at(part, place.point, place.normal); };
        const double better =
            is_cluster(link.source) ? from(halves[0]) + from(halves[1]) : factor_at(place, link.source);
        squares += (from(light) - better) * (from(light) - better) / kLinkPoints;
    }
    return std::sqrt(squares);
}

// Where the ends are apart, light comes from one point. Where they are not, rays say how much there is, which are right
// in the mean, and it is spread out.
void LinkEvaluator::finish_cluster(Link& link, uint32_t number, const Ways& ways) {
    const Seen found = seen_of(link, number, ways);
    const double away = distance(link), far = static_cast<double>(clusters_.radius(elements_, link.source)) / away,
                 both = far + static_cast<double>(clusters_.radius(elements_, link.receiver)) / away,
                 greatest = greatest_factor(link), tries = ways.tries[number];
    double sum = 0;
    Vec3 colors(0, 0, 0);
    for (uint32_t lane = number * kOfLink; lane < (number + 1) * kOfLink; ++lane) {
        sum += static_cast<double>(ways.kernels[lane]);
        colors += ways.free.get(static_cast<int>(lane));
    }
    const double by_rays = std::min(factor_per_kernel(link) * sum / tries, greatest),
                 seen = found.looks > 0 ? found.seen : 1;
    NodeLight light = ways.lights[number];
    const bool apart = clusters_.apart(elements_, link.receiver, link.source);
    link.room = apart ? 0 : static_cast<float>(both * away * both * away);
    light.room += link.room;
    const double point = point_factor(link, light, ways.receivers[number]);
    double factor = point, error = 0;
    if (apart) {
        error = seen * (monopole_error(link, light, ways.receivers[number]) +
                        kMonopole * both * both * std::max(point, by_rays));
    } else {
        // Close parts of theirs may give each other more than rays find, the more the more pairs see each other.
        const double agreed = found.looks == 0 ? static_cast<double>(link.agreed) : 0;
        error = kClose * greatest * (found.looks * seen + 1) / (tries + agreed + 2) + seen * by_rays;
        factor = std::min(by_rays, kMostScale * point);
    }
    link.transfer.fill(0);
    link.transfer[0] = static_cast<float>(factor * seen);
    link.share = static_cast<float>(point > 0 ? factor * seen / point : 0);
    link.unresolved = static_cast<float>(std::min(1.0, is_cluster(link.source) ? far * far : far));
    if (found.looks > 0)
        set_seen(link, found, factor);
    else  // no pair of points that face each other
        link.hidden = link.chance = 0, link.agreed += static_cast<float>(tries);
    const float bright = luminance(colors);
    link.tint = bright > 0 ? colors / bright : Vec3(1, 1, 1);
    link.spread = static_cast<float>(error + factor * (found.uneven + unseen_share(link)));
}

}  // namespace trp
