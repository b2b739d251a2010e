// Gauss-Legendre quadrature.
#pragma once

#include <array>

namespace trp {

struct GaussRule {  // on 0 to 1
    std::array<double, 16> at{}, weight{};
};

// Of n points, 1 to 16.
const GaussRule& gauss_rule(int n);

}  // namespace trp
