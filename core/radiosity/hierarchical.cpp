// Hierarchical radiosity (Hanrahan, Salzman and Aupperle, "A Rapid Hierarchical Radiosity Algorithm", 1991): light goes
// over links between nodes of quad-trees, each as high up as the tolerance allows, and clusters above them.
//
// Light is linear over elements (Linear). A link's error is what no line follows of its irradiance over the receiver
// and of the source's radiosity within it, and for clusters, whose light goes no certain way, all that it carries;
// times the receiver's reflectance. The squares of all errors that come to an element are added up, and over the scene
// weighed by area. That is an estimate of the solution's error, in W/m², and each step refines the links that have more
// than an equal share of what the tolerance allows, along with the elements on which lamps shine unevenly, until it is
// below the tolerance. As light is gathered between the steps, links are refined for what they carry then
// (multigridding).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "radiosity/covered.h"
#include "radiosity/linear.h"
#include "radiosity/link_tree.h"
#include "radiosity/links.h"
#include "radiosity/mirror_rows.h"
#include "radiosity/solver.h"

namespace trp {
namespace {

constexpr size_t kGrain = 1024;      // links that a thread takes at a time
constexpr double kCoherent = 0.5;    // of what differs within a source, what is wrong the same way where half is hidden
constexpr double kUnevenness = 0.5;  // of a lamp's light over an element, what is left as an error
constexpr double kChance = 0.125;    // of the tolerance, what chance may do to what a link brings
constexpr uint32_t kMostSweeps = 500;
// Links and elements; then the solution is left as it is, and its residual says how good. Four times the elements that
// it begins with, where that is more.
constexpr size_t kMost = 1 << 19;
constexpr float kSmallest = 1.0f / 1024;  // side of an element, of the scene's extent, where no size is given

class HierarchicalSolver : public Solver {
  public:
    bool step(const SolverJob& job) override;
    void links(const Elements& elements, std::vector<ElementLink>& out) const override;
    std::vector<uint64_t> links_to(const Elements& elements, uint32_t leaf) const override {
        return links_to_leaf({elements, clusters_, links_}, leaf);
    }
    std::vector<double> row_sums(const Elements& elements) const override {
        return link_sums({elements, clusters_, links_}, [&](uint32_t i) {
            return std::array{element_nodes_[i].x, element_nodes_[i].y};
        });
    }

  private:
    struct Node {
        Linear radiosity, gathered;
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
    void gather();
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
    LinkError link_error(const Link& link) const;
    float allowed(const Link& link) const;
    double measure(const SolverJob& job);
    bool refine(const SolverJob& job);
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
    std::vector<NodeId> tops_;        // of the hierarchy
    std::vector<Link> links_;         // by receiver
    std::vector<size_t> first_link_;  // by place of the receiver, and the end
    MirrorRows mirrors_;
    std::vector<Vec3d> mirrored_;  // irradiance by mirrors, by element
    float least_area_ = 0;
    size_t most_ = kMost;
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
    job.solution.slopes.assign(elements.size(), {});
    measure(job);
    std::vector<Link> links = first_links(elements);
    for (Link& link : links) link.allowed = allowed(link);
    evaluate(job, links);
    mirrors_.add(job.lighting(), 0, job.solution.light);
    if (job.cancelled) return false;
    links_ = std::move(links);
    most_ = std::max(kMost, 4 * size_t{elements.size()});
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
        Linear sum;
        for (size_t l = first_link_[at]; l < first_link_[at + 1]; ++l) {
            const Link& link = links_[l];
            const Linear& source = node(link.source).radiosity;
            const Vec3d tint(link.tint);
            Vec3d* const rows[3] = {&sum.mean, &sum.x, &sum.y};
            for (size_t r = 0; r < 3; ++r)
                *rows[r] += tint * (source.mean * static_cast<double>(link.transfer[3 * r]) +
                                    source.x * static_cast<double>(link.transfer[3 * r + 1]) +
                                    source.y * static_cast<double>(link.transfer[3 * r + 2]));
        }
        node(id).gathered = sum;
    };
    parallel_ranges(cluster_nodes_.size(), 256, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) gather_node(static_cast<NodeId>(k) | kClusterBit);
    });
    mirrored_.resize(element_nodes_.size());
    parallel_ranges(element_nodes_.size(), 256, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            gather_node(static_cast<NodeId>(k));
            mirrored_[k] = mirrors_.irradiance(static_cast<uint32_t>(k), [&](uint32_t source) -> const Vec3d& {
                return element_nodes_[source].radiosity.mean;
            });
        }
    });
}

