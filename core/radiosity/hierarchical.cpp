// Hierarchical radiosity (Hanrahan, Salzman and Aupperle, "A Rapid Hierarchical Radiosity Algorithm", 1991): light goes
// over links between nodes of quad-trees, each as high up as the tolerance allows, and clusters above them.
//
// A link's error is what its irradiance differs by over the receiver, what the source's radiosity differs by within it,
// and for clusters, whose light goes no certain way, all that it carries; times the receiver's reflectance. The squares
// of all errors that come to an element are added up, and over the scene weighed by area. That is an estimate of the
// solution's error, in W/m², and each step refines the links that have more than an equal share of what the tolerance
// allows, along with the elements on which lamps shine unevenly, until it is below the tolerance. As light is gathered
// between the steps, links are refined for what they carry then (multigridding).
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "radiosity/links.h"
#include "radiosity/solver.h"

namespace trp {
namespace {

constexpr size_t kGrain = 1024;      // links that a thread takes at a time
constexpr double kUnevenness = 0.5;  // of a lamp's light over an element, what is left as an error
constexpr uint32_t kMostSweeps = 500;
constexpr size_t kMostLinks = 1 << 18;    // then the solution is left as it is; its residual says how good
constexpr float kSmallest = 1.0f / 1024;  // side of an element, of the scene's extent, where no size is given

// Whether a part of each of two elements lies before the other's plane.
bool may_see(const Elements& elements, uint32_t a, uint32_t b) {
    const auto reaches = [&](uint32_t from, uint32_t to) {
        const float height = (elements[to].centre - elements[from].centre).dot(elements.normal(from));
        return height > -elements.radius(to);
    };
    return reaches(a, b) && reaches(b, a);
}

class HierarchicalSolver : public Solver {
  public:
    bool step(const SolverJob& job) override;
    void links(const Elements& elements, std::vector<ElementLink>& out) const override;

  private:
    struct Node {
        Vec3d radiosity{0, 0, 0}, gathered{0, 0, 0};
        float variance = 0;     // of the brightness of its parts
        float reflectance = 0;  // the mean, of the brightest colour
        float error = 0;        // of what its leaves give, the mean of its squares
        float own_error = 0;    // of what its own links bring, squared
    };

    bool begin(const SolverJob& job);
    std::vector<Link> first_links(const Elements& elements) const;
    void evaluate(const SolverJob& job, std::vector<Link>& links) const;
    void solve(const SolverJob& job);
    void gather();
    void push_pull(const SolverJob& job, NodeId id, const Vec3d& above, double error_above);
    // Irradiance that a link may be wrong by, for what of it differs over the receiver and within the source.
    struct LinkError {
        double over_receiver, within_source;
        double sum() const { return over_receiver + within_source; }
    };
    LinkError link_error(const Link& link) const;
    double measure(const SolverJob& job);
    bool refine(const SolverJob& job);
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
    std::vector<NodeId> tops_;        // of the hierarchy
    std::vector<Link> links_;         // by receiver
    std::vector<size_t> first_link_;  // by place of the receiver, and the end
    float least_area_ = 0;
    bool begun_ = false;
    double tolerance_ = 0;
};

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
            if (i != j && may_see(elements, i, j)) out.push_back({i, j});
    for (const ElementCluster& cluster : clusters_.clusters) {
        const auto [a, b] = std::array{cluster.children[0], cluster.children[1]};
        out.push_back({a, b});
        out.push_back({b, a});
    }
    return out;
}

bool HierarchicalSolver::begin(const SolverJob& job) {
    const Elements& elements = job.elements;
    clusters_ = make_element_clusters(elements);
    cluster_nodes_.assign(clusters_.clusters.size(), {});
    element_nodes_.assign(elements.size(), {});
    tops_.clear();
    if (!clusters_.clusters.empty())
        tops_.push_back(kClusterBit);
    else
        for (uint32_t i = 0; i < elements.size(); ++i) tops_.push_back(i);
    const float size = job.settings.radiosity.element_size,
                smallest = clusters_.clusters.empty() ? 0 : 2 * clusters_.clusters[0].radius * kSmallest;
    least_area_ = size > 0 ? size * size / 4 : smallest * smallest;
    std::vector<Link> links = first_links(elements);
    evaluate(job, links);
    if (job.cancelled) return false;
    links_ = std::move(links);
    begun_ = true;
    return true;
}

void HierarchicalSolver::evaluate(const SolverJob& job, std::vector<Link>& links) const {
    parallel_ranges((links.size() + kGrain - 1) / kGrain, 1, [&](size_t begin, size_t end) {
        const auto evaluator = std::make_unique<LinkEvaluator>(job.elements, clusters_, job.settings.seed);
        for (size_t chunk = begin; chunk < end && !job.cancelled; ++chunk) {
            const size_t first = chunk * kGrain, count = std::min(kGrain, links.size() - first);
            job.statistics.rays += evaluator->evaluate({&links[first], count});
        }
    });
}

// ---------------------------------------------------------------------------------------------------------- solution

void HierarchicalSolver::gather() {
    const auto gather_node = [&](NodeId id) {
        const size_t at = place(id);
        Vec3d sum(0, 0, 0);
        for (size_t l = first_link_[at]; l < first_link_[at + 1]; ++l)
            sum += Vec3d(links_[l].factor) * node(links_[l].source).radiosity;
        node(id).gathered = sum;
    };
    parallel_ranges(cluster_nodes_.size(), 256, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) gather_node(static_cast<NodeId>(k) | kClusterBit);
    });
    parallel_ranges(element_nodes_.size(), 256, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) gather_node(static_cast<NodeId>(k));
    });
}

