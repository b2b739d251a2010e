// The surfaces of a scene cut into elements, of which radiosity is constant in each.
//
// Faces become facets: quads that are plane and convex, and triangles, which can be divided at will; what is neither is
// cut into triangles, or where a face is to be one element, taken as the polygon that it is. A facet has up to two
// sides, each with a grid of roots of its own, and each root may be divided in four, and these again: quad-trees whose
// leaves are the elements. Positions are relative to the snapshot's origin; areas in m².
#pragma once

#include <array>
#include <bit>
#include <span>
#include <vector>

#include "shading/snapshot.h"

namespace trp {

inline constexpr uint32_t kNoElement = ~0u;
inline constexpr uint16_t kAllCovered = 0xFFFF;

// How the area of a quad is spread over its coordinates, which is linear in both: at (0, 0), and what it changes by. Of
// no unit; constant where it is a parallelogram.
struct QuadArea {
    float at_0 = 1, by_s = 0, by_t = 0;
};
QuadArea area_over(std::span<const Vec3d> corners, const Vec3& normal);
// The coordinate below which a share u of a density lies that is `at_0` at 0 and changes by `change` to 1.
float part_below(float at_0, float change, float u);

struct Facet {
    enum class Shape : uint8_t { triangle, quad, polygon };
    uint32_t slot = 0, face = 0, triangle = 0;  // of the placed surface; the first triangle
    Shape shape = Shape::triangle;
    bool skewed = false;                          // a quad that is no parallelogram
    QuadArea spread;                              // of a skewed one
    uint32_t first_corner = 0, corner_count = 0;  // in Elements, counter-clockwise about the normal
    Vec3 normal{0, 0, 1};
    float area = 0;
    uint32_t across = 1, up = 1;                   // roots; a triangle's grid has across² of them
    uint32_t roots[2] = {kNoElement, kNoElement};  // the first of the front and of the back; none: not lit
    uint32_t material = 0;                         // index into Snapshot::materials
};

// A cell of a facet: the part [s, s + ds] × [t, t + dt] of a quad, or of a triangle the corner (s, t) and the legs ds
// and dt, which are below 0 in the cells that stand on their heads.
struct Element {
    uint32_t facet = 0;
    uint32_t first_child = kNoElement;  // four in a row
    float s = 0, t = 0, ds = 1, dt = 1;
    float area = 0;
    Vec3 centre{0, 0, 0};
    uint8_t side = 0;
    // Of its 16 places, a bit to each: those that lie within or under another body, where no light comes and nobody
    // sees. Neither none nor all in an element that is new: it has still to be looked at (find_covered()).
    uint16_t covered = 0;
    float exposed() const { return 1 - static_cast<float>(std::popcount(covered)) / 16; }  // share of the area
    double exposed_area() const { return static_cast<double>(area * exposed()); }
    bool leaf() const { return first_child == kNoElement; }
};

class Elements {
  public:
    // `size`: of the elements' sides in metres, at most; 0: one to a face. `divisible`: all faces must be quads or
    // triangles.
    Elements(std::shared_ptr<const Snapshot> snapshot, float size, bool divisible);

    // The same facets undivided, both sides of each: elements 2 f and 2 f + 1.
    Elements whole_facets() const;

    const Snapshot& snapshot() const { return *snapshot_; }
    const std::vector<Facet>& facets() const { return facets_; }
    const Element& operator[](uint32_t element) const { return elements_[element]; }
    uint32_t size() const { return static_cast<uint32_t>(elements_.size()); }
    bool leaf(uint32_t element) const { return first_children_[element] == kNoElement; }
    const Facet& facet_of(uint32_t element) const { return facets_[elements_[element].facet]; }
    Vec3 normal(uint32_t element) const { return facet_of(element).normal * (elements_[element].side ? -1.0f : 1.0f); }
    double area() const { return area_; }  // of all leaves

    // Makes the roots of a facet's side, in the order of asking. Throws Error, as divide() does, where there would be
    // more elements than can be numbered.
    void add_side(uint32_t facet, int side);
    // Divides a leaf in four.
    void divide(uint32_t element);
    // One of four parts of an element, as divide() makes them; of a polygon, all of it.
    Element quarter(uint32_t element, uint32_t number) const;
    void set_covered(uint32_t element, uint16_t covered) { elements_[element].covered = covered; }
    // Takes back the divisions that made elements from number `size` on.
    void merge(uint32_t size);

