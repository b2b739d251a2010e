// What the links of the hierarchy say of its leaves: which bring light to one, and how much of all that leaves the
// scene's surfaces arrives at each.
#pragma once

#include <array>
#include <functional>

#include "radiosity/links.h"

namespace trp {

struct LinkTree {
    const Elements& elements;
    const ElementClusters& clusters;
    std::span<const Link> links;
};

// Numbers of the links to a leaf, and to what it is a part of, from the leaf upwards.
std::vector<uint64_t> links_to_leaf(const LinkTree& tree, uint32_t leaf);

// By element, of leaves the irradiance where a radiosity of 1 leaves everything: the sums of their form factors.
// `offset`: of an element's middle from that of the whole it is a part of, along its facet's axes.
std::vector<double> link_sums(const LinkTree& tree, const std::function<std::array<float, 2>(uint32_t)>& offset);

}  // namespace trp
