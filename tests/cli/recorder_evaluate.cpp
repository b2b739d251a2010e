// Evaluation of recorded node programs, as triptych.h defines the nodes. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "recorder.h"

namespace triptych::test {
namespace {

using Value = std::array<float, 4>;

template <typename Operation>
Value each(const Value& a, const Value& b, Operation operation) {
    Value result;
    for (size_t k = 0; k < 4; ++k) result[k] = operation(a[k], b[k]);
    return result;
}

// scaled, then turned, then moved
Value transformed(const RecordedNode& node, const Value& uv) {
    const float u = uv[0] * node.value[0], v = uv[1] * node.value[1];
    const float c = std::cos(node.value2[0]), s = std::sin(node.value2[0]);
    return {c * u - s * v + node.value[2], s * u + c * v + node.value[3], 0, 0};
}

}  // namespace

Value evaluate_node(const RecordedMaterial& material, int index, Value image, Value color, std::array<float, 2> uv) {
    const RecordedNode& node = material.nodes[static_cast<size_t>(index)];
    const auto input = [&](int slot) -> Value {
        if (node.inputs[slot] != TRP_NO_NODE) return evaluate_node(material, node.inputs[slot], image, color, uv);
        const float* value = slot == 0 ? node.value : slot == 1 ? node.value2 : node.value3;
        return {value[0], value[1], value[2], value[3]};
    };
    switch (node.type) {
        case TRP_NODE_CONSTANT:
            return {node.value[0], node.value[1], node.value[2], node.value[3]};
        case TRP_NODE_UV:
            return {uv[0], uv[1], 0, 0};
        case TRP_NODE_COLOR:
            return color;
        case TRP_NODE_IMAGE:
            return image;
        case TRP_NODE_NORMAL_MAP:
            return input(0);
        case TRP_NODE_UV_TRANSFORM:
            return transformed(node, input(0));
        case TRP_NODE_CHANNEL: {
            const float value = input(0)[static_cast<size_t>(node.value[0])];
            return {value, value, value, 1};
        }
        case TRP_NODE_ADD:
            return each(input(0), input(1), [](float a, float b) { return a + b; });
        case TRP_NODE_SUBTRACT:
            return each(input(0), input(1), [](float a, float b) { return a - b; });
        case TRP_NODE_MULTIPLY:
            return each(input(0), input(1), [](float a, float b) { return a * b; });
        case TRP_NODE_DIVIDE:
            return each(input(0), input(1), [](float a, float b) { return b == 0 ? 0 : a / b; });
        case TRP_NODE_POWER:
            return each(input(0), input(1), [](float a, float b) { return std::pow(std::max(a, 0.0f), b); });
        case TRP_NODE_GREATER:
            return each(input(0), input(1), [](float a, float b) { return a > b ? 1.0f : 0.0f; });
        case TRP_NODE_CLAMP:
            return each(input(0), input(0), [](float a, float) { return std::clamp(a, 0.0f, 1.0f); });
        case TRP_NODE_MIX: {
            const Value a = input(0), b = input(1), t = input(2);
            Value result;
            for (size_t k = 0; k < 4; ++k) result[k] = a[k] + (b[k] - a[k]) * t[k];
            return result;
        }
        default:
            return {0, 0, 0, 0};
    }
}

Value evaluate(const RecordedMaterial& material, const TrpCoefficient& coefficient, Value image, Value color,
               std::array<float, 2> uv) {
    Value value = {coefficient.value[0], coefficient.value[1], coefficient.value[2], 1};
    if (coefficient.node == TRP_NO_NODE) return value;
    const Value node = evaluate_node(material, coefficient.node, image, color, uv);
    for (size_t k = 0; k < 4; ++k) value[k] *= node[k];
    return value;
}

}  // namespace triptych::test
