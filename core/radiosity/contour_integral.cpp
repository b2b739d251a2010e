#include "radiosity/contour_integral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "radiosity/gauss_rule.h"

namespace trp {
namespace {

// Half the points err by up to 8e-10 of the product of the perimeters (measured as in polygon_factors.cpp).
constexpr double kCoarseError = 2e-9;
constexpr double kParallel = 1e-13;                                      // a sine below it
constexpr double kAcross = 16 * std::numeric_limits<double>::epsilon();  // a cosine below it

struct Edge {
    Vec3d from, to, direction;
    double length;
};

std::vector<Edge> edges_of(std::span<const Vec3d> polygon, const Vec3d& origin, double scale) {
    std::vector<Edge> edges;
    edges.reserve(polygon.size());
    Vec3d from = (polygon.back() - origin) * scale;
    for (const Vec3d& corner : polygon) {
        const Vec3d to = (corner - origin) * scale, along = to - from;
        const double length = along.length();
        if (length > 0) edges.push_back({from, to, along / length, length});
        from = to;
    }
    return edges;
}

// ∫ ln |x − y| dy over an edge.
double log_along(const Vec3d& x, const Edge& edge) {
    const Vec3d r = x - edge.from, s = x - edge.to;
    const double lower = -r.dot(edge.direction), upper = -s.dot(edge.direction);
    const double r2 = r.length2(), s2 = s.length2();
    const double away = r.cross(edge.direction).length();
    double sum = -edge.length + away * std::atan2(away * edge.length, away * away + lower * upper);
    if (s2 > 0) sum += 0.5 * upper * std::log(s2);
    if (r2 > 0) sum -= 0.5 * lower * std::log(r2);
    return sum;
}

// ∫∫ ln r over two parallel edges, b running as a does where `sense` is 1 and against it where −1: the second
// difference of ∫∫ ½ ln (u² + h²) du du.
double log_between_parallel(const Edge& a, const Edge& b, double sense) {
    const Vec3d apart = (b.from + b.to - a.from - a.to) * 0.5;
    const double h = apart.cross(a.direction).length(), h2 = h * h;
    const auto twice = [&](double u) {
        const double r2 = u * u + h2;
        if (r2 == 0) return 0.0;
        return 0.25 * (u * u - h2) * std::log(r2) - 0.75 * u * u + (h > 0 ? h * u * std::atan(u / h) : 0);
    };
    const Vec3d &first = sense > 0 ? b.from : b.to, &second = sense > 0 ? b.to : b.from;
    return twice((first - a.to).dot(a.direction)) + twice((second - a.from).dot(a.direction)) -
           twice((first - a.from).dot(a.direction)) - twice((second - a.to).dot(a.direction));
}

// ∫∫ ln r over any two edges: along `inner` in closed form, along `outer` by Gauss's rule on panels that shrink
// towards the three places where the inner integral has a branch point: across from inner's ends, and where the lines
// are closest. The rule of n points errs by about ρ^−2n, ρ the sum of the semiaxes of the ellipse, with foci at the
// panel's ends, through the nearest of these; `semiaxis` below is the major one, in half panels.
double log_between(const Edge& outer, const Edge& inner, double sine, bool coarse) {
    const Vec3d r = inner.from - outer.from, s = inner.to - outer.from;
    struct Branch {
        double along = 1e9, away = 0;
    };
    std::array<Branch, 3> branches = {{{r.dot(outer.direction), r.cross(outer.direction).length()},
                                       {s.dot(outer.direction), s.cross(outer.direction).length()}}};
    if (sine >= kParallel) {
        const Vec3d across = outer.direction.cross(inner.direction) / sine;
        branches[2] = {r.dot(inner.direction.cross(across)) / sine, std::abs(r.dot(across)) / sine};
    }
    // Panels this small may hold the branch point itself: u ln u and |u| are integrable, and it errs by its square.
    const double smallest = outer.length * (coarse ? 0x1p-10 : 0x1p-20);

    std::array<std::array<double, 2>, 24> waiting;
    size_t count = 0;
    waiting[count++] = {0, outer.length};
    double sum = 0;
    while (count > 0) {
        const auto [start, end] = waiting[--count];
        double semiaxis = 1e9;
        for (const auto& [along, away] : branches) {
            const double to_start = along - start, to_end = along - end, away2 = away * away;
            semiaxis =
                std::min(semiaxis,
                         (std::sqrt(to_start * to_start + away2) + std::sqrt(to_end * to_end + away2)) / (end - start));
        }
        if (semiaxis < 1.5 && end - start > smallest) {
            const double middle = 0.5 * (start + end);
            waiting[count++] = {start, middle};
            waiting[count++] = {middle, end};
            continue;
        }
        const int n = (semiaxis > 20 ? 4 : semiaxis > 2.99 || end - start <= smallest ? 8 : 16) / (coarse ? 2 : 1);
        const GaussRule& rule = gauss_rule(n);
        double part = 0;
        for (size_t i = 0; i < static_cast<size_t>(n); ++i)
            part +=
                rule.weight[i] * log_along(outer.from + outer.direction * (start + (end - start) * rule.at[i]), inner);
        sum += part * (end - start);
    }
    return sum;
}

}  // namespace

double contour_integral(std::span<const Vec3d> a, std::span<const Vec3d> b, double relative_error) {
    // ln r is small and of both signs in units of the whole.
    const Vec3d& origin = a[0];
    double size2 = 0;
    for (const std::span<const Vec3d> polygon : {a, b})
        for (const Vec3d& p : polygon) size2 = std::max(size2, (p - origin).length2());
    const double scale = 1 / std::sqrt(size2);
    const std::vector<Edge> of_a = edges_of(a, origin, scale), of_b = edges_of(b, origin, scale);
    // The difference of the parallel edges' closed form leaves 1e-16 of the whole's square, too much for a short edge.
    const double shortest2 = 1e-14 / std::max(relative_error, 1e-12);
    const auto integral = [&](bool coarse) {
        double sum = 0;
        for (const Edge& p : of_a)
            for (const Edge& q : of_b) {
                const double cosine = p.direction.dot(q.direction), sine = p.direction.cross(q.direction).length();
                if (std::abs(cosine) < kAcross) continue;
                const double shorter = std::min(p.length, q.length);
                if (sine < kParallel && shorter * shorter > shortest2)
                    sum += log_between_parallel(p, q, cosine > 0 ? 1 : -1) * (cosine > 0 ? 1 : -1);
                else
                    sum += cosine *
                           (p.length < q.length ? log_between(p, q, sine, coarse) : log_between(q, p, sine, coarse));
            }
        return sum / (2 * std::numbers::pi * scale * scale);
    };
    if (relative_error >= 1e-5) {
        double around_a = 0, around_b = 0;
        for (const Edge& p : of_a) around_a += p.length;
        for (const Edge& q : of_b) around_b += q.length;
        const double sum = integral(true);
        if (sum * relative_error > kCoarseError * around_a * around_b / (scale * scale)) return sum;
    }
    return integral(false);
}

}  // namespace trp
