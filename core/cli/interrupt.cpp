// Ctrl-C and a request to end. A signal handler may do next to nothing, so that it leaves the signal's number, and a
// thread looks at it. SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace triptych::cli {
namespace {

// Lock-free, so that a handler may write it.
std::atomic<int> signal_seen{0};
static_assert(std::atomic<int>::is_always_lock_free);

void remember(int number) {
    signal_seen = number;
    // A second one ends the program in the system's way.
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
    std::signal(SIGINT, remember);
    std::signal(SIGTERM, remember);
    watcher_ = std::thread([this] { watch(); });
}

InterruptGuard::~InterruptGuard() {
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    wake_.notify_all();
    watcher_.join();
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

void InterruptGuard::hold() {
    const std::lock_guard lock(mutex_);
    held_ = true;
}

bool InterruptGuard::interrupted() {
    return signal_seen != 0;
}

int InterruptGuard::exit_code() {
    return 128 + signal_seen;
}

void InterruptGuard::watch() {
    std::unique_lock lock(mutex_);
    while (!done_) {
        wake_.wait_for(lock, std::chrono::milliseconds(10));
        if (!interrupted() || held_ || done_) continue;
        std::fputs("triptych: error: interrupted\n", stderr);
        std::_Exit(exit_code());
    }
}

}  // namespace triptych::cli
