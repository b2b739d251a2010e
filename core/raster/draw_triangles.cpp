// draw_triangles(): vertices to the film's grid, triangles to edge functions, pixels to the visibility buffer.
//
// Coordinates count from the tile's first sample, so that samples lie at multiples of 256 (pixel i, j at 256 i, 256 j).
// The edge function E(p) = (b − a) × (p − a) then is 256 (B j + A i) + C with A = −(b − a).y, B = (b − a).x, and its
// sign that of floor(C / 256) + A i + B j: 32 bits hold it exactly over a packet, whatever the triangle's size.
#include "raster/draw_triangles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "raster/cluster_vertices.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/draw_triangles.cpp"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMostLanes = HWY_MAX_BYTES / sizeof(float);

// A triangle less than this wide and high has edge functions within 32 bits about its corner.
constexpr int32_t kSmall = 64 * kSubpixels;

// A triangle at a packet or pixel (i, j): edge functions, divided by 256, and nearness; and their steps by a pixel.
struct Setup {
    int32_t edge[3], a[3], b[3];
    float nearness, dx, dy, least, most;
    uint32_t key;
};

// What a triangle's values add from a packet's first pixel to each of its lanes, the same in every packet.
struct PacketSteps {
    alignas(64) int32_t edge[3][16];
    alignas(64) float nearness[16];
};

HWY_INLINE void make_steps(const Setup& t, PacketSteps& steps) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    for (size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
        const auto index = hn::Iota(di, static_cast<int32_t>(lane));
        const auto i = hn::And(index, hn::Set(di, 3)), j = hn::ShiftRight<2>(index);
        for (int k = 0; k < 3; ++k)
            hn::Store(hn::Add(hn::Mul(hn::Set(di, t.a[k]), i), hn::Mul(hn::Set(di, t.b[k]), j)), di,
                      steps.edge[k] + lane);
        hn::Store(hn::MulAdd(hn::Set(d, t.dx), hn::ConvertTo(d, i), hn::Mul(hn::Set(d, t.dy), hn::ConvertTo(d, j))), d,
                  steps.nearness + lane);
    }
}

// Draws 16 pixels, whose lower left one is that of the setup's values, into the packet's lanes.
HWY_INLINE void draw_packet(const Setup& t, const PacketSteps& steps, const VisibilityTile::Buffers& tile,
                            size_t packet) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::RebindToUnsigned<decltype(d)> du;
    for (size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
        auto edge = [&](int k) { return hn::Add(hn::Set(di, t.edge[k]), hn::Load(di, steps.edge[k] + lane)); };
        const auto outside = hn::Or(hn::Or(edge(0), edge(1)), edge(2));  // by its sign
        auto covered = hn::RebindMask(d, hn::Gt(outside, hn::Set(di, -1)));
        if (hn::AllFalse(d, covered)) continue;
        auto near = hn::Add(hn::Set(d, t.nearness), hn::Load(d, steps.nearness + lane));
        near = hn::Max(hn::Min(near, hn::Set(d, t.most)), hn::Set(d, t.least));
        const size_t at = packet + lane;
        covered = hn::And(covered, hn::Gt(near, hn::Load(d, tile.nearness + at)));
        const auto key = hn::Set(du, t.key);
        if (tile.last_keys) {
            const auto last_key = hn::Load(du, tile.last_keys + at);
            const auto last = hn::Load(d, tile.last_nearness + at);
            const auto later = hn::RebindMask(d, hn::Gt(hn::BitCast(di, key), hn::BitCast(di, last_key)));
            const auto shown = hn::RebindMask(d, hn::Ne(last_key, hn::Set(du, kNothing)));
            covered = hn::And(hn::And(covered, shown), hn::Or(hn::Lt(near, last), hn::And(hn::Eq(near, last), later)));
        }
        hn::BlendedStore(near, covered, d, tile.nearness + at);
        hn::BlendedStore(key, hn::RebindMask(du, covered), du, tile.keys + at);
    }
}

