// Progressive refinement (Cohen, Chen, Wallace and Greenberg, "A Progressive Refinement Approach to Fast Radiosity
// Image Generation", 1988): the patch with the most unshot power shoots it at all elements, ΔH_j = ΔB_i F_ij A_i / A_j,
// and a picture is there after each step. Patches may be divided into the elements that receive (substructuring; Cohen,
// Greenberg, Immel and Brock 1986).
#include <algorithm>
#include <optional>

#include "base/parallel.h"
#include "radiosity/hemisphere_row.h"
#include "radiosity/subdivide.h"

namespace trp {
namespace {

constexpr double kSolved = 1e-3;   // the share of the power that is still unshot
constexpr size_t kInChunk = 1024;  // elements, or patches, whose values are summed in a row

size_t chunks_of(size_t count) {
    return (count + kInChunk - 1) / kInChunk;
}
template <class Visit>
void for_each_in(size_t chunk, size_t count, Visit&& visit) {
    for (size_t k = chunk * kInChunk; k < std::min(count, (chunk + 1) * kInChunk); ++k) visit(k);
}

class ProgressiveSolver : public Solver {
  public:
    bool step(const SolverJob& job) override;

  private:
    void begin(const SolverJob& job);
    // Return whether they were not cancelled, which leaves all as it was.
    bool shoot(const SolverJob& job, uint32_t patch);
    bool gather(const SolverJob& job, uint32_t element);
    template <class FactorTo>
    void distribute(const SolverJob& job, const Vec3d& shot, FactorTo&& factor_to);
    void look(const SolverJob& job, size_t chunk);
    void look_at_all(const SolverJob& job);
    bool measure(const SolverJob& job) const;
    template <class Take>
    void for_each_leaf(const Elements& elements, uint32_t element, Take&& take) const {
        if (elements.leaf(element)) return take(element);
        for (uint32_t k = 0; k < 4; ++k) for_each_leaf(elements, elements[element].first_child + k, take);
    }
    // What a patch's leaves have to shoot.
    struct Unshot {
        Vec3d power{0, 0, 0};
        double area = 0;
    };
    Unshot unshot_of(const SolverJob& job, uint32_t patch) const {
        Unshot sum;
        for_each_leaf(job.elements, patch, [&](uint32_t leaf) {
            sum.power += job.solution.unshot[leaf] * exposed_[leaf];
            sum.area += exposed_[leaf];
        });
        return sum;
    }

    // Of a chunk of the patches.
    struct Look {
        Vec3d unshot{0, 0, 0};   // power
        double most = -1;        // as brightness, which a patch has to shoot
        uint32_t brightest = 0;  // patch
    };

