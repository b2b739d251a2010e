// What the benchmarks share: clocks, medians, and the lines that scripts/bench collects. Seconds throughout.
#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace trp_bench {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Wall time, and processor time of all threads of the process.
struct Cost {
    double wall = 0, cpu = 0;
};

double process_cpu_seconds();
Cost cost_of(const std::function<void()>& work);

double median(std::vector<double> values);
double median_wall(const std::vector<Cost>& costs);
double median_cpu(const std::vector<Cost>& costs);

// A figure beside its peer. The goal is the most that `ratio` may be, or `value` where there is no ratio.
struct Row {
    std::string name;
    double value = kNone;
    std::string unit;
    std::string peer;  // empty: none, and then the two below are none as well
    double peer_value = kNone, ratio = kNone;
    double goal = kNone;  // none: for information
};

// Writes the row to standard output, as one line of JSON.
void print(const Row& row);

// A row whose ratio is that of its values.
void print_against(const std::string& name, double value, const std::string& unit, const std::string& peer,
                   double peer_value, double goal = kNone);

// A row without a peer.
void print_value(const std::string& name, double value, const std::string& unit, double goal = kNone);

// Runs `work`; where it throws, says so on standard error. Returns the exit code.
int run(const char* program, const std::function<void()>& work);

}  // namespace trp_bench
