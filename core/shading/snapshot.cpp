#include "shading/snapshot.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/clock.h"
#include "base/parallel.h"

namespace trp {
namespace {

void warn(Snapshot& snapshot, int32_t code, uint32_t item, std::string text) {
    snapshot.warnings.push_back({code, item, std::move(text)});
}

// The origin: the camera's position on a grid so coarse that a walk through a scene rarely moves it, and so fine that
// floats near it are exact to a tenth of a millimetre. A camera within half a kilometre of the world's origin has 0.
Vec3d origin_near(const Camera* camera) {
    constexpr double kGrid = 1024;
    Vec3d origin(0, 0, 0);
    if (camera)
        for (int k = 0; k < 3; ++k) {
            origin[k] = kGrid * std::round(camera->world_from_camera[0].rows[k][3] / kGrid);
            if (origin[k] == 0) origin[k] = 0;  // no −0
        }
    return origin;
}

// Every reference between items, before anything is made.
void check_references(const Scene& scene) {
    for (const auto& [id, instance] : scene.instances)
        if (!scene.meshes.find(instance->mesh))
            fail(TRP_ERROR_ID, "{} shows mesh {}, which the scene does not have",
                 item_name("instance", id, instance->name), instance->mesh);
    for (const auto& [id, material] : scene.materials)
        for (size_t i = 0; i < material->nodes.size(); ++i) {
            const Node& node = material->nodes[i];
            if (node.type == TRP_NODE_IMAGE && !scene.textures.find(node.texture))
                fail(TRP_ERROR_ID, "{}: nodes[{}] reads texture {}, which the scene does not have",
                     item_name("material", id, material->name), i, node.texture);
        }
    if (scene.world.texture != TRP_NO_ID && !scene.textures.find(scene.world.texture))
        fail(TRP_ERROR_ID, "the world reads texture {}, which the scene does not have", scene.world.texture);
    if (scene.camera != TRP_NO_ID && !scene.cameras.find(scene.camera))
        fail(TRP_ERROR_ID, "the scene's camera is {}, which the scene does not have", scene.camera);
}

void make_materials(const Scene& scene, Snapshot& snapshot, const Snapshot* previous,
                    std::map<uint32_t, uint32_t>& index_of) {
    std::map<uint32_t, std::shared_ptr<const Texture>> wanted;
    auto want = [&](uint32_t id) { wanted.emplace(id, scene.textures.find(id)); };
    for (const auto& [id, material] : scene.materials)
        for (const Node& node : material->nodes)
            if (node.type == TRP_NODE_IMAGE) want(node.texture);
    if (scene.world.texture != TRP_NO_ID) want(scene.world.texture);
    snapshot.textures = open_textures(wanted, previous ? previous->textures : TextureSet{}, snapshot.warnings);

    Material grey;  // index 0: what is shown where no material is
    grey.diffuse.value = grey.ambient.value = Vec3(0.8f, 0.8f, 0.8f);
    grey.shininess.value = Vec3(30, 30, 30);
    grey.ior.value = Vec3(1.5f, 1.5f, 1.5f);
    grey.alpha.value = Vec3(1, 1, 1);
    snapshot.materials.push_back(compile(grey, snapshot.textures));
    for (const auto& [id, material] : scene.materials) {
        index_of.emplace(id, static_cast<uint32_t>(snapshot.materials.size()));
        snapshot.materials.push_back(compile(*material, snapshot.textures));
    }
    const size_t count = snapshot.materials.size();
    snapshot.material_rows.resize(count * kCoefficientRows);
    for (size_t m = 0; m < count; ++m) {
        const CompiledMaterial& material = snapshot.materials[m];
        for (int row = 0; row < kCoefficientRows; ++row)
            snapshot.material_rows[row * count + m] = material.constants[row];
        snapshot.material_flags.push_back(
            static_cast<uint8_t>((material.has_program() ? kHasProgram : 0) |
                                 (material.has_holes || !material.double_sided ? kMayHaveHoles : 0) |
                                 (material.transmits ? kTransmits : 0) | (material.mirrors ? kMirrors : 0)));
        snapshot.needs_footprint |= material.needs_footprint();
        snapshot.seen_through |= (snapshot.material_flags.back() & (kMayHaveHoles | kTransmits)) != 0;
    }
}

void make_surfaces(const Scene& scene, Snapshot& snapshot, const Snapshot* previous) {
    std::set<uint32_t> shown;
    for (const auto& [id, instance] : scene.instances) shown.insert(instance->mesh);
    const std::vector<uint32_t> ids(shown.begin(), shown.end());
    std::vector<std::shared_ptr<const Surface>> made(ids.size());
    parallel_ranges(ids.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            auto mesh = scene.meshes.find(ids[i]);
            if (previous) {
                const auto it = previous->made_surfaces.find(ids[i]);
                if (it != previous->made_surfaces.end() && it->second->mesh_handle() == mesh) made[i] = it->second;
            }
            if (!made[i]) made[i] = std::make_shared<const Surface>(std::move(mesh));
        }
    });
    for (size_t i = 0; i < ids.size(); ++i) {
        if (const uint32_t dropped = made[i]->dropped_faces())
            warn(snapshot, TRP_WARNING_MESH, ids[i],
                 fmt::format("{}: {} faces without area were left out", item_name("mesh", ids[i], made[i]->mesh().name),
                             dropped));
        snapshot.made_surfaces.emplace(ids[i], std::move(made[i]));
    }
}

