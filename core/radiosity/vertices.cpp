#include "radiosity/vertices.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "radiosity/linear.h"

namespace trp {
namespace {

constexpr float kSameNormal = 0.999f;  // cosine
constexpr int kMostBetween = 6;        // halvings of a side

uint32_t hash_cell(int64_t x, int64_t y, int64_t z) {
    uint64_t h = static_cast<uint64_t>(x) * 0x9E3779B97F4A7C15u ^ static_cast<uint64_t>(y) * 0xC2B2AE3D27D4EB4Fu ^
                 static_cast<uint64_t>(z) * 0x165667B19E3779F9u;
    h ^= h >> 29;
    return static_cast<uint32_t>(h * 0xBF58476D1CE4E5B9u >> 32);
}

// The shading normal of a facet's surface at a point, on its front.
Vec3 shading_normal(const Elements& elements, const Facet& facet, float s, float t) {
    const PlacedSurface& surface = elements.snapshot().surfaces[facet.slot];
    const NormalLayer& layer = surface.surface->normals(NormalChoice::mesh);
    if (layer.domain == NormalLayer::Domain::flat || (surface.face_smooth && !surface.face_smooth[facet.face]))
        return facet.normal;
    uint32_t triangle;
    float b1, b2;
    elements.locate(facet, s, t, triangle, b1, b2);
    const float b[3] = {1 - b1 - b2, b1, b2};
    Vec3 n(0, 0, 0);
    for (int k = 0; k < 3; ++k)
        n += layer.values[layer.domain == NormalLayer::Domain::corner
                              ? surface.corner(triangle, k)
                              : surface.vertices[3 * size_t{triangle} + static_cast<size_t>(k)]] *
             b[k];
    n = surface.world_from_object.normal(n) * surface.normal_sign;
    return n.length2() > 0 ? n.normalized() : facet.normal;
}

}  // namespace

template <class Take>
void ElementVertices::for_each_cell(const Vec3& position, Take&& take) const {
    // The cell of the point, and those that it lies close to.
    const float p[3] = {position.x / grid_, position.y / grid_, position.z / grid_};
    int64_t low[3], high[3];
    for (int k = 0; k < 3; ++k) low[k] = std::llround(p[k] - 0.25f), high[k] = std::llround(p[k] + 0.25f);
    for (int64_t x = low[0]; x <= high[0]; ++x)
        for (int64_t y = low[1]; y <= high[1]; ++y)
            for (int64_t z = low[2]; z <= high[2]; ++z)
                if (take(hash_cell(x, y, z) & (heads_.size() - 1))) return;
}

uint32_t ElementVertices::find(const Vec3& position, const Vec3& normal, uint32_t slot, uint8_t side) const {
    uint32_t found = kNoElement;
    const float near2 = grid_ * grid_ / 16;
    for_each_cell(position, [&](size_t cell) {
        for (uint32_t v = heads_[cell]; v != kNoElement; v = next_[v]) {
            const ElementVertex& other = vertices_[v];
            if (other.slot == slot && other.side == side && (other.position - position).length2() <= near2 &&
                other.normal.dot(normal) >= kSameNormal) {
                found = v;
                return true;
            }
        }
        return false;
    });
    return found;
}

uint32_t ElementVertices::add(const Vec3& position, const Vec3& normal, uint32_t slot, uint8_t side) {
    const uint32_t old = find(position, normal, slot, side);
    if (old != kNoElement) return old;
    const auto number = static_cast<uint32_t>(vertices_.size());
    vertices_.push_back({position, normal, slot, side});
    const size_t cell = hash_cell(std::llround(position.x / grid_), std::llround(position.y / grid_),
                                  std::llround(position.z / grid_)) &
                        (heads_.size() - 1);
    next_.push_back(heads_[cell]);
    heads_[cell] = number;
    return number;
}

// Vertices of smaller neighbours on the way from a to b.
void ElementVertices::add_between(uint32_t a, uint32_t b, int depth) {
    if (depth == 0) return;
    const ElementVertex &from = vertices_[a], &to = vertices_[b];
    const Vec3 normal = (from.normal + to.normal).normalized();
    const uint32_t middle = find((from.position + to.position) * 0.5f, normal, from.slot, from.side);
    if (middle == kNoElement || middle == a || middle == b) return;
    add_between(a, middle, depth - 1);
    loop_.push_back(middle);
    corners_.push_back(0);
    add_between(middle, b, depth - 1);
}

ElementVertices::ElementVertices(const Elements& elements) {
    Bounds box;
    size_t leaves = 0;
    for (uint32_t i = 0; i < elements.size(); ++i)
        if (elements[i].leaf()) box.extend(elements[i].centre), ++leaves;
    const Vec3 extent = leaves ? box.max - box.min : Vec3(0, 0, 0);
    grid_ = std::max(1e-5f * std::max({extent.x, extent.y, extent.z}), 1e-12f);
    heads_.assign(std::bit_ceil(std::max<size_t>(2 * leaves, 16)), kNoElement);
    // Corners of all leaves first, then what lies between them.
    std::vector<uint32_t> corner_loop, corner_first(elements.size() + 1, 0);
    std::vector<Vec3d> corners;
    for (uint32_t i = 0; i < elements.size(); ++i) {
        corner_first[i] = static_cast<uint32_t>(corner_loop.size());
        const Element& e = elements[i];
        if (!e.leaf()) continue;
        const Facet& facet = elements.facets()[e.facet];
        elements.corners(i, corners);
        if (e.side) std::reverse(corners.begin(), corners.end());
        for (size_t k = 0; k < corners.size(); ++k) {
            const bool quad = facet.shape == Facet::Shape::quad;
            const float ks = quad ? k == 1 || k == 2 : k == 1, kt = quad ? k >= 2 : k == 2;
            const Vec3 normal = facet.shape == Facet::Shape::polygon
                                    ? facet.normal
                                    : shading_normal(elements, facet, e.s + ks * e.ds, e.t + kt * e.dt);
            corner_loop.push_back(add(Vec3(corners[k]), normal, facet.slot, e.side));
        }
    }
    corner_first.back() = static_cast<uint32_t>(corner_loop.size());
    first_.assign(elements.size() + 1, 0);
    ways_.assign(elements.size(), Way::constant);
    for (uint32_t i = 0; i < elements.size(); ++i) {
        first_[i] = static_cast<uint32_t>(loop_.size());
        const uint32_t begin = corner_first[i], count = corner_first[i + 1] - begin;
        for (uint32_t k = 0; k < count; ++k) {
            loop_.push_back(corner_loop[begin + k]);
            corners_.push_back(1);
            add_between(corner_loop[begin + k], corner_loop[begin + (k + 1) % count], kMostBetween);
        }
        const bool plain = loop_.size() - first_[i] == count;
        const Facet::Shape shape = elements.facet_of(i).shape;
        if (shape == Facet::Shape::triangle) ways_[i] = plain ? Way::linear : Way::triangle_sectors;
        if (shape == Facet::Shape::quad) ways_[i] = plain ? Way::bilinear : Way::quad_sectors;
    }
    first_.back() = static_cast<uint32_t>(loop_.size());
}

bool ElementVertices::has_small_neighbours(uint32_t leaf) const {
    uint32_t between = 0;
    for (uint32_t k = first_[leaf]; k < first_[leaf + 1]; ++k) {
        between = corners_[k] ? 0 : between + 1;
        if (between > 1) return true;
    }
    return false;
}

std::vector<Vec3> ElementVertices::average(const Elements& elements, const std::vector<Vec3>& values,
                                           const std::vector<std::array<Vec3, 2>>& slopes) const {
    std::vector<Vec3> sums(vertices_.size(), Vec3(0, 0, 0));
    std::vector<float> areas(vertices_.size(), 0.0f);
    for (uint32_t i = 0; i < elements.size(); ++i) {
        const PlaneAxes axes = axes_of(elements.facet_of(i));
        const auto area = static_cast<float>(elements[i].exposed_area());
        for (const uint32_t v : around(i)) {
            Vec3 value = values[i];
            if (!slopes.empty()) {
                const Vec3 way = vertices_[v].position - elements[i].centre;
                value += slopes[i][0] * axes.x.dot(way) + slopes[i][1] * axes.y.dot(way);
            }
            sums[v] += value * area;
            areas[v] += area;
        }
    }
    for (size_t v = 0; v < sums.size(); ++v)
        for (int c = 0; c < 3 && areas[v] > 0; ++c) sums[v][c] = std::max(sums[v][c] / areas[v], 0.0f);
    return sums;
}

Vec3 ElementVertices::in_sectors(uint32_t leaf, float u, float v, const std::vector<Vec3>& at_vertices,
                                 const std::vector<Vec3>& at_leaves) const {
    const auto loop = around(leaf);
    const uint8_t* const is_corner = &corners_[first_[leaf]];
    const auto at = [&](size_t k) -> const Vec3& { return at_vertices[loop[k % loop.size()]]; };
    const bool quad = ways_[leaf] == Way::quad_sectors;

    // The sector of a side about the middle, how far out the place lies in it, and where along the side.
    int side;
    float out, along;
    if (quad) {
        const float x = 2 * u - 1, y = 2 * v - 1;
        out = std::max(std::abs(x), std::abs(y));
        side = std::abs(y) >= std::abs(x) ? (y < 0 ? 0 : 2) : (x > 0 ? 1 : 3);
        const float across = side == 0 ? x : side == 1 ? y : side == 2 ? -x : -y;
        along = out > 0 ? (across / out + 1) / 2 : 0.5f;
    } else {
        const float b[3] = {1 - u - v, u, v};
        const int least = b[0] <= b[1] && b[0] <= b[2] ? 0 : b[1] <= b[2] ? 1 : 2;
        side = (least + 1) % 3;  // that faces the corner
        out = 1 - 3 * b[least];
        const float to = b[(side + 1) % 3] - b[least], from = b[side] - b[least];
        along = to + from > 0 ? to / (to + from) : 0.5f;
    }
    size_t begin = 0;
    for (int corner = -1; begin < loop.size(); ++begin)
        if (is_corner[begin] && ++corner == side) break;
    size_t end = begin + 1;
    while (end < loop.size() && !is_corner[end]) ++end;
    // The stretch of the side, by the vertices' own places along it.
    const Vec3 start = vertices_[loop[begin]].position, way = vertices_[loop[end % loop.size()]].position - start;
    const float length2 = std::max(way.length2(), 1e-37f);
    float low = 0;
    size_t k = begin;
    for (;; ++k) {
        const float high =
            k + 1 == end ? 1 : (vertices_[loop[(k + 1) % loop.size()]].position - start).dot(way) / length2;
        if (along <= high || k + 1 == end) {
            const float share = high > low ? std::clamp((along - low) / (high - low), 0.0f, 1.0f) : 0;
            const Vec3 edge = at(k) * (1 - share) + at(k + 1) * share;
            return at_leaves[leaf] * (1 - out) + edge * out;
        }
        low = high;
    }
}

}  // namespace trp
