// The system (I − ρF) B = E, solved whole (Goral et al. 1984; Nishita and Nakamae 1985).
//
// It is kept in its symmetric form G_ij = A_i F_ij = A_j F_ji, one matrix for each colour where glass or mirrors tint
// what passes. Sampled rows are made symmetric, the row of more rays to the area counting for more, and scaled so that
// each keeps its sum, of which rays miss nothing: G ← D G D (Sinkhorn and Knopp 1967). What rays go on from has no part
// in that: how often they meet it varies far more than where they end. Others are scaled where their sum is above 1, as
// that of what sees two faces in one place.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "radiosity/form_factors.h"
#include "radiosity/subdivide.h"

namespace trp {
namespace {

constexpr double kSolved = 1e-10;   // residual, of the greatest radiosity
constexpr double kRowError = 1e-6;  // of the sum of a row of contour integrals

class MatrixSolver : public Solver {
  public:
    bool step(const SolverJob& job) override {
        if (solved_) return subdivision_.step(job);
        if (matrices_.empty() && !assemble(job)) return true;
        sweep(job);
        ++job.statistics.steps;
        solved_ = job.statistics.residual <= kSolved;
        return !solved_ || !subdivision_.is_whole(job.settings);
    }

    std::vector<double> row_sums(const Elements& elements) const override;

  private:
    bool assemble(const SolverJob& job);
    // Of what stands in the columns `of`.
    std::vector<double> sums_of(const std::vector<double>& matrix, const std::vector<uint8_t>& of) const;
    void make_symmetric(const Elements& elements, std::vector<double>& matrix) const;
    void scale(std::vector<double>& matrix, const std::vector<uint8_t>& of, const std::vector<double>& sums) const;
    void sweep(const SolverJob& job);

    size_t count_ = 0;
    std::vector<std::vector<double>> matrices_;  // one, or one to a colour
    std::vector<Vec3d> radiosity_;
    bool solved_ = false;
    Subdivision subdivision_;
};

bool MatrixSolver::assemble(const SolverJob& job) {
    const Elements& elements = job.elements;
    count_ = elements.size();
    const bool tinted = tints(elements.snapshot());
    const size_t colors = tinted ? 3 : 1, bytes = colors * count_ * count_ * sizeof(double);
    if (bytes >> 20 > job.settings.radiosity.memory)
        fail(TRP_ERROR_MEMORY,
             "a matrix of {0} x {0} form factors needs {1} MiB, and radiosity.memory allows {2}: choose a larger "
             "radiosity.element_size, or another solver",
             count_, bytes >> 20, job.settings.radiosity.memory);
    std::vector<std::vector<double>> matrices(colors, std::vector<double>(count_ * count_, 0.0));
    const bool halves = job.settings.radiosity.form_factors == FormFactors::analytic;
    const FormFactorJob rows{elements, job.settings.radiosity, job.settings.seed, &job.cancelled, &job.statistics.rays};
    std::atomic<size_t> done{0};
    parallel_ranges(count_, 1, [&](size_t begin, size_t end) {
        std::vector<Vec3d> row(count_);
        for (size_t i = begin; i < end && !job.cancelled; ++i) {
            const size_t first = halves ? i : 0;
            form_factor_row(rows, static_cast<uint32_t>(i), static_cast<uint32_t>(first), row.data());
            const double area = elements[static_cast<uint32_t>(i)].area;
            for (size_t c = 0; c < colors; ++c)
                for (size_t j = first; j < count_; ++j)
                    matrices[c][i * count_ + j] = row[j - first][static_cast<int>(c)] * area;
            job.fraction = static_cast<double>(++done) / static_cast<double>(count_);
        }
    });
    if (job.cancelled) return false;
    const std::vector<uint8_t> all(count_, 1);
    std::vector<uint8_t> ends(count_);  // of rays
    for (uint32_t i = 0; i < count_; ++i) {
        const Facet& facet = elements.facet_of(i);
        ends[i] = (elements.of_triangle(facet.slot, facet.triangle).flags & Elements::TriangleOf::kPass) == 0;
    }
    for (std::vector<double>& matrix : matrices) {
        if (!halves) {
            const std::vector<double> sums = sums_of(matrix, ends);
            make_symmetric(elements, matrix);
            scale(matrix, ends, sums);
            continue;
        }
        for (size_t i = 0; i < count_; ++i)
            for (size_t j = 0; j < i; ++j) matrix[i * count_ + j] = matrix[j * count_ + i];
        std::vector<double> sums = sums_of(matrix, all);
        bool above = false;
        for (size_t i = 0; i < count_; ++i) {
            const double area = elements[static_cast<uint32_t>(i)].area;
            above |= sums[i] > (1 + kRowError) * area;
            sums[i] = std::min(sums[i], area);
        }
        if (above && !tinted) scale(matrix, all, sums);
    }
    matrices_ = std::move(matrices);
    radiosity_.resize(count_);
    for (size_t i = 0; i < count_; ++i) radiosity_[i] = job.solution.emitted(static_cast<uint32_t>(i));
    return true;
}

std::vector<double> MatrixSolver::sums_of(const std::vector<double>& matrix, const std::vector<uint8_t>& of) const {
    std::vector<double> sums(count_, 0.0);
    parallel_ranges(count_, 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            for (size_t j = 0; j < count_; ++j)
                if (of[j]) sums[i] += matrix[i * count_ + j];
    });
    return sums;
}

void MatrixSolver::make_symmetric(const Elements& elements, std::vector<double>& matrix) const {
    for (size_t i = 0; i < count_; ++i)
        for (size_t j = 0; j < i; ++j) {
            const double a = elements[static_cast<uint32_t>(i)].area, b = elements[static_cast<uint32_t>(j)].area;
            double &ij = matrix[i * count_ + j], &ji = matrix[j * count_ + i];
            ij = ji = (b * ij + a * ji) / (a + b);
        }
}

// So that the rows `of` have the sums in these columns.
void MatrixSolver::scale(std::vector<double>& matrix, const std::vector<uint8_t>& of,
                         const std::vector<double>& sums) const {
    std::vector<double> scale(count_, 1.0);
    for (int round = 0; round < 50; ++round) {
        double worst = 0;
        std::vector<double> now(count_, 0.0);
        parallel_ranges(count_, 16, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i)
                for (size_t j = 0; j < count_; ++j)
                    if (of[i] && of[j]) now[i] += matrix[i * count_ + j] * scale[i] * scale[j];
        });
        for (size_t i = 0; i < count_; ++i) {
            if (!(now[i] > 0)) continue;
            worst = std::max(worst, std::abs(sums[i] / now[i] - 1));
            scale[i] *= std::sqrt(sums[i] / now[i]);
        }
        if (worst < 1e-12) break;
    }
    for (size_t i = 0; i < count_; ++i)
        for (size_t j = 0; j < count_; ++j) matrix[i * count_ + j] *= scale[i] * scale[j];
}

