// Light over the links of the hierarchy, down to its leaves and up again.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "radiosity/hierarchical.h"

namespace trp {
namespace {

constexpr uint32_t kMostSweeps = 500;

}  // namespace

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

}  // namespace trp
