#include "radiosity/mirror_rows.h"

#include <algorithm>
#include <memory>

#include "base/parallel.h"
#include "radiosity/element_rays.h"

namespace trp {
namespace {

constexpr uint32_t kMostRays = kBatch, kFewestRays = 8;  // from each element
constexpr size_t kInGroup = 32;
constexpr double kLarge = 1e-4;  // of all area: an element that takes the most

// The boxes of the surfaces that have facets with mirrors.
std::vector<Bounds> boxes_of_mirrors(const Elements& elements) {
    const Snapshot& snapshot = elements.snapshot();
    std::vector<Bounds> by_slot(snapshot.surfaces.size()), out;
    std::vector<uint8_t> any(by_slot.size(), 0);
    for (const Facet& facet : elements.facets()) {
        if (!(snapshot.material_flags[facet.material] & kMirrors)) continue;
        any[facet.slot] = 1;
        for (const Vec3& corner : elements.corners_of(facet)) by_slot[facet.slot].extend(corner);
    }
    for (size_t slot = 0; slot < by_slot.size(); ++slot)
        if (any[slot]) out.push_back(by_slot[slot]);
    return out;
}

bool meets(const Vec3& origin, const Vec3& direction, const Bounds& box) {
    float from = 0, to = 1e30f;
    for (int k = 0; k < 3; ++k) {
        const float inverse = 1 / direction[k], margin = 1e-4f * (1 + std::abs(box.max[k] - box.min[k]));
        const float a = (box.min[k] - margin - origin[k]) * inverse, b = (box.max[k] + margin - origin[k]) * inverse;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from <= to;
}

uint32_t ray_count(const Elements& elements, uint32_t element) {
    const double part = static_cast<double>(elements[element].area) / (kLarge * elements.area());
    return std::max(static_cast<uint32_t>(kMostRays * std::min(part, 1.0)), kFewestRays);
}

}  // namespace

void MirrorRows::add(const LightingJob& job, uint32_t first, std::span<const ElementLight> light) {
    const Elements& elements = job.elements;
    const std::vector<Bounds> boxes = boxes_of_mirrors(elements);
    if (boxes.empty()) return;
    rows_.resize(elements.size());
    // Elements in fixed groups, whose rays are traced side by side: their order is that of sums.
    const size_t count = elements.size() - first, groups = (count + kInGroup - 1) / kInGroup;
    parallel_ranges(groups, 1, [&](size_t begin, size_t end) {
        const auto tracer = std::make_unique<ElementTracer>(elements);
        LaneVec3 origins, directions;
        std::vector<ElementRay> rays;
        std::vector<ElementHit> hits;
        for (size_t group = begin; group < end && !*job.cancelled; ++group) {
            rays.clear();
            hits.clear();
            for (size_t k = group * kInGroup; k < std::min(count, (group + 1) * kInGroup); ++k) {
                const auto element = first + static_cast<uint32_t>(k);
                if (light[element].reflectance == Vec3(0, 0, 0)) continue;
                const uint32_t number = ray_count(elements, element);
                HemisphereRays(elements, element, job.seed).make(0, origins, directions);
                for (uint32_t ray = 0; ray < number; ++ray) {
                    const auto lane = static_cast<int>(ray);
                    const Vec3 origin = origins.get(lane), direction = directions.get(lane);
                    if (std::any_of(boxes.begin(), boxes.end(),
                                    [&](const Bounds& box) { return meets(origin, direction, box); }))
                        rays.push_back({origin, direction, element});
                }
            }
            *job.rays += tracer->trace(rays, hits);
            for (const ElementHit& hit : hits)
                if (hit.mirrored && hit.element != kNoElement)
                    rows_[hit.id].push_back(
                        {hit.element, hit.weight / static_cast<float>(ray_count(elements, hit.id))});
        }
    });
}

}  // namespace trp
