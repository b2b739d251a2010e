// TrpMaterialDesc → Material.
#include <limits>

#include "scene/checks.h"
#include "scene/describe.h"
#include "scene/nodes.h"

namespace trp {
namespace {

constexpr uint32_t kMaxNodes = 4096;

Node describe_node(const std::string& what, const TrpNode& in, uint32_t index) {
    const std::string name = fmt::format("{}: nodes[{}]", what, index);
    check_enum(name, "type", in.type, static_cast<int32_t>(kNodeTypeCount) - 1);
    Node node;
    node.type = in.type;
    node.texture = in.texture;
    node.name = text_of(in.name);
    const float* values[TRP_NODE_INPUTS] = {in.value, in.value2, in.value3};
    for (uint32_t k = 0; k < TRP_NODE_INPUTS; ++k) {
        node.inputs[k] = k < kNodeTypes[in.type].inputs ? in.inputs[k] : TRP_NO_NODE;
        if (node.inputs[k] < TRP_NO_NODE || node.inputs[k] >= static_cast<int32_t>(index))
            fail(TRP_ERROR_ARGUMENT, "{}.inputs[{}] is {}; a node reads only nodes before it", name, k, node.inputs[k]);
        for (int c = 0; c < 4; ++c) {
            if (!std::isfinite(values[k][c]))
                fail(TRP_ERROR_ARGUMENT, "{}: value{}[{}] is {}", name, k ? std::to_string(k + 1) : "", c,
                     values[k][c]);
            node.values[k][c] = values[k][c];
        }
    }
    if (node.type == TRP_NODE_CHANNEL) check_range(name, "value[0]", node.values[0][0], 0, 3);
    if (node.type == TRP_NODE_IMAGE && node.texture == TRP_NO_ID)
        fail(TRP_ERROR_ARGUMENT, "{}: no texture is named", name);
    return node;
}

}  // namespace

Material describe(const TrpMaterialDesc& desc, uint32_t id) {
    Material material;
    material.name = text_of(desc.name);
    const std::string what = item_name("material", id, material.name);
    if (desc.node_count > kMaxNodes)
        fail(TRP_ERROR_ARGUMENT, "{}: {} nodes, at most {}", what, desc.node_count, kMaxNodes);
    if (desc.node_count && !desc.nodes)
        fail(TRP_ERROR_ARGUMENT, "{}: nodes is null, with a count of {}", what, desc.node_count);
    material.nodes.reserve(desc.node_count);
    for (uint32_t i = 0; i < desc.node_count; ++i) material.nodes.push_back(describe_node(what, desc.nodes[i], i));

    auto coefficient = [&](const char* field, const TrpCoefficient& in, int channels, double low, double high) {
        for (int k = 0; k < channels; ++k)
            check_range(what, fmt::format("{}.value[{}]", field, k).c_str(), in.value[k], low, high);
        if (in.node < TRP_NO_NODE || in.node >= static_cast<int32_t>(desc.node_count))
            fail(TRP_ERROR_ARGUMENT, "{}: {}.node is {}; there are {} nodes", what, field, in.node, desc.node_count);
        Coefficient out;
        for (int k = 0; k < 3; ++k) out.value[k] = in.value[k < channels ? k : 0];
        out.node = in.node;
        return out;
    };
    constexpr double kGreatest = std::numeric_limits<float>::max();
    material.emission = coefficient("emission", desc.emission, 3, 0, kGreatest);
    material.diffuse = coefficient("diffuse", desc.diffuse, 3, 0, kGreatest);
    material.specular = coefficient("specular", desc.specular, 3, 0, kGreatest);
    material.shininess = coefficient("shininess", desc.shininess, 1, 0, 1e6);
    material.transmission = coefficient("transmission", desc.transmission, 3, 0, kGreatest);
    material.ior = coefficient("ior", desc.ior, 1, 1e-3, 1e3);
    material.alpha = coefficient("alpha", desc.alpha, 1, 0, 1);
    material.ambient =
        desc.ambient_is_diffuse ? material.diffuse : coefficient("ambient", desc.ambient, 3, 0, kGreatest);
    material.mirror = desc.mirror_is_specular ? material.specular : coefficient("mirror", desc.mirror, 3, 0, kGreatest);
    material.normal = desc.normal;
    if (desc.normal < TRP_NO_NODE || desc.normal >= static_cast<int32_t>(desc.node_count))
        fail(TRP_ERROR_ARGUMENT, "{}: normal is {}; there are {} nodes", what, desc.normal, desc.node_count);
    if (desc.normal != TRP_NO_NODE && material.nodes[desc.normal].type != TRP_NODE_NORMAL_MAP)
        fail(TRP_ERROR_ARGUMENT, "{}: normal names nodes[{}], which gives no normal", what, desc.normal);
    material.thin = desc.thin;
    material.double_sided = desc.double_sided;
    material.index = desc.index;
    material.fresnel = desc.fresnel;
    material.priority = desc.priority;
    for (int k = 0; k < 3; ++k) {
        check_range(what, fmt::format("absorption[{}]", k).c_str(), desc.absorption[k], 0, kGreatest);
        material.absorption[k] = desc.absorption[k];
    }
    return material;
}

}  // namespace trp
