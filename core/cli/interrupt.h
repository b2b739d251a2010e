// Ctrl-C and a request to end: a running render is cancelled, and nothing is left half-written.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "error.h"

namespace triptych::cli {

// While one lives, SIGINT and SIGTERM end the program with exit code 1 and a line: at once, or, while a render runs, by
// cancelling it; while a file is written, after that.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    // The render that an interrupt cancels; null: none.
    void set_render(TrpRender* render);
    // Between these, an interrupt waits: the caller asks `interrupted()` where it can stop.
    void begin_writing();
    void end_writing();
    bool interrupted() const;

  private:
    void watch();

    std::mutex mutex_;
    TrpRender* render_ = nullptr;
    bool writing_ = false;
    bool done_ = false;
    std::condition_variable wake_;
    std::thread watcher_;
};

}  // namespace triptych::cli
