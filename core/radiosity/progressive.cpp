// Progressive refinement (Cohen, Chen, Wallace and Greenberg, "A Progressive Refinement Approach to Fast Radiosity
// Image Generation", 1988): the patch with the most unshot power shoots it at all elements, ΔH_j = ΔB_i F_ij A_i / A_j,
// and a picture is there after each step. Patches may be divided into the elements that receive (substructuring; Cohen,
// Greenberg, Immel and Brock 1986).
#include <algorithm>

#include "base/parallel.h"
#include "radiosity/form_factors.h"
#include "radiosity/subdivide.h"

namespace trp {
namespace {

constexpr double kSolved = 1e-3;  // the share of the power that is still unshot

class ProgressiveSolver : public Solver {
  public:
    bool step(const SolverJob& job) override;

  private:
    void begin(const SolverJob& job);
    // Return whether they were not cancelled, which leaves all as it was.
    bool shoot(const SolverJob& job, uint32_t patch);
    bool gather(const SolverJob& job, uint32_t element);
    bool measure(const SolverJob& job) const;
    template <class Take>
    void for_each_leaf(const Elements& elements, uint32_t element, Take&& take) const {
        if (elements[element].leaf()) return take(element);
        for (uint32_t k = 0; k < 4; ++k) for_each_leaf(elements, elements[element].first_child + k, take);
    }
    Vec3d unshot_of(const SolverJob& job, uint32_t patch) const {
        Vec3d sum(0, 0, 0);
        double area = 0;
        for_each_leaf(job.elements, patch, [&](uint32_t leaf) {
            sum += job.solution.unshot[leaf] * job.elements[leaf].exposed_area();
            area += job.elements[leaf].exposed_area();
        });
        return area > 0 ? sum / area : sum;
    }

    std::vector<uint32_t> patches_;
    uint32_t next_ = 0;  // patch of the unsorted orders
    std::vector<Vec3d> row_;
    bool solved_ = false;
    Subdivision subdivision_;
};

// Patches are the elements that are no part of another.
void ProgressiveSolver::begin(const SolverJob& job) {
    std::vector<uint8_t> is_part(job.elements.size(), 0);
    for (uint32_t i = 0; i < job.elements.size(); ++i)
        for (uint32_t k = 0; k < 4 && !job.elements[i].leaf(); ++k) is_part[job.elements[i].first_child + k] = 1;
    const bool gathers = job.settings.radiosity.order == RadiositySettings::Order::gathering;
    for (uint32_t i = 0; i < job.elements.size(); ++i)
        if (gathers ? job.elements[i].leaf() : !is_part[i]) patches_.push_back(i);
    Solution& solution = job.solution;
    solution.unshot.resize(job.elements.size());
    for (uint32_t i = 0; i < job.elements.size(); ++i) solution.unshot[i] = solution.emitted(i);
    row_.resize(job.elements.size());
}

bool ProgressiveSolver::shoot(const SolverJob& job, uint32_t patch) {
    const Elements& elements = job.elements;
    Solution& solution = job.solution;
    const Vec3d unshot = unshot_of(job, patch) * static_cast<double>(elements[patch].area);
    if (unshot == Vec3d(0, 0, 0)) return true;
    form_factor_row({elements, job.settings.radiosity, job.settings.seed + job.statistics.steps * 0x9E3779B9u,
                     &job.cancelled, &job.statistics.rays},
                    patch, 0, row_.data());
    if (job.cancelled) return false;
    // No more arrives than was shot.
    Vec3d sum(0, 0, 0);
    for (const Vec3d& factor : row_) sum += factor;
    const double most = tints(elements.snapshot()) ? 1 : std::max({sum.x, sum.y, sum.z, 1.0});
    const Vec3d shot = unshot / most;
    for_each_leaf(elements, patch, [&](uint32_t leaf) { solution.unshot[leaf] = Vec3d(0, 0, 0); });
    parallel_ranges(elements.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t j = begin; j < end; ++j) {
            const auto element = static_cast<uint32_t>(j);
            const double area = elements[element].exposed_area();
            if (!elements[element].leaf() || row_[j] == Vec3d(0, 0, 0) || area == 0) continue;
            const Vec3d arriving = row_[j] * shot / area;
            solution.irradiance[j] += arriving;
            solution.unshot[j] += solution.reflected(element, arriving);
        }
    });
    return true;
}

bool ProgressiveSolver::gather(const SolverJob& job, uint32_t element) {
    Solution& solution = job.solution;
    form_factor_row({job.elements, job.settings.radiosity, job.settings.seed, &job.cancelled, &job.statistics.rays},
                    element, 0, row_.data());
    if (job.cancelled) return false;
    Vec3d sum(0, 0, 0);
    for (uint32_t j = 0; j < job.elements.size(); ++j)
        if (row_[j] != Vec3d(0, 0, 0)) sum += row_[j] * solution.radiosity(j);
    const double exposed = job.elements[element].exposed();
    if (exposed > 0) sum = sum / exposed;
    // What is new in it, others have not gathered yet.
    solution.unshot[element] = solution.reflected(element, sum - solution.irradiance[element]);
    solution.irradiance[element] = sum;
    return true;
}

// The share of the power that is unshot, and the ambient light that stands for it (Cohen et al. 1988, eq. 12-15).
bool ProgressiveSolver::measure(const SolverJob& job) const {
    Solution& solution = job.solution;
    Vec3d unshot(0, 0, 0), all(0, 0, 0), reflectance(0, 0, 0);
    double area = 0;
    for (uint32_t i = 0; i < job.elements.size(); ++i) {
        if (!job.elements[i].leaf()) continue;
        const double a = job.elements[i].exposed_area();
        area += a;
        unshot += solution.unshot[i] * a;
        all += solution.radiosity(i) * a;
        reflectance += Vec3d(solution.light[i].reflectance) * a;
    }
    for (int c = 0; c < 3 && area > 0; ++c)
        solution.ambient[c] = unshot[c] / area / std::max(1 - reflectance[c] / area, 1e-3);
    job.statistics.residual = brightness(all) > 0 ? brightness(unshot) / brightness(all) : 0;
    const double tolerance = job.settings.radiosity.tolerance;
    return tolerance > 0 ? brightness(unshot) > tolerance * area : job.statistics.residual > kSolved;
}

bool ProgressiveSolver::step(const SolverJob& job) {
    if (solved_) return subdivision_.step(job);
    if (patches_.empty()) begin(job);
    if (patches_.empty()) return false;
    uint32_t chosen = patches_[next_ % patches_.size()];
    const auto order = job.settings.radiosity.order;
    if (order == RadiositySettings::Order::sorted) {
        double most = -1;
        for (const uint32_t patch : patches_) {
            const double unshot = brightness(unshot_of(job, patch)) * job.elements[patch].exposed_area();
            if (unshot > most) most = unshot, chosen = patch;
        }
    }
    if (!(order == RadiositySettings::Order::gathering ? gather(job, chosen) : shoot(job, chosen))) return true;
    ++next_;
    ++job.statistics.steps;
    solved_ = !measure(job);
    // Gathering knows only after a round of all elements what is left.
    if (order == RadiositySettings::Order::gathering) solved_ &= next_ % patches_.size() == 0;
    return !solved_ || !subdivision_.is_whole(job.settings);
}

}  // namespace

std::unique_ptr<Solver> make_progressive_solver() {
    return std::make_unique<ProgressiveSolver>();
}

}  // namespace trp