    std::vector<uint32_t> patches_;
    uint32_t next_ = 0;  // patch of the unsorted orders
    std::vector<Look> looks_;
    std::vector<double> exposed_;  // area of each element
    // Sums over all leaves.
    double area_ = 0;                      // exposed
    Vec3d radiated_{0, 0, 0};              // radiosity times area
    Vec3d reflectance_{0, 0, 0};           // times area
    std::optional<HemisphereRow> counts_;  // where shots are rays
    std::vector<Vec3d> row_;               // and where not
    bool solved_ = false;
    Subdivision subdivision_;
};

// Patches are the elements that are no part of another.
void ProgressiveSolver::begin(const SolverJob& job) {
    const Elements& elements = job.elements;
    std::vector<uint8_t> is_part(elements.size(), 0);
    for (uint32_t i = 0; i < elements.size(); ++i)
        for (uint32_t k = 0; k < 4 && !elements.leaf(i); ++k) is_part[elements[i].first_child + k] = 1;
    const bool gathers = job.settings.radiosity.order == RadiositySettings::Order::gathering;
    for (uint32_t i = 0; i < elements.size(); ++i)
        if (gathers ? elements.leaf(i) : !is_part[i]) patches_.push_back(i);
    Solution& solution = job.solution;
    solution.unshot.resize(elements.size());
    exposed_.resize(elements.size());
    for (uint32_t i = 0; i < elements.size(); ++i) {
        solution.unshot[i] = solution.emitted(i);
        exposed_[i] = elements[i].exposed_area();
        if (!elements.leaf(i)) continue;
        area_ += exposed_[i];
        radiated_ += solution.radiosity(i) * exposed_[i];
        reflectance_ += Vec3d(solution.light[i].reflectance) * exposed_[i];
    }
    if (job.settings.radiosity.form_factors == FormFactors::hemisphere && !gathers)
        counts_.emplace(elements);
    else
        row_.resize(elements.size());
    looks_.resize(chunks_of(patches_.size()));
    look_at_all(job);
}

bool ProgressiveSolver::shoot(const SolverJob& job, uint32_t patch) {
    const Elements& elements = job.elements;
    const Unshot unshot = unshot_of(job, patch);
    if (unshot.power == Vec3d(0, 0, 0)) return true;
    const FormFactorJob row{elements, job.settings.radiosity, job.settings.seed + job.statistics.steps * 0x9E3779B9u,
                            &job.cancelled, &job.statistics.rays};
    double most = 1;
    if (counts_) {
        if (!counts_->trace(row, patch, false)) return false;
    } else {
        form_factor_row(row, patch, 0, row_.data());
        if (job.cancelled) return false;
        // No more arrives than was shot.
        Vec3d sum(0, 0, 0);
        for (const Vec3d& factor : row_) sum += factor;
        if (!tints(elements.snapshot())) most = std::max({sum.x, sum.y, sum.z, 1.0});
    }
    const Vec3d shot = unshot.power / unshot.area * static_cast<double>(elements[patch].area) / most;
    for_each_leaf(elements, patch, [&](uint32_t leaf) { job.solution.unshot[leaf] = Vec3d(0, 0, 0); });
    if (counts_)
        distribute(job, shot, [&](uint32_t j) { return counts_->take(j); });
    else
        distribute(job, shot, [&](uint32_t j) { return row_[j]; });
    return true;
}

template <class FactorTo>
void ProgressiveSolver::distribute(const SolverJob& job, const Vec3d& shot, FactorTo&& factor_to) {
    Solution& solution = job.solution;
    const bool divided = patches_.size() != exposed_.size();
    std::vector<Vec3d> reflected(chunks_of(exposed_.size()), Vec3d(0, 0, 0));
    parallel_ranges(reflected.size(), 1, [&](size_t begin, size_t end) {
        for (size_t chunk = begin; chunk < end; ++chunk) {
            for_each_in(chunk, exposed_.size(), [&](size_t j) {
                const auto element = static_cast<uint32_t>(j);
                const Vec3d factor = factor_to(element);
                if (factor == Vec3d(0, 0, 0) || exposed_[j] == 0) return;
                const Vec3d power = factor * shot, of_it = solution.reflected(element, power);
                const double per_area = 1 / exposed_[j];
                solution.irradiance[j] += power * per_area;
                solution.unshot[j] += of_it * per_area;
                reflected[chunk] += of_it;
            });
            if (!divided) look(job, chunk);  // while it is in the caches
        }
    });
    for (const Vec3d& power : reflected) radiated_ += power;
    if (divided) look_at_all(job);
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
    radiated_ += solution.unshot[element] * exposed_[element];
    look(job, next_ % patches_.size() / kInChunk);
    return true;
}

void ProgressiveSolver::look(const SolverJob& job, size_t chunk) {
    Look sum;
    for_each_in(chunk, patches_.size(), [&](size_t k) {
        const uint32_t patch = patches_[k];
        const Unshot unshot = unshot_of(job, patch);
        sum.unshot += unshot.power;
        const double share = unshot.area == exposed_[patch] ? 1 : exposed_[patch] / unshot.area;
        const double power = brightness(unshot.power) * share;
        if (power > sum.most) sum.most = power, sum.brightest = patch;
    });
    looks_[chunk] = sum;
}

void ProgressiveSolver::look_at_all(const SolverJob& job) {
    parallel_ranges(looks_.size(), 1, [&](size_t begin, size_t end) {
        for (size_t chunk = begin; chunk < end; ++chunk) look(job, chunk);
    });
}

// The share of the power that is unshot, and the ambient light that stands for it (Cohen et al. 1988, eq. 12-15).
bool ProgressiveSolver::measure(const SolverJob& job) const {
    Vec3d all(0, 0, 0);
    for (const Look& of : looks_) all += of.unshot;
    for (int c = 0; c < 3 && area_ > 0; ++c)
        job.solution.ambient[c] = all[c] / area_ / std::max(1 - reflectance_[c] / area_, 1e-3);
    const double unshot = brightness(all), radiated = brightness(radiated_);
    job.statistics.residual = radiated > 0 ? unshot / radiated : 0;
    const double tolerance = job.settings.radiosity.tolerance;
    job.statistics.wanted = tolerance > 0 ? tolerance * area_ / std::max(radiated, 1e-300) : kSolved;
    return job.statistics.residual > job.statistics.wanted;
}

bool ProgressiveSolver::step(const SolverJob& job) {
    if (solved_) return subdivision_.step(job);
    if (patches_.empty()) begin(job);
    if (patches_.empty()) return false;
    uint32_t chosen = patches_[next_ % patches_.size()];
    const auto order = job.settings.radiosity.order;
    if (order == RadiositySettings::Order::sorted) {
        double most = -1;
        for (const Look& of : looks_)
            if (of.most > most) most = of.most, chosen = of.brightest;
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
