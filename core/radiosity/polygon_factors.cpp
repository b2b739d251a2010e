// Point to polygon: the contour formula of Lambert, Photometria, 1760, as in Baum, Rushmeier, Winget, "Improving
// Radiosity Solutions Through the Use of Analytically Determined Form-Factors", SIGGRAPH 1989.
// Polygon to polygon: near pairs by the contour integral; far pairs by Gauss's rule on one polygon, of the above, or on
// both, of the kernel.
#include "radiosity/polygon_factors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "radiosity/contour_integral.h"
#include "radiosity/gauss_rule.h"

namespace trp {
namespace {

using std::numbers::pi;
using Corners = std::span<const Vec3d>;

// Heights over a plane up to this share of the coordinates are rounding.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

// ---- Polygons and their planes ----

struct Plane {
    Vec3d normal{0, 0, 0};  // unit
    Vec3d centre{0, 0, 0};  // mean of the corners
    double area = 0;        // 0: degenerate
    double reach = 0;       // largest coordinate

    double height(const Vec3d& p) const { return normal.dot(p - centre); }
};

Plane plane_of(Corners polygon) {
    Plane plane;
    if (polygon.size() < 3) return plane;
    Vec3d sum(0, 0, 0), centre(0, 0, 0);
    double around = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d &p = polygon[i], &q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
        const Vec3d from = p - polygon[0], to = q - polygon[0];
        sum += from.cross(to);
        centre += from;
        around += (to - from).length2();
        plane.reach = std::max({plane.reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    const double length = sum.length();
    if (!(length > kRounding * around)) return plane;
    plane.normal = sum / length;
    plane.centre = polygon[0] + centre / static_cast<double>(polygon.size());
    plane.area = 0.5 * length;
    return plane;
}

// The part of `polygon` in front of `plane` (Sutherland, Hodgman 1974): the polygon itself where nothing is cut away,
// or `storage`, empty where all is. The bridges that a concave polygon gets lie in the plane and cancel.
Corners in_front(Corners polygon, const Plane& plane, double rounding, std::vector<Vec3d>& storage) {
    bool any_front = false, any_behind = false;
    for (const Vec3d& p : polygon) {
        const double h = plane.height(p);
        any_front |= h > rounding;
        any_behind |= h < -rounding;
    }
    if (!any_front) return {};
    if (!any_behind) return polygon;
    storage.reserve(polygon.size() + polygon.size() / 2 + 1);
    Vec3d from = polygon.back();
    double from_height = plane.height(from);
    for (const Vec3d& to : polygon) {
        const double height = plane.height(to);
        if ((from_height > rounding && height < -rounding) || (from_height < -rounding && height > rounding))
            storage.push_back(from + (to - from) * (from_height / (from_height - height)));
        if (height >= -rounding) storage.push_back(to);
        from = to, from_height = height;
    }
    return storage;
}

// ---- Point to polygon ----

// Lambert's formula: the contour's angles seen from the point, each about the normal of its wedge, along `normal`.
double lambert(const Vec3d& point, const Vec3d& normal, Corners polygon) {
    double sum = 0;
    Vec3d first(0, 0, 0), last(0, 0, 0);
    bool empty = true;
    const auto go_to = [&](const Vec3d& r) {
        if (empty) {
            first = r, empty = false;
        } else {
            const Vec3d wedge = r.cross(last);
            const double sine = wedge.length();
            if (sine > 0) sum += std::atan2(sine, r.dot(last)) / sine * normal.dot(wedge);
        }
        last = r;
    };
    Vec3d from = polygon.back() - point;
    double from_height = normal.dot(from);
    for (const Vec3d& corner : polygon) {
        const Vec3d to = corner - point;
        const double height = normal.dot(to);
        if ((from_height < 0) != (height < 0))
            go_to(from + (to - from) * (from_height / (from_height - height)));  // at the horizon
        if (height >= 0) go_to(to);
        from = to, from_height = height;
    }
    if (empty) return 0;
    go_to(first);
    return sum / (2 * pi);
}

// ---- Far pairs: Gauss's rule on a polygon ----

// A polygon as a fan of quads: its own corners, or three and the last twice.
struct Quad {
    Vec3d corner[4];
};

size_t quad_count(Corners polygon) {
    return (polygon.size() - 1) / 2;
}

Quad quad_of(Corners polygon, size_t i) {
    return {{polygon[0], polygon[2 * i + 1], polygon[2 * i + 2], polygon[std::min(2 * i + 3, polygon.size() - 1)]}};
}

// The bilinear map's area is signed: where a concave polygon's quads overlap, they cancel.
template <typename Visit>
void visit_nodes(Corners polygon, const Vec3d& normal, const std::array<int, 2>& order, const Visit& visit) {
    const GaussRule &rule_u = gauss_rule(order[0]), &rule_v = gauss_rule(order[1]);
    for (size_t k = 0; k < quad_count(polygon); ++k) {
        const auto [p] = quad_of(polygon, k);
        const Vec3d u0 = p[1] - p[0], v0 = p[3] - p[0], uv = p[2] - p[3] - u0;
        for (size_t j = 0; j < static_cast<size_t>(order[1]); ++j)
            for (size_t i = 0; i < static_cast<size_t>(order[0]); ++i) {
                const double u = rule_u.at[i], v = rule_v.at[j];
                const Vec3d along_u = u0 + uv * v, along_v = v0 + uv * u;
                visit(p[0] + along_u * u + v0 * v,
                      rule_u.weight[i] * rule_v.weight[j] * normal.dot(along_u.cross(along_v)));
            }
    }
}

struct Extent {
    double radius = 0;             // about the centre
    std::array<double, 2> half{};  // half the longest line along u and along v of its quads
    bool even = true;              // all quads are parallelograms
};

Extent extent_of(Corners polygon, const Vec3d& centre) {
    Extent extent;
    for (const Vec3d& p : polygon) extent.radius = std::max(extent.radius, (p - centre).length2());
    for (size_t k = 0; k < quad_count(polygon); ++k) {
        const auto [p] = quad_of(polygon, k);
        const Vec3d u = p[1] - p[0], v = p[3] - p[0], u1 = p[2] - p[3], v1 = p[2] - p[1];
        extent.half[0] = std::max({extent.half[0], u.length2(), u1.length2()});
        extent.half[1] = std::max({extent.half[1], v.length2(), v1.length2()});
        extent.even &= (u1 - u).length2() <= 1e-8 * std::min(u.length2(), v.length2());
    }
    extent.radius = std::sqrt(extent.radius);
    for (double& half : extent.half) half = 0.5 * std::sqrt(half);
    return extent;
}

// Of Gauss's rules: their error over ρ^−2n, measured (see polygon_to_polygon), and limits of their use.
constexpr double kQuadratureError = 30;
constexpr int kMaxOrder = 12;
constexpr int kMaxNodes = 64;

// The points that Gauss's rule needs along u and v of a polygon whose counterpart stays `distance` from its centre, or
// 0 where it would need too many. Along a line of half length h whose middle is at least d away, n points err by ρ^−2n,
// ρ = z + √(z² − 1), z = d / h. One more where the map to the polygon is not affine: its area and the cosine make a
// square of what may vanish at one end.
std::array<int, 2> orders(const Extent& extent, double distance, double relative_error) {
    std::array<int, 2> order{};
    for (size_t i = 0; i < 2; ++i) {
        const double half = extent.half[i];
        const double z = (distance - std::sqrt(std::max(0.0, extent.radius * extent.radius - half * half))) / half;
        if (!(z > 1.2)) return {0, 0};
        const double rho = z + std::sqrt(z * z - 1), step = 1 / (rho * rho);
        order[i] = extent.even ? 1 : 2;
        double error = kQuadratureError * step;
        while (error > relative_error) {
            if (++order[i] > kMaxOrder) return {0, 0};
            error *= step;
        }
    }
    return order;
}

// Both planar, so the cosines' numerators are each a function of the other's point alone: (1/π) ∫∫ h_a(y) h_b(x) / r⁴.
double kernel_sum(Corners a, const Plane& plane_a, const std::array<int, 2>& order_a, Corners b, const Plane& plane_b,
                  const std::array<int, 2>& order_b) {
    std::array<double, kMaxNodes> x, y, z, weight;
    size_t count = 0;
    visit_nodes(b, plane_b.normal, order_b, [&](const Vec3d& p, double area) {
        const Vec3d r = p - plane_a.centre;
        x[count] = r.x, y[count] = r.y, z[count] = r.z;
        weight[count++] = area * plane_a.normal.dot(r);
    });
    double sum = 0;
    visit_nodes(a, plane_a.normal, order_a, [&](const Vec3d& p, double area) {
        const Vec3d r = p - plane_a.centre;
        double seen = 0;
        for (size_t i = 0; i < count; ++i) {
            const double dx = x[i] - r.x, dy = y[i] - r.y, dz = z[i] - r.z, r2 = dx * dx + dy * dy + dz * dz;
            seen += weight[i] / (r2 * r2);
        }
        sum += area * plane_b.height(p) * seen;
    });
    return sum / pi;
}

double lambert_sum(Corners a, const Plane& plane_a, const std::array<int, 2>& order_a, Corners b) {
    double sum = 0;
    visit_nodes(a, plane_a.normal, order_a,
                [&](const Vec3d& p, double area) { sum += area * lambert(p, plane_a.normal, b); });
    return sum;
}

}  // namespace

double point_to_polygon(const Vec3d& point, const Vec3d& normal, std::span<const Vec3d> polygon) {
    const Plane plane = plane_of(polygon);
    const double reach = std::max({plane.reach, std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    if (plane.area == 0 || !(plane.height(point) > kRounding * reach)) return 0;
    const double factor = lambert(point, normal, polygon);
    return factor > 0 ? std::min(factor, 1.0) : 0;  // NaN too
}

double polygon_to_polygon(std::span<const Vec3d> a, std::span<const Vec3d> b) {
    return polygon_to_polygon(a, b, 1e-12);
}

// The error was measured over 100 000 pairs of random triangles, quads and pentagons, of sizes 0.01 to 1, up to ten
// times as long as wide, one to thirty sizes apart, cut by each other's planes or not, against 1e-13, at 1e-1 to
// 1e-8: 99.8 % are within relative_error, 99 % within a third of it, and grazing ones up to twenty times off.
double polygon_to_polygon(std::span<const Vec3d> a, std::span<const Vec3d> b, double relative_error) {
    Plane plane_a = plane_of(a), plane_b = plane_of(b);
    if (plane_a.area == 0 || plane_b.area == 0) return 0;
    const double rounding = kRounding * std::max(plane_a.reach, plane_b.reach);
    std::vector<Vec3d> storage_a, storage_b;
    const Corners front_a = in_front(a, plane_b, rounding, storage_a),
                  front_b = in_front(b, plane_a, rounding, storage_b);
    if (front_a.size() < 3 || front_b.size() < 3) return 0;
    const auto cut = [](Plane& plane, Corners front) {  // of a sliver, the normal is known no better
        const Vec3d normal = plane.normal;
        plane = plane_of(front);
        plane.normal = normal;
    };
    if (!storage_a.empty()) cut(plane_a, front_a);
    if (!storage_b.empty()) cut(plane_b, front_b);
    if (plane_a.area == 0 || plane_b.area == 0) return 0;

    // How far the one's nearest point can be from the other's centre.
    const Extent extent_a = extent_of(front_a, plane_a.centre), extent_b = extent_of(front_b, plane_b.centre);
    const double apart = (plane_b.centre - plane_a.centre).length();
    const auto order_a =
        orders(extent_a, std::max(apart - extent_b.radius, plane_b.height(plane_a.centre)), relative_error);
    const auto order_b =
        orders(extent_b, std::max(apart - extent_a.radius, plane_a.height(plane_b.centre)), relative_error);

    const auto nodes = [](Corners polygon, const std::array<int, 2>& order) {
        return static_cast<double>(quad_count(polygon)) * order[0] * order[1];
    };
    const double nodes_a = nodes(front_a, order_a), nodes_b = nodes(front_b, order_b);
    const auto edges_a = static_cast<double>(front_a.size()), edges_b = static_cast<double>(front_b.size());
    // Nanoseconds, about.
    const double never = 1e30;
    const double by_a = nodes_a > 0 ? 45 * edges_b * nodes_a : never;
    const double by_b = nodes_b > 0 ? 45 * edges_a * nodes_b : never;
    const double by_both = nodes_a > 0 && nodes_b > 0 && nodes_b <= kMaxNodes ? 4 * nodes_a * nodes_b : never;
    const double least = std::min({by_a, by_b, by_both, 2000 * edges_a * edges_b});
    double sum = 0;
    if (least == by_both)
        sum = kernel_sum(front_a, plane_a, order_a, front_b, plane_b, order_b);
    else if (least == by_a)
        sum = lambert_sum(front_a, plane_a, order_a, front_b);
    else if (least == by_b)
        sum = lambert_sum(front_b, plane_b, order_b, front_a);
    else
        sum = contour_integral(front_a, front_b, relative_error);
    return sum > 0 ? std::min({sum, plane_a.area, plane_b.area}) : 0;  // NaN too
}

}  // namespace trp
