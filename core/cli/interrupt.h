// Ctrl-C and a request to end: what was found by then is left, and nothing half-written.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "error.h"

namespace triptych::cli {

// The command was interrupted, and has left what it had: a line, and the exit code that shells have for the signal.
class Interrupted : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// While one lives, SIGINT and SIGTERM end the program with a line and exit code 130 or 143: at once, or, while it is
// held, where the caller sees that it is `interrupted()`, and throws. A second one ends it at once in any case.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    // From here on an interrupt waits for the caller.
    void hold();
    static bool interrupted();
    static int exit_code();

  private:
    void watch();

    std::mutex mutex_;
    bool held_ = false;
    bool done_ = false;
    std::condition_variable wake_;
    std::thread watcher_;
};

}  // namespace triptych::cli
