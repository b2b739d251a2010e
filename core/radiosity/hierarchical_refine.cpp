// What the hierarchy's links are wrong by, and the refining of those to which the error is owed.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "radiosity/covered.h"
#include "radiosity/hierarchical.h"
#include "radiosity/vertices.h"

namespace trp {
namespace {

constexpr double kCoherent = 0.5;  // of what differs within a source, what is wrong the same way where half is hidden
constexpr int kAtOnce = 2;         // divisions of a link, where a cluster is not apart from its other end
constexpr double kChance = 0.125;  // of the tolerance, what chance may do to what a link brings

// Of shares of the squared error, the least of those to be refined, so that the rest is half of what is allowed
// (Dörfler, "A Convergent Adaptive Algorithm for Poisson's Equation", 1996).
double least_share(std::vector<double> shares, double allowed) {
    std::sort(shares.begin(), shares.end());
    double sum = 0;
    for (const double share : shares)
        if ((sum += share) > allowed / 2) return share;
    return std::numeric_limits<double>::infinity();
}

}  // namespace

HierarchicalSolver::LinkError HierarchicalSolver::link_error(size_t number) const {
    const Link& link = links_[number];
    const double within = luminance(link.factor()) * std::sqrt(static_cast<double>(node(link.source).variance));
    const auto bright = static_cast<double>(brightness_[number]);
    return {static_cast<double>(link.spread) * bright, within * static_cast<double>(link.unresolved),
            kCoherent * within * static_cast<double>(link.hidden), static_cast<double>(link.chance) * bright};
}

// What chance may do to the factor of a link, or of those that take its place.
float HierarchicalSolver::allowed(NodeId receiver, double bright) const {
    const double carried = bright * static_cast<double>(node(receiver).reflectance);
    return static_cast<float>(kChance * tolerance_ / std::max(carried, 1e-30));
}

// The estimated mean square error of the solution, with the errors of all nodes.
double HierarchicalSolver::measure(const SolverJob& job) {
    for (auto* nodes : {&cluster_nodes_, &element_nodes_})
        for (Node& n : *nodes) n.own_error = n.own_coherent = 0;
    for (size_t l = 0; l < links_.size(); ++l) {
        const LinkError error = link_error(l);
        const Link& link = links_[l];
        node(link.receiver).own_error += static_cast<float>(error.squares());
        node(link.receiver).own_coherent += static_cast<float>(error.coherent);
    }
    for (const NodeId top : tops_) push_pull(job, top, {}, {});
    double sum = 0, area = 0, power = 0;
    for (uint32_t i = 0; i < job.elements.size(); ++i) {
        if (!job.elements[i].leaf()) continue;
        const double a = job.elements[i].area;
        sum += a * static_cast<double>(element_nodes_[i].error);
        area += a;
        power += a * brightness(element_nodes_[i].radiosity.mean);
    }
    tolerance_ = job.settings.radiosity.tolerance;
    if (!(tolerance_ > 0)) tolerance_ = area > 0 ? 0.01 * power / area : 0;
    return area > 0 ? sum / area : 0;
}

// Of a link with a cluster, that, or the larger of two, is divided.
HierarchicalSolver::Part HierarchicalSolver::part_of_clusters(const Elements& elements, const Link& link) const {
    return is_cluster(link.receiver) &&
                   (!is_cluster(link.source) || extent(elements, link.receiver) >= extent(elements, link.source))
               ? Part::receiver
               : Part::source;
}

// What to do about a link: divide its receiver or its source, whichever its error is owed to and can be divided.
HierarchicalSolver::Part HierarchicalSolver::part_by_error(const SolverJob& job, const Link& link,
                                                           const LinkError& error) const {
    const Elements& elements = job.elements;
    if (has_cluster(link)) return part_of_clusters(elements, link);
    const auto may_be_divided = [&](NodeId id) { return !elements[id].leaf() || may_divide(elements, id); };
    // Of a leaf that reflects alone, the parts would have its radiosity.
    const bool receivers = may_be_divided(link.receiver),
               sources = may_be_divided(link.source) &&
                         (!elements[link.source].leaf() || job.solution.light[link.source].texture > 0);
    if (!receivers && !sources) return Part::none;
    return receivers && (!sources || error.over_receiver >= error.within_source + error.coherent + error.chance)
               ? Part::receiver
               : Part::source;
}

// Or the larger one, where its side is not less than a share of the distance.
HierarchicalSolver::Part HierarchicalSolver::part_by_ratio(const Elements& elements, const Link& link,
                                                           float ratio) const {
    const float to = extent(elements, link.receiver), from = extent(elements, link.source);
    const NodeId larger = to >= from ? link.receiver : link.source;
    const Vec3d way(clusters_.centre(elements, link.source) - clusters_.centre(elements, link.receiver));
    if (std::max(to, from) < ratio * way.length()) return Part::none;
    if (!is_cluster(larger) && elements[larger].leaf() && !may_divide(elements, larger)) return Part::none;
    return larger == link.receiver ? Part::receiver : Part::source;
}

// The links and leaves to be refined: those that the error is mostly owed to, or all links that are too wide.
HierarchicalSolver::Marks HierarchicalSolver::mark(const SolverJob& job) const {
    const Elements& elements = job.elements;
    const auto area_of = [&](NodeId id) { return static_cast<double>(clusters_.area(elements, id)); };
    const float ratio = job.settings.radiosity.link_ratio;
    Marks out{std::vector<Part>(links_.size(), Part::none), std::vector<uint8_t>(elements.size(), 0)};
    std::vector<double> shares(links_.size() + elements.size(), 0.0);
    parallel_ranges(links_.size(), kLinkGrain, [&](size_t begin, size_t end) {
        for (size_t l = begin; l < end; ++l) {
            const Link& link = links_[l];
            if (ratio > 0) {
                out.parts[l] = part_by_ratio(elements, link, ratio);
                continue;
            }
            if (leads_across_walls(link)) {
                out.parts[l] = is_across(link.receiver) ? Part::receiver : Part::source;
                shares[l] = std::numeric_limits<double>::infinity();
                continue;
            }
            const Node& to = node(link.receiver);
            const LinkError error = link_error(l);
            out.parts[l] = part_by_error(job, link, error);
            if (out.parts[l] != Part::none)
                shares[l] = (error.squares() + error.coherent * static_cast<double>(to.coherent)) *
                            static_cast<double>(to.reflectance * to.reflectance) * area_of(link.receiver);
        }
    });
    if (ratio > 0) return out;
    double* const uneven = &shares[links_.size()];
    for (uint32_t i = 0; i < elements.size(); ++i)
        if (elements[i].leaf() && may_divide(elements, i)) {
            const double error =
                kUnevenness * static_cast<double>(job.solution.light[i].unevenness * element_nodes_[i].reflectance);
            uneven[i] = error * error * area_of(i);
        }
    const double least = least_share(shares, tolerance_ * tolerance_ * elements.area());
    for (size_t l = 0; l < links_.size(); ++l)
        if (!(shares[l] >= least)) out.parts[l] = Part::none;
    for (uint32_t i = 0; i < elements.size(); ++i) out.uneven[i] = uneven[i] >= least;
    return out;
}

// The links that take the place of one, of which a part is divided. What it brings between ends that are not apart is
// hardly known: parts of it that are not either are divided at once, as the next step would.
void HierarchicalSolver::add_parts(const Elements& elements, const Link& link, Part part, int times,
                                   std::vector<Link>& out) const {
    const bool by_receiver = part == Part::receiver;
    const Children below = children(elements, by_receiver ? link.receiver : link.source);
    for (const NodeId child : std::span(below.ids, below.count)) {
        Link next{by_receiver ? child : link.receiver, by_receiver ? link.source : child};
        next.agreed = link.agreed / static_cast<float>(below.count);
        next.allowed = link.allowed;
        if (!clusters_.may_see(elements, next.receiver, next.source)) continue;
        if (times > 1 && has_cluster(next) && !clusters_.apart(elements, next.receiver, next.source))
            add_parts(elements, next, part_of_clusters(elements, next), times - 1, out);
        else
            out.push_back(next);
    }
}

// Divides leaves until each has neighbours of half its size at least, so that what a small one has at its corners is
// not spread over a large one (a restricted quad-tree: Baum, Mann, Smith and Winget 1991).
void HierarchicalSolver::balance(Elements& elements) const {
    for (bool any = true; any;) {
        any = false;
        const ElementVertices vertices(elements);
        for (uint32_t i = 0, count = elements.size(); i < count; ++i)
            if (elements[i].leaf() && vertices.has_small_neighbours(i)) elements.divide(i), any = true;
    }
}

// What elements from number `first` on need, which have just been made, and new links. Returns false where it was
// cancelled: then the elements are gone, and all is as before.
bool HierarchicalSolver::add_elements(const SolverJob& job, uint32_t first, std::vector<Link>& fresh) {
    Elements& elements = job.elements;
    Solution& solution = job.solution;
    solution.light.resize(elements.size());
    find_covered(elements, job.lighting(), first);
    light_elements(job.lighting(), first, std::span(solution.light).subspan(first));
    evaluate(job, fresh);
    mirrors_.add(job.lighting(), first, solution.light);
    if (job.cancelled) {
        elements.merge(first);
        mirrors_.merge(first);
        solution.light.resize(first);
        return false;
    }
    solution.irradiance.resize(elements.size(), Vec3d(0, 0, 0));
    solution.slopes.resize(elements.size(), {Vec3(0, 0, 0), Vec3(0, 0, 0)});
    add_nodes(job);
    return true;
}

// Returns whether there was anything to refine.
bool HierarchicalSolver::refine(const SolverJob& job) {
    Elements& elements = job.elements;
    const uint32_t old_size = elements.size();
    const Marks marks = mark(job);
    const bool by_error = job.settings.radiosity.link_ratio == 0;

    // Elements are divided in their order and in that of the links, by one thread: their numbers are always the same.
    std::vector<Link> kept, fresh;
    kept.reserve(links_.size());
    for (uint32_t i = 0; i < old_size; ++i)
        if (marks.uneven[i]) elements.divide(i);
    for (size_t l = 0; l < links_.size(); ++l) {
        const Link& link = links_[l];
        if (marks.parts[l] == Part::none) {
            kept.push_back(link);
            continue;
        }
        const NodeId split = marks.parts[l] == Part::receiver ? link.receiver : link.source;
        if (!is_cluster(split) && elements[split].leaf()) elements.divide(split);
        Link next = link;
        next.allowed = allowed(link.receiver, static_cast<double>(brightness_[l]));
        add_parts(elements, next, marks.parts[l], by_error ? kAtOnce : 1, fresh);
    }
    if (kept.size() == links_.size() && elements.size() == old_size) return false;
    balance(elements);
    if (!add_elements(job, old_size, fresh)) return false;
    kept.insert(kept.end(), fresh.begin(), fresh.end());
    links_.swap(kept);
    return true;
}

}  // namespace trp
