// The solution between the elements: irradiance at their corners, the mean of the elements around each by area, and
// interpolated in each element, so that it is continuous wherever the surface is smooth.
//
// Corners at one position are one vertex where they belong to one side of one object and its shading normals agree. An
// element along whose side its neighbours are smaller has their corners in that side (T-vertices), and is interpolated
// in triangles about its middle, so that both sides of an edge agree.
#pragma once

#include <array>
#include <vector>

#include "radiosity/solver.h"

namespace trp {

struct ElementVertex {
    Vec3 position{0, 0, 0}, normal{0, 0, 1};
    uint32_t slot = 0;
    uint8_t side = 0;
};

class ElementVertices {
  public:
    // Of the leaves. Runs in the current arena.
    explicit ElementVertices(const Elements& elements);

    const std::vector<ElementVertex>& vertices() const { return vertices_; }
    // The vertices around a leaf, counter-clockwise about the front of its facet, with those of smaller neighbours.
    std::span<const uint32_t> around(uint32_t leaf) const {
        return {&loop_[first_[leaf]], first_[leaf + 1] - first_[leaf]};
    }
    // Means of the leaves' values by the area that is not covered, at all vertices. `slopes`: of each leaf's value
    // along its facet's axes, as Linear has them; or empty.
    std::vector<Vec3> average(const Elements& elements, const std::vector<Vec3>& values,
                              const std::vector<std::array<Vec3, 2>>& slopes) const;
    // How a leaf is interpolated: not at all, as polygons are; between its three or four corners; or, where there are
    // more vertices around it, in triangles about its middle.
    enum class Way : uint8_t { constant, linear, bilinear, triangle_sectors, quad_sectors };
    Way way(uint32_t leaf) const { return ways_[leaf]; }
    // Whether the neighbours along a side have less than half of it each.
    bool has_small_neighbours(uint32_t leaf) const;
    // What vertices have, and the leaf in its middle, at a place in a leaf with sectors: u and v from 0 to 1 along the
    // sides that meet in its first corner.
    Vec3 in_sectors(uint32_t leaf, float u, float v, const std::vector<Vec3>& at_vertices,
                    const std::vector<Vec3>& at_leaves) const;

  private:
    uint32_t find(const Vec3& position, const Vec3& normal, uint32_t slot, uint8_t side) const;
    uint32_t add(const Vec3& position, const Vec3& normal, uint32_t slot, uint8_t side);
    void add_between(uint32_t a, uint32_t b, int depth);
    template <class Take>
    void for_each_cell(const Vec3& position, Take&& take) const;

    std::vector<ElementVertex> vertices_;
    std::vector<uint32_t> loop_, first_;
    std::vector<uint8_t> corners_;        // of each entry of loop_: 1 where it is a corner of its leaf
    std::vector<Way> ways_;               // by element
    std::vector<uint32_t> heads_, next_;  // of the hash table
    float grid_ = 1;
};

}  // namespace trp
