// What the solvers of radiosity have in common. Each advances a solution step by step: B = E + ρ H, with the irradiance
// H of lamps and of other elements (Goral et al., "Modeling the Interaction of Light Between Diffuse Surfaces", 1984,
// eq. 5). A solution is valid after each step, and where a step was cancelled.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>

#include "film/settings.h"
#include "radiosity/element_light.h"

namespace trp {

// As luminance(), of what solvers keep.
inline double brightness(const Vec3d& v) {
    return 0.2126 * v.x + 0.7152 * v.y + 0.0722 * v.z;
}

// By element, divided ones too, whose values are means of their parts.
struct Solution {
    std::vector<ElementLight> light;
    std::vector<Vec3d> irradiance;  // of other elements, W/m²
    // Hierarchical: of all light that arrives, what it changes by per metre along the facet's axes (Linear); else
    // empty.
    std::vector<std::array<Vec3, 2>> slopes;
    std::vector<Vec3d> unshot;  // progressive: radiosity that has not been shot yet, W/m²; else empty
    Vec3d ambient{0, 0, 0};     // progressive: irradiance that stands for what is unshot, for display

    Vec3d reflected(uint32_t i, const Vec3d& arriving) const { return Vec3d(light[i].reflectance) * arriving; }
    Vec3d emitted(uint32_t i) const { return Vec3d(light[i].emission) + reflected(i, Vec3d(light[i].irradiance)); }
    Vec3d radiosity(uint32_t i) const { return emitted(i) + reflected(i, irradiance[i]); }
};

// Why a solver ended before what was asked for; TRP_LIMIT_….
enum class SolverLimit : int32_t { none, links, size };

struct SolverStatistics {
    std::atomic<uint64_t> rays{0};
    std::atomic<uint32_t> steps{0};  // read while the solver runs
    uint64_t links = 0;
    double residual = 0;  // of the equation, or the estimated error, or the share that is unshot: as the solver says
    double wanted = 0;    // the residual that was asked for, where the solver may have to end before
    SolverLimit limit = SolverLimit::none;
};

struct SolverJob {
    Elements& elements;
    Solution& solution;
    const Settings& settings;
    SolverStatistics& statistics;
    std::atomic<bool>& cancelled;
    std::atomic<double>& fraction;  // of the step, 0 to 1

    LightingJob lighting() const {
        return {elements, settings.illumination, settings.seed, &cancelled, &statistics.rays};
    }
};

struct ElementLink {
    uint32_t receiver, source;  // elements; kNoElement: a group of them
    Vec3 factor;                // irradiance at the receiver for a radiosity of 1
    Vec3 ends[2];               // middles, relative to the origin
    int32_t level = -1;         // how often the receiver's facet was divided; −1: a group
};

class Solver {
  public:
    virtual ~Solver() = default;
    // One step, in the current arena. Returns whether there is more to do.
    virtual bool step(const SolverJob& job) = 0;
    virtual void links(const Elements&, std::vector<ElementLink>&) const {}
    // Of those, by number, what brings light to a leaf: links to it, and to what it is a part of.
    virtual std::vector<uint64_t> links_to(const Elements&, uint32_t /*leaf*/) const { return {}; }
    // Of each leaf, the sum of its form factors as the solver has them; empty where it has none.
    virtual std::vector<double> row_sums(const Elements&) const { return {}; }
};

std::unique_ptr<Solver> make_matrix_solver();
std::unique_ptr<Solver> make_progressive_solver();
std::unique_ptr<Solver> make_hierarchical_solver();

}  // namespace trp
