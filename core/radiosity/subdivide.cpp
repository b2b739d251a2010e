#include "radiosity/subdivide.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "radiosity/covered.h"
#include "radiosity/form_factors.h"
#include "radiosity/vertices.h"

namespace trp {
namespace {

constexpr double kMeanShare = 0.01;  // of the mean radiosity, the tolerance where none is given
constexpr double kAllowed = 2;       // tolerances that what is shown of an element may be off by
constexpr double kLarge = 0.01;      // of all area: an element that is divided where no neighbour tells how light runs

double tolerance_of(const SolverJob& job) {
    const double tolerance = job.settings.radiosity.tolerance;
    if (tolerance > 0) return tolerance;
    double power = 0, area = 0;
    for (uint32_t i = 0; i < job.elements.size(); ++i) {
        if (!job.elements[i].leaf()) continue;
        power += brightness(job.solution.radiosity(i)) * job.elements[i].exposed_area();
        area += job.elements[i].exposed_area();
    }
    return area > 0 ? kMeanShare * power / area : 0;
}

// The leaves to be divided, in their order. Where light changes evenly, what an element gets is the mean of what is
// interpolated at its corners from it and its neighbours; what these differ by is about what the picture is wrong by,
// and a quarter of a step from light to shadow, as the unevenness of a lamp's light is where an edge crosses.
std::vector<uint32_t> uneven(const SolverJob& job) {
    const Elements& elements = job.elements;
    const Solution& solution = job.solution;
    const ElementVertices vertices(elements);
    std::vector<Vec3> arriving(elements.size(), Vec3(0, 0, 0));
    std::vector<uint32_t> neighbours(vertices.vertices().size(), 0);
    for (uint32_t i = 0; i < elements.size(); ++i) {
        if (!elements[i].leaf()) continue;
        arriving[i] = Vec3(solution.irradiance[i]) + solution.light[i].irradiance;
        for (const uint32_t v : vertices.around(i)) ++neighbours[v];
    }
    const std::vector<Vec3> at_vertices = vertices.average(elements, arriving, {});
    const double allowed = kAllowed * tolerance_of(job), large = kLarge * elements.area();
    std::vector<uint32_t> out;
    for (uint32_t i = 0; i < elements.size(); ++i) {
        if (!elements[i].leaf() || elements[i].covered == kAllCovered) continue;
        if (elements.facet_of(i).shape == Facet::Shape::polygon) continue;
        const ElementLight& light = solution.light[i];
        const auto around = vertices.around(i);
        Vec3 sum(0, 0, 0);
        bool alone = true;
        for (const uint32_t v : around) {
            sum += at_vertices[v];
            alone &= neighbours[v] == 1;
        }
        const Vec3 off = sum / static_cast<float>(around.size()) - arriving[i];
        const float reflectance = std::max({light.reflectance.x, light.reflectance.y, light.reflectance.z}),
                    error = reflectance * std::max(std::abs(luminance(off)), light.unevenness);
        if (static_cast<double>(error) > allowed || elements[i].covered != 0 ||
            (alone && reflectance > 0 && allowed > 0 && static_cast<double>(elements[i].area) > large))
            out.push_back(i);
    }
    return out;
}

// All that has parts has their mean. Parts come after what they are parts of.
void take_means(const Elements& elements, Solution& solution) {
    for (uint32_t i = elements.size(); i-- > 0;) {
        if (elements[i].leaf()) continue;
        Vec3d sum(0, 0, 0);
        double area = 0;
        for (uint32_t k = elements[i].first_child; k < elements[i].first_child + 4; ++k) {
            sum += solution.irradiance[k] * elements[k].exposed_area();
            area += elements[k].exposed_area();
        }
        if (area > 0) solution.irradiance[i] = sum / area;
    }
}

}  // namespace

// The irradiance of the elements from number `first` on. Returns whether it was not cancelled.
bool Subdivision::gather(const SolverJob& job, uint32_t first) {
    const Elements& elements = job.elements;
    Solution& solution = job.solution;
    const uint32_t size = elements.size();
    std::vector<Vec3d> radiosity(size, Vec3d(0, 0, 0)), irradiance(size - first, Vec3d(0, 0, 0));
    std::vector<double> sums(size - first);
    for (uint32_t i = 0; i < size; ++i)
        if (elements[i].leaf()) radiosity[i] = solution.radiosity(i);
    const bool tinted = tints(elements.snapshot());
    const FormFactorJob rows{elements, job.settings.radiosity, job.settings.seed, &job.cancelled, &job.statistics.rays};
    std::atomic<size_t> done{0};
    parallel_ranges(irradiance.size(), 1, [&](size_t begin, size_t end) {
        std::vector<Vec3d> row(size);
        for (size_t k = begin; k < end && !job.cancelled; ++k) {
            const auto element = first + static_cast<uint32_t>(k);
            job.fraction = static_cast<double>(++done) / static_cast<double>(irradiance.size());
            const double exposed = elements[element].exposed();
            if (!(exposed > 0)) continue;
            form_factor_row(rows, element, 0, row.data());
            Vec3d sum(0, 0, 0), arriving(0, 0, 0);
            for (uint32_t j = 0; j < size; ++j) {
                if (row[j] == Vec3d(0, 0, 0)) continue;
                sum += row[j];
                arriving += row[j] * radiosity[j];
            }
            // What sees faces in one place twice, or by chance too much, gets no more than there is.
            sum = sum / exposed;
            arriving = arriving / exposed;
            const double most = tinted ? 1 : std::max({sum.x, sum.y, sum.z, 1.0});
            irradiance[k] = arriving / most;
            sums[k] = (sum.x + sum.y + sum.z) / (3 * most);
        }
    });
    if (job.cancelled) return false;
    std::copy(irradiance.begin(), irradiance.end(), solution.irradiance.begin() + first);
    if (sums_.empty()) first_ = first;
    sums_.insert(sums_.end(), sums.begin(), sums.end());
    return true;
}

bool Subdivision::step(const SolverJob& job) {
    if (is_whole(job.settings)) return false;
    Elements& elements = job.elements;
    Solution& solution = job.solution;
    const uint32_t old_size = elements.size();
    const std::vector<uint32_t> chosen = uneven(job);
    if (chosen.empty()) {
        level_ = job.settings.radiosity.subdivisions;
        return false;
    }
    const auto resize = [&](uint32_t size) {
        solution.light.resize(size);
        solution.irradiance.resize(size);
        if (!solution.unshot.empty()) solution.unshot.resize(size);
    };
    for (const uint32_t i : chosen) elements.divide(i);
    resize(elements.size());
    find_covered(elements, job.lighting(), old_size);
    light_elements(job.lighting(), old_size, std::span(solution.light).subspan(old_size));
    // Until they have gathered, they shine as what they are parts of, in their own lamps' light.
    for (const uint32_t i : chosen)
        for (uint32_t k = elements[i].first_child; k < elements[i].first_child + 4; ++k) {
            solution.irradiance[k] = solution.irradiance[i];
            if (!solution.unshot.empty()) solution.unshot[k] = solution.unshot[i];
        }
    if (!gather(job, old_size)) {
        elements.merge(old_size);
        resize(old_size);
        return true;
    }
    take_means(elements, solution);
    ++level_;
    ++job.statistics.steps;
    return !is_whole(job.settings);
}

void Subdivision::put_row_sums(std::vector<double>& sums) const {
    if (sums_.empty()) return;
    sums.resize(first_ + sums_.size(), 0.0);
    std::copy(sums_.begin(), sums_.end(), sums.begin() + first_);
}

}  // namespace trp
