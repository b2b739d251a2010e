// What the commands about radiosity have in common. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "interrupt.h"
#include "picture_job.h"
#include "report.h"
#include "statistics.h"

namespace triptych::cli {

// A radiosity solution of the scene that make_picture() has committed, with the file's settings and the job's.
RadiosityHandle make_radiosity(const PictureJob& job, const LoadedPicture& picture);

// Says which of the job's settings its solver does without.
void print_unused_settings(const PictureJob& job, const LoadedPicture& picture);

// Callbacks that show progress on a terminal, and stop on an interrupt.
class SolveCallbacks {
  public:
    explicit SolveCallbacks(bool quiet);
    const TrpCallbacks* get() const { return &callbacks_; }
    // Takes the progress line off the terminal. Returns whether the call was not interrupted; throws an Error where it
    // failed.
    bool check_whole(TrpStatus status);

  private:
    ProgressLine line_;
    TrpCallbacks callbacks_{};
};

// What is said where an interrupt ended the solving. Throws Interrupted where nothing was found by then.
std::string interrupted_after(const TrpRadiosityInfo& info);

// Puts what a solution cost into a command's costs.
void put_solution(TrpRadiosity* radiosity, CommandCosts& costs);

TrpRadiosityInfo info_of(TrpRadiosity* radiosity);

// Of its elements; none where its solver has no form factors of all.
std::optional<RowSums> row_sums_of(TrpRadiosity* radiosity);

// Says its warnings from number `first` on; returns how many there are.
uint32_t print_radiosity_warnings(const PictureJob& job, TrpRadiosity* radiosity, uint32_t first = 0);

}  // namespace triptych::cli
