#include "radiosity/coincident.h"

#include <algorithm>

#include "geometry/weld.h"

namespace trp {
namespace {

// The same for the same corners in any order; others may have the same by chance.
uint64_t place_hash(std::span<const Vec3> corners) {
    uint64_t sum = corners.size();
    for (const Vec3& corner : corners) sum += position_hash(corner);
    return sum;
}

bool same_place(std::span<const Vec3> a, std::span<const Vec3> b) {
    return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const Vec3& corner) {
               return std::find(b.begin(), b.end(), corner) != b.end();
           });
}

}  // namespace

Coincident find_coincident(const Elements& elements) {
    const auto& facets = elements.facets();
    std::vector<std::pair<uint64_t, uint32_t>> places;  // hash, facet
    places.reserve(facets.size());
    for (uint32_t f = 0; f < facets.size(); ++f) places.emplace_back(place_hash(elements.corners_of(facets[f])), f);
    std::sort(places.begin(), places.end());
    const auto two_sided = [&](const Facet& f) { return elements.snapshot().materials[f.material].double_sided; };
    Coincident out;
    for (size_t k = 1; k < places.size(); ++k) {
        if (places[k].first != places[k - 1].first) continue;
        const Facet &a = facets[places[k - 1].second], &b = facets[places[k].second];
        // Back to back, one-sided faces are a sheet.
        if (a.normal.dot(b.normal) < 0 && !two_sided(a) && !two_sided(b)) continue;
        if (!same_place(elements.corners_of(a), elements.corners_of(b))) continue;
        if (out.count++ == 0) out.first[0] = places[k - 1].second, out.first[1] = places[k].second;
    }
    return out;
}

}  // namespace trp
