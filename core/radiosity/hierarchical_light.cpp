// Light over the links of the hierarchy, down to its leaves and up again.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "radiosity/hierarchical.h"

namespace trp {
namespace {

constexpr uint32_t kMostSweeps = 500;
constexpr double kMostSum = 1.5;      // of an element's form factors; links that say more would make light of nothing
constexpr double kUnfinished = 0.02;  // of the tolerance, what a sweep may still have changed
constexpr size_t kRootGrain = 1024;   // roots that a thread takes at a time

}  // namespace

// What leaves the source of a link that has a cluster at an end.
NodeLight HierarchicalSolver::light_of_link(const Elements& elements, const Link& link) const {
    const Vec3 way = clusters_.centre(elements, link.receiver) - clusters_.centre(elements, link.source);
    NodeLight out = is_cluster(link.source) ? light_of(clusters_, link.source, &root_colors_, way.normalized())
                                            : light_of(elements, link.source, node(link.source).radiosity.mean);
    out.room += link.room;
    return out;
}

// The brightness that a link's error is for: parts may show themselves that do not from the middle of the receiver.
float HierarchicalSolver::shown(NodeId source, const NodeLight& light) const {
    return std::max(light.mean, static_cast<float>(brightness(node(source).radiosity.mean)));
}

// Links to clusters, which are the first ones, to the roots of those.
void HierarchicalSolver::light_clusters(const Elements& elements) {
    const std::vector<ElementCluster>& clusters = clusters_.clusters;
    if (clusters.empty()) return;
    root_colors_.resize(clusters_);
    root_light_.clear(clusters_);
    for (size_t k = 0; k < clusters_.roots.size(); ++k)
        root_colors_.set(k, element_nodes_[clusters_.roots[k]].radiosity.mean);
    to_clusters_.resize(first_link_[clusters.size()]);
    parallel_ranges(to_clusters_.size(), 64, [&](size_t begin, size_t end) {
        for (size_t l = begin; l < end; ++l) {
            to_clusters_[l] = light_of_link(elements, links_[l]);
            brightness_[l] = shown(links_[l].source, to_clusters_[l]);
        }
    });
    parallel_ranges((clusters_.roots.size() + kRootGrain - 1) / kRootGrain, 1, [&](size_t begin, size_t end) {
        const auto low = static_cast<uint32_t>(begin * kRootGrain),
                   high = static_cast<uint32_t>(std::min(end * kRootGrain, clusters_.roots.size()));
        for (size_t k = 0; k < clusters.size(); ++k) {
            const uint32_t first = std::max(clusters[k].first_root, low),
                           last = std::min(clusters[k].first_root + clusters[k].root_count, high);
            if (first >= last) {  // past all within it: with itself, one cluster less than its roots
                k += clusters[k].root_count - 2;
                continue;
            }
            for (size_t l = first_link_[k]; l < first_link_[k + 1]; ++l)
                receive(clusters_, to_clusters_[l], links_[l].tint * links_[l].share, first, last, root_light_);
        }
    });
}

void HierarchicalSolver::gather(const Elements& elements) {
    brightness_.resize(links_.size());
    light_clusters(elements);
    parallel_ranges(element_nodes_.size(), 256, [&](size_t begin, size_t end) {
        for (auto k = static_cast<uint32_t>(begin); k < end; ++k) {
            Linear sum;
            const PlaneAxes axes = axes_of(elements.facet_of(k));
            const size_t at = place(k);
            for (size_t l = first_link_[at]; l < first_link_[at + 1]; ++l) {
                const Link& link = links_[l];
                const Vec3d tint(link.tint);
                Vec3d* const rows[3] = {&sum.mean, &sum.x, &sum.y};
                if (is_cluster(link.source)) {
                    const NodeLight light = light_of_link(elements, link);
                    brightness_[l] = shown(link.source, light);
                    const Linear here = receive(elements, k, light, axes);
                    const Vec3d* const values[3] = {&here.mean, &here.x, &here.y};
                    for (size_t r = 0; r < 3; ++r) *rows[r] += tint * *values[r] * static_cast<double>(link.share);
                    continue;
                }
                const Linear& source = node(link.source).radiosity;
                brightness_[l] = static_cast<float>(brightness(source.mean));
                for (size_t r = 0; r < 3; ++r)
                    *rows[r] += tint * (source.mean * static_cast<double>(link.transfer[3 * r]) +
                                        source.x * static_cast<double>(link.transfer[3 * r + 1]) +
                                        source.y * static_cast<double>(link.transfer[3 * r + 2]));
            }
            gathered_[k] = sum;
            mirrored_[k] = mirrors_.irradiance(
                k, [&](uint32_t source) -> const Vec3d& { return element_nodes_[source].radiosity.mean; });
        }
    });
    parallel_ranges(clusters_.roots.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const uint32_t root = clusters_.roots[k];
            gathered_[root] += root_light_.at(k, axes_of(elements.facet_of(root)));
        }
    });
}

