// A material's node program under construction. An expression is factor · node, or a constant; arithmetic on constants
// is done here, so that a material without pictures needs no nodes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <string>
#include <vector>

#include "error.h"

namespace triptych::cli {

// `factor`, number by number, times the value of `node`; `factor` alone where node is TRP_NO_NODE.
struct Expression {
    std::array<float, 4> factor{1.0f, 1.0f, 1.0f, 1.0f};
    int32_t node = TRP_NO_NODE;

    bool constant() const { return node == TRP_NO_NODE; }
    static Expression of(float value) { return {{value, value, value, value}, TRP_NO_NODE}; }
    static Expression of(float r, float g, float b, float a = 1.0f) { return {{r, g, b, a}, TRP_NO_NODE}; }
};

class NodeProgram {
  public:
    // A node with its defaults, to be filled by the caller before the next one is made.
    TrpNode& add(int32_t type);
    int32_t last() const { return static_cast<int32_t>(nodes_.size()) - 1; }
    // A copy of `text` that lives as long as the program, for TrpNode.name.
    const char* keep(const std::string& text);

    // `expression` as a node that others can read.
    int32_t node_of(const Expression& expression);

    Expression sum(const Expression& a, const Expression& b);
    Expression difference(const Expression& a, const Expression& b);
    Expression product(const Expression& a, const Expression& b);
    Expression quotient(const Expression& a, const Expression& b);
    Expression power(const Expression& base, float exponent);  // of max(base, 0)
    Expression mix(const Expression& a, const Expression& b, const Expression& t);
    Expression greater(const Expression& a, const Expression& b);
    Expression clamped(const Expression& a);
    Expression channel(const Expression& a, int index);
    Expression one_minus(const Expression& a) { return difference(Expression::of(1.0f), a); }

    TrpCoefficient coefficient(const Expression& expression) const;
    const std::vector<TrpNode>& nodes() const { return nodes_; }

  private:
    Expression binary(int32_t type, const Expression& a, const Expression& b);
    void input(TrpNode& node, int slot, const Expression& expression);

    std::vector<TrpNode> nodes_;
    std::deque<std::string> names_;
};

}  // namespace triptych::cli
