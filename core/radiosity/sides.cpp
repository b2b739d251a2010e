#include "radiosity/sides.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "radiosity/element_rays.h"

namespace trp {
namespace {

constexpr uint32_t kRays = 16;   // from each side
constexpr double kLarge = 1e-4;  // of all area

// Disjoint sets (Tarjan 1975), joined in one thread and so the same each time.
class Regions {
  public:
    explicit Regions(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    uint32_t find(uint32_t a) {
        while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
        return a;
    }
    void join(uint32_t a, uint32_t b) { parent_[find(a)] = find(b); }

  private:
    std::vector<uint32_t> parent_;
};

}  // namespace

void add_sides(Elements& elements, const LightingJob& job) {
    const Snapshot& snapshot = elements.snapshot();
    const auto& facets = elements.facets();
    const auto count = static_cast<uint32_t>(facets.size());
    // All sides for the time being, each with its light: two elements to a facet.
    Elements trial = elements.whole_facets();
    std::vector<ElementLight> light(trial.size());
    const LightingJob look{trial, job.illumination, job.seed, job.cancelled, job.rays};
    light_elements(look, 0, light);

    std::vector<uint32_t> met(size_t{2} * count * kRays, kNoElement);
    parallel_ranges(size_t{2} * count, 64, [&](size_t begin, size_t end) {
        ElementTracer tracer(trial);
        std::vector<ElementRay> rays;
        std::vector<ElementHit> hits;
        for (size_t side = begin; side < end && !*job.cancelled; ++side) {
            const auto element = static_cast<uint32_t>(side);
            make_hemisphere_rays(trial, element, element * 0x9E3779B9u, 0, kRays, rays);
            hits.clear();
            *job.rays += tracer.trace(rays, hits);
            for (const ElementHit& hit : hits)
                if (hit.element != kNoElement) met[side * kRays + hit.id] = hit.element;
        }
    });

    Regions regions(size_t{2} * count);
    const auto exists = [&](uint32_t side) {
        return side % 2 == 0 || snapshot.materials[facets[side / 2].material].double_sided;
    };
    std::vector<uint8_t> sees(size_t{2} * count, 0), lit(size_t{2} * count, 0);
    for (uint32_t side = 0; side < 2 * count; ++side) {
        if (!exists(side)) continue;
        for (uint32_t k = 0; k < kRays; ++k) {
            const uint32_t other = met[size_t{side} * kRays + k];
            if (other == kNoElement || !exists(other)) continue;
            sees[side] = 1;
            regions.join(side, other);
        }
    }
    for (uint32_t side = 0; side < 2 * count; ++side)
        if (exists(side) && (light[side].irradiance != Vec3(0, 0, 0) || light[side].emission != Vec3(0, 0, 0)))
            lit[regions.find(side)] = 1;
    for (uint32_t facet = 0; facet < count; ++facet) {
        bool any = false;
        for (uint32_t side = 0; side < 2; ++side)
            // What neither gets light nor gives any to another surface shows its own glow without an element.
            if (const uint32_t k = 2 * facet + side;
                exists(k) && lit[regions.find(k)] && (sees[k] || light[k].irradiance != Vec3(0, 0, 0))) {
                elements.add_side(facet, static_cast<int>(side));
                any = true;
            }
        if (!any) elements.add_side(facet, exists(2 * facet + 1) && !sees[2 * facet] && sees[2 * facet + 1]);
    }

    // What sees sides without elements may be covered in part; of large facets so few rays may have missed it.
    double all = 0;
    for (const Facet& facet : facets) all += static_cast<double>(facet.area);
    for (uint32_t side = 0; side < 2 * count; ++side) {
        const Facet& facet = facets[side / 2];
        const uint32_t root = facet.roots[side % 2];
        if (root == kNoElement) continue;
        const bool suspect =
            static_cast<double>(facet.area) > kLarge * all ||
            std::any_of(&met[size_t{side} * kRays], &met[size_t{side} * kRays] + kRays, [&](uint32_t other) {
                return other != kNoElement && facets[other / 2].roots[other % 2] == kNoElement;
            });
        for (uint32_t k = 0; suspect && k < facet.across * facet.up; ++k) elements.set_covered(root + k, 1);
    }
}

}  // namespace trp
