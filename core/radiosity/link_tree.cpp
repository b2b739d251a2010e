#include "radiosity/link_tree.h"

#include <algorithm>

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

std::vector<double> link_sums(const LinkTree& tree, const std::function<std::array<float, 2>(uint32_t)>& offset) {
    struct Sum {
        double mean = 0, x = 0, y = 0;  // as Linear has them
    };
    const auto& clusters = tree.clusters.clusters;
    std::vector<Sum> of_clusters(clusters.size()), of_elements(tree.elements.size());
    const auto sum_of = [&](NodeId id) -> Sum& {
        return is_cluster(id) ? of_clusters[id & ~kClusterBit] : of_elements[id];
    };
    for (const Link& link : tree.links) {
        const double tint = static_cast<double>(link.tint.x + link.tint.y + link.tint.z) / 3;
        Sum& sum = sum_of(link.receiver);
        sum.mean += tint * static_cast<double>(link.transfer[0]);
        sum.x += tint * static_cast<double>(link.transfer[3]);
        sum.y += tint * static_cast<double>(link.transfer[6]);
    }
    for (size_t k = 0; k < clusters.size(); ++k)
        for (const NodeId child : clusters[k].children) sum_of(child).mean += of_clusters[k].mean;
    std::vector<double> out;
    for (uint32_t i = 0; i < tree.elements.size(); ++i) {
        const Sum& whole = of_elements[i];
        out.push_back(whole.mean);
        for (uint32_t k = 0; k < 4 && !tree.elements[i].leaf(); ++k) {
            const uint32_t child = tree.elements[i].first_child + k;
            const auto [x, y] = offset(child);
            Sum& part = of_elements[child];
            part.mean += whole.mean + whole.x * static_cast<double>(x) + whole.y * static_cast<double>(y);
            part.x += whole.x;
            part.y += whole.y;
        }
    }
    return out;
}

}  // namespace trp
