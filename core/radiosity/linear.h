// Light that changes linearly over an element, which is right to the second order of the element's size where constant
// light is to the first: the basis of the hierarchical solver (Gortler, Schröder, Cohen and Hanrahan, "Wavelet
// Radiosity", 1993, whose M2 basis has a mixed term besides).
#pragma once

#include "radiosity/elements.h"

namespace trp {

// Two axes in a facet's plane.
struct PlaneAxes {
    Vec3 x, y;
};
inline PlaneAxes axes_of(const Facet& facet) {
    const Vec3 x = perpendicular_to(facet.normal);
    return {x, facet.normal.cross(x)};
}

// What an element has at its middle, and what it changes by per metre along the axes of its facet.
struct Linear {
    Vec3d mean{0, 0, 0}, x{0, 0, 0}, y{0, 0, 0};
    Linear& operator+=(const Linear& o) {
        mean += o.mean, x += o.x, y += o.y;
        return *this;
    }
};

// A symmetric matrix of second moments, in the plane: m².
struct Moments {
    double xx = 0, xy = 0, yy = 0;
    void add(double x, double y, double weight = 1) {
        xx += weight * x * x, xy += weight * x * y, yy += weight * y * y;
    }
    // That of points in a line, or of one point, is no matrix that has an inverse: 0.
    Moments inverse() const {
        const double determinant = xx * yy - xy * xy;
        if (!(determinant > 1e-12 * (xx + yy) * (xx + yy))) return {};
        return {yy / determinant, -xy / determinant, xx / determinant};
    }
    // Of a gradient: the mean square of what it makes of the points.
    double of(double x, double y) const { return xx * x * x + 2 * xy * x * y + yy * y * y; }
};

// An element in its facet's plane: the moments of its area about its middle, and its sides.
struct PlaneCell {
    Moments moments;
    double side[2][2] = {};  // x and y of the two sides that meet in its first corner
    bool triangle = false;
    // The most that a gradient falls below the middle, about.
    double fall(double x, double y) const {
        double sum = 0;
        for (const auto& s : side) sum += std::abs(s[0] * x + s[1] * y);
        return triangle ? 2 * sum / 3 : sum / 2;
    }
};
// Of polygons, over which light is taken to be constant, all is 0.
PlaneCell plane_cell(const Elements& elements, uint32_t element);

}  // namespace trp