// The materials of an instance by slot, as indices into the snapshot's list.
std::vector<uint32_t> resolve_slots(Snapshot& snapshot, const std::map<uint32_t, uint32_t>& index_of,
                                    uint32_t instance_id, const Instance& instance, const Mesh& mesh) {
    const std::string what = item_name("instance", instance_id, instance.name);
    uint32_t slots = static_cast<uint32_t>(std::max({mesh.materials.size(), instance.materials.size(), size_t{1}}));
    if (!mesh.face_materials.empty()) {
        const uint32_t used = *std::max_element(mesh.face_materials.begin(), mesh.face_materials.end()) + 1u;
        if (used > slots)
            warn(snapshot, TRP_WARNING_MATERIAL, instance_id,
                 fmt::format("{}: faces use material slot {}, and there are {}; grey stands in", what, used - 1,
                             mesh.materials.size()));
        slots = std::max(slots, used);
    }
    std::vector<uint32_t> out(slots, 0);
    for (uint32_t slot = 0; slot < slots; ++slot) {
        uint32_t id = slot < mesh.materials.size() ? mesh.materials[slot] : TRP_NO_ID;
        if (slot < instance.materials.size() && instance.materials[slot] != TRP_NO_ID) id = instance.materials[slot];
        if (id == TRP_NO_ID) continue;
        const auto it = index_of.find(id);
        if (it == index_of.end())
            warn(snapshot, TRP_WARNING_MATERIAL, instance_id,
                 fmt::format("{}: slot {} names material {}, which the scene does not have; grey stands in", what, slot,
                             id));
        else
            out[slot] = it->second;
    }
    return out;
}

// A box about a placed surface, relative to the origin.
Bounds world_bounds(const Surface& surface, const Affine& world_from_object) {
    Bounds bounds;
    const Bounds& b = surface.bounds();
    for (int corner = 0; corner < 8 && !b.empty(); ++corner)
        bounds.extend(world_from_object.point(
            {corner & 1 ? b.max.x : b.min.x, corner & 2 ? b.max.y : b.min.y, corner & 4 ? b.max.z : b.min.z}));
    return bounds;
}

// And over all time samples.
Bounds bounds_over_time(const Surface& surface, const std::vector<Affine>& world_from_object) {
    const Mesh& mesh = surface.mesh();
    Bounds bounds;
    if (mesh.time_count == 1) {
        for (const Affine& m : world_from_object) {
            const Bounds at = world_bounds(surface, m);
            bounds.extend(at.min);
            bounds.extend(at.max);
        }
        return bounds;
    }
    for (const Affine& m : world_from_object)
        for (size_t v = 0; v < size_t{mesh.time_count} * mesh.vertex_count; ++v)
            bounds.extend(m.point(mesh.positions[v]));
    return bounds;
}

// Whether rays can meet what fills these bounds: not a point, and within the numbers that rays can have.
bool has_extent(const Bounds& bounds) {
    constexpr float kFarthest = 1e18f;
    float extent = 0;
    for (int k = 0; k < 3; ++k) {
        if (!(std::abs(bounds.min[k]) < kFarthest && std::abs(bounds.max[k]) < kFarthest)) return false;
        extent = std::max(extent, bounds.max[k] - bounds.min[k]);
    }
    return extent > 0;
}

bool moves(const Scene& scene, const Snapshot& snapshot) {
    const auto lamp_moves = [](const Light& lamp) { return lamp.world_from_light.size() > 1; };
    if (snapshot.camera && snapshot.camera->world_from_camera.size() > 1) return true;
    return std::any_of(snapshot.lamps.begin(), snapshot.lamps.end(), lamp_moves) ||
           std::any_of(scene.instances.begin(), scene.instances.end(), [&](const auto& entry) {
               return entry.second->world_from_object.size() > 1 ||
                      scene.meshes.find(entry.second->mesh)->time_count > 1;
           });
}

