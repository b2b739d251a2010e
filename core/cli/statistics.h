// The JSON that --stats writes: what a command cost. Its first keys are fixed; others may be added.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "error.h"

namespace triptych::cli {

// Of elements' form factors.
struct RowSums {
    double least = 0, mean = 0, greatest = 0;
};

struct CommandCosts {
    std::string method;
    double load_seconds = 0.0, commit_seconds = 0.0, write_seconds = 0.0;
    TrpSceneInfo scene{};
    TrpStatistics render{};
    uint32_t width = 0, height = 0;
    std::optional<TrpRadiosityInfo> radiosity;  // of a command that solves one
    std::optional<RowSums> row_sums;            // where its solver knows them
};

std::string statistics_json(const CommandCosts& costs);

}  // namespace triptych::cli
