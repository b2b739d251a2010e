#include "radiosity/sides.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "film/pixel_random.h"
#include "radiosity/element_rays.h"
#include "radiosity/way_rays.h"

namespace trp {
namespace {

constexpr double kLarge = 1e-4;  // of all area: a facet that something else may stand on
constexpr uint32_t kRays = 4;    // from each place
constexpr uint32_t kTurns = 2;   // that mirrors and glass hand a ray on

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

// All sides of all facets, two elements to each, and places on them: 16 on large ones, 4 on the others.
class Places {
  public:
    explicit Places(const Elements& elements) : elements_(elements), first_(elements.size() + 1, 0) {
        double all = 0;
        for (const Facet& facet : elements.facets()) all += static_cast<double>(facet.area);
        for (uint32_t side = 0; side < elements.size(); ++side)
            first_[side + 1] =
                first_[side] + (static_cast<double>(elements.facet_of(side).area) > kLarge * all ? 16 : 4);
    }
    uint32_t size() const { return first_.back(); }
    uint32_t first(uint32_t side) const { return first_[side]; }
    uint32_t count(uint32_t side) const { return first_[side + 1] - first_[side]; }
    // Number `k` of a side, among the 16 of an element: one in each quarter where there are 4.
    uint32_t place_of(uint32_t side, uint32_t k) const { return count(side) == 16 ? k : 5 * k; }
    Vec3 point(uint32_t side, uint32_t k) const { return elements_.place_point(side, place_of(side, k)); }
    uint32_t nearest(uint32_t side, const Vec3& point) const {
        uint32_t best = 0;
        float least = 1e38f;
        for (uint32_t k = 0; k < count(side); ++k)
            if (const float d2 = (this->point(side, k) - point).length2(); d2 < least) least = d2, best = k;
        return best;
    }

  private:
    const Elements& elements_;
    std::vector<uint32_t> first_;
};

// One to a thread.
struct Looker {
    Looker(const Elements& trial, const Places& of, const LightingJob& lighting)
        : elements(trial), places(of), job(lighting), tracer(trial, kTurns), ways(trial.snapshot()) {}
    const Elements& elements;
    const Places& places;
    const LightingJob& job;
    ElementTracer tracer;
    WayRays ways;
    std::vector<ElementRay> rays;
    std::vector<ElementHit> hits;

