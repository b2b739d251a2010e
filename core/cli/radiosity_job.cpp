// What the commands about radiosity have in common. SPDX-License-Identifier: Apache-2.0
#include "radiosity_job.h"

#include <algorithm>
#include <numeric>

#include "report.h"

namespace triptych::cli {

RadiosityHandle make_radiosity(const PictureJob& job, const LoadedPicture& picture) {
    TrpRadiosity* made = nullptr;
    check(trp_radiosity_create(picture.loaded.scene.get(), &made));
    RadiosityHandle radiosity(made);
    for (const auto* settings : {&picture.loaded.settings, &job.settings})
        for (const auto& [name, value] : *settings) check(trp_radiosity_set(made, name.c_str(), value.c_str()));
    return radiosity;
}

SolveCallbacks::SolveCallbacks(const InterruptGuard& guard, bool quiet)
    : line_(!quiet && error_is_terminal()), guard_(guard) {
    check(trp_callbacks_init(&callbacks_, sizeof callbacks_));
    callbacks_.user = this;
    callbacks_.progress = [](void* user, const TrpProgress* progress) -> int32_t {
        SolveCallbacks& self = *static_cast<SolveCallbacks*>(user);
        self.line_.show(*progress);
        return self.guard_.interrupted() ? 0 : 1;
    };
}

void SolveCallbacks::check_call(TrpStatus status) {
    line_.clear();
    if (status == TRP_CANCELLED) throw Error("interrupted");
    check(status);
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