// The nodes of elements that have none yet.
void HierarchicalSolver::add_nodes(const SolverJob& job) {
    const Elements& elements = job.elements;
    const size_t old_size = element_nodes_.size();
    element_nodes_.resize(elements.size());
    for (auto i = static_cast<uint32_t>(old_size); i < elements.size(); ++i)
        element_nodes_[i].cell = plane_cell(elements, i);
    for (uint32_t i = 0; i < elements.size(); ++i) {
        const uint32_t first = elements[i].first_child;
        if (first == kNoElement || first < old_size) continue;
        const PlaneAxes axes = axes_of(elements.facet_of(i));
        float x = 0, y = 0, exposed = 0;  // the middle is that of what is not covered
        for (uint32_t k = first; k < first + 4; ++k) {
            const Vec3 way = elements[k].centre - elements[i].centre;
            element_nodes_[k].x = axes.x.dot(way);
            element_nodes_[k].y = axes.y.dot(way);
            const auto area = static_cast<float>(elements[k].exposed_area());
            x += element_nodes_[k].x * area;
            y += element_nodes_[k].y * area;
            exposed += area;
        }
        if (!(exposed > 0)) continue;
        x /= exposed, y /= exposed;
        for (uint32_t k = first; k < first + 4; ++k) element_nodes_[k].x -= x, element_nodes_[k].y -= y;
    }
}

// What a leaf gives for what arrives.
void HierarchicalSolver::set_leaf(const SolverJob& job, uint32_t leaf, Linear arriving, double error) {
    Solution& solution = job.solution;
    const ElementLight& light = solution.light[leaf];
    Node& n = element_nodes_[leaf];
    if (leaf < mirrored_.size()) arriving.mean += mirrored_[leaf];
    solution.irradiance[leaf] = arriving.mean;
    arriving += {Vec3d(light.irradiance), Vec3d(light.irradiance_x), Vec3d(light.irradiance_y)};
    // No light falls below 0.
    for (int c = 0; c < 3; ++c) {
        const double fall = n.cell.fall(arriving.x[c], arriving.y[c]);
        if (fall <= arriving.mean[c]) continue;
        const double share = std::max(arriving.mean[c], 0.0) / fall;
        arriving.x[c] *= share;
        arriving.y[c] *= share;
    }
    solution.slopes[leaf] = {Vec3(arriving.x), Vec3(arriving.y)};
    n.radiosity = {solution.radiosity(leaf), solution.reflected(leaf, arriving.x),
                   solution.reflected(leaf, arriving.y)};
    n.reflectance = std::max({light.reflectance.x, light.reflectance.y, light.reflectance.z});
    // The lamps' light within the leaf, and the error of what it gathers.
    const double uneven = kUnevenness * static_cast<double>(light.unevenness), reflectance = n.reflectance;
    n.variance = static_cast<float>(reflectance * reflectance * uneven * uneven);
    n.error = static_cast<float>(reflectance * reflectance * error) + n.variance;
}

