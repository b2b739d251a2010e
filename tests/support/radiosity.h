// Radiosity solutions for tests.
#pragma once

#include "support/abi.h"

namespace trp_test {

class Solution {
  public:
    using Settings = std::vector<std::pair<std::string, std::string>>;
    Solution(TrpScene* scene, const Settings& settings) {
        check(trp_scene_commit(scene, 0));
        check(trp_radiosity_create(scene, &handle_));
        for (const auto& [name, value] : settings) check(trp_radiosity_set(handle_, name.c_str(), value.c_str()));
    }
    ~Solution() { trp_radiosity_destroy(handle_); }
    Solution(const Solution&) = delete;
    Solution& operator=(const Solution&) = delete;
    operator TrpRadiosity*() const { return handle_; }

    Solution& prepare() {
        check(trp_radiosity_prepare(handle_, nullptr));
        return *this;
    }
    Solution& step(uint32_t count) {
        check(trp_radiosity_step(handle_, count, nullptr));
        return *this;
    }
    Solution& solve() {
        check(trp_radiosity_solve(handle_, nullptr));
        return *this;
    }
    TrpRadiosityInfo info() const {
        TrpRadiosityInfo info{};
        info.struct_size = sizeof info;
        check(trp_radiosity_info(handle_, &info));
        return info;
    }
    // So many numbers to each element, or to each vertex for names that begin so.
    std::vector<float> read(const std::string& name, size_t channels) const {
        const bool of_vertices = name.starts_with("vertex");
        std::vector<float> out(channels * (of_vertices ? info().vertex_count : info().element_count));
        check(trp_radiosity_read(handle_, name.c_str(), out.data(), out.size()));
        return out;
    }
    // The first of the colours, element by element.
    std::vector<double> red(const std::string& name) const {
        const std::vector<float> all = read(name, 3);
        std::vector<double> out;
        for (size_t k = 0; k < all.size(); k += 3) out.push_back(all[k]);
        return out;
    }
    std::vector<double> row(uint32_t element) const {
        std::vector<double> out(info().element_count);
        check(trp_radiosity_form_factors(handle_, element, out.data(), out.size()));
        return out;
    }

  private:
    TrpRadiosity* handle_ = nullptr;
};

}  // namespace trp_test
