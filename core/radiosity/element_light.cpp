#include "radiosity/element_light.h"

#include <algorithm>
#include <memory>
#include <numbers>
#include <numeric>

#include "base/parallel.h"
#include "film/pixel_random.h"
#include "radiosity/linear.h"
#include "shading/shadow_rays.h"

namespace trp {
namespace {

constexpr uint32_t kSide = 4, kPlaces = kSide * kSide;  // of an element
constexpr double kByChance = 2 * 2.0 / 13;  // of what a line does not explain, what it may by chance, twice the mean
constexpr double kSureChance = 3;           // times its mean, what chance seldom does: what is beyond is no chance
constexpr float kEven = 1e-3f;              // of an emission, differences that are rounding
constexpr double kNoise = 0.05;             // of the lamps' mean light, and of an element's own, what chance may do
constexpr double kMostPairs = 8;            // of samples of each light, at each place

// One to a thread.
struct Scratch {
    Points points;
    Coefficients coefficients;
    LightScratch lights;
    ProgramScratch program;
    LaneVec3 irradiance, again;  // sums, by two samples of each light at a time
    uint32_t pairs = 0;          // of them
    alignas(64) uint32_t keys[kBatch], indices[kBatch];
};

// Place number k of an element.
void put(const LightingJob& job, uint32_t element, uint32_t k, int lane, Scratch& w) {
    const Elements& elements = job.elements;
    const Facet& facet = elements.facet_of(element);
    const auto [s, t] = elements.place_in(element, k);
    Points& points = w.points;
    points.slot[lane] = facet.slot;
    elements.locate(facet, s, t, points.triangle[lane], points.b1[lane], points.b2[lane]);
    points.time[lane] = points.depth[lane] = 0;
    points.to_viewer.set(lane, elements.normal(element));
    w.keys[lane] = element * 0x9E3779B9u ^ job.seed * 0x85EBCA6Bu;
    w.indices[lane] = k;
}

// Textures are filtered over the cell that a place stands for, taken as a part of the triangle's own coordinates.
void set_footprints(const LightingJob& job, uint32_t element, int lane, Points& points) {
    const float triangle = points.edge1.get(lane).cross(points.edge2.get(lane)).length() / 2;
    const float step = std::sqrt(job.elements[element].area / std::max(triangle, 1e-37f)) / kSide;
    points.b1_dx[lane] = points.b2_dy[lane] = step;
    points.b1_dy[lane] = points.b2_dx[lane] = 0;
}

void add_lamps(const LightingJob& job, Scratch& w, LaneVec3& irradiance) {
    const Snapshot& snapshot = job.elements.snapshot();
    const Illumination& illumination = job.illumination;
    for (size_t l = 0; l < snapshot.lights.size() && !*job.cancelled; ++l) {
        const ReadyLight& light = snapshot.lights[l];
        if (light.kind == ReadyLight::Kind::surface) continue;  // its elements shine themselves
        LightScratch& lights = w.lights;
        const bool shadows = illumination.shadows && light.cast_shadow;
        lights.samples.packets =
            reached_packets(light, illumination.falloff, illumination.least_light, shadows, w.points);
        if (lights.samples.packets == 0) continue;
        if (light.is_sampled())
            random_pair_of(w.keys, w.indices, kFirstLightPair + static_cast<uint32_t>(l), lights.u, lights.v);
        sample_light(snapshot, light, illumination.falloff, w.points, lights.u, lights.v, lights.samples, w.program);
        if (shadows)
            *job.rays += trace_shadows(snapshot, w.points, lights.samples, Coherence::incoherent,
                                       TransparentShadows::transmission, lights.visibility, lights.shadow, w.program);
        for (int i = 0; i < kBatch; ++i) {
            if (w.points.slot[i] == kNoSlot || !lights.samples.reaches(i)) continue;
            const float cosine = std::max(w.points.geometric_normal.get(i).dot(lights.samples.direction.get(i)), 0.0f);
            const Vec3 seen = shadows ? lights.visibility.get(i) : Vec3(1, 1, 1);
            const Vec3 light_there = lights.samples.light.get(i) * seen * (cosine * std::numbers::pi_v<float>);
            irradiance.set(i, irradiance.get(i) + light_there);
        }
    }
}

Vec3 dimmed(const Vec3& light, bool& any) {
    any |= std::max({light.x, light.y, light.z}) > kGreatestLight;
    return {std::min(light.x, kGreatestLight), std::min(light.y, kGreatestLight), std::min(light.z, kGreatestLight)};
}

// The means of an element's places that are not covered, which stand in so many lanes from `first` on.
ElementLight mean(const Elements& elements, uint32_t element, int first, const Scratch& w) {
    const PlaneAxes axes = axes_of(elements.facet_of(element));
    const uint16_t covered = elements[element].covered;
    ElementLight out;
    if (covered == kAllCovered) return out;
    const float share = 1.0f / static_cast<float>(kPlaces - static_cast<uint32_t>(std::popcount(covered)));
    double squares = 0, chance = 0;
    Vec3 emitted(0, 0, 0);  // mean of squares
    Moments places;
    Vec3 by_x(0, 0, 0), by_y(0, 0, 0);
    float x_mean = 0, y_mean = 0;
    for (int k = 0; k < static_cast<int>(kPlaces); ++k) {
        const int i = first + k;
        if (w.points.slot[i] == kNoSlot) continue;
        if (covered >> k & 1) continue;
        const float alpha = w.coefficients.alpha[i];
        const Vec3 reflectance = w.coefficients.diffuse.get(i) * alpha;
        for (int c = 0; c < 3; ++c) {
            out.clamped |= reflectance[c] > kGreatestReflectance;
            out.reflectance[c] += share * std::clamp(reflectance[c], 0.0f, kGreatestReflectance);
        }
        const Vec3 emission = dimmed(w.coefficients.emission.get(i) * (alpha * std::numbers::pi_v<float>), out.dimmed);
        out.emission += emission * share;
        emitted += emission * emission * share;
        const float half = 0.5f / static_cast<float>(w.pairs);
        const Vec3 once = dimmed(w.irradiance.get(i) * half, out.dimmed),
                   again = dimmed(w.again.get(i) * half, out.dimmed), irradiance = once + again;
        const float differs = luminance(once - again);
        chance += static_cast<double>(differs * differs * share);
        if (irradiance != Vec3(0, 0, 0) || emission != Vec3(0, 0, 0))
            out.lit = static_cast<uint16_t>(out.lit | 1u << k);
        out.irradiance += irradiance * share;
        squares += static_cast<double>(luminance(irradiance) * luminance(irradiance) * share);
        const Vec3 from_middle = w.points.position.get(i) - elements[element].centre;
        const float x = axes.x.dot(from_middle), y = axes.y.dot(from_middle);
        places.add(x, y, share);
        x_mean += share * x;
        y_mean += share * y;
        by_x += irradiance * (share * x);
        by_y += irradiance * (share * y);
    }
    // The line of least squares.
    places.add(x_mean, y_mean, -1);
    by_x -= out.irradiance * x_mean;
    by_y -= out.irradiance * y_mean;
    const Moments fit = places.inverse();
    out.irradiance_x = by_x * static_cast<float>(fit.xx) + by_y * static_cast<float>(fit.xy);
    out.irradiance_y = by_x * static_cast<float>(fit.xy) + by_y * static_cast<float>(fit.yy);
    // What samples differ by at one place is chance, and no reason to divide an element; of it, the two numbers of a
    // line explain as much as of anything that is scattered over 16 places: what is not well beyond that is not kept.
    const double bright = luminance(out.irradiance),
                 explained = places.of(luminance(out.irradiance_x), luminance(out.irradiance_y)),
                 rest = std::max(squares - bright * bright - explained, 0.0);
    out.unevenness = static_cast<float>(std::sqrt(std::max(rest - kSureChance * chance, 0.0)));
    for (int c = 0; c < 3; ++c)
        out.texture = std::max(out.texture, std::sqrt(std::max(emitted[c] - out.emission[c] * out.emission[c], 0.0f)));
    if (out.texture < kEven * luminance(out.emission)) out.texture = 0;
    out.noise = static_cast<float>(std::sqrt(chance * static_cast<double>(share)));
    const auto sure = static_cast<float>(std::max(1 - kByChance * rest / std::max(explained, 1e-300), 0.0));
    out.irradiance_x *= sure;
    out.irradiance_y *= sure;
    return out;
}

// Of the elements [first, first + out.size()) those whose numbers in `out` are given, with so many pairs of samples
// each.
void light_some(const LightingJob& job, uint32_t first, std::span<const uint32_t> numbers,
                std::span<const uint32_t> pairs, std::span<ElementLight> out) {
    constexpr uint32_t kInBatch = kBatch / kPlaces;
    const size_t batches = (numbers.size() + kInBatch - 1) / kInBatch;
    parallel_ranges(batches, 4, [&](size_t begin, size_t end) {
        const auto w = std::make_unique<Scratch>();
        for (size_t b = begin; b < end && !*job.cancelled; ++b) {
            const size_t from = b * kInBatch, count = std::min<size_t>(kInBatch, numbers.size() - from);
            const auto element_at = [&](size_t k) { return first + numbers[from + k]; };
            std::fill_n(w->points.slot, kBatch, kNoSlot);
            for (uint32_t lane = 0; lane < count * kPlaces; ++lane)
                put(job, element_at(lane / kPlaces), lane % kPlaces, static_cast<int>(lane), *w);
            locate(job.elements.snapshot(), NormalChoice::flat, w->points);
            for (uint32_t lane = 0; lane < count * kPlaces; ++lane)
                set_footprints(job, element_at(lane / kPlaces), static_cast<int>(lane), w->points);
            evaluate(job.elements.snapshot(), w->points, w->coefficients, w->program);
            w->irradiance.clear();
            w->again.clear();
            const uint32_t most = *std::max_element(&pairs[from], &pairs[from] + count);
            for (w->pairs = 0; w->pairs < most && !*job.cancelled; ++w->pairs)
                for (LaneVec3* half : {&w->irradiance, &w->again}) {
                    if (half == &w->irradiance || job.twice) add_lamps(job, *w, *half);
                    for (uint32_t& index : w->indices) index += kPlaces;
                }
            if (!job.twice) w->again = w->irradiance;
            for (size_t k = 0; k < count; ++k)
                out[numbers[from + k]] = mean(job.elements, element_at(k), static_cast<int>(k * kPlaces), *w);
        }
    });
}

}  // namespace

void light_elements(const LightingJob& job, uint32_t first, std::span<ElementLight> out) {
    std::vector<uint32_t> numbers(out.size()), pairs(out.size(), 1);
    std::iota(numbers.begin(), numbers.end(), 0u);
    light_some(job, first, numbers, pairs, out);
    if (!job.twice) return;
    // Again, with more samples, where chance does too much.
    double sum = 0, area = 0;
    for (size_t k = 0; k < out.size(); ++k) {
        const double a = job.elements[first + static_cast<uint32_t>(k)].exposed_area();
        sum += a * static_cast<double>(luminance(out[k].irradiance));
        area += a;
    }
    numbers.clear();
    pairs.clear();
    for (size_t k = 0; k < out.size() && sum > 0; ++k) {
        const double most = kNoise * std::max(sum / area, static_cast<double>(luminance(out[k].irradiance))),
                     times = static_cast<double>(out[k].noise) / most;
        if (!(times > 1)) continue;
        numbers.push_back(static_cast<uint32_t>(k));
        pairs.push_back(static_cast<uint32_t>(std::ceil(std::min(times * times, kMostPairs))));
    }
    light_some(job, first, numbers, pairs, out);
}

}  // namespace trp
