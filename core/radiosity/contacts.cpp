#include "radiosity/contacts.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "radiosity/element_rays.h"

namespace trp {
namespace {

constexpr uint32_t kPieces = 4;          // of an edge, each with a contact of its own
constexpr float kShortest = 1.0f / 256;  // of the scene's extent: edges that may stand between rooms
constexpr float kThin = 1.0f / 16;       // of the edge: the depth of what has none, a face alone
constexpr float kSlender = 1.0f / 3;     // of the edge: the depth of a wall; deeper bodies part no rooms
constexpr float kAround = 2;      // of such a body's size: elements about it, whose lamps' light shows its shadow
constexpr float kSlanted = 0.9f;  // cosine: faces that lie along each other have no line in common

// One to a thread.
struct Feeler {
    explicit Feeler(const LightingJob& lighting) : job(lighting), elements(lighting.elements), tracer(elements, 0) {}
    const LightingJob& job;
    const Elements& elements;
    ElementTracer tracer;
    std::vector<ElementRay> rays;
    std::vector<ElementHit> hits;

    // What a ray meets within `reach`, or null.
    const ElementHit* feel(const Vec3& from, const Vec3& direction, float reach) {
        rays.assign(1, {from, direction});
        hits.clear();
        *job.rays += tracer.trace(rays, hits);
        const bool met = !hits.empty() && !hits[0].left && (hits[0].position - from).length() <= reach;
        return met ? &hits[0] : nullptr;
    }
    // Whether the ground is there, too.
    bool goes_on(const Vec3& point, const Vec3& ground, float off) {
        const ElementHit* met = feel(point + ground * (4 * off), -ground, 8 * off);
        return met && met->element != kNoElement && elements.normal(met->element).dot(ground) > kSlanted;
    }
    void along_edge(const Facet& facet, int side, uint32_t edge, std::vector<Contact>& out);
};

// From the middle of the face down to an edge, and past it where something is there that it stands on.
void Feeler::along_edge(const Facet& facet, int side, uint32_t edge, std::vector<Contact>& out) {
    const auto corners = elements.corners_of(facet);
    const Vec3& from = corners[edge];
    const Vec3 along = corners[(edge + 1) % corners.size()] - from;
    const Vec3 normal = side ? -facet.normal : facet.normal;
    Vec3 middle(0, 0, 0);
    for (const Vec3& corner : corners) middle += corner / static_cast<float>(corners.size());
    for (uint32_t piece = 0; piece < kPieces; ++piece) {
        const Vec3 foot = from + along * ((static_cast<float>(piece) + 0.5f) / kPieces);
        const float off = 4 * clearance(foot);
        const Vec3 start = (foot + middle) / 2 + normal * off, way = foot + normal * off - start;
        const ElementHit* met = feel(start, way.normalized(), way.length() + off);
        if (!met || met->element == kNoElement) continue;
        const uint32_t element = met->element;
        const Vec3 ground = elements.normal(element), line = normal.cross(ground);
        if (std::abs(normal.dot(ground)) > kSlanted) continue;
        const Vec3 there = met->position, slope = ground.cross(line).normalized(),
                   behind = slope.dot(normal) > 0 ? -slope : slope;  // along the ground
        const float most = 2 * elements.radius(element);
        const ElementHit* back = feel(there + ground * (2 * off) + behind * (2 * off), behind, most);
        const float depth = back ? (back->position - there).length() : kThin * along.length();
        const Vec3 half = line.normalized() * (along.length() * (0.5f / kPieces));
        // What is sunk into the ground may have other light there.
        const float sunk = (foot - there).length();
        if (sunk > 4 * off && facet.across * facet.up == 1)
            out.push_back({facet.roots[side], there, half, sunk, false});
        float size = depth;
        const bool wall = depth <= kSlender * along.length();
        if (!wall)
            size = kAround * std::max(depth, along.length());
        else if (!goes_on(there + behind * ((back ? depth : 0) + 16 * off), ground, off))
            continue;
        if (size < most) out.push_back({element, there, half, size, wall});
    }
}

// Of an element, along a contact.
void divide_along(const Contact& contact, uint32_t element, float size, Elements& elements,
                  std::vector<uint8_t>& across) {
    const float radius = elements.radius(element);
    if (2 * radius <= size) return;
    const Vec3 way = elements[element].centre - contact.middle;
    const float share = std::clamp(way.dot(contact.half) / std::max(contact.half.length2(), 1e-37f), -1.0f, 1.0f);
    if ((way - contact.half * share).length() > radius) return;
    if (elements[element].leaf()) {
        if (elements.facet_of(element).shape == Facet::Shape::polygon) return;
        elements.divide(element);
        for (uint32_t k = 0; k < 4; ++k) elements.set_covered(elements[element].first_child + k, 1);
    }
    across.resize(elements.size(), 0);
    across[element] |= contact.wall;
    for (uint32_t k = 0; k < 4; ++k) divide_along(contact, elements[element].first_child + k, size, elements, across);
}

}  // namespace

std::vector<Contact> find_contacts(const LightingJob& job) {
    const Elements& elements = job.elements;
    const auto& facets = elements.facets();
    Bounds box;
    for (uint32_t i = 0; i < elements.size(); ++i) box.extend(elements[i].centre);
    const float shortest = facets.empty() ? 0 : kShortest * (box.max - box.min).length();
    constexpr size_t kGrain = 64;
    std::vector<std::vector<Contact>> found((facets.size() + kGrain - 1) / kGrain);
    parallel_ranges(found.size(), 1, [&](size_t begin, size_t end) {
        const auto feeler = std::make_unique<Feeler>(job);
        for (size_t chunk = begin; chunk < end && !*job.cancelled; ++chunk)
            for (size_t f = chunk * kGrain; f < std::min(facets.size(), (chunk + 1) * kGrain); ++f)
                for (int side = 0; side < 2; ++side) {
                    const auto corners = elements.corners_of(facets[f]);
                    for (uint32_t k = 0; k < corners.size() && facets[f].roots[side] != kNoElement; ++k)
                        if ((corners[(k + 1) % corners.size()] - corners[k]).length() > shortest)
                            feeler->along_edge(facets[f], side, k, found[chunk]);
                }
    });
    std::vector<Contact> out;
    for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
    return out;
}

std::vector<uint8_t> divide_at(const std::vector<Contact>& contacts, float least, Elements& elements) {
    std::vector<uint8_t> across(elements.size(), 0);
    for (const Contact& contact : contacts)
        divide_along(contact, contact.element, std::max(contact.size, least), elements, across);
    return across;
}

}  // namespace trp