    std::span<const Vec3> corners_of(const Facet& facet) const {
        return {&corners_[facet.first_corner], facet.corner_count};
    }
    // A point of a facet by its coordinates.
    Vec3 point(const Facet& facet, float s, float t) const;
    // The facet's coordinates of a point of an element that is given by coordinates of its own, as in point_in(); those
    // themselves in a polygon.
    std::array<float, 2> coordinates_in(const Element& element, float u, float v) const;
    // The facet's coordinates of one of 16 places of an element, the middles of its quarters' quarters: number 4 i + j
    // in quarter i; of a polygon, a point for each.
    std::array<float, 2> place_in(uint32_t element, uint32_t number) const;
    Vec3 place_point(uint32_t element, uint32_t number) const;
    // A point of an element by coordinates of its own, both in [0, 1]; uniform in area where u and v are.
    Vec3 point_in(const Element& element, float u, float v) const;
    Vec3 point_in(uint32_t element, float u, float v) const { return point_in(elements_[element], u, v); }
    float radius(uint32_t element) const;  // of a ball about its centre that holds it
    // Three or four corners, or those of a polygon, counter-clockwise about the element's normal.
    void corners(uint32_t element, std::vector<Vec3d>& out) const;

    // The facet that a triangle of a surface shows, if any, which of its corners the triangle's are, and what
    // find_elements() is to know of both, until there are other elements or sides.
    struct TriangleOf {
        enum Flag : uint8_t {
            kTriangle = 1,  // the facet is one
            kSkewed = 2,    // or a quad that is no parallelogram
            kPass = 4,      // rays may go on from the facet: by a hole, glass or a mirror
            kOneSided = 8,  // the eye's go on from its back, too
        };
        uint32_t facet = kNoElement;
        uint8_t corners[3] = {0, 1, 2};
        uint8_t flags = 0;
        // The facet's.
        Vec3 normal{0, 0, 0};
        uint16_t across = 1, up = 1;
        uint32_t roots[2] = {kNoElement, kNoElement};
        float twist[2] = {0, 0};  // of a quad: what its third corner has more than the parallelogram's, in its sides
    };
    const TriangleOf& of_triangle(uint32_t slot, uint32_t triangle) const {
        return triangles_[size_t{first_triangles_[slot]} + triangle];
    }
    // The coordinates in its facet, which is no polygon, of a point of a triangle.
    std::array<float, 2> coordinates_at(const TriangleOf& of, float b1, float b2) const;
    // By element, as Element has it.
    const uint32_t* first_children() const { return first_children_.data(); }
    struct Lookup {
        const TriangleOf* triangles;
        const uint32_t* first_triangles;  // by slot
        const uint32_t* first_children;   // null: no element is divided
    };
    Lookup lookup() const {
        return {triangles_.data(), first_triangles_.data(), divided_ ? first_children_.data() : nullptr};
    }

    // The element that lies at a point of a surface; kNoElement where that side has none. LeafLanes has it for batches.
    uint32_t find(uint32_t slot, uint32_t triangle, float b1, float b2, bool behind) const;
    // As a ray in that direction meets it.
    uint32_t find(uint32_t slot, uint32_t triangle, float b1, float b2, const Vec3& direction) const {
        return find(slot, triangle, b1, b2, is_behind(slot, triangle, direction));
    }
    bool is_behind(uint32_t slot, uint32_t triangle, const Vec3& direction) const {
        const uint32_t facet = of_triangle(slot, triangle).facet;
        return facet != kNoElement && facets_[facet].normal.dot(direction) > 0;
    }
    // And the triangle of the surface, with its barycentrics, that shows a point of a facet; of a polygon, which has no
    // coordinates, one that is uniform in area where s and t are.
    void locate(const Facet& facet, float s, float t, uint32_t& triangle, float& b1, float& b2) const;

  private:
    void add_face(uint32_t slot, uint32_t face, uint32_t first_triangle, uint32_t triangle_count);
    void add_facet(Facet facet, std::span<const Vec3> corners);
    void tell_triangles(uint32_t facet);
    void set_grid(Facet& facet) const;
    uint32_t triangle_by_area(const Facet& facet, float& share) const;
    Vec3 corner(const Element& element, uint32_t k) const;  // about the facet's normal
    Element cell(const Facet& facet, uint32_t number) const;
    void finish(Element& element) const;

    std::shared_ptr<const Snapshot> snapshot_;
    float size_;
    bool divisible_;
    std::vector<Facet> facets_;
    std::vector<Vec3> corners_;
    std::vector<TriangleOf> triangles_;  // slot by slot
    std::vector<Element> elements_;
    std::vector<uint32_t> first_children_;  // as elements have them, close together for those who look for leaves
    double area_ = 0;
    std::vector<uint32_t> first_triangles_;  // by slot
    bool divided_ = false;                   // an element is
};

}  // namespace trp
