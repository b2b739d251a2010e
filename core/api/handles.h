// What is behind the ABI's handles.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "film/tiles.h"
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
    std::vector<trp::RayNode> tree;  // of the last pixel that was asked for
};

namespace trp {

struct MethodRow {
    const char *name, *label, *description;
    bool (*run)(RenderJob&, const RenderEvents&);
};
extern const MethodRow kMethods[];
extern const uint32_t kMethodCount;

}  // namespace trp
