#include "radiosity/elements.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/triangulate.h"

namespace trp {
namespace {

constexpr float kCornerS[4] = {0, 1, 1, 0}, kCornerT[4] = {0, 0, 1, 1};
constexpr uint32_t kMostElements = 1u << 28;
constexpr float kEven = 0.01f;  // of a quad's area: what it may be uneven by and count as even, as small cells do

// Whether four corners lie in a plane, to a thousandth of their extent, and bend one way.
bool is_plane_and_convex(std::span<const Vec3> p, const Vec3& normal) {
    float extent = 0, height = 0;
    for (size_t k = 0; k < 4; ++k) {
        const Vec3 a = p[(k + 1) % 4] - p[k], b = p[(k + 2) % 4] - p[(k + 1) % 4];
        if (!(a.cross(b).dot(normal) > 1e-6f * a.length() * b.length())) return false;
        extent = std::max(extent, a.length());
        height = std::max(height, std::abs((p[k] - p[0]).dot(normal)));
    }
    return height <= 1e-3f * extent;
}

// Coordinates of the cells that a division makes of one.
Element part(const Element& e, Facet::Shape shape, uint32_t number) {
    Element out;
    out.facet = e.facet;
    out.side = e.side;
    out.covered = e.covered;
    out.ds = e.ds / 2;
    out.dt = e.dt / 2;
    out.s = e.s + (number % 2 ? out.ds : 0);
    out.t = e.t + (number / 2 ? out.dt : 0);
    if (shape == Facet::Shape::triangle && number == 3) out.ds = -out.ds, out.dt = -out.dt;  // the one in the middle
    return out;
}

// Whether a polygon is wider than single precision can tell of its corners: what is not is no surface, and as an
// element would get all the light of any ray or pixel that happens to meet it.
bool has_width(std::span<const Vec3> polygon) {
    constexpr double kThinnest = 1e-6;  // of its length
    double length2 = 0;
    for (const Vec3& p : polygon) length2 = std::max(length2, static_cast<double>((p - polygon[0]).length2()));
    return polygon.size() > 2 && newell(polygon).length() > kThinnest * length2;
}

// Whose rays may go on from it.
uint8_t passes(const CompiledMaterial& material) {
    using Of = Elements::TriangleOf;
    return static_cast<uint8_t>((material.has_holes || material.transmits || material.mirrors ? Of::kPass : 0) |
                                (material.double_sided ? 0 : Of::kOneSided));
}

}  // namespace

Elements::Elements(std::shared_ptr<const Snapshot> snapshot, float size, bool divisible)
    : snapshot_(std::move(snapshot)), size_(size), divisible_(divisible || size > 0) {
    for (uint32_t slot = 0; slot < snapshot_->surfaces.size(); ++slot) {
        const PlacedSurface& surface = snapshot_->surfaces[slot];
        first_triangles_.push_back(static_cast<uint32_t>(triangles_.size()));
        if (!surface.mesh) continue;
        const uint32_t count = surface.surface->triangle_count();
        triangles_.resize(triangles_.size() + count);
        for (uint32_t first = 0, end; first < count; first = end) {
            const uint32_t face = surface.face(first);
            for (end = first + 1; end < count && surface.face(end) == face;) ++end;
            for (uint32_t t = first; t < end; ++t)
                triangles_[first_triangles_[slot] + t].flags =
                    passes(snapshot_->materials[surface.face_material(face)]);
            add_face(slot, face, first, end - first);
        }
    }
}

void Elements::add_face(uint32_t slot, uint32_t face, uint32_t first_triangle, uint32_t triangle_count) {
    const PlacedSurface& surface = snapshot_->surfaces[slot];
    const Mesh& mesh = *surface.mesh;
    const bool mirrored = surface.normal_sign < 0;
    Facet facet;
    facet.slot = slot;
    facet.face = face;
    facet.triangle = first_triangle;
    facet.material = surface.face_material(face);
    std::vector<uint32_t> loop;
    mesh.distinct_corners(face, loop);
    if (mirrored) std::reverse(loop.begin(), loop.end());
    std::vector<Vec3> polygon;
    for (const uint32_t c : loop) polygon.push_back(surface.world_position(mesh.corner_vertices[c]));

    const auto map = [&](uint32_t triangle) {
        TriangleOf& of = triangles_[first_triangles_[slot] + triangle];
        of.facet = static_cast<uint32_t>(facets_.size());
        for (int k = 0; k < 3; ++k) {
            const auto at = std::find(loop.begin(), loop.end(), surface.corner(triangle, k));
            of.corners[k] = static_cast<uint8_t>(std::min<ptrdiff_t>(at - loop.begin(), 3));
        }
    };
    if (!has_width(polygon)) return;
    const Vec3 normal(newell(polygon).normalized());
    if (triangle_count == 1 && polygon.size() == 3) {
        map(first_triangle);
        return add_facet(facet, polygon);
    }
    if (polygon.size() == 4 && is_plane_and_convex(polygon, normal)) {
        facet.shape = Facet::Shape::quad;
        for (uint32_t t = 0; t < triangle_count; ++t) map(first_triangle + t);
        return add_facet(facet, polygon);
    }
    if (!divisible_) {
        facet.shape = Facet::Shape::polygon;
        for (uint32_t t = 0; t < triangle_count; ++t) map(first_triangle + t);
        return add_facet(facet, polygon);
    }
    for (uint32_t t = first_triangle; t < first_triangle + triangle_count; ++t) {
        Vec3 p[3];
        for (int k = 0; k < 3; ++k) p[k] = surface.world_position(surface.vertices[3 * size_t{t} + k]);
        if (mirrored) std::swap(p[1], p[2]);
        if (!has_width(p)) continue;
        TriangleOf& of = triangles_[first_triangles_[slot] + t];
        of.facet = static_cast<uint32_t>(facets_.size());
        if (mirrored) of.corners[1] = 2, of.corners[2] = 1;
        facet.triangle = t;
        add_facet(facet, p);
    }
}

void Elements::add_facet(Facet facet, std::span<const Vec3> corners) {
    facet.first_corner = static_cast<uint32_t>(corners_.size());
    facet.corner_count = static_cast<uint32_t>(corners.size());
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    const Vec3d area2 = newell(corners);
    facet.area = static_cast<float>(area2.length() / 2);
    facet.normal = Vec3(area2.normalized());
    if (facet.shape == Facet::Shape::quad)
        facet.skewed = (corners[0] + corners[2] - corners[1] - corners[3]).length() >
                       1e-5f * ((corners[1] - corners[0]).length() + (corners[2] - corners[1]).length());
    if (facet.skewed) {
        const Vec3d p[4] = {Vec3d(corners[0]), Vec3d(corners[1]), Vec3d(corners[2]), Vec3d(corners[3])};
        facet.spread = area_over(p, facet.normal);
    }
    set_grid(facet);
    facets_.push_back(facet);
}

// As few roots as keep their sides below the size, or where nothing is said, one; where they are to be divided, sides
// that differ by less than half.
void Elements::set_grid(Facet& facet) const {
    if (facet.shape == Facet::Shape::polygon) return;
    const Vec3* p = &corners_[facet.first_corner];
    const auto steps = [&](float length) {
        return static_cast<uint32_t>(std::clamp(std::ceil(length / size_ * (1 - 1e-5f)), 1.0f, 32768.0f));
    };
    const float a = (p[1] - p[0]).length(), b = (p[2] - p[1]).length();
    if (facet.shape == Facet::Shape::triangle) {
        if (size_ > 0) facet.across = facet.up = steps(std::max({a, b, (p[0] - p[2]).length()}));
        return;
    }
    const float width = std::max(a, (p[3] - p[2]).length()), height = std::max(b, (p[0] - p[3]).length());
    if (size_ > 0) {
        facet.across = steps(width);
        facet.up = steps(height);
    } else if (divisible_ && width > 0 && height > 0) {
        facet.across = static_cast<uint32_t>(std::clamp(std::round(width / height), 1.0f, 256.0f));
        facet.up = static_cast<uint32_t>(std::clamp(std::round(height / width), 1.0f, 256.0f));
    }
}

// Root `number` of a facet's grid, row by row; in a triangle's row an upright cell and one on its head take turns.
Element Elements::cell(const Facet& facet, uint32_t number) const {
    Element e;
    if (facet.shape == Facet::Shape::polygon) return e;
    e.ds = 1 / static_cast<float>(facet.across);
    e.dt = 1 / static_cast<float>(facet.up);
    const auto at = [](uint32_t k, uint32_t count) { return static_cast<float>(k) / static_cast<float>(count); };
    if (facet.shape == Facet::Shape::quad) {
        e.s = at(number % facet.across, facet.across);
        e.t = at(number / facet.across, facet.up);
        return e;
    }
    // Row r holds 2 (n − r) − 1 cells: n² − (n − r)² lie before it.
    const uint32_t n = facet.across;
    uint32_t row = 0, place = number;
    while (place >= 2 * (n - row) - 1) place -= 2 * (n - row) - 1, ++row;
    const bool turned = place % 2;
    e.s = at(place / 2 + turned, n);
    e.t = at(row + turned, n);
    if (turned) e.ds = -e.ds, e.dt = -e.dt;
    return e;
}

void Elements::add_side(uint32_t number, int side) {
    Facet& facet = facets_[number];
    const uint64_t count = uint64_t{facet.across} * facet.up;
    if (elements_.size() + count > kMostElements)
        fail(TRP_ERROR_MEMORY, "elements of {} m would be more than {}: choose a larger radiosity.element_size", size_,
             kMostElements);
    facet.roots[side] = size();
    for (uint32_t k = 0; k < count; ++k) {
        Element e = cell(facet, k);
        e.facet = number;
        e.side = static_cast<uint8_t>(side);
        finish(e);
        area_ += static_cast<double>(e.area);
        elements_.push_back(e);
    }
    first_children_.resize(elements_.size(), kNoElement);
    tell_triangles(number);
}

// What find_elements() is to know of a facet.
void Elements::tell_triangles(uint32_t number) {
    const Facet& facet = facets_[number];
    float twist[2] = {0, 0};
    if (facet.skewed) {
        const Vec3* c = &corners_[facet.first_corner];
        const Vec3 e1 = c[1] - c[0], e2 = c[3] - c[0], e3 = c[2] - c[1] - e2;
        const float area = e1.cross(e2).dot(facet.normal);
        twist[0] = e3.cross(e2).dot(facet.normal) / area;
        twist[1] = e1.cross(e3).dot(facet.normal) / area;
    }
    for (size_t t = size_t{first_triangles_[facet.slot]} + facet.triangle;
         t < triangles_.size() && triangles_[t].facet == number; ++t) {
        TriangleOf& of = triangles_[t];
        of.flags |= (facet.shape == Facet::Shape::triangle ? TriangleOf::kTriangle : 0) |
                    (facet.skewed ? TriangleOf::kSkewed : 0);
        of.normal = facet.normal;
        of.across = static_cast<uint16_t>(facet.across);
        of.up = static_cast<uint16_t>(facet.up);
        std::copy_n(facet.roots, 2, of.roots);
        std::copy_n(twist, 2, of.twist);
    }
}

Elements Elements::whole_facets() const {
    Elements out = *this;
    out.elements_.clear();
    out.first_children_.clear();
    out.area_ = 0;
    for (uint32_t facet = 0; facet < facets_.size(); ++facet) {
        out.facets_[facet].across = out.facets_[facet].up = 1;
        for (int side = 0; side < 2; ++side) out.add_side(facet, side);
    }
    return out;
}

void Elements::finish(Element& e) const {
    const Facet& facet = facets_[e.facet];
    if (facet.shape == Facet::Shape::polygon) {
        e.area = facet.area;
        const Vec3* p = &corners_[facet.first_corner];
        for (uint32_t k = 0; k < facet.corner_count; ++k) e.centre += p[k] / static_cast<float>(facet.corner_count);
        return;
    }
    if (facet.shape == Facet::Shape::triangle) {
        e.area = facet.area * std::abs(e.ds * e.dt);
        e.centre = point(facet, e.s + e.ds / 3, e.t + e.dt / 3);
        return;
    }
    e.centre = point(facet, e.s + e.ds / 2, e.t + e.dt / 2);
    e.area = facet.area * e.ds * e.dt;
    if (!facet.skewed) return;
    const Vec3 a = point(facet, e.s + e.ds, e.t + e.dt) - point(facet, e.s, e.t),
               b = point(facet, e.s, e.t + e.dt) - point(facet, e.s + e.ds, e.t);
    e.area = a.cross(b).length() / 2;
}

void Elements::divide(uint32_t number) {
    if (elements_.size() + 4 > kMostElements)
        fail(TRP_ERROR_MEMORY, "the elements would be more than {}", kMostElements);
    const uint32_t first = size();
    for (uint32_t k = 0; k < 4; ++k) elements_.push_back(quarter(number, k));
    elements_[number].first_child = first_children_[number] = first;
    divided_ = true;
    first_children_.resize(elements_.size(), kNoElement);
}

Element Elements::quarter(uint32_t element, uint32_t number) const {
    const Element& e = elements_[element];
    const Facet::Shape shape = facets_[e.facet].shape;
    if (shape == Facet::Shape::polygon) return e;
    Element out = part(e, shape, number);
    finish(out);
    return out;
}

void Elements::merge(uint32_t size) {
    elements_.resize(size);
    first_children_.resize(size);
    for (uint32_t i = 0; i < size; ++i)
        if (!elements_[i].leaf() && elements_[i].first_child >= size)
            elements_[i].first_child = first_children_[i] = kNoElement;
}

Vec3 Elements::point(const Facet& facet, float s, float t) const {
    const Vec3* p = &corners_[facet.first_corner];
    if (facet.shape == Facet::Shape::triangle) return p[0] + (p[1] - p[0]) * s + (p[2] - p[0]) * t;
    return (p[0] * (1 - s) + p[1] * s) * (1 - t) + (p[3] * (1 - s) + p[2] * s) * t;
}

float part_below(float at_0, float change, float u) {
    const float twice = 2 * u * (at_0 + change / 2);
    return twice / std::max(at_0 + std::sqrt(std::max(at_0 * at_0 + change * twice, 0.0f)), 1e-37f);
}

QuadArea area_over(std::span<const Vec3d> p, const Vec3& normal) {
    const auto at = [&](const Vec3d& along_s, const Vec3d& along_t) {
        return static_cast<float>(along_s.cross(along_t).dot(Vec3d(normal)));
    };
    const float at_0 = at(p[1] - p[0], p[3] - p[0]);
    return {at_0, at(p[1] - p[0], p[2] - p[1]) - at_0, at(p[2] - p[3], p[3] - p[0]) - at_0};
}

std::array<float, 2> Elements::coordinates_in(const Element& e, float u, float v) const {
    const Facet& facet = facets_[e.facet];
    if (facet.skewed) {
        const QuadArea& all = facet.spread;
        const QuadArea area = {all.at_0 + all.by_s * e.s + all.by_t * e.t, all.by_s * e.ds, all.by_t * e.dt};
        if (std::abs(area.by_s) + std::abs(area.by_t) > kEven * area.at_0) {
            v = part_below(area.at_0 + area.by_s / 2, area.by_t, v);
            u = part_below(area.at_0 + area.by_t * v, area.by_s, u);
        }
    }
    if (facet.shape != Facet::Shape::triangle) return {e.s + u * e.ds, e.t + v * e.dt};
    const float root = std::sqrt(u);
    return {e.s + root * (1 - v) * e.ds, e.t + root * v * e.dt};
}

std::array<float, 2> Elements::place_in(uint32_t element, uint32_t number) const {
    const Element& e = elements_[element];
    const Facet::Shape shape = facets_[e.facet].shape;
    if (shape == Facet::Shape::polygon)
        return {(static_cast<float>(number % 4) + 0.5f) / 4, (static_cast<float>(number / 4) + 0.5f) / 4};
    const Element cell = part(part(e, shape, number / 4), shape, number % 4);
    const float middle = shape == Facet::Shape::triangle ? 1.0f / 3 : 0.5f;
    return {cell.s + middle * cell.ds, cell.t + middle * cell.dt};
}

Vec3 Elements::place_point(uint32_t element, uint32_t number) const {
    const Facet& facet = facet_of(element);
    const auto [s, t] = place_in(element, number);
    return facet.shape == Facet::Shape::polygon ? point_in(element, s, t) : point(facet, s, t);
}

Vec3 Elements::point_in(const Element& element, float u, float v) const {
    const Facet& facet = facets_[element.facet];
    if (facet.shape != Facet::Shape::polygon) {
        const auto [s, t] = coordinates_in(element, u, v);
        return point(facet, s, t);
    }
    uint32_t triangle;
    float b1, b2;
    locate(facet, u, v, triangle, b1, b2);
    const PlacedSurface& surface = snapshot_->surfaces[facet.slot];
    Vec3 p[3];
    for (int k = 0; k < 3; ++k) p[k] = surface.world_position(surface.vertices[3 * size_t{triangle} + k]);
    return p[0] + (p[1] - p[0]) * b1 + (p[2] - p[0]) * b2;
}

// Which triangle of a polygon a share of its area falls into; the share becomes that of the triangle.
uint32_t Elements::triangle_by_area(const Facet& facet, float& share) const {
    const PlacedSurface& surface = snapshot_->surfaces[facet.slot];
    const auto area = [&](uint32_t t) {
        const uint32_t* v = surface.vertices + 3 * size_t{facet.triangle + t};
        const Vec3 p = surface.world_position(v[0]);
        return (surface.world_position(v[1]) - p).cross(surface.world_position(v[2]) - p).length() / 2;
    };
    const uint32_t count = facet.corner_count - 2;
    float left = 0;
    for (uint32_t t = 0; t < count; ++t) left += area(t);
    left *= share;
    uint32_t t = 0;
    for (; t + 1 < count && left >= area(t); ++t) left -= area(t);
    share = std::clamp(left / std::max(area(t), 1e-37f), 0.0f, 1.0f);
    return t;
}

Vec3 Elements::corner(const Element& e, uint32_t k) const {
    const Facet& facet = facets_[e.facet];
    if (facet.shape == Facet::Shape::polygon) return corners_[facet.first_corner + k];
    const bool quad = facet.shape == Facet::Shape::quad;
    const float ks = quad ? kCornerS[k] : k == 1, kt = quad ? kCornerT[k] : k == 2;
    return point(facet, e.s + ks * e.ds, e.t + kt * e.dt);
}

void Elements::corners(uint32_t element, std::vector<Vec3d>& out) const {
    out.clear();
    const Element& e = elements_[element];
    for (uint32_t k = 0; k < facets_[e.facet].corner_count; ++k) out.emplace_back(corner(e, k));
    if (e.side) std::reverse(out.begin(), out.end());
}

float Elements::radius(uint32_t element) const {
    const Element& e = elements_[element];
    float radius2 = 0;
    for (uint32_t k = 0; k < facets_[e.facet].corner_count; ++k)
        radius2 = std::max(radius2, (corner(e, k) - e.centre).length2());
    return std::sqrt(radius2);
}

std::array<float, 2> Elements::coordinates_at(const TriangleOf& of, float b1, float b2) const {
    const Facet& facet = facets_[of.facet];
    const float b[3] = {1 - b1 - b2, b1, b2};
    float s = 0, t = 0;
    if (facet.shape == Facet::Shape::triangle) {
        for (int k = 0; k < 3; ++k) s += of.corners[k] == 1 ? b[k] : 0, t += of.corners[k] == 2 ? b[k] : 0;
    } else if (!facet.skewed) {
        for (int k = 0; k < 3; ++k) s += b[k] * kCornerS[of.corners[k]], t += b[k] * kCornerT[of.corners[k]];
    } else {
        // Of p = e1 s + e2 t + e3 s t: first t, from (p − e2 t) × (e1 + e3 t) = 0.
        const Vec3* c = &corners_[facet.first_corner];
        const Vec3 e1 = c[1] - c[0], e2 = c[3] - c[0], e3 = c[2] - c[1] - e2;
        Vec3 p(0, 0, 0);
        for (int k = 0; k < 3; ++k) p += (c[of.corners[k]] - c[0]) * b[k];
        const auto cross = [&](const Vec3& x, const Vec3& y) { return x.cross(y).dot(facet.normal); };
        const float qa = -cross(e2, e3), qb = cross(p, e3) + cross(e1, e2), qc = cross(p, e1);
        const float root = qb + std::copysign(std::sqrt(std::max(qb * qb - 4 * qa * qc, 0.0f)), qb);
        t = root != 0 ? -2 * qc / root : 0;
        const Vec3 along = e1 + e3 * t;
        s = (p - e2 * t).dot(along) / std::max(along.length2(), 1e-37f);
    }
    return {std::clamp(s, 0.0f, 1.0f), std::clamp(t, 0.0f, 1.0f)};
}

uint32_t Elements::find(uint32_t slot, uint32_t triangle, float b1, float b2, bool behind) const {
    const TriangleOf& of = of_triangle(slot, triangle);
    if (of.facet == kNoElement) return kNoElement;
    const Facet& facet = facets_[of.facet];
    uint32_t out = facet.roots[behind ? 1 : 0];
    if (out == kNoElement || facet.shape == Facet::Shape::polygon) return out;
    const auto [s, t] = coordinates_at(of, b1, b2);

    const auto cell_at = [](float x, uint32_t count) {
        return std::min(static_cast<uint32_t>(x * static_cast<float>(count)), count - 1);
    };
    // The place within the cell, from 0 to 1, is followed down: of the elements on the way, nothing else is read.
    const bool quad = facet.shape == Facet::Shape::quad;
    float u = s * static_cast<float>(facet.across), v = t * static_cast<float>(facet.up);
    if (quad) {
        const uint32_t column = cell_at(s, facet.across), row = cell_at(t, facet.up);
        out += row * facet.across + column;
        u -= static_cast<float>(column), v -= static_cast<float>(row);
    } else {
        const uint32_t n = facet.across, row = cell_at(t, n), left = n - row,
                       column = std::min(static_cast<uint32_t>(u), left - 1);
        u -= static_cast<float>(column), v -= static_cast<float>(row);
        const bool turned = column + 1 < left && u + v > 1;
        out += n * n - left * left + 2 * column + turned;
        if (turned) u = 1 - u, v = 1 - v;
    }
    while (first_children_[out] != kNoElement) {
        uint32_t child;
        if (quad)
            child = (u >= 0.5f) + 2 * (v >= 0.5f);
        else
            child = u >= 0.5f ? 1 : v >= 0.5f ? 2 : u + v > 0.5f ? 3 : 0;
        out = first_children_[out] + child;
        u = 2 * u - static_cast<float>(child % 2), v = 2 * v - static_cast<float>(child / 2);
        if (!quad && child == 3) u = -u, v = -v;
    }
    return out;
}

void Elements::locate(const Facet& facet, float s, float t, uint32_t& triangle, float& b1, float& b2) const {
    const PlacedSurface& surface = snapshot_->surfaces[facet.slot];
    triangle = facet.triangle;
    if (facet.shape == Facet::Shape::polygon) {
        float share = s;
        triangle += triangle_by_area(facet, share);
        const float root = std::sqrt(share);
        b1 = root * (1 - t);
        b2 = root * t;
        return;
    }
    // The triangle in whose plane no weight is below 0, or least so: a quad has two.
    const Vec3 p = point(facet, s, t);
    float best = -1e30f;
    const uint32_t count = facet.shape == Facet::Shape::quad ? 2 : 1;
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t* v = surface.vertices + 3 * size_t{facet.triangle + k};
        const Vec3 p0 = surface.world_position(v[0]), e1 = surface.world_position(v[1]) - p0,
                   e2 = surface.world_position(v[2]) - p0, n = e1.cross(e2), d = p - p0;
        const float length2 = std::max(n.length2(), 1e-37f);
        const float w1 = d.cross(e2).dot(n) / length2, w2 = e1.cross(d).dot(n) / length2;
        const float least = std::min({w1, w2, 1 - w1 - w2});
        if (least <= best) continue;
        best = least;
        triangle = facet.triangle + k;
        b1 = std::clamp(w1, 0.0f, 1.0f);
        b2 = std::clamp(w2, 0.0f, 1.0f - b1);
    }
}

}  // namespace trp