// Irradiance goes down to the leaves, radiosity comes up as the linear function that is closest to that of the parts,
// with their mean by area, so that no power is lost.
void HierarchicalSolver::push_pull(const SolverJob& job, NodeId id, const Linear& above, ErrorAbove error) {
    Node& n = node(id);
    Linear irradiance = above;
    irradiance += n.gathered;
    error.squares += static_cast<double>(n.own_error);
    error.coherent += static_cast<double>(n.own_coherent);
    n.coherent = static_cast<float>(error.coherent);
    const Elements& elements = job.elements;
    Solution& solution = job.solution;
    if (!is_cluster(id) && elements[id].leaf()) {
        set_leaf(job, id, irradiance, error.squares + error.coherent * error.coherent);
        return;
    }
    const Children parts = children(elements, id);
    double area = 0, squares = 0, reflectance = 0, errors = 0;
    Linear sum;
    Vec3d arriving(0, 0, 0);
    for (uint32_t k = 0; k < parts.count; ++k) {
        const NodeId child = parts.ids[k];
        Node& part = node(child);
        const double a = is_cluster(child) ? clusters_.area(elements, child) : elements[child].exposed_area(),
                     x = part.x, y = part.y;
        if (is_cluster(id)) {
            push_pull(job, child, irradiance, error);
        } else {
            push_pull(job, child, {irradiance.mean + irradiance.x * x + irradiance.y * y, irradiance.x, irradiance.y},
                      error);
            const Moments& m = part.cell.moments;
            const Linear& b = part.radiosity;
            sum.x += (b.mean * x + b.x * m.xx + b.y * m.xy) * a;
            sum.y += (b.mean * y + b.x * m.xy + b.y * m.yy) * a;
            squares += a * m.of(brightness(b.x), brightness(b.y));
            arriving += solution.irradiance[child] * a;
        }
        const double bright = brightness(part.radiosity.mean);
        area += a;
        sum.mean += part.radiosity.mean * a;
        squares += a * (bright * bright + static_cast<double>(part.variance));
        reflectance += a * static_cast<double>(part.reflectance);
        errors += a * static_cast<double>(part.error);
    }
    if (!(area > 0)) return;
    n.radiosity.mean = sum.mean / area;
    const double mean = brightness(n.radiosity.mean);
    double explained = mean * mean;
    if (!is_cluster(id)) {
        const Moments fit = n.cell.moments.inverse();
        n.radiosity.x = (sum.x * fit.xx + sum.y * fit.xy) / area;
        n.radiosity.y = (sum.x * fit.xy + sum.y * fit.yy) / area;
        explained += n.cell.moments.of(brightness(n.radiosity.x), brightness(n.radiosity.y));
        solution.irradiance[id] = arriving / area;
    }
    n.variance = static_cast<float>(std::max(squares / area - explained, 0.0));
    n.reflectance = static_cast<float>(reflectance / area);
    n.error = static_cast<float>(errors / area);
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
            push_pull(job, top, {}, {});
            const double area = clusters_.area(job.elements, top);
            now += area * brightness(node(top).radiosity.mean);
        }
        if (std::abs(now - before) <= 1e-6 * now) break;
        before = now;
    }
}

// ------------------------------------------------------------------------------------------------------------- error

HierarchicalSolver::LinkError HierarchicalSolver::link_error(const Link& link) const {
    const Node& source = node(link.source);
    const double within = luminance(link.factor()) * std::sqrt(static_cast<double>(source.variance));
    return {static_cast<double>(link.spread) * brightness(source.radiosity.mean), within,
            kCoherent * within * static_cast<double>(link.hidden),
            static_cast<double>(link.chance) * brightness(source.radiosity.mean)};
}

// What chance may do to the factor of a link, or of those that take its place.
float HierarchicalSolver::allowed(const Link& link) const {
    const double carried =
        brightness(node(link.source).radiosity.mean) * static_cast<double>(node(link.receiver).reflectance);
    return static_cast<float>(kChance * tolerance_ / std::max(carried, 1e-30));
}

