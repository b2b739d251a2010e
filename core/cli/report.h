// What a command says besides its result: warnings, progress, and statistics. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gltf_scene.h"

namespace triptych::cli {

// The reader's warnings, then those of the scene's last commit.
std::vector<std::string> all_warnings(const LoadedScene& loaded);

// Prints them to standard error, one "triptych: warning: …" line each.
void print_warnings(const std::vector<std::string>& warnings);

// Whether standard error is a terminal.
bool error_is_terminal();

// One line on the terminal that is written over and over, with the time left.
class ProgressLine {
  public:
    explicit ProgressLine(bool shown) : shown_(shown) {}
    ~ProgressLine() { clear(); }
    void show(const TrpProgress& progress);
    void clear();

  private:
    bool shown_;
    bool on_screen_ = false;
    double last_seconds_ = -1.0;
};

// A file that appears whole or not at all: written beside itself, then renamed.
void write_file(const std::string& path, const std::string& content);

// Throws an Error where no file can be made in the folder of `path`.
void check_writable(const std::string& path);

}  // namespace triptych::cli