// Irradiance goes down to the leaves, radiosity comes up as the mean by area, so that no power is lost.
void HierarchicalSolver::push_pull(const SolverJob& job, NodeId id, const Vec3d& above, double error_above) {
    Node& n = node(id);
    const Vec3d irradiance = above + n.gathered;
    const double error = error_above + static_cast<double>(n.own_error);
    const Elements& elements = job.elements;
    Solution& solution = job.solution;
    if (!is_cluster(id) && elements[id].leaf()) {
        solution.irradiance[id] = irradiance;
        n.radiosity = solution.radiosity(id);
        const Vec3& rho = solution.light[id].reflectance;
        n.reflectance = std::max({rho.x, rho.y, rho.z});
        n.variance = 0;
        // The lamps' light within the leaf, and the error of what it gathers.
        const double uneven = kUnevenness * static_cast<double>(solution.light[id].unevenness),
                     reflectance = n.reflectance;
        n.error = static_cast<float>(reflectance * reflectance * (error + uneven * uneven));
        return;
    }
    const Children parts = children(elements, id);
    double area = 0, squares = 0, reflectance = 0, errors = 0;
    Vec3d radiosity(0, 0, 0), arriving(0, 0, 0);
    for (uint32_t k = 0; k < parts.count; ++k) {
        const NodeId child = parts.ids[k];
        push_pull(job, child, irradiance, error);
        const Node& part = node(child);
        const double a = clusters_.area(elements, child);
        const double bright = brightness(part.radiosity);
        area += a;
        radiosity += part.radiosity * a;
        squares += a * (bright * bright + static_cast<double>(part.variance));
        reflectance += a * static_cast<double>(part.reflectance);
        errors += a * static_cast<double>(part.error);
        if (!is_cluster(id)) arriving += solution.irradiance[child] * a;
    }
    n.radiosity = radiosity / area;
    const double mean = brightness(n.radiosity);
    n.variance = static_cast<float>(std::max(squares / area - mean * mean, 0.0));
    n.reflectance = static_cast<float>(reflectance / area);
    n.error = static_cast<float>(errors / area);
    if (!is_cluster(id)) solution.irradiance[id] = arriving / area;
}

// Sweeps of gathering until nothing changes that would matter.
void HierarchicalSolver::solve(const SolverJob& job) {
    const size_t places = clusters_.clusters.size() + element_nodes_.size();
    first_link_.assign(places + 1, 0);
    for (const Link& link : links_) ++first_link_[place(link.receiver) + 1];
    for (size_t p = 0; p < places; ++p) first_link_[p + 1] += first_link_[p];
    std::vector<Link> sorted(links_.size());
    std::vector<size_t> next(first_link_.begin(), first_link_.end() - 1);
    for (const Link& link : links_) sorted[next[place(link.receiver)]++] = link;
    links_.swap(sorted);

    double before = -1;
    for (uint32_t sweep = 0; sweep < kMostSweeps && !job.cancelled; ++sweep) {
        gather();
        double now = 0;
        for (const NodeId top : tops_) {
            push_pull(job, top, Vec3d(0, 0, 0), 0);
            const double area = clusters_.area(job.elements, top);
            now += area * brightness(node(top).radiosity);
        }
        if (std::abs(now - before) <= 1e-6 * now) break;
        before = now;
    }
}

// ------------------------------------------------------------------------------------------------------------- error

HierarchicalSolver::LinkError HierarchicalSolver::link_error(const Link& link) const {
    const Node& source = node(link.source);
    return {static_cast<double>(link.spread) * brightness(source.radiosity),
            luminance(link.factor) * std::sqrt(static_cast<double>(source.variance))};
}

// The estimated mean square error of the solution, with the errors of all nodes.
double HierarchicalSolver::measure(const SolverJob& job) {
    for (auto* nodes : {&cluster_nodes_, &element_nodes_})
        for (Node& n : *nodes) n.own_error = 0;
    for (const Link& link : links_) {
        const double error = link_error(link).sum();
        node(link.receiver).own_error += static_cast<float>(error * error);
    }
    for (const NodeId top : tops_) push_pull(job, top, Vec3d(0, 0, 0), 0);
    double sum = 0, area = 0, power = 0;
    for (uint32_t i = 0; i < job.elements.size(); ++i) {
        if (!job.elements[i].leaf()) continue;
        const double a = job.elements[i].area;
        sum += a * static_cast<double>(element_nodes_[i].error);
        area += a;
        power += a * brightness(element_nodes_[i].radiosity);
    }
    tolerance_ = job.settings.radiosity.tolerance;
    if (!(tolerance_ > 0)) tolerance_ = area > 0 ? 0.01 * power / area : 0;
    return area > 0 ? sum / area : 0;
}

