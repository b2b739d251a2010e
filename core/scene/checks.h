// Checks that the validator shares.
#pragma once

#include <cmath>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "base/vec.h"

namespace trp {

inline std::string text_of(const char* text) {
    return text ? text : "";
}

// A template, so that the message has the value in its own type: 0.1, not 0.10000000149011612.
template <class Number>
void check_range(const std::string& what, const char* field, Number value, double low, double high) {
    using Limit = std::conditional_t<std::is_same_v<Number, float>, float, double>;
    if (!(value >= static_cast<Limit>(low) && value <= static_cast<Limit>(high)))
        fail(TRP_ERROR_ARGUMENT, "{}: {} is {}, which is not between {} and {}", what, field, value, low, high);
}

inline void check_enum(const std::string& what, const char* field, int32_t value, int32_t last) {
    if (value < 0 || value > last)
        fail(TRP_ERROR_ARGUMENT, "{}: {} is {}, which is none of the values 0 to {}", what, field, value, last);
}

// Finite and not negative.
inline void check_color(const std::string& what, const char* field, const float* c) {
    for (int k = 0; k < 3; ++k)
        if (!(c[k] >= 0) || std::isinf(c[k]))
            fail(TRP_ERROR_ARGUMENT, "{}: {}[{}] is {}, not a finite number from 0", what, field, k, c[k]);
}

}  // namespace trp
