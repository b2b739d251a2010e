#include "scene/nodes.h"

namespace trp {

// In the order of the enumeration, so that a type is its own row.
const NodeType kNodeTypes[] = {
    {TRP_NODE_CONSTANT, "constant", "value", 0},
    {TRP_NODE_UV, "uv", "The UV set `name`, or the first; 0 on a mesh without it", 0},
    {TRP_NODE_COLOR, "color", "The vertex colour layer `name`, or the first; 1 on a mesh without it", 0},
    {TRP_NODE_OBJECT_COLOR, "object_color", "The instance's colour", 0},
    {TRP_NODE_IMAGE, "image", "A texture at inputs[0], or at the first UV set, filtered by footprint", 1},
    {TRP_NODE_NORMAL_MAP, "normal_map", "A tangent-space normal, inputs[0], in the UV set `name`, of strength value[0]",
     1},
    {TRP_NODE_UV_TRANSFORM, "uv_transform",
     "inputs[0] scaled by value[0, 1], turned by value2[0], moved by value[2, 3]", 1},
    {TRP_NODE_CHANNEL, "channel", "Channel value[0] of inputs[0]", 1},
    {TRP_NODE_ADD, "add", "inputs[0] + inputs[1]", 2},
    {TRP_NODE_SUBTRACT, "subtract", "inputs[0] - inputs[1]", 2},
    {TRP_NODE_MULTIPLY, "multiply", "inputs[0] * inputs[1]", 2},
    {TRP_NODE_DIVIDE, "divide", "inputs[0] / inputs[1]; 0 where the divisor is 0", 2},
    {TRP_NODE_POWER, "power", "max(inputs[0], 0) to the power of inputs[1]", 2},
    {TRP_NODE_MIX, "mix", "From inputs[0] to inputs[1] by inputs[2]", 3},
    {TRP_NODE_CLAMP, "clamp", "inputs[0] held between 0 and 1", 1},
    {TRP_NODE_GREATER, "greater", "1 where inputs[0] > inputs[1], else 0", 2},
};
const uint32_t kNodeTypeCount = sizeof kNodeTypes / sizeof kNodeTypes[0];

}  // namespace trp
