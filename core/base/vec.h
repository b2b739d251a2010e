// Small vectors and affine transforms. Vectors are Imath's; an Affine maps points by rows, as the C ABI hands them in.
#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace trp {

using Vec2 = Imath::V2f;
using Vec3 = Imath::V3f;
using Vec3d = Imath::V3d;

// world = rows · (x, y, z, 1)
struct Affine {
    float rows[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

    static Affine from_rows(const float* m) {
        Affine a;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 4; ++c) a.rows[r][c] = m[4 * r + c];
        return a;
    }
    bool operator==(const Affine&) const = default;

    Vec3 column(int c) const { return {rows[0][c], rows[1][c], rows[2][c]}; }
    Vec3 point(const Vec3& p) const {
        Vec3 q;
        for (int r = 0; r < 3; ++r) q[r] = rows[r][0] * p.x + rows[r][1] * p.y + rows[r][2] * p.z + rows[r][3];
        return q;
    }
    Vec3 vector(const Vec3& v) const {
        Vec3 q;
        for (int r = 0; r < 3; ++r) q[r] = rows[r][0] * v.x + rows[r][1] * v.y + rows[r][2] * v.z;
        return q;
    }
    // The cofactor matrix times v: turns normals, up to length, and keeps their side under mirroring.
    Vec3 normal(const Vec3& v) const {
        const Vec3 x = column(0), y = column(1), z = column(2);
        return y.cross(z) * v.x + z.cross(x) * v.y + x.cross(y) * v.z;
    }
    double determinant() const {
        const Vec3d x(column(0)), y(column(1)), z(column(2));
        return x.dot(y.cross(z));
    }
    // The same map seen from `origin`, subtracted in double.
    Affine relative_to(const Vec3d& origin) const {
        Affine a = *this;
        for (int r = 0; r < 3; ++r) a.rows[r][3] = static_cast<float>(static_cast<double>(rows[r][3]) - origin[r]);
        return a;
    }
};

// Between which two of a count of steps, evenly spaced over the times 0 to 1, a time lies, and the later one's share.
struct TimeStep {
    size_t before, after;
    float share;
};
inline TimeStep time_step_at(float time, size_t count) {
    const float at = time * static_cast<float>(count - 1);
    const size_t before = std::min(static_cast<size_t>(std::max(at, 0.0f)), count - 1);
    return {before, std::min(before + 1, count - 1), at - static_cast<float>(before)};
}

// Linear between two steps, of which there is at least one.
inline Affine at_time(const std::vector<Affine>& steps, float time) {
    const auto [before, after, share] = time_step_at(time, steps.size());
    Affine out = steps[before];
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) out.rows[r][c] += share * (steps[after].rows[r][c] - steps[before].rows[r][c]);
    return out;
}

inline float greatest(const Vec3& v) {
    return std::max({v.x, v.y, v.z});
}

// A unit vector at right angles to one.
inline Vec3 perpendicular_to(const Vec3& unit) {
    return (std::abs(unit.z) < 0.9f ? Vec3(0, 0, 1) : Vec3(1, 0, 0)).cross(unit).normalized();
}

inline float luminance(const Vec3& c) {  // Rec. 709
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

}  // namespace trp
