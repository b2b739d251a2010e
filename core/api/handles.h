// What is behind the ABI's handles.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "film/tiles.h"
#include "radiosity/radiosity.h"
#include "scene/scene.h"
#include "shading/snapshot.h"
#include "trace/ray_tracing.h"

struct TrpScene {
    trp::Scene data;
    std::shared_ptr<const trp::Snapshot> snapshot;  // of the last commit; null before the first
};

struct TrpRender {
    std::shared_ptr<const trp::Snapshot> snapshot;
    uint32_t method = 0;  // index into the table
    trp::Settings settings;
    trp::Window window;
    trp::PassList passes;
    std::unique_ptr<trp::Film> film;  // of the last run
    std::unique_ptr<trp::Film> spare_film;
    std::atomic<bool> cancelled{false}, running{false};
    std::mutex state;  // between a run's beginning or end and a cancel from another thread
    TrpStatistics statistics{};
    std::vector<trp::RayNode> tree;             // of the last pixel that was asked for
    std::shared_ptr<trp::Radiosity> radiosity;  // that it was given
};

struct TrpRadiosity {
    std::shared_ptr<trp::Radiosity> data;
    std::vector<uint32_t> leaves;         // elements by their number in the ABI
    std::vector<trp::ElementLink> links;  // of the last step, once asked for
    bool links_read = false;
    std::atomic<bool> cancelled{false}, running{false};
    std::mutex state;
};

namespace trp {

struct MethodRow {
    const char *name, *label, *description;
    bool (*run)(RenderJob&, const RenderEvents&);
};
extern const MethodRow kMethods[];
extern const uint32_t kMethodCount;

RenderEvents events_of(const TrpCallbacks* callbacks);  // null: none

// Marks a handle as running for as long as it stands, so that its calls are refused, but for a cancel.
template <class Handle>
struct Running {
    Running(Handle& handle, const char* what) : handle(handle) {
        const std::lock_guard lock(handle.state);
        if (handle.running) fail(TRP_ERROR_STATE, "the {} is running", what);
        handle.cancelled = false;
        handle.running = true;
    }
    ~Running() {
        const std::lock_guard lock(handle.state);
        handle.running = false;
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    Handle& handle;
};

}  // namespace trp