// The setup, whose values are those of pixel (i, j), over the pixels [i, i1] by [j, j1].
void draw_small(const Setup& at_corner, int32_t i, int32_t j, int32_t i1, int32_t j1,
                const VisibilityTile::Buffers& tile) {
    const int32_t begin_i = std::max(i, 0) & ~3, end_i = std::min(i1, static_cast<int32_t>(tile.width) - 1);
    const int32_t begin_j = std::max(j, 0) & ~3, end_j = std::min(j1, static_cast<int32_t>(tile.height) - 1);
    Setup t = at_corner;
    PacketSteps steps;
    make_steps(t, steps);
    for (int32_t y = begin_j; y <= end_j; y += 4)
        for (int32_t x = begin_i; x <= end_i; x += 4) {
            for (int k = 0; k < 3; ++k) t.edge[k] = at_corner.edge[k] + t.a[k] * (x - i) + t.b[k] * (y - j);
            t.nearness = at_corner.nearness + t.dx * static_cast<float>(x - i) + t.dy * static_cast<float>(y - j);
            draw_packet(t, steps, tile,
                        tile_lane(tile.blocks_across, static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
        }
}

struct GridPoint {
    int64_t x, y;
};

// A triangle of any size, given by its corners on the grid; nearness is that of the plane, at the tile's first sample
// and its steps by a pixel.
void draw_large(GridPoint p0, GridPoint p1, GridPoint p2, const std::array<double, 3>& plane, float least, float most,
                uint32_t key, const VisibilityTile::Buffers& tile) {
    const int64_t area = (p1.x - p0.x) * (p2.y - p0.y) - (p2.x - p0.x) * (p1.y - p0.y);
    if (area == 0) return;
    if (area < 0) std::swap(p1, p2);
    const int64_t begin_i = std::max<int64_t>((std::min({p0.x, p1.x, p2.x}) + 255) >> 8, 0),
                  begin_j = std::max<int64_t>((std::min({p0.y, p1.y, p2.y}) + 255) >> 8, 0),
                  end_i = std::min<int64_t>(std::max({p0.x, p1.x, p2.x}) >> 8, tile.width - 1),
                  end_j = std::min<int64_t>(std::max({p0.y, p1.y, p2.y}) >> 8, tile.height - 1);
    const GridPoint corners[4] = {p0, p1, p2, p0};
    int64_t constant[3];
    Setup t{};
    for (int k = 0; k < 3; ++k) {
        const GridPoint &from = corners[k], &to = corners[k + 1];
        const int64_t dx = to.x - from.x, dy = to.y - from.y;
        const bool left_or_top = dy < 0 || (dy == 0 && dx < 0);
        constant[k] = (dy * from.x - dx * from.y - (left_or_top ? 0 : 1)) >> 8;
        t.a[k] = static_cast<int32_t>(-dy);
        t.b[k] = static_cast<int32_t>(dx);
    }
    t.dx = static_cast<float>(plane[1]);
    t.dy = static_cast<float>(plane[2]);
    t.least = least;
    t.most = most;
    t.key = key;
    PacketSteps steps;
    make_steps(t, steps);
    constexpr int64_t kFar = int64_t{1} << 30;  // no sum over a packet comes back from there
    // Block by block, those that lie outside of an edge left out.
    for (int64_t block_j = begin_j & ~15; block_j <= end_j; block_j += 16)
        for (int64_t block_i = begin_i & ~15; block_i <= end_i; block_i += 16) {
            bool outside = false;
            for (int k = 0; k < 3; ++k) {
                const int64_t at = constant[k] + t.a[k] * block_i + t.b[k] * block_j;
                outside |= at + 15 * (std::max<int64_t>(t.a[k], 0) + std::max<int64_t>(t.b[k], 0)) < 0;
            }
            if (outside) continue;
            for (int64_t j = std::max(block_j, begin_j & ~3); j <= std::min(block_j + 15, end_j); j += 4)
                for (int64_t i = std::max(block_i, begin_i & ~3); i <= std::min(block_i + 15, end_i); i += 4) {
                    for (int k = 0; k < 3; ++k)
                        t.edge[k] =
                            static_cast<int32_t>(std::clamp(constant[k] + t.a[k] * i + t.b[k] * j, -kFar, kFar));
                    t.nearness = static_cast<float>(plane[0] + plane[1] * static_cast<double>(i) +
                                                    plane[2] * static_cast<double>(j));
                    draw_packet(t, steps, tile,
                                tile_lane(tile.blocks_across, static_cast<uint32_t>(i), static_cast<uint32_t>(j)));
                }
        }
}

// A triangle that is large on the film or reaches beyond what its grid can hold: cut by the near plane and the guard
// band, and drawn as a fan.
void draw_any(const PlacedCluster& c, uint32_t k, uint32_t key, const VisibilityTile::Buffers& tile,
              const int32_t* grid_x, const int32_t* grid_y, bool cut) {
    const Projection& projection = c.projection;
    const bool perspective = projection.perspective();
    FilmPoint p[3];
    for (int m = 0; m < 3; ++m) p[m] = on_film(c.transform, c.positions[c.vertex(k, m)]);

    // Nearness over the film, from the plane N · q = D: 1 / depth = (N.x x + N.y y + N.z) / D, or the depth itself.
    double normal[3], e1[3], e2[3], distance = 0;
    for (int r = 0; r < 3; ++r) e1[r] = p[1][r] - p[0][r], e2[r] = p[2][r] - p[0][r];
    for (int r = 0; r < 3; ++r) {
        const int s = (r + 1) % 3, t = (r + 2) % 3;
        normal[r] = e1[s] * e2[t] - e1[t] * e2[s];
        distance += normal[r] * p[0][r];
    }
    const double divisor = perspective ? distance : normal[2];
    if (divisor == 0) return;  // seen edge-on
    std::array<double, 3> plane;
    if (perspective)
        plane = {normal[2] / divisor, normal[0] / divisor, normal[1] / divisor};
    else
        plane = {-distance / divisor, normal[0] / divisor, normal[1] / divisor};
    // From the film's pixels to the tile's.
    plane[0] += (plane[1] * tile.origin_x + plane[2] * tile.origin_y) / kSubpixels;

    if (!cut) {
        GridPoint g[3];
        float least = 1e38f, most = -1e38f;
        for (int m = 0; m < 3; ++m) {
            const uint8_t local = c.set.corners[m][c.cluster().first + k];
            g[m] = {grid_x[local], grid_y[local]};
            const float near = projection.nearness(static_cast<float>(p[m][2]));
            least = std::min(least, near), most = std::max(most, near);
        }
        return draw_large(g[0], g[1], g[2], plane, least, most, key, tile);
    }

    // Sutherland and Hodgman, "Reentrant Polygon Clipping" (1974), in an order of corners that neighbours share.
    std::array<FilmPoint, 16> polygon, next;  // 8 but for rounding
    size_t count = 3;
    std::copy_n(p, 3, polygon.begin());
    for (int bound = 0; bound < kBoundCount; ++bound) {
        size_t kept = 0;
        for (size_t m = 0; m < count; ++m) {
            if (kept + 2 > next.size()) return;
            const FilmPoint *a = &polygon[m], *b = &polygon[(m + 1) % count];
            const double at_a = within_bound(projection, bound, *a), at_b = within_bound(projection, bound, *b);
            if (at_a >= 0) next[kept++] = *a;
            if ((at_a >= 0) == (at_b >= 0)) continue;
            double from = at_a, to = at_b;
            if (*b < *a) std::swap(a, b), std::swap(from, to);
            const double t = from / (from - to);
            for (int r = 0; r < 3; ++r) next[kept][r] = (*a)[r] + ((*b)[r] - (*a)[r]) * t;
            ++kept;
        }
        count = kept;
        polygon.swap(next);
        if (count < 3) return;
    }
    GridPoint g[16];
    float least = 1e38f, most = -1e38f;
    // Beyond 1e16 rounding takes a cut corner anywhere: it is held within the guard band, or given up.
    const auto grid = [](double film, double size, int32_t origin) {
        return std::llround(std::clamp(film, -double{kGuardBand}, size + kGuardBand) * kSubpixels) - origin;
    };
    for (size_t m = 0; m < count; ++m) {
        const double depth = perspective ? polygon[m][2] : 1, x = polygon[m][0] / depth, y = polygon[m][1] / depth;
        if (std::isnan(x) || std::isnan(y)) return;
        g[m] = {grid(x, projection.width(), tile.origin_x), grid(y, projection.height(), tile.origin_y)};
        const float near = projection.nearness(static_cast<float>(polygon[m][2]));
        least = std::min(least, near), most = std::max(most, near);
    }
    for (size_t m = 2; m < count; ++m) draw_large(g[0], g[m - 1], g[m], plane, least, most, key, tile);
}

// A pixel of a triangle of a few. Of equally near triangles the one with the least key is kept, in whatever order they
// come.
HWY_INLINE void draw_pixel(size_t at, float near, uint32_t key, const VisibilityTile::Buffers& tile) {
    const float shown = tile.nearness[at];
    if (!(near > shown || (near == shown && key < tile.keys[at] && tile.keys[at] != kNothing))) return;
    if (tile.last_keys) {
        const float last = tile.last_nearness[at];
        if (tile.last_keys[at] == kNothing || !(near < last || (near == last && key > tile.last_keys[at]))) return;
    }
    tile.nearness[at] = near;
    tile.keys[at] = key;
}

// Triangles at most so many pixels wide and high are drawn side by side, a pixel of each at a time.
constexpr int32_t kFewPixels = 4;

// `edge`, `a`, `b`: of the edge functions, as in Setup; `first_key`: of the first lane.
template <class VI, class V, class M>
HWY_INLINE void draw_few(M wanted, VI i0, VI j0, VI across, VI up, const int32_t (*edge)[kMostLanes],
                         const int32_t (*a)[kMostLanes], const int32_t (*b)[kMostLanes], V at_corner, V by_x, V by_y,
                         V least, V most, uint32_t first_key, const VisibilityTile::Buffers& tile) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const VI width = hn::Set(di, static_cast<int32_t>(tile.width)),
             height = hn::Set(di, static_cast<int32_t>(tile.height)), none = hn::Set(di, -1), three = hn::Set(di, 3);
    for (int32_t j = 0; j < kFewPixels; ++j) {
        const auto row = hn::And(wanted, hn::Not(hn::Gt(hn::Set(di, j), up)));
        if (hn::AllFalse(di, row)) return;
        const VI y = hn::Add(j0, hn::Set(di, j));
        for (int32_t i = 0; i < kFewPixels; ++i) {
            const VI x = hn::Add(i0, hn::Set(di, i));
            auto value = [&](int k) {
                return hn::Add(hn::Load(di, edge[k]), hn::Add(hn::Mul(hn::Load(di, a[k]), hn::Set(di, i)),
                                                              hn::Mul(hn::Load(di, b[k]), hn::Set(di, j))));
            };
            const VI outside = hn::Or(hn::Or(value(0), value(1)), value(2));  // by its sign
            auto covered = hn::And(hn::And(row, hn::Not(hn::Gt(hn::Set(di, i), across))), hn::Gt(outside, none));
            covered = hn::And(covered, hn::And(hn::And(hn::Gt(x, none), hn::Lt(x, width)),
                                               hn::And(hn::Gt(y, none), hn::Lt(y, height))));
            if (hn::AllFalse(di, covered)) continue;
            V near = hn::MulAdd(by_x, hn::Set(d, static_cast<float>(i)),
                                hn::MulAdd(by_y, hn::Set(d, static_cast<float>(j)), at_corner));
            near = hn::Max(hn::Min(near, most), least);
            // As tile_lane() has it.
            const VI block =
                hn::Add(hn::Mul(hn::ShiftRight<4>(y), hn::Set(di, static_cast<int32_t>(tile.blocks_across))),
                        hn::ShiftRight<4>(x));
            auto bits = [&](VI v) { return hn::And(v, three); };
            const VI packet = hn::Add(hn::ShiftLeft<2>(bits(hn::ShiftRight<2>(y))), bits(hn::ShiftRight<2>(x)));
            const VI lane = hn::Add(hn::ShiftLeft<2>(bits(y)), bits(x));
            alignas(64) int32_t at[kMostLanes];
            alignas(64) float nearness[kMostLanes];
            hn::Store(hn::Add(hn::ShiftLeft<8>(block), hn::Add(hn::ShiftLeft<4>(packet), lane)), di, at);
            hn::Store(near, d, nearness);
            uint8_t mask[8] = {};
            hn::StoreMaskBits(di, covered, mask);
            uint64_t left = 0;
            std::memcpy(&left, mask, sizeof left);
            for (; left; left &= left - 1) {
                const auto m = static_cast<uint32_t>(std::countr_zero(left));
                draw_pixel(static_cast<size_t>(at[m]), nearness[m], first_key + m, tile);
            }
        }
    }
}

void draw_triangle_lanes(const PlacedCluster& c, uint32_t first_key, const VisibilityTile::Buffers& tile) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    using VI = hn::Vec<decltype(di)>;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const Cluster& cluster = c.cluster();

    ClusterVertices vertices;
    project_vertices(c, tile.origin_x, tile.origin_y, vertices);
    const int32_t *const x = vertices.x, *const y = vertices.y, *const is_cut = vertices.is_cut;
    const float* const near = vertices.near;

    // Triangles: what covers no sample is left out, what is small is set up here.
    for (uint32_t k = 0; k < cluster.count; k += static_cast<uint32_t>(lanes)) {
        const hn::Rebind<uint8_t, decltype(di)> d8;
        auto corner = [&](int m) { return hn::PromoteTo(di, hn::LoadU(d8, &c.set.corners[m][cluster.first + k])); };
        const auto left = hn::FirstN(di, cluster.count - k);
        const VI c0 = corner(0), c1 = corner(1), c2 = corner(2);
        const VI x0 = hn::GatherIndex(di, x, c0), y0 = hn::GatherIndex(di, y, c0);
        VI x1 = hn::GatherIndex(di, x, c1), y1 = hn::GatherIndex(di, y, c1), x2 = hn::GatherIndex(di, x, c2),
           y2 = hn::GatherIndex(di, y, c2);
        const VI least_x = hn::Min(x0, hn::Min(x1, x2)), most_x = hn::Max(x0, hn::Max(x1, x2)),
                 least_y = hn::Min(y0, hn::Min(y1, y2)), most_y = hn::Max(y0, hn::Max(y1, y2));
        const VI i0 = hn::ShiftRight<8>(hn::Add(least_x, hn::Set(di, 255))), i1 = hn::ShiftRight<8>(most_x),
                 j0 = hn::ShiftRight<8>(hn::Add(least_y, hn::Set(di, 255))), j1 = hn::ShiftRight<8>(most_y);
        const VI none = hn::Set(di, -1);
        auto wanted = hn::And(hn::And(hn::Gt(i1, none), hn::Gt(j1, none)),
                              hn::And(hn::Lt(i0, hn::Set(di, static_cast<int32_t>(tile.width))),
                                      hn::Lt(j0, hn::Set(di, static_cast<int32_t>(tile.height)))));
        wanted = hn::And(wanted, hn::And(hn::Not(hn::Gt(i0, i1)), hn::Not(hn::Gt(j0, j1))));
        auto cut = hn::MaskFromVec(hn::Zero(di));
        if (vertices.any_cut)
            cut = hn::Ne(hn::Or(hn::GatherIndex(di, is_cut, c0),
                                hn::Or(hn::GatherIndex(di, is_cut, c1), hn::GatherIndex(di, is_cut, c2))),
                         hn::Zero(di));
        wanted = hn::And(left, hn::Or(wanted, cut));
        if (hn::AllFalse(di, wanted)) continue;
        const VI limit = hn::Set(di, kSmall);
        const auto small = hn::And(
            hn::And(hn::Lt(hn::Sub(most_x, least_x), limit), hn::Lt(hn::Sub(most_y, least_y), limit)), hn::Not(cut));

        V near0 = hn::GatherIndex(d, near, c0), near1 = hn::GatherIndex(d, near, c1),
          near2 = hn::GatherIndex(d, near, c2);
        const VI area = hn::Sub(hn::Mul(hn::Sub(x1, x0), hn::Sub(y2, y0)), hn::Mul(hn::Sub(x2, x0), hn::Sub(y1, y0)));
        wanted = hn::And(wanted, hn::Not(hn::And(small, hn::Eq(area, hn::Zero(di)))));
        const auto turned = hn::Lt(area, hn::Zero(di));
        auto swap = [&](auto mask, auto& a, auto& b) {
            const auto kept = a;
            a = hn::IfThenElse(mask, b, a);
            b = hn::IfThenElse(mask, kept, b);
        };
        swap(turned, x1, x2);
        swap(turned, y1, y2);
        swap(hn::RebindMask(d, turned), near1, near2);

        // Edge functions at pixel (i0, j0), about which coordinates are small.
        alignas(64) int32_t edge[3][kMostLanes], a[3][kMostLanes], b[3][kMostLanes];
        const VI corner_x = hn::ShiftLeft<8>(i0), corner_y = hn::ShiftLeft<8>(j0);
        auto set_edge = [&](int m, VI from_x, VI from_y, VI to_x, VI to_y) {
            const VI dx = hn::Sub(to_x, from_x), dy = hn::Sub(to_y, from_y);
            const VI constant = hn::Sub(hn::Mul(dy, hn::Sub(from_x, corner_x)), hn::Mul(dx, hn::Sub(from_y, corner_y)));
            const auto flat = hn::Eq(dy, hn::Zero(di));
            const auto left_or_top = hn::Or(hn::Lt(dy, hn::Zero(di)), hn::And(flat, hn::Lt(dx, hn::Zero(di))));
            const VI biased = hn::Sub(constant, hn::IfThenZeroElse(left_or_top, hn::Set(di, 1)));
            hn::Store(hn::ShiftRight<8>(biased), di, edge[m]);
            hn::Store(hn::Neg(dy), di, a[m]);
            hn::Store(dx, di, b[m]);
        };
        set_edge(0, x0, y0, x1, y1);
        set_edge(1, x1, y1, x2, y2);
        set_edge(2, x2, y2, x0, y0);

        alignas(64) float at_corner[kMostLanes], by_x[kMostLanes], by_y[kMostLanes], least[kMostLanes],
            most[kMostLanes];
        auto real = [&](VI v) { return hn::ConvertTo(d, v); };
        const V scale = hn::Div(hn::Set(d, float{kSubpixels}), hn::Abs(real(area)));
        const V n1 = hn::Sub(near1, near0), n2 = hn::Sub(near2, near0);
        const V dx1 = real(hn::Sub(x1, x0)), dy1 = real(hn::Sub(y1, y0)), dx2 = real(hn::Sub(x2, x0)),
                dy2 = real(hn::Sub(y2, y0));
        const V step_x = hn::Mul(scale, hn::MulSub(n1, dy2, hn::Mul(n2, dy1))),
                step_y = hn::Mul(scale, hn::MulSub(n2, dx1, hn::Mul(n1, dx2)));
        const V pixel = hn::Set(d, 1.0f / kSubpixels);
        const V near_corner = hn::MulAdd(hn::Mul(real(hn::Sub(corner_x, x0)), pixel), step_x,
                                         hn::MulAdd(hn::Mul(real(hn::Sub(corner_y, y0)), pixel), step_y, near0)),
                near_least = hn::Min(near0, hn::Min(near1, near2)), near_most = hn::Max(near0, hn::Max(near1, near2));
        const VI few = hn::Set(di, kFewPixels), across = hn::Sub(i1, i0), up = hn::Sub(j1, j0);
        const auto tiny = hn::And(hn::And(wanted, small), hn::And(hn::Lt(across, few), hn::Lt(up, few)));
        wanted = hn::AndNot(tiny, wanted);
        hn::Store(near_corner, d, at_corner);
        hn::Store(step_x, d, by_x);
        hn::Store(step_y, d, by_y);
        hn::Store(near_least, d, least);
        hn::Store(near_most, d, most);
        alignas(64) int32_t begin_i[kMostLanes], begin_j[kMostLanes], end_i[kMostLanes], end_j[kMostLanes],
            is_wanted[kMostLanes], is_small[kMostLanes];
        hn::Store(i0, di, begin_i);
        hn::Store(j0, di, begin_j);
        hn::Store(i1, di, end_i);
        hn::Store(j1, di, end_j);
        hn::Store(hn::VecFromMask(di, wanted), di, is_wanted);
        hn::Store(hn::VecFromMask(di, small), di, is_small);
        for (int m = 0; m < lanes; ++m) {
            if (!is_wanted[m]) continue;
            const uint32_t triangle = k + static_cast<uint32_t>(m);
            if (is_small[m]) {
                const Setup t{{edge[0][m], edge[1][m], edge[2][m]},
                              {a[0][m], a[1][m], a[2][m]},
                              {b[0][m], b[1][m], b[2][m]},
                              at_corner[m],
                              by_x[m],
                              by_y[m],
                              least[m],
                              most[m],
                              first_key + triangle};
                draw_small(t, begin_i[m], begin_j[m], end_i[m], end_j[m], tile);
                continue;
            }
            bool is_clipped = false;
            for (const auto& corners : c.set.corners) is_clipped |= is_cut[corners[cluster.first + triangle]] != 0;
            draw_any(c, triangle, first_key + triangle, tile, x, y, is_clipped);
        }
        draw_few(tiny, i0, j0, across, up, edge, a, b, near_corner, step_x, step_y, near_least, near_most,
                 first_key + k, tile);
    }
}

float least_of_block(const float* values) {
    const hn::ScalableTag<float> d;
    auto least = hn::Load(d, values);
    for (size_t i = hn::Lanes(d); i < kBatch; i += hn::Lanes(d)) least = hn::Min(least, hn::Load(d, values + i));
    return hn::GetLane(hn::MinOfLanes(d, least));
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(draw_triangle_lanes);
HWY_EXPORT(least_of_block);

void draw_triangles(const PlacedCluster& cluster, uint32_t first_key, const VisibilityTile::Buffers& tile) {
    HWY_DYNAMIC_DISPATCH(draw_triangle_lanes)(cluster, first_key, tile);
}

float least_nearness(const float* block) {
    return HWY_DYNAMIC_DISPATCH(least_of_block)(block);
}

}  // namespace trp
#endif