// Gauss and Seidel's method, colour by colour; the residual is that of the sweep's beginning.
void MatrixSolver::sweep(const SolverJob& job) {
    Solution& solution = job.solution;
    double residual[3] = {}, greatest[3] = {};
    parallel_ranges(3, 1, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
            const std::vector<double>& matrix = matrices_[std::min(c, matrices_.size() - 1)];
            const auto k = static_cast<int>(c);
            for (size_t i = 0; i < count_; ++i) {
                const auto element = static_cast<uint32_t>(i);
                const ElementLight& light = solution.light[element];
                const double* const row = &matrix[i * count_];
                double sum = 0;
                for (size_t j = 0; j < count_; ++j) sum += row[j] * radiosity_[j][k];
                const double area = job.elements[element].exposed_area(), irradiance = area > 0 ? sum / area : 0;
                const double before = radiosity_[i][k];
                solution.irradiance[i][k] = irradiance;
                radiosity_[i][k] =
                    solution.emitted(element)[k] + static_cast<double>(light.reflectance[k]) * irradiance;
                residual[c] = std::max(residual[c], std::abs(radiosity_[i][k] - before));
                greatest[c] = std::max(greatest[c], radiosity_[i][k]);
            }
        }
    });
    const double scale = std::max({greatest[0], greatest[1], greatest[2]});
    job.statistics.residual = scale > 0 ? std::max({residual[0], residual[1], residual[2]}) / scale : 0;
}

std::vector<double> MatrixSolver::row_sums(const Elements& elements) const {
    if (matrices_.empty()) return {};
    std::vector<double> out(count_, 0.0);
    for (size_t i = 0; i < count_; ++i) {
        for (const std::vector<double>& matrix : matrices_)
            for (size_t j = 0; j < count_; ++j) out[i] += matrix[i * count_ + j];
        const double area = elements[static_cast<uint32_t>(i)].exposed_area();
        out[i] = area > 0 ? out[i] / (area * static_cast<double>(matrices_.size())) : 0;
    }
    subdivision_.put_row_sums(out);
    return out;
}

}  // namespace

std::unique_ptr<Solver> make_matrix_solver() {
    return std::make_unique<MatrixSolver>();
}

}  // namespace trp
