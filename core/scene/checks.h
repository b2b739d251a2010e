// Checks that the validator shares.
#pragma once

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/vec.h"

namespace trp {

inline std::string text_of(const char* text) {
    return text ? text : "";
}

inline void check_range(const std::string& what, const char* field, double value, double low, double high) {
    if (!(value >= low && value <= high))
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