    // Rays number `first` to `first` + `count` (at most kBatch), kRays to a place, of the sides of all places.
    void look(size_t first, size_t count, std::span<const uint32_t> side_of, uint32_t* met);
};

void Looker::look(size_t first, size_t count, std::span<const uint32_t> side_of, uint32_t* met) {
    alignas(64) uint32_t keys[kBatch], indices[kBatch];
    alignas(64) Lanes u, v;
    const auto side = [&](size_t ray) { return side_of[(first + ray) / kRays]; };
    for (size_t k = 0; k < kBatch; ++k) {
        const uint32_t element = side(std::min(k, count - 1));
        keys[k] = element * 0x9E3779B9u;
        indices[k] = static_cast<uint32_t>(first + k - size_t{places.first(element)} * kRays);
    }
    random_pair_of(keys, indices, 0, u, v);
    rays.clear();
    hits.clear();
    for (size_t k = 0; k < count; ++k) {
        const uint32_t element = side(k);
        const Vec3 p = places.point(element, indices[k] / kRays), normal = elements.normal(element);
        rays.push_back({p + normal * clearance(p), Hemisphere(normal).direction(u[k], v[k]), static_cast<uint32_t>(k)});
    }
    *job.rays += tracer.trace(rays, hits);
    std::fill_n(met, count, kNoElement);
    for (size_t begin = 0; begin < hits.size(); begin += kBatch) {
        const auto part = std::span(hits).subspan(begin, std::min<size_t>(hits.size() - begin, kBatch));
        ways.clear();
        for (size_t h = 0; h < part.size(); ++h) {
            const ElementHit& hit = part[h];
            if (hit.element == kNoElement) continue;
            const uint32_t next = places.nearest(hit.element, hit.position);
            const Vec3 to = places.point(hit.element, next), other = elements.normal(hit.element);
            met[hit.id] = places.first(hit.element) + next;
            ways.set(static_cast<int>(h), elements.facet_of(hit.element).slot, hit.position, other,
                     to + other * (2 * clearance(to)));
        }
        *job.rays += ways.trace();
        for (size_t h = 0; h < part.size(); ++h)
            if (part[h].element != kNoElement && ways.free(static_cast<int>(h)) == Vec3(0, 0, 0))
                met[part[h].id] = kNoElement;
    }
}

// The place that each ray of each place shows to be in one region with it: the place next to where it meets a side,
// where nothing stands between the two; kNoElement: none.
std::vector<uint32_t> look_around(const Elements& trial, const Places& places, std::span<const uint32_t> side_of,
                                  const LightingJob& job) {
    std::vector<uint32_t> met(size_t{places.size()} * kRays, kNoElement);
    parallel_ranges((met.size() + kBatch - 1) / kBatch, 4, [&](size_t begin, size_t end) {
        const auto looker = std::make_unique<Looker>(trial, places, job);
        for (size_t batch = begin; batch < end && !*job.cancelled; ++batch) {
            const size_t first = batch * kBatch;
            looker->look(first, std::min<size_t>(met.size() - first, kBatch), side_of, &met[first]);
        }
    });
    return met;
}

}  // namespace

void add_sides(Elements& elements, const LightingJob& job) {
    const Snapshot& snapshot = elements.snapshot();
    const auto& facets = elements.facets();
    const auto count = static_cast<uint32_t>(facets.size());
    // All sides for the time being, each with its light: two elements to a facet.
    const Elements trial = elements.whole_facets();
    std::vector<ElementLight> light(trial.size());
    light_elements({trial, job.illumination, job.seed, job.cancelled, job.rays, false}, 0, light);
    const Places places(trial);
    std::vector<uint32_t> side_of(places.size());
    for (uint32_t side = 0; side < 2 * count; ++side)
        std::fill_n(&side_of[places.first(side)], places.count(side), side);
    const std::vector<uint32_t> met = look_around(trial, places, side_of, job);

    const auto exists = [&](uint32_t side) {
        return side % 2 == 0 || snapshot.materials[facets[side / 2].material].double_sided;
    };
    Regions regions(places.size());
    std::vector<uint8_t> sees(size_t{2} * count, 0), lit(places.size(), 0);
    for (uint32_t place = 0; place < places.size(); ++place)
        for (uint32_t k = 0; k < kRays; ++k) {
            const uint32_t other = met[size_t{place} * kRays + k];
            if (other == kNoElement || !exists(side_of[place]) || !exists(side_of[other])) continue;
            sees[side_of[place]] = 1;
            regions.join(place, other);
        }
    for (uint32_t side = 0; side < 2 * count; ++side)
        for (uint32_t k = 0; k < places.count(side) && exists(side); ++k)
            if (light[side].lit >> places.place_of(side, k) & 1) lit[regions.find(places.first(side) + k)] = 1;

    for (uint32_t facet = 0; facet < count; ++facet) {
        bool any = false;
        for (uint32_t side = 0; side < 2; ++side) {
            const uint32_t k = 2 * facet + side;
            uint32_t dark = 0;  // places
            for (uint32_t place = 0; place < places.count(k); ++place)
                dark += !lit[regions.find(places.first(k) + place)];
            // What neither gets light nor gives any to another surface shows its own glow without an element.
            if (!exists(k) || dark == places.count(k) || !(sees[k] || light[k].irradiance != Vec3(0, 0, 0))) continue;
            elements.add_side(facet, static_cast<int>(side));
            any = true;
            const uint32_t root = facets[facet].roots[side];
            for (uint32_t r = 0; dark > 0 && r < facets[facet].across * facets[facet].up; ++r)
                elements.set_covered(root + r, 1);
        }
        if (!any) elements.add_side(facet, exists(2 * facet + 1) && !sees[2 * facet] && sees[2 * facet + 1]);
    }
}

}  // namespace trp
