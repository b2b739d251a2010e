// A radiosity solution as it is shown: the one header through which pictures see it.
#pragma once

#include <memory>

#include "film/tiles.h"
#include "radiosity/vertices.h"

namespace trp {

// What stood when it was taken, never changed.
struct ShownSolution {
    std::shared_ptr<const Elements> elements;
    std::shared_ptr<const ElementVertices> vertices;
    // Of leaves and of vertices: irradiance in W/m², radiosity, or form factors, as radiosity.view asks.
    std::vector<Vec3> leaves, at_vertices;
    uint32_t chosen = kNoElement;  // whose form factors they are

    uint64_t leaf_count() const;
};

// The method: the job's solution drawn by the rasterizer, with radiance I_E + K_D H / π. Returns false where it was
// cancelled.
bool radiosity_view(RenderJob& job, const RenderEvents& events);

// The element that the camera of a scene sees in the middle of a pixel; kNoElement where it sees none. Throws Error
// where there is no camera.
uint32_t element_at(const Snapshot& snapshot, const Window& window, const Elements& elements, uint32_t x, uint32_t y);

}  // namespace trp
