// The hierarchical solver's beginning and its steps; see hierarchical.h.
#include "radiosity/hierarchical.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "radiosity/contacts.h"

namespace trp {
namespace {

constexpr float kSmallest = 1.0f / 1024;  // side of an element, of the scene's extent, where no size is given
constexpr float kLeastAtContacts = 4;     // of that, what walls that are thinner divide elements to

}  // namespace

HierarchicalSolver::Children HierarchicalSolver::children(const Elements& elements, NodeId id) const {
    if (is_cluster(id)) return {{clusters_.of(id).children[0], clusters_.of(id).children[1]}, 2};
    const uint32_t first = elements[id].first_child;
    return {{first, first + 1, first + 2, first + 3}, 4};
}

float HierarchicalSolver::extent(const Elements& elements, NodeId id) const {
    return is_cluster(id) ? 2 * clusters_.of(id).radius : std::sqrt(elements[id].area);
}

// Between the two halves of all clusters, or where there are none between all elements, both ways; within an element
// there are none.
std::vector<Link> HierarchicalSolver::first_links(const Elements& elements) const {
    std::vector<Link> out;
    for (uint32_t i = 0; i < elements.size() && clusters_.clusters.empty(); ++i)
        for (uint32_t j = 0; j < elements.size(); ++j)
            if (i != j && clusters_.may_see(elements, i, j)) out.push_back({i, j});
    for (const ElementCluster& cluster : clusters_.clusters) {
        const auto [a, b] = std::array{cluster.children[0], cluster.children[1]};
        if (!clusters_.may_see(elements, a, b)) continue;
        out.push_back({a, b});
        out.push_back({b, a});
    }
    return out;
}

bool HierarchicalSolver::begin(const SolverJob& job) {
    const Elements& elements = job.elements;
    clusters_ = make_element_clusters(elements);
    cluster_nodes_.assign(clusters_.clusters.size(), {});
    element_nodes_.clear();
    add_nodes(job);
    tops_.clear();
    if (!clusters_.clusters.empty())
        tops_.push_back(kClusterBit);
    else
        for (uint32_t i = 0; i < elements.size(); ++i) tops_.push_back(i);
    const float size = job.settings.radiosity.element_size,
                smallest = clusters_.clusters.empty() ? 0 : 2 * clusters_.clusters[0].radius * kSmallest;
    least_area_ = size > 0 ? size * size / 4 : smallest * smallest;
    // What is allowed to chance, by what surfaces emit.
    job.solution.slopes.assign(elements.size(), {Vec3(0, 0, 0), Vec3(0, 0, 0)});
    measure(job);
    std::vector<Link> links = first_links(elements);
    for (Link& link : links) link.allowed = allowed(link.receiver, brightness(node(link.source).radiosity.mean));
    mirrors_.add(job.lighting(), 0, job.solution.light);
    const uint32_t roots = elements.size();
    if (job.settings.radiosity.link_ratio == 0) {  // which goes by size and distance alone
        const float least = kLeastAtContacts * std::sqrt(least_area_);
        across_walls_ = divide_at(find_contacts(job.lighting()), least, job.elements);
        balance(job.elements);
    }
    if (!add_elements(job, roots, links)) return false;
    links_ = std::move(links);
    most_ = std::max(kMostLinks, 8 * size_t{roots}) + (elements.size() - roots);
    begun_ = true;
    return true;
}

void HierarchicalSolver::evaluate(const SolverJob& job, std::vector<Link>& links) const {
    parallel_ranges((links.size() + kLinkGrain - 1) / kLinkGrain, 1, [&](size_t begin, size_t end) {
        const auto evaluator = std::make_unique<LinkEvaluator>(job.elements, clusters_, job.settings.seed);
        for (size_t chunk = begin; chunk < end && !job.cancelled; ++chunk) {
            const size_t first = chunk * kLinkGrain, count = std::min(kLinkGrain, links.size() - first);
            job.statistics.rays += evaluator->evaluate({&links[first], count});
        }
    });
}

bool HierarchicalSolver::is_done(const SolverJob& job) const {
    return job.settings.radiosity.link_ratio == 0 && job.statistics.residual <= tolerance_ &&
           std::none_of(links_.begin(), links_.end(), [&](const Link& link) { return leads_across_walls(link); });
}

bool HierarchicalSolver::step(const SolverJob& job) {
    if (!begun_) {
        if (!begin(job)) return true;
    } else if (is_done(job) || is_full()) {
        return false;
    } else if (!refine(job)) {
        const bool wanted = job.settings.radiosity.link_ratio == 0 && job.statistics.residual > tolerance_;
        if (wanted && !job.cancelled) job.statistics.limit = SolverLimit::size;
        return job.cancelled;
    }
    solve(job);
    ++job.statistics.steps;
    job.statistics.links = links_.size();
    job.statistics.residual = std::sqrt(measure(job));
    job.statistics.wanted = tolerance_;
    if (is_done(job)) return false;
    if (is_full()) job.statistics.limit = SolverLimit::links;
    return !is_full();
}

void HierarchicalSolver::links(const Elements& elements, std::vector<ElementLink>& out) const {
    for (const Link& link : links_) {
        ElementLink shown{is_cluster(link.receiver) ? kNoElement : link.receiver,
                          is_cluster(link.source) ? kNoElement : link.source,
                          link.factor(),
                          {}};
        const NodeId ends[2] = {link.receiver, link.source};
        for (int k = 0; k < 2; ++k) shown.ends[k] = clusters_.centre(elements, ends[k]);
        out.push_back(shown);
    }
}

std::unique_ptr<Solver> make_hierarchical_solver() {
    return std::make_unique<HierarchicalSolver>();
}

}  // namespace trp
