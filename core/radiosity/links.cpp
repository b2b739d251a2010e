#include "radiosity/links.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "film/pixel_random.h"
#include "radiosity/element_rays.h"
#include "radiosity/linear.h"
#include "radiosity/polygon_factors.h"

namespace trp {
namespace {

constexpr double kCurved = 0.06;  // of the square of a relative difference over an element, what no line follows: of
                                  // d^-2, whose second derivative is 3/2 of the first one's square
constexpr double kShadow = 0.5;   // of differences in what points see, what a line leaves
constexpr double kNear = 0.4;     // points of the receiver differ by more of their mean: it is close to the source
constexpr double kRelativeError = 1e-3;
constexpr double kUnseen = 0.1;      // what rays between few parts may miss of what stands in the way, of a receiver as
                                     // large as it is far away
constexpr float kWide = 0.25f;       // of the distance
constexpr double kSurprise = 0.3;    // of the share of one ray more, where all so far found the same
constexpr float kNearest = 0.1f;     // of a part's area: the least square of a distance that is told from others
constexpr uint32_t kWideRounds = 4;  // of rays between what is wide
constexpr uint32_t kMostRounds = 32;  // where chance would do too much

}  // namespace

uint64_t LinkEvaluator::evaluate(std::span<Link> links) {
    uint64_t rays = 0;
    for (size_t first = 0; first < links.size(); first += kInGroup)
        rays += group(links.subspan(first, std::min<size_t>(kInGroup, links.size() - first)));
    return rays;
}

LinkEvaluator::Place LinkEvaluator::place_of(uint32_t root) const {
    return {elements_[root].centre,    elements_.normal(root), elements_.facet_of(root).slot, 0, 0,
            elements_[root].exposed(), elements_[root]};
}

// The middles of an element's quarters, or of four roots of a cluster by area.
LinkEvaluator::Places LinkEvaluator::places_of(NodeId node) const {
    Places out;
    if (is_cluster(node)) {
        for (uint32_t k = 0; k < kLinkPoints; ++k)
            out[k] = place_of(clusters_.root_at(clusters_.of(node), (static_cast<float>(k) + 0.5f) / kLinkPoints));
        return out;
    }
    const Facet& facet = elements_.facet_of(node);
    const Element& element = elements_[node];
    const PlaneAxes axes = axes_of(facet);
    float x = 0, y = 0, exposed = 0;
    for (uint32_t k = 0; k < kLinkPoints; ++k) {
        Place& place = out[k];
        const uint32_t covered = element.covered >> 4 * k & 15;
        place = {{},
                 elements_.normal(node),
                 facet.slot,
                 0,
                 0,
                 1 - static_cast<float>(std::popcount(covered)) / 4,
                 elements_.quarter(node, k)};
        place.point = place.part.centre;
        if (facet.shape == Facet::Shape::polygon) {
            place.point = elements_.point_in(node, (static_cast<float>(k) + 0.5f) / kLinkPoints, 0.5f);
            continue;
        }
        if (covered != 0 && covered != 15) {
            place.point = elements_.place_point(node, 4 * k + static_cast<uint32_t>(std::countr_one(covered)));
        }
        const Vec3 way = place.point - element.centre;
        place.x = axes.x.dot(way);
        place.y = axes.y.dot(way);
        x += place.x * place.exposed;
        y += place.y * place.exposed;
        exposed += place.exposed;
    }
    // The middle is that of what is not covered.
    for (Place& place : out)
        if (exposed > 0) place.x -= x / exposed, place.y -= y / exposed;
    return out;
}

// The form factor from a point to an element, with nothing between them.
double LinkEvaluator::factor_at(const Place& place, uint32_t source) {
    // Rounding lifts points of one plane over it.
    const float height = (place.point - elements_[source].centre).dot(elements_.normal(source));
    if (!(height > 2 * clearance(place.point))) return 0;
    if (polygon_of_ != source) elements_.corners(polygon_of_ = source, polygon_);
    return point_to_polygon(Vec3d(place.point), Vec3d(place.normal), polygon_);
}

double LinkEvaluator::distance(const Link& link) const {
    const Vec3 way = clusters_.centre(elements_, link.source) - clusters_.centre(elements_, link.receiver);
    return std::max(way.length(), 1e-37f);
}

// The smaller the receiver the less.
double LinkEvaluator::unseen_share(const Link& link) const {
    const double size = is_cluster(link.receiver) ? 2 * static_cast<double>(clusters_.radius(elements_, link.receiver))
                                                  : std::sqrt(static_cast<double>(elements_[link.receiver].area));
    return kUnseen * std::min(1.0, size / distance(link));
}

// What is large for its distance is looked at closer: a link that seems all hidden, or all seen, is not refined again.
uint32_t LinkEvaluator::first_rounds(const Link& link) const {
    const float area = std::max(clusters_.area(elements_, link.receiver), clusters_.area(elements_, link.source));
    return std::sqrt(static_cast<double>(area)) > kWide * distance(link) ? kWideRounds : 1;
}

// Points count by what they would get, and by what is not covered around them.
LinkEvaluator::Seen LinkEvaluator::seen_of(const Link& link, uint32_t number, const Ways& ways) const {
    Seen out;
    double weights = 0, squares = 0, noise = 0;
    // With a cluster, rays say it.
    const bool clustered = has_cluster(link);
    const double per_kernel = clustered ? factor_per_kernel(link) * kLinkPoints / ways.tries[number] : 0;
    for (uint32_t r = 0; r < kLinkPoints; ++r) {
        const double exposed = static_cast<double>(ways.receivers[number][r].exposed);
        double weight = 0, share = 0;
        uint32_t looks = 0;
        for (uint32_t k = 0; k < kLinkPoints; ++k) {
            const uint32_t lane = number * kOfLink + r * kLinkPoints + k;
            weight += static_cast<double>(ways.kernels[lane]);
            share += static_cast<double>(luminance(ways.free.get(static_cast<int>(lane))));
            looks += ways.looks[lane];
        }
        weights += exposed;
        if (!(weight > 0)) continue;
        const double factor = exposed * (clustered ? weight * per_kernel : ways.factors[number * kLinkPoints + r]);
        share /= weight;
        if (std::abs(share - 0.5) > 0.4999) share = std::round(share);  // all alike, but for rounding
        const double chance = factor * share * (1 - share) / looks;
        out.mean += factor;
        out.seen += factor * share;
        squares += factor * share * share;
        noise += chance;
        out.within += factor * chance;
        out.looks += looks;
    }
    if (!(out.mean > 0)) return out;
    out.seen /= out.mean;
    out.alike = out.seen == 0 || out.seen == 1;
    // Of what points differ in how much they see, chance explains a part: few rays went to each.
    out.uneven = std::sqrt(std::max((squares - noise) / out.mean - out.seen * out.seen, 0.0));
    out.within /= out.mean * out.mean;
    out.mean /= weights;
    return out;
}

// The standard deviation of the share. Of rays that all found the same, the next one may not.
double LinkEvaluator::Seen::chance(float agreed) const {
    const double most = kSurprise / (2 + looks + (alike ? static_cast<double>(agreed) : 0));
    return std::sqrt(within + most * most);
}

uint32_t LinkEvaluator::more_rounds(const Link& link, const Seen& seen) const {
    const double chance = seen.mean * seen.chance(link.agreed), allowed = static_cast<double>(link.allowed);
    if (seen.looks == 0 || !(chance > allowed) || has_cluster(link)) return 0;
    // As the square root of the number, or, where all are alike, as the number.
    const double times = !seen.alike ? chance * chance / (allowed * allowed) : chance / allowed;
    return static_cast<uint32_t>(std::min(times * seen.looks / kOfLink, double{kMostRounds}));
}

uint64_t LinkEvaluator::group(std::span<Link> links) {
    const auto ways = std::make_unique<Ways>();
    std::vector<Round> rounds;
    ways->free.clear();
    for (uint32_t number = 0; number < links.size(); ++number) {
        const Link& link = links[number];
        for (uint32_t round = 0; round < first_rounds(link); ++round) rounds.push_back({number, round});
        const Places& receivers = ways->receivers[number] = places_of(link.receiver);
        const Places& sources = ways->sources[number] = places_of(link.source);
        polygon_of_ = ~0u;
        const bool to_cluster = is_cluster(link.receiver), from_cluster = is_cluster(link.source);
        NodeLight& light = ways->lights[number];
        if (to_cluster || from_cluster) light = light_between(link.source, link.receiver);
        for (uint32_t r = 0; r < kLinkPoints; ++r) {
            const Place& receiver = receivers[r];
            double& factor = ways->factors[number * kLinkPoints + r];
            if (!to_cluster && !from_cluster) factor = factor_at(receiver, link.source);
            for (uint32_t k = 0; k < kLinkPoints; ++k) {
                const Vec3 way = sources[k].point - receiver.point;
                ways->open[number * kOfLink + r * kLinkPoints + k] =
                    to_cluster || from_cluster ||
                    (factor > 0 && way.dot(receiver.normal) > 0 && way.dot(sources[k].normal) < 0);
            }
        }
    }
    uint64_t rays = look(links, rounds, *ways);
    rounds.clear();
    for (uint32_t number = 0; number < links.size(); ++number) {
        const uint32_t first = first_rounds(links[number]),
                       more = more_rounds(links[number], seen_of(links[number], number, *ways));
        for (uint32_t round = first; round < first + more; ++round) rounds.push_back({number, round});
    }
    rays += look(links, rounds, *ways);
    for (uint32_t number = 0; number < links.size(); ++number) finish(links[number], number, *ways);
    return rays;
}

// In each round, a ray for each pair of parts that light would go between, from any point of the one to any of the
// other.
uint64_t LinkEvaluator::look(std::span<const Link> links, std::span<const Round> rounds, Ways& ways) {
    alignas(64) uint32_t keys[kBatch], indices[kBatch];
    alignas(64) Lanes u, v, s, t, a, b, kernels;
    uint64_t count = 0;
    // Of a cluster, any root of the quarter.
    const auto place_at = [&](NodeId node, const Places& places, uint32_t quarter, float share) {
        if (!is_cluster(node)) return places[quarter];
        return place_of(clusters_.root_at(clusters_.of(node), (static_cast<float>(quarter) + share) / kLinkPoints));
    };
    for (size_t first = 0; first < rounds.size(); first += kInGroup) {
        const auto group = rounds.subspan(first, std::min<size_t>(kInGroup, rounds.size() - first));
        for (uint32_t lane = 0; lane < kBatch; ++lane) {
            const Round& of = group[std::min<size_t>(lane / kOfLink, group.size() - 1)];
            const Link& link = links[of.number];
            // The pairs share the first round's points; after that each has a sequence of its own.
            const uint32_t pair = lane % kOfLink, sequence = of.round == 0 ? 0 : pair + 1;
            keys[lane] = ((link.receiver * 0x9E3779B9u + link.source) * 0x85EBCA6Bu ^ seed_) + sequence * 0xC2B2AE35u;
            indices[lane] = of.round == 0 ? pair : of.round - 1;
        }
        random_pair_of(keys, indices, 0, u, v);
        random_pair_of(keys, indices, 1, s, t);
        random_pair_of(keys, indices, 2, a, b);
        rays_.clear();
        std::fill_n(kernels, kBatch, 0.0f);
        for (uint32_t lane = 0; lane < group.size() * kOfLink; ++lane) {
            const uint32_t number = group[lane / kOfLink].number, pair = lane % kOfLink, at = number * kOfLink + pair;
            if (!ways.open[at]) continue;
            ++ways.tries[number];
            const Link& link = links[number];
            const Place place = place_at(link.receiver, ways.receivers[number], pair / kLinkPoints, a[lane]),
                        of = place_at(link.source, ways.sources[number], pair % kLinkPoints, b[lane]);
            const Vec3 from = place.exposed == 1 ? elements_.point_in(place.part, s[lane], t[lane]) : place.point,
                       to = elements_.point_in(of.part, u[lane], v[lane]), way = to - from;
            // What is near counts for more, and is less likely to be hidden.
            const float d2 = std::max(way.length2(), 1e-37f), least = of.part.area * kNearest;
            kernels[lane] = std::max(way.dot(place.normal), 0.0f) * std::max(-way.dot(of.normal), 0.0f) /
                            (d2 * std::max(d2, least));
            if (!(kernels[lane] > 0)) continue;
            rays_.set(static_cast<int>(lane), place.slot, from, place.normal, to);
            ways.kernels[at] += kernels[lane];
            ++ways.looks[at];
        }
        count += rays_.trace();
        for (uint32_t lane = 0; lane < group.size() * kOfLink; ++lane) {
            const auto at = static_cast<int>(group[lane / kOfLink].number * kOfLink + lane % kOfLink);
            if (kernels[lane] > 0)
                ways.free.set(at, ways.free.get(at) + rays_.free(static_cast<int>(lane)) * kernels[lane]);
        }
    }
    return count;
}

void LinkEvaluator::finish(Link& link, uint32_t number, const Ways& ways) {
    if (has_cluster(link)) return finish_cluster(link, number, ways);
    const Places &receivers = ways.receivers[number], &sources = ways.sources[number];
    const double* const factors = &ways.factors[number * kLinkPoints];
    const auto lane_of = [&](uint32_t r, uint32_t k) { return number * kOfLink + r * kLinkPoints + k; };
    const auto weight_of = [&](uint32_t r, uint32_t k) { return static_cast<double>(ways.kernels[lane_of(r, k)]); };
    // What each point of the receiver gets, of the source's mean and of its changes.
    link.transfer.fill(0);
    link.spread = link.hidden = link.chance = 0;
    float exposed = 0;
    for (const Place& place : receivers) exposed += place.exposed;
    Vec3 colors(0, 0, 0);
    double arriving[kLinkPoints][3] = {};
    double least = 1e30, most = 0, mean = 0, squares = 0;
    double counts[kLinkPoints] = {};
    for (uint32_t r = 0; r < kLinkPoints && exposed > 0; ++r) {
        counts[r] = static_cast<double>(receivers[r].exposed / exposed);
        if (counts[r] == 0) continue;
        const double factor = factors[r], counted = factor * counts[r];
        double weight = 0;
        for (uint32_t k = 0; k < kLinkPoints; ++k) weight += weight_of(r, k);
        for (uint32_t k = 0; k < kLinkPoints && weight > 0; ++k) {
            const double part = weight_of(r, k) / weight;
            if (part == 0) continue;
            const uint32_t lane = lane_of(r, k);
            const Vec3 free = ways.free.get(static_cast<int>(lane)) / ways.kernels[lane];
            const double bright = part * static_cast<double>(luminance(free));
            colors += free * static_cast<float>(counted * part);
            arriving[r][0] += factor * bright;
            arriving[r][1] += factor * bright * static_cast<double>(sources[k].x);
            arriving[r][2] += factor * bright * static_cast<double>(sources[k].y);
        }
        mean += counted;
        squares += counted * factor;
        least = std::min(least, factor);
        most = std::max(most, factor);
    }
    const auto exact = [&] {
        elements_.corners(link.receiver, receiver_);
        elements_.corners(polygon_of_ = link.source, polygon_);
        return polygon_to_polygon(receiver_, polygon_, kRelativeError) /
               static_cast<double>(elements_[link.receiver].area);
    };
    if (!(mean > 0)) {
        // Other points may see the source where its plane cuts the receiver: that is left to smaller elements.
        if (exposed > 0) link.spread = static_cast<float>(exact());
        return;
    }
    const float bright = luminance(colors);
    link.tint = bright > 0 ? colors / bright : Vec3(1, 1, 1);

    Moments points;
    for (uint32_t r = 0; r < kLinkPoints; ++r)
        points.add(static_cast<double>(receivers[r].x), static_cast<double>(receivers[r].y), counts[r]);
    const Moments fit = points.inverse();
    const auto line_of = [&](auto&& value) {  // mean, and by x and y
        std::array<double, 3> sum{};
        for (uint32_t r = 0; r < kLinkPoints; ++r) {
            const double counted = counts[r] * value(r);
            sum[0] += counted;
            sum[1] += counted * static_cast<double>(receivers[r].x);
            sum[2] += counted * static_cast<double>(receivers[r].y);
        }
        return std::array{sum[0], fit.xx * sum[1] + fit.xy * sum[2], fit.xy * sum[1] + fit.yy * sum[2]};
    };
    for (size_t column = 0; column < 3; ++column) {
        const auto line = line_of([&](uint32_t r) { return arriving[r][column]; });
        for (size_t row = 0; row < 3; ++row) link.transfer[3 * row + column] = static_cast<float>(line[row]);
    }
    // Four points are too few where the two are close: the contour integral says how much light there is.
    if (most - least > kNear * mean && elements_[link.receiver].covered == 0) {
        const auto scale = static_cast<float>(exact() / mean);
        for (float& t : link.transfer) t *= scale;
    }
    const Seen found = seen_of(link, number, ways);
    set_seen(link, found, mean);
    // What differs smoothly follows a line mostly; shadows' edges do not.
    const auto line = line_of([&](uint32_t r) { return factors[r]; });
    const double twist = std::sqrt(std::max(squares - mean * mean - points.of(line[1], line[2]), 0.0)),
                 smooth = kCurved * (most - least) * (most - least) / mean + twist;
    link.spread = static_cast<float>(smooth * found.seen + mean * (kShadow * found.uneven + unseen_share(link)));
}

// How much of a link is seen, and what chance may have done to that.
void LinkEvaluator::set_seen(Link& link, const Seen& found, double mean) {
    link.hidden = static_cast<float>(found.seen > 0 ? std::sqrt(std::max(1 - found.seen, 0.0) / found.seen) : 0);
    link.chance = static_cast<float>(mean * found.chance(link.agreed));
    link.agreed = found.alike ? link.agreed + static_cast<float>(found.looks) : 0;
}

}  // namespace trp