// The estimated mean square error of the solution, with the errors of all nodes.
double HierarchicalSolver::measure(const SolverJob& job) {
    for (auto* nodes : {&cluster_nodes_, &element_nodes_})
        for (Node& n : *nodes) n.own_error = n.own_coherent = 0;
    for (const Link& link : links_) {
        const LinkError error = link_error(link);
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

// ------------------------------------------------------------------------------------------------------------ refining

// Of shares of the squared error, the least of those to be refined, so that the rest is half of what is allowed
// (Dörfler, "A Convergent Adaptive Algorithm for Poisson's Equation", 1996).
double least_share(std::vector<double> shares, double allowed) {
    std::sort(shares.begin(), shares.end());
    double sum = 0;
    for (const double share : shares)
        if ((sum += share) > allowed / 2) return share;
    return std::numeric_limits<double>::infinity();
}

// The links and leaves that the error is mostly owed to. Returns whether there were any.
bool HierarchicalSolver::refine(const SolverJob& job) {
    Elements& elements = job.elements;
    const auto area_of = [&](NodeId id) { return static_cast<double>(clusters_.area(elements, id)); };
    const uint32_t old_size = elements.size();
    // What to do about a link: divide its receiver or its source, whichever its error is owed to and can be divided.
    enum class Part : uint8_t { none, receiver, source };
    const auto part_of = [&](const Link& link, const LinkError& error) {
        const bool receiver = is_cluster(link.receiver), source = is_cluster(link.source);
        if (receiver || source)
            return receiver && (!source || extent(elements, link.receiver) >= extent(elements, link.source))
                       ? Part::receiver
                       : Part::source;
        const bool receivers = !elements[link.receiver].leaf() || may_divide(elements, link.receiver),
                   sources = !elements[link.source].leaf();
        if (!receivers && !sources) return Part::none;
        return receivers && (!sources || error.over_receiver >= error.within_source + error.coherent + error.chance)
                   ? Part::receiver
                   : Part::source;
    };
    std::vector<Part> parts(links_.size(), Part::none);
    std::vector<double> shares(links_.size() + old_size, 0.0);
    parallel_ranges(links_.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t l = begin; l < end; ++l) {
            const Link& link = links_[l];
            const Node& to = node(link.receiver);
            const LinkError error = link_error(link);
            parts[l] = part_of(link, error);
            if (parts[l] != Part::none)
                shares[l] = (error.squares() + error.coherent * static_cast<double>(to.coherent)) *
                            static_cast<double>(to.reflectance * to.reflectance) * area_of(link.receiver);
        }
    });
    double* const uneven = &shares[links_.size()];
    for (uint32_t i = 0; i < old_size; ++i)
        if (elements[i].leaf() && may_divide(elements, i)) {
            const double error =
                kUnevenness * static_cast<double>(job.solution.light[i].unevenness * element_nodes_[i].reflectance);
            uneven[i] = error * error * area_of(i);
        }
    const double least = least_share(shares, tolerance_ * tolerance_ * elements.area());

    // Elements are divided in their order and in that of the links, by one thread: their numbers are always the same.
    std::vector<Link> kept, fresh;
    kept.reserve(links_.size());
    for (uint32_t i = 0; i < old_size; ++i)
        if (uneven[i] >= least) elements.divide(i);
    for (size_t l = 0; l < links_.size(); ++l) {
        const Link& link = links_[l];
        if (!(shares[l] >= least)) {
            kept.push_back(link);
            continue;
        }
        const bool by_receiver = parts[l] == Part::receiver;
        const NodeId split = by_receiver ? link.receiver : link.source;
        if (!is_cluster(split) && elements[split].leaf()) elements.divide(split);
        const Children below = children(elements, split);
        for (const NodeId part : std::span(below.ids, below.count)) {
            Link next{by_receiver ? part : link.receiver, by_receiver ? link.source : part};
            next.agreed = link.agreed / static_cast<float>(below.count);
            next.allowed = allowed(link);
            if (clusters_.may_see(elements, next.receiver, next.source)) fresh.push_back(next);
        }
    }
    if (kept.size() == links_.size() && elements.size() == old_size) return false;
    job.solution.light.resize(elements.size());
    job.solution.irradiance.resize(elements.size());
    find_covered(elements, job.lighting(), old_size);
    light_elements(job.lighting(), old_size, std::span(job.solution.light).subspan(old_size));
    evaluate(job, fresh);
    mirrors_.add(job.lighting(), old_size, job.solution.light);
    if (job.cancelled) {  // as if it had not begun
        elements.merge(old_size);
        mirrors_.merge(old_size);
        job.solution.light.resize(old_size);
        job.solution.irradiance.resize(old_size);
        return false;
    }
    job.solution.slopes.resize(elements.size());
    add_nodes(job);
    kept.insert(kept.end(), fresh.begin(), fresh.end());
    links_.swap(kept);
    return true;
}

bool HierarchicalSolver::step(const SolverJob& job) {
    if (!begun_) {
        if (!begin(job)) return true;
    } else if (job.statistics.residual <= tolerance_ || is_full() || !refine(job)) {
        return job.cancelled;
    }
    solve(job);
    ++job.statistics.steps;
    job.statistics.links = links_.size();
    job.statistics.residual = std::sqrt(measure(job));
    return job.statistics.residual > tolerance_ && !is_full();
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

}  // namespace

std::unique_ptr<Solver> make_hierarchical_solver() {
    return std::make_unique<HierarchicalSolver>();
}

}  // namespace trp
