// Time that statistics tell.
#pragma once

#include <chrono>
#include <cstdint>

namespace trp {

using Clock = std::chrono::steady_clock;

inline uint64_t nanoseconds(Clock::time_point from, Clock::time_point to) {
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(to - from).count());
}
inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace trp
