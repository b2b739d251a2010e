// What rays are traced against: every placed surface in one Embree scene.
//
// A surface that stands in the scene once is moved to world space, so that rays need not be transformed; one that
// stands there several times is instanced. Each surface keeps a tree of its own under the top level (Embree's low scene
// quality with medium quality for each geometry), which measured as fast to trace as one flat tree and makes an edit
// cost the edited surface alone. All positions are relative to an origin near the camera.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/embree.h"
#include "geometry/surface.h"

namespace trp {

// A surface, where it stands, and the rays that meet it (RayMask).
struct Placement {
    uint32_t instance = 0;  // the scene's id, which tells placements of one commit and the next apart
    std::shared_ptr<const Surface> surface;
    std::vector<Affine> world_from_object;  // relative to the origin; one to a time sample, at least one
    unsigned mask = 0;
};

class PlacedGeometry;

class RayScene {
  public:
    // The scene of these placements, in an order of its own. What `previous` (may be null) holds unchanged is taken
    // over; where nobody else holds it, its Embree scene is changed in place, so that the cost follows the change. Runs
    // in the current arena.
    static std::shared_ptr<RayScene> build(const std::vector<Placement>& placements,
                                           std::shared_ptr<RayScene> previous);

    RTCScene embree() const { return scene_.get(); }
    // Geometry ids run from 0 to slot_count() − 1; a slot may be empty (null).
    size_t slot_count() const { return slots_.size(); }
    const Placement* placement(uint32_t slot) const;
    // Vertices in world space where the surface was moved there, time step after time step, else null: then they are
    // the mesh's, to be transformed.
    const Vec3* world_positions(uint32_t slot) const;
    uint32_t position_steps(uint32_t slot) const;  // of those, or of the mesh's
    // How occlusion packets may be traced: a coherent one can fail to return from an instance (seen in Embree 3.13.5).
    Coherence occlusion_coherence() const { return instanced_ ? Coherence::incoherent : Coherence::coherent; }
    uint64_t position_bytes() const;  // of the world-space copies
    double build_seconds() const { return build_seconds_; }

  private:
    EmbreeScene scene_;
    std::vector<std::shared_ptr<const PlacedGeometry>> slots_;
    double build_seconds_ = 0;
    bool instanced_ = false;
};

// Bytes that Embree holds, over all scenes of the process.
uint64_t embree_bytes();

}  // namespace trp
