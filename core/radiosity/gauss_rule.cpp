#include "radiosity/gauss_rule.h"

#include <cmath>
#include <numbers>

namespace trp {

const GaussRule& gauss_rule(int n) {
    static const std::array<GaussRule, 17> rules = [] {
        std::array<GaussRule, 17> made{};
        for (int order = 1; order <= 16; ++order)
            for (int i = 0; i < order; ++i) {
                double x = std::cos(std::numbers::pi * (i + 0.75) / (order + 0.5)), slope = 1;
                for (int step = 0; step < 8; ++step) {  // Newton's, on the polynomial by its recurrence
                    double p = 1, before = 0;
                    for (int k = 1; k <= order; ++k) {
                        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                        before = p, p = next;
                    }
                    slope = order * (x * p - before) / (x * x - 1);
                    x -= p / slope;
                }
                const auto at = static_cast<size_t>(i);
                made[static_cast<size_t>(order)].at[at] = 0.5 * (1 + x);
                made[static_cast<size_t>(order)].weight[at] = 1 / ((1 - x * x) * slope * slope);
            }
        return made;
    }();
    return rules[static_cast<size_t>(n)];
}

}  // namespace trp
