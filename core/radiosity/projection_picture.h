// What an element sees from its middle, drawn as the two projections show it that form factors are found by:
//
//   hemicube  its five faces unfolded into a cross, the top in the middle
//   else      Nusselt's analog: all that is seen, on the unit hemisphere and from there straight down on its base
//             circle, of whose area an element covers its form factor (Nusselt 1928)
//
// Both are looked at from outside, down on the element: x to the right and y up are its frame's. Those of a point are
// shown, where form factors but the hemicube's are means over the element.
#pragma once

#include <span>

#include "radiosity/form_factors.h"
#include "textures/image_module.h"

namespace trp {

// Axes about an element's middle; z is its normal.
struct ElementFrame {
    Vec3 middle, x, y, z;
};
ElementFrame frame_of(const Elements& elements, uint32_t element);

struct ProjectionPicture {
    uint32_t side = 0;               // pixels, of a square; row 0 is the bottom
    std::vector<uint32_t> elements;  // seen in each pixel, through glass the one that counts for most; or kNoElement
    std::vector<float> shares;       // of the form factors in each pixel, 1 in all; 0 outside the projection
};

// Its side is twice radiosity.hemicube_resolution. Runs in the current arena.
ProjectionPicture make_projection_picture(const FormFactorJob& job, uint32_t element);

// With the reflectance of each element, by which it is coloured, in a shade of its own. Channels Combined, Element (its
// number among `numbers`, −1: none) and FormFactor.
Picture draw_projection(const ProjectionPicture& projection, std::span<const Vec3> reflectances,
                        std::span<const float> numbers);

// The outline of a polygon on the unit hemisphere, in the frame's coordinates: corners, joined by great circles, of the
// part above the horizon, counter-clockwise as seen from outside. Empty where none of its front is seen.
std::vector<Vec3d> project_polygon(const ElementFrame& frame, std::span<const Vec3d> polygon);

}  // namespace trp
