#include "geometry/triangulate.h"

#include <cmath>

namespace trp {
namespace {

struct Point {
    double x, y;
};

// Twice the signed area of a triangle.
double area2(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool inside(const Point& p, const Point& a, const Point& b, const Point& c) {
    return area2(a, b, p) >= 0 && area2(b, c, p) >= 0 && area2(c, a, p) >= 0;
}

// The polygon seen along its normal, counter-clockwise.
std::vector<Point> project(std::span<const Vec3> polygon, const Vec3d& normal) {
    const Vec3d n = normal.normalized();
    const Vec3d x = (std::abs(n.x) > 0.7 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0)).cross(n).normalized();
    const Vec3d y = n.cross(x);
    const Vec3d origin(polygon[0]);
    std::vector<Point> points;
    points.reserve(polygon.size());
    for (const Vec3& p : polygon) {
        const Vec3d q = Vec3d(p) - origin;
        points.push_back({q.dot(x), q.dot(y)});
    }
    return points;
}

}  // namespace

Vec3d newell(std::span<const Vec3> positions) {
    Vec3d sum(0, 0, 0);
    const Vec3d origin(positions[0]);
    for (size_t i = 1; i + 1 < positions.size(); ++i)
        sum += (Vec3d(positions[i]) - origin).cross(Vec3d(positions[i + 1]) - origin);
    return sum;
}

void triangulate(std::span<const Vec3> polygon, const Vec3d& normal, std::vector<uint32_t>& triangles) {
    const auto n = static_cast<uint32_t>(polygon.size());
    auto emit = [&](uint32_t a, uint32_t b, uint32_t c) { triangles.insert(triangles.end(), {a, b, c}); };
    if (n == 3) return emit(0, 1, 2);

    const std::vector<Point> points = project(polygon, normal);
    bool convex = true;
    for (uint32_t i = 0; i < n && convex; ++i) convex = area2(points[i], points[(i + 1) % n], points[(i + 2) % n]) > 0;
    if (n == 4 && !convex) {
        // The diagonal that leaves two triangles of the right side: from the reflex corner.
        const bool first = area2(points[0], points[1], points[2]) > 0 && area2(points[0], points[2], points[3]) > 0;
        if (first) return emit(0, 1, 2), emit(0, 2, 3);
        return emit(0, 1, 3), emit(1, 2, 3);
    }
    if (convex) {
        for (uint32_t i = 1; i + 1 < n; ++i) emit(0, i, i + 1);
        return;
    }

    // Ear clipping; only reflex corners can lie in an ear (Eberly, "Triangulation by Ear Clipping").
    std::vector<uint32_t> next(n), previous(n);
    std::vector<bool> reflex(n);
    for (uint32_t i = 0; i < n; ++i) next[i] = (i + 1) % n, previous[i] = (i + n - 1) % n;
    auto turn = [&](uint32_t i) { return area2(points[previous[i]], points[i], points[next[i]]); };
    for (uint32_t i = 0; i < n; ++i) reflex[i] = turn(i) <= 0;
    std::vector<uint32_t> reflexes;
    for (uint32_t i = 0; i < n; ++i)
        if (reflex[i]) reflexes.push_back(i);
    std::vector<bool> clipped(n);
    auto is_ear = [&](uint32_t i) {
        if (reflex[i]) return false;
        const uint32_t a = previous[i], c = next[i];
        for (const uint32_t r : reflexes)
            if (!clipped[r] && reflex[r] && r != a && r != c && inside(points[r], points[a], points[i], points[c]))
                return false;
        return true;
    };
    uint32_t remaining = n, i = 0, since_ear = 0;
    while (remaining > 3) {
        // A whole round without an ear: the polygon crosses itself or is degenerate here; clip anyway.
        if (!is_ear(i) && since_ear <= remaining) {
            i = next[i];
            ++since_ear;
            continue;
        }
        const uint32_t a = previous[i], c = next[i];
        emit(a, i, c);
        clipped[i] = true;
        next[a] = c;
        previous[c] = a;
        if (reflex[a]) reflex[a] = turn(a) <= 0;
        if (reflex[c]) reflex[c] = turn(c) <= 0;
        --remaining;
        since_ear = 0;
        i = c;
    }
    emit(previous[i], i, next[i]);
}

}  // namespace trp
