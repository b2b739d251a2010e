#include "radiosity/covered.h"

#include "base/parallel.h"
#include "film/pixel_random.h"
#include "radiosity/element_rays.h"

namespace trp {
namespace {

constexpr uint32_t kRounds = 4;  // rays from a place, as long as they meet nothing that takes part
constexpr uint32_t kTurns = 2;   // that mirrors and glass hand a ray on

// The places of `left`, a bit to each, that a ray from each shows to be open.
uint16_t open_places(const Elements& elements, const LightingJob& job, uint32_t element, uint32_t round, uint16_t left,
                     ElementTracer& tracer, std::vector<ElementRay>& rays, std::vector<ElementHit>& hits) {
    alignas(64) uint32_t keys[kBatch], indices[kBatch];
    alignas(64) Lanes u, v;
    std::fill_n(keys, kBatch, element * 0x9E3779B9u ^ job.seed * 0x85EBCA6Bu);
    for (uint32_t k = 0; k < kBatch; ++k) indices[k] = round + kRounds * (k % 16);
    random_pair_of(keys, indices, 0, u, v);
    const Vec3 normal = elements.normal(element);
    const Hemisphere hemisphere(normal);
    rays.clear();
    hits.clear();
    for (uint32_t k = 0; k < 16; ++k) {
        if (!(left >> k & 1)) continue;
        const Vec3 p = elements.place_point(element, k);
        rays.push_back({p + normal * clearance(p), hemisphere.direction(u[k], v[k]), k});
    }
    *job.rays += tracer.trace(rays, hits);
    uint16_t open = 0;
    for (const ElementHit& hit : hits)
        if (hit.left || hit.element != kNoElement) open = static_cast<uint16_t>(open | 1u << hit.id);
    return open;
}

}  // namespace

void find_covered(Elements& elements, const LightingJob& job, uint32_t first) {
    std::vector<uint16_t> covered(elements.size() - first);
    parallel_ranges(covered.size(), 64, [&](size_t begin, size_t end) {
        ElementTracer tracer(elements, kTurns);
        std::vector<ElementRay> rays;
        std::vector<ElementHit> hits;
        for (size_t k = begin; k < end && !*job.cancelled; ++k) {
            const auto element = first + static_cast<uint32_t>(k);
            covered[k] = elements[element].covered;
            if (covered[k] == 0 || covered[k] == kAllCovered) continue;
            covered[k] = kAllCovered;
            for (uint32_t round = 0; round < kRounds && covered[k] != 0; ++round)
                covered[k] = static_cast<uint16_t>(
                    covered[k] & ~open_places(elements, job, element, round, covered[k], tracer, rays, hits));
        }
    });
    if (*job.cancelled) return;
    for (size_t k = 0; k < covered.size(); ++k) elements.set_covered(first + static_cast<uint32_t>(k), covered[k]);
}

}  // namespace trp
