#include "radiosity/linear.h"

namespace trp {

PlaneCell plane_cell(const Elements& elements, uint32_t element) {
    const Facet& facet = elements.facet_of(element);
    const Element& e = elements[element];
    PlaneCell out;
    if (facet.shape == Facet::Shape::polygon) return out;
    out.triangle = facet.shape == Facet::Shape::triangle;
    const PlaneAxes axes = axes_of(facet);
    // Of a skewed quad, the lines between the middles of its sides.
    const float half = out.triangle ? 0 : 0.5f;
    const Vec3 sides[2] = {
        elements.point(facet, e.s + e.ds, e.t + half * e.dt) - elements.point(facet, e.s, e.t + half * e.dt),
        elements.point(facet, e.s + half * e.ds, e.t + e.dt) - elements.point(facet, e.s + half * e.ds, e.t)};
    for (int k = 0; k < 2; ++k) {
        out.side[k][0] = sides[k].dot(axes.x);
        out.side[k][1] = sides[k].dot(axes.y);
        out.moments.add(out.side[k][0], out.side[k][1], out.triangle ? 1.0 / 18 : 1.0 / 12);
    }
    if (out.triangle) {
        const auto& [a, b] = out.side;
        out.moments.xx -= a[0] * b[0] / 18;
        out.moments.xy -= (a[0] * b[1] + a[1] * b[0]) / 36;
        out.moments.yy -= a[1] * b[1] / 18;
    }
    return out;
}

}  // namespace trp