// What is not shown as it moves.
void warn_of_motion(const Scene& scene, Snapshot& snapshot) {
    for (const auto& [id, light] : scene.lights) {
        const std::vector<Affine>& motion = light->world_from_light;
        const auto grows = [&](const Affine& m, int axis) {
            const float first = motion[0].column(axis).length();
            return std::abs(m.column(axis).length() - first) > 1e-3f * first;
        };
        if (light->type == TRP_LIGHT_AREA &&
            std::any_of(motion.begin(), motion.end(), [&](const Affine& m) { return grows(m, 0) || grows(m, 1); }))
            warn(snapshot, TRP_WARNING_LIGHT, id,
                 fmt::format("{} changes its size while the shutter is open, and keeps the first",
                             item_name("light", id, light->name)));
    }
    for (const PlacedSurface& placed : snapshot.surfaces) {
        if (!placed.mesh || !placed.baked || placed.motion.empty()) continue;
        const size_t last = placed.position_steps - 1;
        if (last % (placed.motion.size() - 1) != 0 ||
            (placed.mesh->time_count > 1 && last % (placed.mesh->time_count - 1) != 0))
            warn(snapshot, TRP_WARNING_MESH, placed.instance,
                 fmt::format(
                     "{} has {} time samples and its mesh {}, which have no common ones: its motion is that of {}",
                     item_name("instance", placed.instance, scene.instances.find(placed.instance)->name),
                     placed.motion.size(), placed.mesh->time_count, placed.position_steps));
    }
}

// `world_positions`: the vertices where they were moved to world space, else null; of so many time steps.
PlacedSurface place(const Placement& placement, const Vec3* world_positions, uint32_t position_steps,
                    const Instance& instance, std::vector<uint32_t> slot_materials) {
    PlacedSurface out;
    const Surface& surface = *placement.surface;
    out.surface = placement.surface;
    out.mesh = &surface.mesh();
    out.baked = world_positions != nullptr;
    out.positions = out.baked ? world_positions : out.mesh->positions.data();
    out.vertices = surface.triangle_vertices();
    out.corners = surface.triangle_corners();
    out.faces = surface.triangle_faces();
    out.face_smooth = surface.mixed_smooth() ? out.mesh->face_smooth.data() : nullptr;
    out.position_steps = position_steps;
    out.world_from_object = placement.world_from_object[0];
    if (placement.world_from_object.size() > 1) out.motion = placement.world_from_object;
    out.identity = std::all_of(placement.world_from_object.begin(), placement.world_from_object.end(), [](Affine m) {
        for (auto& row : m.rows) row[3] = 0;
        return m == Affine{};
    });
    out.normal_sign = out.world_from_object.determinant() < 0 ? -1.0f : 1.0f;
    out.instance = placement.instance;
    out.slot_materials = std::move(slot_materials);
    if (out.slot_materials.size() > 1 && !out.mesh->face_materials.empty())
        out.face_materials = out.mesh->face_materials.data();
    out.color = instance.color;
    out.index = instance.index;
    return out;
}

void fill_info(const Scene& scene, Snapshot& snapshot) {
    TrpSceneInfo& info = snapshot.info;
    info.mesh_count = static_cast<uint32_t>(scene.meshes.size());
    info.instance_count = static_cast<uint32_t>(scene.instances.size());
    info.material_count = static_cast<uint32_t>(scene.materials.size());
    info.texture_count = static_cast<uint32_t>(scene.textures.size());
    info.light_count = static_cast<uint32_t>(scene.lights.size());
    info.camera_count = static_cast<uint32_t>(scene.cameras.size());
    Bounds bounds;
    for (const auto* list : {&snapshot.surfaces, &snapshot.wires})
        for (const PlacedSurface& placed : *list) {
            if (!placed.mesh) continue;
            info.face_count += placed.mesh->face_count();
            info.triangle_count += placed.surface->triangle_count();
            info.vertex_count += placed.mesh->vertex_count;
            const Bounds placed_bounds = world_bounds(*placed.surface, placed.world_from_object);
            bounds.extend(placed_bounds.min);
            bounds.extend(placed_bounds.max);
        }
    for (int k = 0; k < 3; ++k) {
        const float origin = bounds.empty() ? 0 : static_cast<float>(snapshot.origin[k]);
        info.bounds_min[k] = bounds.min[k] + origin;
        info.bounds_max[k] = bounds.max[k] + origin;
    }
    for (const auto& [id, mesh] : scene.meshes) info.mesh_bytes += mesh->bytes();
    info.held_bytes = info.mesh_bytes + snapshot.rays->position_bytes();
    for (const auto& [id, surface] : snapshot.made_surfaces) info.held_bytes += surface->bytes();
    info.bvh_bytes = embree_bytes();
    info.bvh_seconds = snapshot.rays->build_seconds();
}

}  // namespace

