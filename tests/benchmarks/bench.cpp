#include "bench.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

namespace trp_bench {

double process_cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Cost cost_of(const std::function<void()>& work) {
    const double cpu = process_cpu_seconds();
    const auto start = Clock::now();
    work();
    const double wall = seconds_since(start);
    return {wall, process_cpu_seconds() - cpu};
}

double median(std::vector<double> values) {
    if (values.empty()) return kNone;
    std::sort(values.begin(), values.end());
    const size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double median_wall(const std::vector<Cost>& costs) {
    std::vector<double> values;
    for (const Cost& cost : costs) values.push_back(cost.wall);
    return median(std::move(values));
}

double median_cpu(const std::vector<Cost>& costs) {
    std::vector<double> values;
    for (const Cost& cost : costs) values.push_back(cost.cpu);
    return median(std::move(values));
}

void print(const Row& row) {
    nlohmann::ordered_json line;
    line["name"] = row.name;
    line["value"] = row.value;
    line["unit"] = row.unit;
    line["peer"] = row.peer.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(row.peer);
    line["peer_value"] = row.peer_value;  // what is not a number is written as null
    line["ratio"] = row.ratio;
    line["goal"] = row.goal;
    std::puts(line.dump().c_str());
    std::fflush(stdout);
}

void print_against(const std::string& name, double value, const std::string& unit, const std::string& peer,
                   double peer_value, double goal) {
    print({name, value, unit, peer, peer_value, value / peer_value, goal});
}

void print_value(const std::string& name, double value, const std::string& unit, double goal) {
    print({name, value, unit, {}, kNone, kNone, goal});
}

int run(const char* program, const std::function<void()>& work) {
    try {
        work();
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: error: %s\n", program, error.what());
        return 1;
    }
}

}  // namespace trp_bench
