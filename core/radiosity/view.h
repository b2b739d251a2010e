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
    // Of leaves and of vertices: irradiance in W/m², or radiosity, as radiosity.view asks.
    std::vector<Vec3> leaves, at_vertices;

    uint64_t leaf_count() const;
};

// The method: the job's solution drawn by the rasterizer, with radiance I_E + K_D H / π. Returns false where it was
// cancelled.
bool radiosity_view(RenderJob& job, const RenderEvents& events);

}  // namespace trp
