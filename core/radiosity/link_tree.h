// Which links of the hierarchy bring light to a leaf.
#pragma once

#include "radiosity/links.h"

namespace trp {

struct LinkTree {
    const Elements& elements;
    const ElementClusters& clusters;
    std::span<const Link> links;
};

// Numbers of the links to a leaf, and to what it is a part of, from the leaf upwards.
std::vector<uint64_t> links_to_leaf(const LinkTree& tree, uint32_t leaf);

}  // namespace trp
