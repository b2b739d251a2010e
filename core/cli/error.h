// Errors and warnings of the command line. An error ends the command with one line that names the file and the item;
// a warning says what was left out and why, and the command goes on. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <triptych/triptych.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace triptych::cli {

// The work failed: exit code 1.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// The command was called wrongly: exit code 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// `text` with line breaks and control characters turned into spaces: what libraries say, fitted into one line.
std::string one_line(const std::string& text);

// Throws an Error with the core's own message, after `item`, where `status` is a failure.
void check(TrpStatus status, const std::string& item = {});

class Warnings {
  public:
    // The same text is kept once: a fault that a thousand nodes share is one line.
    void add(std::string text) {
        if (std::find(lines_.begin(), lines_.end(), text) == lines_.end()) lines_.push_back(std::move(text));
    }
    const std::vector<std::string>& lines() const { return lines_; }

  private:
    std::vector<std::string> lines_;
};

}  // namespace triptych::cli