Vec3 PlacedSurface::world_position(uint32_t vertex, float time) const {
    if (!moves()) return world_position(vertex);
    const auto [before, after, share] = time_step_at(time, position_steps);
    const size_t vertices = mesh->vertex_count;
    const Vec3 from = positions[before * vertices + vertex], to = positions[after * vertices + vertex];
    const Vec3 position = from + (to - from) * share;
    return baked            ? position
           : motion.empty() ? world_from_object.point(position)
                            : at_time(motion, time).point(position);
}

std::shared_ptr<const Snapshot> make_snapshot(const Scene& scene, std::shared_ptr<const Snapshot>& previous) {
    const auto start = Clock::now();
    check_references(scene);
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->camera = scene.cameras.find(scene.camera);
    snapshot->origin = origin_near(snapshot->camera.get());
    snapshot->world = scene.world;
    std::map<uint32_t, uint32_t> index_of;
    make_materials(scene, *snapshot, previous.get(), index_of);
    make_surfaces(scene, *snapshot, previous.get());
    for (const auto& [id, light] : scene.lights) {
        Light lamp = *light;
        for (Affine& m : lamp.world_from_light) m = m.relative_to(snapshot->origin);
        snapshot->lamps.push_back(std::move(lamp));
    }

    snapshot->moves = moves(scene, *snapshot);

    std::vector<Placement> placements;
    std::map<uint32_t, std::vector<uint32_t>> slots_of;
    for (const auto& [id, instance] : scene.instances) {
        const auto& surface = snapshot->made_surfaces.at(instance->mesh);
        const bool is_wire = surface->triangle_count() == 0;
        if (is_wire && (surface->bounds().empty() || !instance->visible_camera)) continue;
        auto& slots = slots_of[id] = resolve_slots(*snapshot, index_of, id, *instance, surface->mesh());
        const bool holes =
            std::any_of(slots.begin(), slots.end(), [&](uint32_t m) { return snapshot->materials[m].has_holes; });
        const bool transmits =
            std::any_of(slots.begin(), slots.end(), [&](uint32_t m) { return snapshot->materials[m].transmits; });
        snapshot->any_holes |= holes && !is_wire;
        snapshot->any_transmission |= transmits && !is_wire;
        Placement p;
        p.instance = id;
        p.surface = surface;
        for (const Affine& m : instance->world_from_object)
            p.world_from_object.push_back(m.relative_to(snapshot->origin));
        p.mask = (instance->visible_camera ? kSeenByCamera : 0u) | (!instance->visible_shadow ? 0u
                                                                    : holes                   ? kFiltersShadow
                                                                    : transmits               ? kTransmitsShadow
                                                                                              : kCastsShadow);
        if (!has_extent(bounds_over_time(*surface, p.world_from_object))) {
            warn(*snapshot, TRP_WARNING_MESH, id,
                 fmt::format("{} has no extent where it stands and was left out",
                             item_name("instance", id, instance->name)));
            continue;
        }
        if (is_wire)
            snapshot->wires.push_back(place(p, nullptr, surface->mesh().time_count, *instance, slots));
        else
            placements.push_back(std::move(p));
    }

    // Where nobody else holds the last snapshot, its ray scene is taken out of it and changed in place; all that could
    // fail for the scene's own sake has been checked by now.
    std::shared_ptr<RayScene> rays;
    if (previous) {
        rays = previous->rays;
        if (previous.use_count() == 1) previous.reset();
    }
    snapshot->rays = RayScene::build(placements, std::move(rays));

    snapshot->surfaces.resize(snapshot->rays->slot_count());
    for (uint32_t slot = 0; slot < snapshot->surfaces.size(); ++slot) {
        if (!snapshot->rays->placement(slot)) continue;
        const uint32_t id = snapshot->rays->placement(slot)->instance;
        snapshot->surfaces[slot] =
            place(*snapshot->rays->placement(slot), snapshot->rays->world_positions(slot),
                  snapshot->rays->position_steps(slot), *scene.instances.find(id), std::move(slots_of[id]));
    }
    warn_of_motion(scene, *snapshot);
    snapshot->lights = make_lights(*snapshot);
    fill_info(scene, *snapshot);
    snapshot->info.commit_seconds = seconds_since(start);
    return snapshot;
}

}  // namespace trp
