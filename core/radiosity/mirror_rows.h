// What mirrors hand on to elements: rays from each element that meet a mirror, by the elements that they go on to.
// Links carry what goes straight, and these rows the rest.
#pragma once

#include <algorithm>
#include <span>

#include "radiosity/element_light.h"

namespace trp {

class MirrorRows {
  public:
    // Those of the elements from number `first` on, which are new; earlier ones stay. `light`: of all elements; what is
    // black needs none. Runs in the current arena.
    void add(const LightingJob& job, uint32_t first, std::span<const ElementLight> light);
    // Forgets the elements from number `size` on.
    void merge(uint32_t size) { rows_.resize(std::min<size_t>(rows_.size(), size)); }

    // The irradiance of an element, of what radiosity(source) gives for the elements that it sees in mirrors.
    template <class Radiosity>
    Vec3d irradiance(uint32_t element, Radiosity&& radiosity) const {
        Vec3d sum(0, 0, 0);
        if (element < rows_.size())
            for (const Seen& seen : rows_[element]) sum += Vec3d(seen.weight) * radiosity(seen.source);
        return sum;
    }

  private:
    struct Seen {
        uint32_t source;
        Vec3 weight;
    };
    std::vector<std::vector<Seen>> rows_;  // by element; none where the scene has no mirror
};

}  // namespace trp
