#include "geometry/ray_scene.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <unordered_map>

#include "base/clock.h"
#include "base/error.h"
#include "base/parallel.h"

namespace trp {
namespace {

std::atomic<int64_t> g_embree_bytes{0};

bool count_memory(void*, ssize_t bytes, bool) {
    g_embree_bytes += bytes;
    return true;
}

RTCDevice device() {
    static const RTCDevice device = [] {
        const RTCDevice made = rtcNewDevice(nullptr);
        if (!made)
            fail(TRP_ERROR_INTERNAL, "Embree could not be started (error {})",
                 static_cast<int>(rtcGetDeviceError(nullptr)));
        rtcSetDeviceMemoryMonitorFunction(made, count_memory, nullptr);
        return made;
    }();
    return device;
}

void check_embree() {
    const RTCError error = rtcGetDeviceError(device());
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        fail(TRP_ERROR_MEMORY, "out of memory while building the ray tracing structure");
    if (error != RTC_ERROR_NONE) fail(TRP_ERROR_INTERNAL, "Embree reports error {}", static_cast<int>(error));
}

EmbreeScene new_scene(RTCBuildQuality quality, unsigned more_flags = 0) {
    EmbreeScene scene(rtcNewScene(device()));
    check_embree();
    rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | more_flags));
    rtcSetSceneBuildQuality(scene.get(), quality);
    return scene;
}

// Triangles over indices and positions, time step after time step, that outlive the geometry.
EmbreeGeometry new_triangles(const Surface& surface, const Vec3* positions, uint32_t steps) {
    EmbreeGeometry geometry(rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE));
    rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_MEDIUM);
    const size_t vertices = surface.mesh().vertex_count;
    rtcSetGeometryTimeStepCount(geometry.get(), steps);
    for (uint32_t step = 0; step < steps; ++step)
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3, positions,
                                   step * vertices * sizeof(Vec3), sizeof(Vec3), vertices);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, surface.triangle_vertices(),
                               0, 3 * sizeof(uint32_t), surface.triangle_count());
    return geometry;
}

// A surface that stands in the scene several times is instanced where copies would be large; small ones are faster to
// trace as copies in world space.
bool is_instanced(const Placement& placement, uint32_t uses) {
    constexpr uint64_t kGreatestCopies = 1 << 16;  // triangles
    if (uses < 2 || uint64_t{uses} * placement.surface->triangle_count() <= kGreatestCopies) return false;
    // Rays go into an instance by the inverse of its transform, which a flattened one lacks.
    return std::all_of(placement.world_from_object.begin(), placement.world_from_object.end(),
                       [](const Affine& m) { return std::abs(m.determinant()) > 1e-30; });
}

// The tree of a surface that several instances share.
struct SharedTree {
    explicit SharedTree(const Surface& surface) : scene(new_scene(RTC_BUILD_QUALITY_MEDIUM)) {
        const EmbreeGeometry geometry =
            new_triangles(surface, surface.mesh().positions.data(), surface.mesh().time_count);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene.get(), geometry.get());
        rtcCommitScene(scene.get());
    }
    EmbreeScene scene;
};

}  // namespace

// One placement as Embree has it. Never changed: an edit makes a new one.
class PlacedGeometry {
  public:
    PlacedGeometry(const Placement& placement, std::shared_ptr<const SharedTree> tree)
        : placement(placement), tree(std::move(tree)), steps(placement.surface->mesh().time_count) {
        const Surface& surface = *placement.surface;
        if (this->tree) {
            geometry.reset(rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_INSTANCE));
            rtcSetGeometryInstancedScene(geometry.get(), this->tree->scene.get());
            const std::vector<Affine>& motion = placement.world_from_object;
            rtcSetGeometryTimeStepCount(geometry.get(), static_cast<unsigned>(motion.size()));
            for (unsigned step = 0; step < motion.size(); ++step)
                rtcSetGeometryTransform(geometry.get(), step, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, motion[step].rows);
        } else {
            positions = surface.mesh().positions.data();
            if (placement.world_from_object != std::vector<Affine>(1)) {
                move_to_world();
                positions = moved.data();
            }
            geometry = new_triangles(surface, positions, steps);
        }
        rtcSetGeometryMask(geometry.get(), placement.mask);
        rtcCommitGeometry(geometry.get());
    }

    const Placement placement;
    const std::shared_ptr<const SharedTree> tree;  // null: in world space
    uint32_t steps;                                // of the positions
    std::vector<Vec3> moved;
    const Vec3* positions = nullptr;
    EmbreeGeometry geometry;

  private:
    // Steps among which are those of the mesh and those of the placement, if Embree takes so many; else those of the
    // one that has more. What has none at a step is linear there.
    static uint32_t common_steps(uint32_t a, uint32_t b) {
        if (a == 1 || b == 1) return std::max(a, b);
        const uint32_t common = std::lcm(a - 1, b - 1) + 1;
        return common <= RTC_MAX_TIME_STEP_COUNT ? common : std::max(a, b);
    }
    void move_to_world() {
        const Mesh& mesh = placement.surface->mesh();
        const size_t vertices = mesh.vertex_count;
        steps = common_steps(steps, static_cast<uint32_t>(placement.world_from_object.size()));
        moved.reserve(steps * vertices + 1);  // Embree may read 4 bytes past the end
        moved.resize(steps * vertices);
        for (uint32_t step = 0; step < steps; ++step) {
            const float time = steps > 1 ? static_cast<float>(step) / static_cast<float>(steps - 1) : 0;
            const Affine world_from_object = at_time(placement.world_from_object, time);
            const TimeStep of_mesh = time_step_at(time, mesh.time_count);
            const Vec3 *const from = &mesh.positions[of_mesh.before * vertices],
                              *const to = &mesh.positions[of_mesh.after * vertices];
            Vec3* const out = &moved[step * vertices];
            parallel_ranges(vertices, 1 << 15, [&](size_t begin, size_t end) {
                for (size_t v = begin; v < end; ++v)
                    out[v] = world_from_object.point(of_mesh.share > 0 ? from[v] + (to[v] - from[v]) * of_mesh.share
                                                                       : from[v]);
            });
        }
    }
};