// What would arrive at each leaf from a radiosity of 1 everywhere.
void HierarchicalSolver::find_sums(const Elements& elements) {
    std::vector<Linear> kept;
    for (Node& n : element_nodes_) kept.push_back(std::exchange(n.radiosity, {{1, 1, 1}}));
    gather(elements);
    sums_.assign(elements.size(), 0);
    std::vector<Linear> above(elements.size());
    for (uint32_t i = 0; i < elements.size(); ++i) {  // wholes are before their parts
        element_nodes_[i].radiosity = kept[i];
        Linear& all = above[i];
        all += gathered_[i];
        sums_[i] = brightness(all.mean);
        for (uint32_t k = 0; k < 4 && !elements[i].leaf(); ++k) {
            const uint32_t child = elements[i].first_child + k;
            const Node& part = element_nodes_[child];
            above[child] = {all.mean + all.x * static_cast<double>(part.x) + all.y * static_cast<double>(part.y), all.x,
                            all.y};
        }
    }
}

// The nodes of elements that have none yet.
void HierarchicalSolver::add_nodes(const SolverJob& job) {
    const Elements& elements = job.elements;
    const size_t old_size = element_nodes_.size();
    element_nodes_.resize(elements.size());
    gathered_.resize(elements.size());
    mirrored_.resize(elements.size(), Vec3d(0, 0, 0));
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
    if (leaf < sums_.size() && sums_[leaf] > kMostSum) {
        const double share = kMostSum / sums_[leaf];
        arriving.mean *= share, arriving.x *= share, arriving.y *= share;
    }
    arriving.mean += mirrored_[leaf];
    // Lines of coarse elements may fall below 0 at a part's middle.
    for (int c = 0; c < 3; ++c) arriving.mean[c] = std::max(arriving.mean[c], 0.0);
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
    n.variance += light.texture * light.texture;  // which pictures have of the material itself
}

// Irradiance goes down to the leaves, radiosity comes up as the linear function that is closest to that of the parts,
// with their mean by area, so that no power is lost.
void HierarchicalSolver::push_pull(const SolverJob& job, NodeId id, const Linear& above, ErrorAbove error) {
    Node& n = node(id);
    Linear irradiance = above;
    if (!is_cluster(id)) irradiance += gathered_[id];
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

    find_sums(job.elements);
    double before = -1;
    for (uint32_t sweep = 0; sweep < kMostSweeps && !job.cancelled; ++sweep) {
        gather(job.elements);
        double now = 0, area = 0;
        for (const NodeId top : tops_) {
            push_pull(job, top, {}, {});
            const double own = clusters_.area(job.elements, top);
            now += own * brightness(node(top).radiosity.mean);
            area += own;
        }
        if (std::abs(now - before) <= std::max(1e-6 * now, kUnfinished * tolerance_ * area)) break;
        before = now;
    }
}

}  // namespace trp
