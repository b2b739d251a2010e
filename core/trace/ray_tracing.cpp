#include "trace/ray_tracing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trace/tracer.h"

namespace trp {
namespace {

// Along a ray from the eye: surfaces that it meets from behind, without having met them from the front, are those of
// solids around the eye.
void find_solids_around_eye(Tracer& tracer) {
    const Snapshot& snapshot = tracer.snapshot;
    if (!tracer.maker.view.perspective || !snapshot.seen_through) return;
    constexpr int kMostHits = 4096;
    const auto w = std::make_unique<TreeWorkspace>(snapshot, tracer.job.film->passes());
    std::vector<uint32_t> entered;
    std::fill_n(w->active, kBatch, uint8_t{0});
    w->active[0] = 1;
    RTCRay16& ray = w->secondary.packets[0].ray;
    const Vec3 direction = Vec3(0.2345f, 0.1234f, 0.9637f).normalized();
    for (int k = 0; k < 3; ++k) {
        float* const origins[3] = {ray.org_x, ray.org_y, ray.org_z};
        float* const directions[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
        origins[k][0] = tracer.maker.view.position[k];
        directions[k][0] = direction[k];
    }
    w->secondary.direction.set(0, direction);
    ray.tnear[0] = 0;
    ray.tfar[0] = std::numeric_limits<float>::infinity();
    for (int hit = 0; hit < kMostHits; ++hit) {
        trace_primary(snapshot.rays->embree(), w->active, Coherence::incoherent, w->secondary);
        read_hits(w->secondary, w->active, w->points);
        const uint32_t slot = w->points.slot[0];
        if (slot == kNoSlot) return;
        locate(snapshot, tracer.job.settings.normals(), w->points);
        if (snapshot.materials[w->points.material[0]].is_solid()) {
            const auto open = std::find(entered.begin(), entered.end(), slot);
            if (!w->points.behind[0])
                entered.push_back(slot);
            else if (open != entered.end())
                entered.erase(open);
            else
                tracer.around_eye.insert(tracer.around_eye.begin(), {slot, w->points.material[0]});
        }
        pass_surface(w->secondary, 0, w->points, std::numeric_limits<float>::infinity());
    }
}

Tracer make_tracer(const RenderJob& job, const PixelFilter& filter, Branches branches) {
    const Window& window = job.film->window();
    const Snapshot& snapshot = *job.snapshot;
    const auto any_light = [&](auto&& wanted) {
        return std::any_of(snapshot.lights.begin(), snapshot.lights.end(), wanted);
    };
    Tracer tracer{job,
                  snapshot,
                  make_ray_maker(snapshot, job.settings, filter, window.width, window.height),
                  job.settings.illumination,
                  branches,
                  any_light([](const ReadyLight& l) { return l.visible_camera; }),
                  any_light([](const ReadyLight& l) { return l.kind == ReadyLight::Kind::area; }),
                  0,
                  {}};
    tracer.pixel_step = std::max(tracer.maker.view.step_x, tracer.maker.view.step_y) * tracer.maker.footprint;
    if (tracer.straight()) return tracer;
    tracer.illumination.mirrors = true;
    // What a transparent body casts on a path's surfaces is found by the paths that go through it.
    if (tracer.one_way()) tracer.illumination.transparent_shadows = TransparentShadows::opaque;
    find_solids_around_eye(tracer);
    return tracer;
}

bool trace_film(RenderJob& job, const RenderEvents& events, Branches branches) {
    const Tracer tracer = make_tracer(job, PixelFilter(job.settings.filter, job.settings.filter_width), branches);
    const Window& window = job.film->window();
    if (events.log)
        events.log(fmt::format("{} x {} pixels, {} samples, {} lights{}", window.w, window.h, job.settings.samples,
                               job.snapshot->lights.size(),
                               tracer.straight() ? "" : fmt::format(", depth {}", job.settings.trace.depth)));
    return run_tiles(job, events, [&](const TileWork& work) { tracer.tile(work); });
}

}  // namespace

bool ray_casting(RenderJob& job, const RenderEvents& events) {
    return trace_film(job, events, Branches::none);
}

bool ray_tracing(RenderJob& job, const RenderEvents& events) {
    return trace_film(job, events, Branches::all);
}

bool path_tracing(RenderJob& job, const RenderEvents& events) {
    return trace_film(job, events, Branches::one);
}

std::vector<RayNode> trace_ray_tree(const RenderJob& job, uint32_t x, uint32_t y) {
    Tracer tracer = make_tracer(job, PixelFilter(PixelFilter::Kind::box, 0), Branches::all);
    tracer.maker.view.aperture_radius = 0;
    const auto w = std::make_unique<TreeWorkspace>(*job.snapshot, job.film->passes());
    std::vector<RayNode> tree(1);
    w->tree = &tree;
    tracer.begin_block(x / kBlockSide, y / kBlockSide, *w);
    const uint32_t lane = lane_at(x % kBlockSide, y % kBlockSide);
    std::fill_n(w->active, kBatch, uint8_t{0});
    w->active[lane] = 1;
    tracer.primary(x / kBlockSide, y / kBlockSide, 0, *w);
    const auto i = static_cast<int>(lane);
    tree[0].origin = w->primary.origin.get(i);
    tree[0].direction = w->primary.direction.get(i).normalized();
    constexpr size_t kMostRays = size_t{1} << 20;
    while (!w->stack.empty()) {
        tracer.secondary(*w);
        if (tree.size() > kMostRays)
            fail(TRP_ERROR_MEMORY,
                 "the tree of pixel ({}, {}) has more than {} rays; a lower trace.depth or a greater "
                 "trace.least_weight makes it smaller",
                 x, y, kMostRays);
    }
    for (size_t k = tree.size(); k-- > 0;) {
        RayNode& node = tree[k];
        node.intensity += node.local;
        if (node.parent >= 0) {
            Vec3& up = tree[static_cast<size_t>(node.parent)].intensity;
            up += node.weight * node.intensity;
        }
    }
    for (RayNode& node : tree) node.origin += Vec3(job.snapshot->origin), node.position += Vec3(job.snapshot->origin);
    return tree;
}

}  // namespace trp
