// What the commands about radiosity have in common. SPDX-License-Identifier: Apache-2.0
#include "radiosity_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "report.h"

namespace triptych::cli {
namespace {

// Settings that not all solvers use, and those that do.
constexpr std::pair<const char*, std::string_view> kSettingsOfSolvers[] = {
    {"radiosity.link_ratio", "hierarchical"},         {"radiosity.order", "progressive"},
    {"radiosity.patch_levels", "progressive"},        {"radiosity.ambient", "progressive"},
    {"radiosity.subdivisions", "matrix progressive"}, {"radiosity.memory", "matrix"},
};

}  // namespace

RadiosityHandle make_radiosity(const PictureJob& job, const LoadedPicture& picture) {
    TrpRadiosity* made = nullptr;
    check(trp_radiosity_create(picture.loaded.scene.get(), &made));
    RadiosityHandle radiosity(made);
    for (const auto* settings : {&picture.loaded.settings, &job.settings})
        for (const auto& [name, value] : *settings) check(trp_radiosity_set(made, name.c_str(), value.c_str()));
    return radiosity;
}

void print_unused_settings(const PictureJob& job, const LoadedPicture& picture) {
    if (job.quiet) return;
    const std::string solver = setting_of(job, picture, "radiosity.solver");
    std::vector<std::string> lines;
    for (const auto& [name, value] : job.settings) {
        for (const auto& [of_some, solvers] : kSettingsOfSolvers)
            if (name == of_some && solvers.find(solver) == std::string_view::npos)
                lines.push_back(fmt::format("--set {}: the {} solver does without", name, solver));
        if (name == "radiosity.view" && value == "unshot" && solver != "progressive")
            lines.push_back(fmt::format("--set {}={}: the {} solver shoots nothing", name, value, solver));
    }
    print_warnings(lines);
}

SolveCallbacks::SolveCallbacks(bool quiet) : line_(!quiet && error_is_terminal()) {
    check(trp_callbacks_init(&callbacks_, sizeof callbacks_));
    callbacks_.user = this;
    callbacks_.progress = [](void* user, const TrpProgress* progress) -> int32_t {
        static_cast<SolveCallbacks*>(user)->line_.show(*progress);
        return InterruptGuard::interrupted() ? 0 : 1;
    };
}

bool SolveCallbacks::check_whole(TrpStatus status) {
    line_.clear();
    if (status == TRP_CANCELLED) return false;
    check(status);
    return true;
}

std::string interrupted_after(const TrpRadiosityInfo& info) {
    if (info.iterations == 0) throw Interrupted("interrupted");
    return fmt::format("interrupted after {} step{}, residual {:.3g}", info.iterations, info.iterations == 1 ? "" : "s",
                       info.residual);
}

void put_solution(TrpRadiosity* radiosity, CommandCosts& costs) {
    const TrpRadiosityInfo info = info_of(radiosity);
    costs.render.solve_seconds = info.seconds;
    costs.render.gather_rays = info.rays;
    costs.render.elements = info.element_count;
    costs.render.links = info.links;
    costs.render.iterations = info.iterations;
    costs.render.residual = info.residual;
    costs.radiosity = info;
    costs.row_sums = row_sums_of(radiosity);
}

TrpRadiosityInfo info_of(TrpRadiosity* radiosity) {
    TrpRadiosityInfo info{};
    info.struct_size = sizeof info;
    check(trp_radiosity_info(radiosity, &info));
    return info;
}

std::optional<RowSums> row_sums_of(TrpRadiosity* radiosity) {
    std::vector<float> sums(info_of(radiosity).element_count);
    if (sums.empty() || trp_radiosity_read(radiosity, "row_sum", sums.data(), sums.size()) != TRP_OK)
        return std::nullopt;
    const auto [least, greatest] = std::minmax_element(sums.begin(), sums.end());
    return RowSums{*least, std::accumulate(sums.begin(), sums.end(), 0.0) / static_cast<double>(sums.size()),
                   *greatest};
}

uint32_t print_radiosity_warnings(const PictureJob& job, TrpRadiosity* radiosity, uint32_t first) {
    const uint32_t count = trp_radiosity_warning_count(radiosity);
    std::vector<std::string> lines;
    for (uint32_t k = first; k < count && !job.quiet; ++k) {
        TrpWarning warning{};
        warning.struct_size = sizeof warning;
        check(trp_radiosity_warning(radiosity, k, &warning));
        lines.emplace_back(warning.text);
    }
    print_warnings(lines);
    return count;
}

}  // namespace triptych::cli
