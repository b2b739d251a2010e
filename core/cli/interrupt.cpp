// Ctrl-C and a request to end. A signal handler may do next to nothing, so that it sets a flag, and a thread looks at
// it. SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace triptych::cli {
namespace {

// Lock-free, so that a handler may write it.
std::atomic<bool> signal_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void remember(int number) {
    signal_seen = true;
    // A second one ends the program in the system's way.
    std::signal(number, SIG_DFL);
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

void InterruptGuard::set_render(TrpRender* render) {
    const std::lock_guard lock(mutex_);
    render_ = render;
}

void InterruptGuard::begin_writing() {
    const std::lock_guard lock(mutex_);
    writing_ = true;
}

void InterruptGuard::end_writing() {
    const std::lock_guard lock(mutex_);
    writing_ = false;
}

bool InterruptGuard::interrupted() const {
    return signal_seen;
}

void InterruptGuard::watch() {
    std::unique_lock lock(mutex_);
    while (!done_) {
        wake_.wait_for(lock, std::chrono::milliseconds(10));
        if (!signal_seen || done_) continue;
        if (render_ != nullptr) {
            // Again and again: a cancel before the render runs has no effect.
            trp_render_cancel(render_);
        } else if (!writing_) {
            std::fputs("triptych: error: interrupted\n", stderr);
            std::_Exit(1);
        }
    }
}

}  // namespace triptych::cli
