// The methods that trace rays.
#pragma once

#include <vector>

#include "film/tiles.h"

namespace trp {

// All render into the job's film, and return false where that was cancelled.

// Ray casting (Appel 1968; Goldstein and Nagel 1971): one primary ray to a sample, the equation with shadows, no
// recursion.
bool ray_casting(RenderJob& job, const RenderEvents& events);
// Recursive ray tracing: the ray tree (Whitted, "An Improved Illumination Model for Shaded Display", 1980).
bool ray_tracing(RenderJob& job, const RenderEvents& events);
// Path tracing with next-event estimation (Kajiya, "The Rendering Equation", 1986): the tree, of which one branch is
// followed at random, with diffuse and glossy reflection beside mirrors and transmission.
bool path_tracing(RenderJob& job, const RenderEvents& events);

// A ray of a pixel's tree.
struct RayNode {
    enum class Kind { primary, reflection, transmission };
    enum class End { surface, light, background, depth, weight };
    Kind kind = Kind::primary;
    End end = End::background;
    int32_t parent = -1;                                                           // before it in the list
    Vec3 origin{0, 0, 0}, direction{0, 0, 0}, position{0, 0, 0}, normal{0, 0, 0};  // in the world
    float distance = 0;
    uint32_t slot = kNoSlot, material = 0;  // where it ends at a surface
    // What its surface, light or background sends along it; what its parent gives it; and what it hands up:
    // local + Σ of its children's weight · intensity.
    Vec3 local{0, 0, 0}, weight{1, 1, 1}, intensity{0, 0, 0};
};

// The tree of the ray through the centre of a pixel, sample 0, parents before children. Runs in the current arena.
std::vector<RayNode> trace_ray_tree(const RenderJob& job, uint32_t x, uint32_t y);

}  // namespace trp
