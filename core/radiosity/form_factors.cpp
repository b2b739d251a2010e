#include "radiosity/form_factors.h"

#include <algorithm>
#include <memory>

#include "base/parallel.h"
#include "film/pixel_random.h"
#include "radiosity/hemicube.h"
#include "radiosity/hemisphere_row.h"
#include "radiosity/polygon_factors.h"
#include "radiosity/way_rays.h"

namespace trp {
namespace {

constexpr double kRelativeError = 1e-6;  // of far pairs without anything between them
constexpr size_t kColumns = 512;         // that a thread takes at a time
constexpr float kInset = 1e-4f;          // of an element: at its edges, rays may slip past what they meet there
constexpr uint32_t kPairRays = 16;       // between two elements, in a round

struct ElementPair {
    uint32_t a, b, round, rounds;
};
// What rays between two elements would carry, and what of it comes through by colour.
struct Carried {
    Vec3 free{0, 0, 0};
    float all = 0;
};

// A round of rays between well-distributed points of elements a and b, for each pair. Returns the number of rays.
uint64_t look(const FormFactorJob& job, WayRays& ways, std::span<const ElementPair> pairs, Carried* out) {
    const Elements& elements = job.elements;
    alignas(64) uint32_t keys[kBatch], indices[kBatch];
    alignas(64) Lanes u, v, s, t;
    float weights[kBatch];
    constexpr size_t kInBatch = kBatch / kPairRays;
    uint64_t rays = 0;
    for (size_t first = 0; first < pairs.size(); first += kInBatch) {
        const size_t count = std::min(kInBatch, pairs.size() - first);
        for (uint32_t lane = 0; lane < kBatch; ++lane) {
            const ElementPair pair = pairs[first + std::min<size_t>(lane / kPairRays, count - 1)];
            keys[lane] = (pair.a * 0x9E3779B9u + pair.b) * 0x85EBCA6Bu ^ job.seed;
            indices[lane] = pair.round * kPairRays + lane % kPairRays;
        }
        random_pair_of(keys, indices, 0, u, v);
        random_pair_of(keys, indices, 1, s, t);
        ways.clear();
        for (int lane = 0; lane < static_cast<int>(count * kPairRays); ++lane) {
            const auto [a, b, round, rounds] = pairs[first + static_cast<size_t>(lane) / kPairRays];
            const auto inset = [](float x) { return kInset + (1 - 2 * kInset) * x; };
            const Vec3 from = elements.point_in(a, inset(u[lane]), inset(v[lane])),
                       to = elements.point_in(b, inset(s[lane]), inset(t[lane])), way = to - from,
                       normal = elements.normal(a);
            const Vec3 other = elements.normal(b);
            const float d2 = way.length2(), cosines = std::max(normal.dot(way), 0.0f) * std::max(-other.dot(way), 0.0f);
            // What a ray carries grows without bound where the elements touch: no single one is to speak for all.
            weights[lane] =
                cosines > 0 ? cosines / (d2 * std::max(d2, elements[b].area / static_cast<float>(kPairRays * rounds)))
                            : 0;
            // The end is off its surface, too, which grazing rays would meet before it.
            if (cosines > 0) ways.set(lane, elements.facet_of(a).slot, from, normal, to + other * (2 * clearance(to)));
        }
        rays += ways.trace();
        for (size_t k = 0; k < count; ++k) {
            Carried& sum = out[first + k];
            for (uint32_t ray = 0; ray < kPairRays; ++ray) {
                const auto lane = static_cast<int>(k * kPairRays + ray);
                sum.free += ways.free(lane) * weights[lane];
                sum.all += weights[lane];
            }
        }
    }
    return rays;
}

// Of a row's rays into the hemisphere, as many go to an element as its form factor says; of the two elements, from the
// one that sees more of the other.
uint32_t round_count(const FormFactorJob& job, double power, uint32_t a, uint32_t b) {
    const auto area = static_cast<double>(std::min(job.elements[a].area, job.elements[b].area));
    return 1 + static_cast<uint32_t>(std::min(power / area, 1.0) * job.settings.rays / kPairRays);
}

void analytic_row(const FormFactorJob& job, uint32_t i, uint32_t first, Vec3d* out) {
    const Elements& elements = job.elements;
    std::vector<Vec3d> from;
    elements.corners(i, from);
    const Vec3 normal = elements.normal(i);
    parallel_ranges(elements.size() - first, kColumns, [&](size_t begin, size_t end) {
        const auto ways = std::make_unique<WayRays>(elements.snapshot());
        std::vector<Vec3d> to;
        std::vector<ElementPair> pairs;
        std::vector<double> factors;
        for (size_t k = begin; k < end && !*job.cancelled; ++k) {
            const auto j = first + static_cast<uint32_t>(k);
            if (!elements[j].leaf() || elements[j].facet == elements[i].facet) continue;
            elements.corners(j, to);
            // Wholly behind each other: the common case of a room is met cheaply.
            const auto before = [](const std::vector<Vec3d>& polygon, const Vec3& n, const Vec3& origin) {
                return std::any_of(polygon.begin(), polygon.end(),
                                   [&](const Vec3d& p) { return (p - Vec3d(origin)).dot(Vec3d(n)) > 0; });
            };
            if (!before(to, normal, elements[i].centre) || !before(from, elements.normal(j), elements[j].centre))
                continue;
            const double power = polygon_to_polygon(from, to, kRelativeError);
            if (!(power > 0)) continue;
            const uint32_t rounds = round_count(job, power, i, j);
            for (uint32_t round = 0; round < rounds; ++round) pairs.push_back({i, j, round, rounds});
            factors.push_back(power / static_cast<double>(elements[i].area));
        }
        std::vector<Carried> carried(pairs.size());
        *job.rays += look(job, *ways, pairs, carried.data());
        for (size_t k = 0, next = 0; k < factors.size(); ++k) {
            const uint32_t j = pairs[next].b;
            Carried sum;
            for (; next < pairs.size() && pairs[next].b == j; ++next)
                sum.free += carried[next].free, sum.all += carried[next].all;
            if (sum.all > 0) out[j - first] = Vec3d(sum.free / sum.all) * factors[k];
        }
    });
}

}  // namespace

bool tints(const Snapshot& snapshot) {
    return snapshot.any_transmission || snapshot.any_holes ||
           std::any_of(snapshot.materials.begin(), snapshot.materials.end(),
                       [](const CompiledMaterial& m) { return m.mirrors; });
}

void form_factor_row(const FormFactorJob& job, uint32_t i, uint32_t first, Vec3d* out) {
    std::fill_n(out, job.elements.size() - first, Vec3d(0, 0, 0));
    const FormFactors kind = job.settings.form_factors;
    if (kind == FormFactors::analytic) analytic_row(job, i, first, out);
    if (kind == FormFactors::hemicube) hemicube_row(job, i, first, out);
    const bool all = kind == FormFactors::hemisphere;
    if (!all && !has_mirrors(job.elements)) return;
    HemisphereRow row(job.elements);
    row.trace(job, i, !all);
    for (uint32_t j = first; j < job.elements.size(); ++j) out[j - first] += row.take(j);
}

}  // namespace trp
