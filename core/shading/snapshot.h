// The immutable scene of one commit, as renders see it. Positions are relative to `origin`, a point near the camera.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "base/error.h"
#include "geometry/ray_scene.h"
#include "scene/scene.h"
#include "shading/lights.h"
#include "shading/program.h"

namespace trp {

// What shading reads of a placed surface, by geometry id.
struct PlacedSurface {
    const Mesh* mesh = nullptr;
    const Vec3* positions = nullptr;           // world space where `baked`, else object space; step after step
    uint32_t position_steps = 1;               // evenly spaced over the time samples
    const uint32_t* vertices = nullptr;        // three to a triangle
    const uint32_t* corners = nullptr;         // null: 3t … 3t + 2
    const uint32_t* faces = nullptr;           // null: t
    const uint8_t* face_smooth = nullptr;      // null: all faces have the normals chosen
    const uint16_t* face_materials = nullptr;  // null: all faces are of slot 0
    std::vector<uint32_t> slot_materials;      // indices into Snapshot::materials, at least one
    Affine world_from_object;                  // at the first time sample
    std::vector<Affine> motion;                // of world_from_object over the time samples; empty: it stands still
    bool baked = true, identity = true;
    float normal_sign = 1;  // −1 where the transform mirrors
    Vec3 color{1, 1, 1};
    int32_t index = 0;
    uint32_t instance = 0;
    std::shared_ptr<const Surface> surface;

    uint32_t face(uint32_t triangle) const { return faces ? faces[triangle] : triangle; }
    uint32_t corner(uint32_t triangle, int k) const { return corners ? corners[3 * triangle + k] : 3 * triangle + k; }
    uint32_t material(uint32_t triangle) const {
        return face_materials ? face_material(face(triangle)) : slot_materials[0];
    }
    uint32_t face_material(uint32_t face) const {
        if (!face_materials) return slot_materials[0];
        return slot_materials[std::min<size_t>(face_materials[face], slot_materials.size() - 1)];
    }
    Vec3 world_position(uint32_t vertex) const {
        return baked ? positions[vertex] : world_from_object.point(positions[vertex]);
    }
    Vec3 world_position(uint32_t vertex, float time) const;
    bool moves() const { return position_steps > 1 || motion.size() > 1; }
};

enum MaterialFlag : uint8_t {
    kHasProgram = 1,
    kMayHaveHoles = 2,  // alpha below 1, or one side
    kTransmits = 4,
    kMirrors = 8,
};

struct Snapshot {
    Vec3d origin{0, 0, 0};
    std::shared_ptr<RayScene> rays;
    std::vector<PlacedSurface> surfaces;  // by geometry id; empty slots have no mesh
    std::vector<PlacedSurface> wires;     // that the camera sees: edges without a triangle, which no ray meets
    std::vector<CompiledMaterial> materials;
    std::vector<float> material_rows;     // kCoefficientRows rows of materials.size() numbers each
    std::vector<uint8_t> material_flags;  // MaterialFlag bits of each material, close together for locate()
    TextureSet textures;
    std::vector<Light> lamps;  // the scene's, relative to the origin
    LightList lights;          // all that is sampled: lamps, emitting surfaces and the world
    World world;
    std::shared_ptr<const Camera> camera;  // null: none; in world space, not relative
    bool needs_footprint = false;
    bool moves = false;             // something that is shown, a light or the camera, between the time samples
    bool any_holes = false;         // a shown material's alpha may be below 1
    bool any_transmission = false;  // a shown material transmits, and may be lighter in shadows
    bool seen_through = false;      // or one transmits, or has one side: the eye may see what lies behind a surface

    std::map<uint32_t, std::shared_ptr<const Surface>> made_surfaces;  // by mesh id, for the next commit
    std::vector<Warning> warnings;
    TrpSceneInfo info{};
};

// Commits: checks references, makes what is missing and takes the rest from `previous` (may be null), which is used up
// where nobody else holds it. Throws Error with `previous` as it was.
std::shared_ptr<const Snapshot> make_snapshot(const Scene& scene, std::shared_ptr<const Snapshot>& previous);

// Background radiance in directions (of any length), for lanes that are `wanted`.
void sample_background(const Snapshot& snapshot, const LaneVec3& directions, const uint8_t* wanted, LaneVec3& radiance);

}  // namespace trp
