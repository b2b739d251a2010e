// A material's node program under construction. SPDX-License-Identifier: Apache-2.0
#include "node_program.h"

#include <algorithm>
#include <cmath>

namespace triptych::cli {
namespace {

bool is_one(const std::array<float, 4>& values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return value == 1.0f; });
}

bool is_all(const Expression& expression, float number) {
    return expression.constant() &&
           std::all_of(expression.factor.begin(), expression.factor.begin() + 3, [=](float v) { return v == number; });
}

template <typename Operation>
Expression fold(const Expression& a, const Expression& b, Operation operation) {
    Expression result;
    for (size_t k = 0; k < 4; ++k) result.factor[k] = operation(a.factor[k], b.factor[k]);
    return result;
}

}  // namespace

TrpNode& NodeProgram::add(int32_t type) {
    TrpNode node;
    check(trp_node_init(&node, type));
    nodes_.push_back(node);
    return nodes_.back();
}

const char* NodeProgram::keep(const std::string& text) {
    names_.push_back(text);
    return names_.back().c_str();
}

int32_t NodeProgram::node_of(const Expression& expression) {
    if (!expression.constant() && is_one(expression.factor)) return expression.node;
    TrpNode& node = add(expression.constant() ? TRP_NODE_CONSTANT : TRP_NODE_MULTIPLY);
    if (expression.constant()) {
        std::copy(expression.factor.begin(), expression.factor.end(), node.value);
    } else {
        node.inputs[0] = expression.node;
        node.inputs[1] = TRP_NO_NODE;
        std::copy(expression.factor.begin(), expression.factor.end(), node.value2);
    }
    return last();
}

void NodeProgram::input(TrpNode& node, int slot, const Expression& expression) {
    node.inputs[slot] = expression.node;
    float* value = slot == 0 ? node.value : slot == 1 ? node.value2 : node.value3;
    std::copy(expression.factor.begin(), expression.factor.end(), value);
}

Expression NodeProgram::binary(int32_t type, const Expression& a, const Expression& b) {
    // Factors of inputs that are nodes become nodes of their own first: they must stand before the one that reads them.
    const Expression first = a.constant() ? a : Expression{{1, 1, 1, 1}, node_of(a)};
    const Expression second = b.constant() ? b : Expression{{1, 1, 1, 1}, node_of(b)};
    TrpNode& node = add(type);
    input(node, 0, first);
    input(node, 1, second);
    return {{1, 1, 1, 1}, last()};
}

Expression NodeProgram::sum(const Expression& a, const Expression& b) {
    if (a.constant() && b.constant()) return fold(a, b, [](float x, float y) { return x + y; });
    return binary(TRP_NODE_ADD, a, b);
}

Expression NodeProgram::difference(const Expression& a, const Expression& b) {
    if (a.constant() && b.constant()) return fold(a, b, [](float x, float y) { return x - y; });
    return binary(TRP_NODE_SUBTRACT, a, b);
}

Expression NodeProgram::product(const Expression& a, const Expression& b) {
    if (!a.constant() && !b.constant()) return binary(TRP_NODE_MULTIPLY, a, b);
    Expression result = fold(a, b, [](float x, float y) { return x * y; });
    result.node = a.constant() ? b.node : a.node;
    return result;
}

Expression NodeProgram::quotient(const Expression& a, const Expression& b) {
    if (a.constant() && b.constant()) return fold(a, b, [](float x, float y) { return y == 0.0f ? 0.0f : x / y; });
    return binary(TRP_NODE_DIVIDE, a, b);
}

Expression NodeProgram::power(const Expression& base, float exponent) {
    const Expression second = Expression::of(exponent);
    if (base.constant()) return fold(base, second, [](float x, float y) { return std::pow(std::max(x, 0.0f), y); });
    return binary(TRP_NODE_POWER, base, second);
}

Expression NodeProgram::mix(const Expression& a, const Expression& b, const Expression& t) {
    if (is_all(t, 0.0f)) return a;
    if (is_all(t, 1.0f)) return b;
    if (t.constant() && a.constant() && b.constant()) return sum(a, product(difference(b, a), t));
    const auto plain = [this](const Expression& e) { return e.constant() ? e : Expression{{1, 1, 1, 1}, node_of(e)}; };
    const Expression first = plain(a), second = plain(b), third = plain(t);
    TrpNode& node = add(TRP_NODE_MIX);
    input(node, 0, first);
    input(node, 1, second);
    input(node, 2, third);
    return {{1, 1, 1, 1}, last()};
}

Expression NodeProgram::greater(const Expression& a, const Expression& b) {
    if (a.constant() && b.constant()) return fold(a, b, [](float x, float y) { return x > y ? 1.0f : 0.0f; });
    return binary(TRP_NODE_GREATER, a, b);
}

Expression NodeProgram::clamped(const Expression& a) {
    if (a.constant()) return fold(a, a, [](float x, float) { return std::clamp(x, 0.0f, 1.0f); });
    const int32_t source = node_of(a);
    add(TRP_NODE_CLAMP).inputs[0] = source;
    return {{1, 1, 1, 1}, last()};
}

Expression NodeProgram::channel(const Expression& a, int index) {
    if (a.constant()) return Expression::of(a.factor[static_cast<size_t>(index)]);
    TrpNode& node = add(TRP_NODE_CHANNEL);
    node.inputs[0] = a.node;
    node.value[0] = static_cast<float>(index);
    const float factor = a.factor[static_cast<size_t>(index)];
    return {{factor, factor, factor, 1.0f}, last()};
}

TrpCoefficient NodeProgram::coefficient(const Expression& expression) const {
    return {{expression.factor[0], expression.factor[1], expression.factor[2]}, expression.node};
}

}  // namespace triptych::cli