std::shared_ptr<RayScene> RayScene::build(const std::vector<Placement>& placements,
                                          std::shared_ptr<RayScene> previous) {
    std::unordered_map<const Surface*, uint32_t> uses;
    for (const Placement& p : placements) ++uses[p.surface.get()];
    std::unordered_map<const Surface*, std::shared_ptr<const SharedTree>> trees;
    std::unordered_map<uint32_t, uint32_t> previous_slots;
    for (uint32_t slot = 0; previous && slot < previous->slots_.size(); ++slot)
        if (const auto& placed = previous->slots_[slot]) {
            previous_slots.emplace(placed->placement.instance, slot);
            if (placed->tree) trees.emplace(placed->placement.surface.get(), placed->tree);
        }

    // Slots: kept where the instance was there before, else free ones.
    std::vector<std::shared_ptr<const PlacedGeometry>> slots(previous ? previous->slots_.size() : 0);
    std::vector<const Placement*> fresh;
    auto unchanged = [&](const PlacedGeometry& old, const Placement& p) {
        return old.placement.surface == p.surface && old.placement.world_from_object == p.world_from_object &&
               old.placement.mask == p.mask && (old.tree != nullptr) == is_instanced(p, uses[p.surface.get()]);
    };
    auto place = [&](const Placement& p) {
        const Surface* surface = p.surface.get();
        std::shared_ptr<const SharedTree> tree;
        if (is_instanced(p, uses[surface])) {
            auto& shared = trees[surface];
            if (!shared) shared = std::make_shared<const SharedTree>(*surface);
            tree = shared;
        }
        return std::make_shared<const PlacedGeometry>(p, std::move(tree));
    };
    for (const Placement& p : placements) {
        const auto it = previous_slots.find(p.instance);
        if (it == previous_slots.end())
            fresh.push_back(&p);
        else
            slots[it->second] = unchanged(*previous->slots_[it->second], p) ? previous->slots_[it->second] : place(p);
    }
    uint32_t free_slot = 0;
    for (const Placement* p : fresh) {
        while (free_slot < slots.size() && slots[free_slot]) ++free_slot;
        if (free_slot == slots.size()) slots.emplace_back();
        slots[free_slot] = place(*p);
    }

    const auto start = Clock::now();
    const bool in_place = previous && previous.use_count() == 1;
    auto result = in_place ? std::move(previous) : std::make_shared<RayScene>();
    if (!in_place)
        result->scene_ =
            new_scene(RTC_BUILD_QUALITY_LOW, RTC_SCENE_FLAG_DYNAMIC);  // keeps its trees for the next commit
    for (uint32_t slot = 0; slot < std::max(slots.size(), result->slots_.size()); ++slot) {
        const auto old = slot < result->slots_.size() ? result->slots_[slot] : nullptr;
        const auto now = slot < slots.size() ? slots[slot] : nullptr;
        if (old == now) continue;
        if (old) rtcDetachGeometry(result->scene_.get(), slot);
        if (now) rtcAttachGeometryByID(result->scene_.get(), now->geometry.get(), slot);
    }
    result->slots_ = std::move(slots);
    result->instanced_ =
        std::any_of(result->slots_.begin(), result->slots_.end(), [](const auto& s) { return s && s->tree; });
    rtcCommitScene(result->scene_.get());
    check_embree();
    result->build_seconds_ = seconds_since(start);
    return result;
}

const Placement* RayScene::placement(uint32_t slot) const {
    return slots_[slot] ? &slots_[slot]->placement : nullptr;
}

const Vec3* RayScene::world_positions(uint32_t slot) const {
    return slots_[slot]->positions;
}

uint32_t RayScene::position_steps(uint32_t slot) const {
    return slots_[slot]->steps;
}

uint64_t RayScene::position_bytes() const {
    uint64_t sum = 0;
    for (const auto& placed : slots_)
        if (placed) sum += placed->moved.size() * sizeof(Vec3);
    return sum;
}

uint64_t embree_bytes() {
    return static_cast<uint64_t>(std::max<int64_t>(0, g_embree_bytes.load()));
}

}  // namespace trp
