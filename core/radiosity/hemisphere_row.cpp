#include "radiosity/hemisphere_row.h"

#include <algorithm>

#include "base/parallel.h"

namespace trp {

bool HemisphereRow::trace(const FormFactorJob& job, uint32_t i, bool mirrored) {
    const uint32_t count = job.settings.rays, batches = (count + kBatch - 1) / kBatch;
    const HemisphereRays rays(elements_, i, job.seed);
    std::vector<std::vector<ElementHit>> others(batches);  // in the order of the rays, whoever traces them
    parallel_ranges(batches, 16, [&](size_t begin, size_t end) {
        ElementTracer tracer(elements_);
        std::vector<uint32_t>& counts = counts_.local();
        if (counts.empty()) counts.resize(size_t{elements_.size()} + 1);
        uint64_t traced = 0;
        for (size_t batch = begin; batch < end && !*job.cancelled; ++batch) {
            const uint32_t first = static_cast<uint32_t>(batch) * kBatch;
            traced += tracer.trace(rays, first, static_cast<int>(std::min<uint32_t>(kBatch, count - first)),
                                   counts.data(), others[batch]);
        }
        *job.rays += traced;
    });
    const bool whole = !*job.cancelled;
    share_ = 1.0 / count;
    any_tinted_ = false;
    used_.clear();
    for (std::vector<uint32_t>& counts : counts_) {
        if (counts.empty()) continue;
        used_.push_back(counts.data());
        if (mirrored || !whole) std::fill(counts.begin(), counts.end(), 0);
    }
    for (size_t batch = 0; batch < batches && whole; ++batch)
        for (const ElementHit& hit : others[batch]) {
            if (hit.element == kNoElement || hit.mirrored < mirrored) continue;
            if (tinted_.empty()) tinted_.assign(elements_.size(), Vec3d(0, 0, 0));
            any_tinted_ = true;
            tinted_[hit.element] += Vec3d(hit.weight);
        }
    return whole;
}

}  // namespace trp
