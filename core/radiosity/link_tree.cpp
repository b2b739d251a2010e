#include "radiosity/link_tree.h"

namespace trp {

// Numbers of wholes are below those of their parts, of elements and of clusters alike.

std::vector<uint64_t> links_to_leaf(const LinkTree& tree, uint32_t leaf) {
    const auto& clusters = tree.clusters.clusters;
    std::vector<NodeId> nodes = {leaf};  // and the wholes
    for (uint32_t i = leaf; i-- > 0;)
        if (!tree.elements[i].leaf() && nodes.back() - tree.elements[i].first_child < 4) nodes.push_back(i);
    for (auto k = static_cast<uint32_t>(clusters.size()); k-- > 0;)
        if (clusters[k].children[0] == nodes.back() || clusters[k].children[1] == nodes.back())
            nodes.push_back(k | kClusterBit);
    std::vector<uint64_t> out;
    for (const NodeId id : nodes)
        for (size_t l = 0; l < tree.links.size(); ++l)
            if (tree.links[l].receiver == id) out.push_back(l);
    return out;
}

}  // namespace trp