// ------------------------------------------------------------------------------------------------------------ refining

// The links and leaves that have more than an equal share of the error that is allowed, which is the sum over all of
// what each has to do with it. Returns whether there were any.
bool HierarchicalSolver::refine(const SolverJob& job) {
    Elements& elements = job.elements;
    const auto area_of = [&](NodeId id) { return static_cast<double>(clusters_.area(elements, id)); };
    const uint32_t old_size = elements.size();
    const double least = tolerance_ * tolerance_ * elements.area() / static_cast<double>(links_.size() + old_size);
    // What to do about a link: divide its receiver or its source, whichever its error is owed to and can be divided.
    enum class Part : uint8_t { none, receiver, source };
    const auto part_of = [&](const Link& link) {
        const Node& to = node(link.receiver);
        const double weight = static_cast<double>(to.reflectance * to.reflectance) * area_of(link.receiver);
        const auto matters = [&](double error) { return error * error * weight > least; };
        const LinkError error = link_error(link);
        if (!matters(error.sum())) return Part::none;
        const bool receiver = is_cluster(link.receiver), source = is_cluster(link.source);
        if (receiver || source)
            return receiver && (!source || extent(elements, link.receiver) >= extent(elements, link.source))
                       ? Part::receiver
                       : Part::source;
        const bool divisible = !elements[link.receiver].leaf() || may_divide(elements, link.receiver);
        if (divisible && error.over_receiver >= error.within_source) return Part::receiver;
        if (elements[link.source].leaf()) return divisible ? Part::receiver : Part::none;
        return matters(error.within_source) ? Part::source : Part::none;
    };
    const auto is_uneven = [&](uint32_t leaf) {
        const double error =
            kUnevenness * static_cast<double>(job.solution.light[leaf].unevenness * element_nodes_[leaf].reflectance);
        return elements[leaf].leaf() && may_divide(elements, leaf) && error * error * area_of(leaf) > least;
    };
    std::vector<Part> parts(links_.size());
    parallel_ranges(links_.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t l = begin; l < end; ++l) parts[l] = part_of(links_[l]);
    });

    // Elements are divided in their order and in that of the links, by one thread: their numbers are always the same.
    std::vector<Link> kept, fresh;
    kept.reserve(links_.size());
    for (uint32_t i = 0; i < old_size; ++i)
        if (is_uneven(i)) elements.divide(i);
    for (size_t l = 0; l < links_.size(); ++l) {
        const Link& link = links_[l];
        if (parts[l] == Part::none) {
            kept.push_back(link);
            continue;
        }
        const bool by_receiver = parts[l] == Part::receiver;
        const NodeId split = by_receiver ? link.receiver : link.source;
        if (!is_cluster(split) && elements[split].leaf()) elements.divide(split);
        const Children below = children(elements, split);
        for (const NodeId part : std::span(below.ids, below.count)) {
            const Link next = by_receiver ? Link{part, link.source} : Link{link.receiver, part};
            if (is_cluster(next.receiver) || is_cluster(next.source) || may_see(elements, next.receiver, next.source))
                fresh.push_back(next);
        }
    }
    if (kept.size() == links_.size() && elements.size() == old_size) return false;
    job.solution.light.resize(elements.size());
    job.solution.irradiance.resize(elements.size());
    element_nodes_.resize(elements.size());
    light_elements(job.lighting(), old_size, std::span(job.solution.light).subspan(old_size));
    evaluate(job, fresh);
    if (job.cancelled) {  // as if it had not begun
        elements.merge(old_size);
        job.solution.light.resize(old_size);
        job.solution.irradiance.resize(old_size);
        element_nodes_.resize(old_size);
        return false;
    }
    kept.insert(kept.end(), fresh.begin(), fresh.end());
    links_.swap(kept);
    return true;
}

bool HierarchicalSolver::step(const SolverJob& job) {
    if (!begun_) {
        if (!begin(job)) return true;
    } else if (job.statistics.residual <= tolerance_ || links_.size() > kMostLinks || !refine(job)) {
        return job.cancelled;
    }
    solve(job);
    ++job.statistics.steps;
    job.statistics.links = links_.size();
    job.statistics.residual = std::sqrt(measure(job));
    return job.statistics.residual > tolerance_ && links_.size() <= kMostLinks;
}

void HierarchicalSolver::links(const Elements& elements, std::vector<ElementLink>& out) const {
    for (const Link& link : links_) {
        ElementLink shown{is_cluster(link.receiver) ? kNoElement : link.receiver,
                          is_cluster(link.source) ? kNoElement : link.source,
                          link.factor,
                          {}};
        const NodeId ends[2] = {link.receiver, link.source};
        for (int k = 0; k < 2; ++k) shown.ends[k] = clusters_.centre(elements, ends[k]);
        out.push_back(shown);
    }
}

}  // namespace

std::unique_ptr<Solver> make_hierarchical_solver() {
    return std::make_unique<HierarchicalSolver>();
}

}  // namespace trp
