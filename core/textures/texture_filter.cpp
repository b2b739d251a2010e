// filter_texture(): lanes of any texel kind and wrap mode.
#include <algorithm>

#include "textures/mip_pyramid.h"
#include "triptych/triptych.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "textures/texture_filter.cpp"
#include "hwy/foreach_target.h"

#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMostProbes = 16;

template <class V>
struct Texel {
    V r, g, b, a;
};

// Texels by their index among all levels'.
template <class D, class V = hn::Vec<D>, class VI = hn::Vec<hn::RebindToSigned<D>>>
Texel<V> load_texels(D d, const MipPyramid& pyramid, VI index) {
    const hn::RebindToSigned<D> di;
    if (const float* floats = pyramid.floats()) {
        const VI at = hn::ShiftLeft<2>(index);
        return {hn::GatherIndex(d, floats, at), hn::GatherIndex(d, floats + 1, at), hn::GatherIndex(d, floats + 2, at),
                hn::GatherIndex(d, floats + 3, at)};
    }
    // Two numbers to a word, the first in its lower half.
    const auto* words = reinterpret_cast<const int32_t*>(pyramid.integers());
    const hn::RebindToUnsigned<D> du;
    const VI at = hn::ShiftLeft<1>(index);
    const VI rg = hn::GatherIndex(di, words, at), ba = hn::GatherIndex(di, words + 1, at);
    auto low = [&](VI v) { return hn::ConvertTo(d, hn::And(v, hn::Set(di, 0xFFFF))); };
    auto high = [&](VI v) { return hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(du, v)))); };
    return {low(rg), high(rg), low(ba), high(ba)};
}

// A coordinate within what its wrap mode can tell apart, so that it fits an integer: whole turns are taken off.
template <class D, class V>
V reduce(D d, int32_t wrap, V u) {
    const V one = hn::Set(d, 1.0f);
    u = hn::IfThenElseZero(hn::Eq(u, u), u);  // not a number: 0
    if (wrap == TRP_WRAP_REPEAT) return hn::Sub(u, hn::Floor(u));
    if (wrap == TRP_WRAP_MIRROR) return hn::NegMulAdd(hn::Set(d, 2.0f), hn::Floor(hn::Mul(u, hn::Set(d, 0.5f))), u);
    return hn::Max(hn::Min(u, hn::Set(d, 2.0f)), hn::Neg(one));
}

// A texel's place along an axis, from one off either end to within it.
template <class DI, class VI>
VI wrapped(DI di, int32_t wrap, VI i, VI size) {
    const VI zero = hn::Zero(di), last = hn::Sub(size, hn::Set(di, 1));
    if (wrap == TRP_WRAP_REPEAT) {
        i = hn::IfThenElse(hn::Lt(i, zero), hn::Add(i, size), i);
        i = hn::IfThenElse(hn::Gt(i, last), hn::Sub(i, size), i);
    } else if (wrap == TRP_WRAP_MIRROR) {
        i = hn::IfThenElse(hn::Lt(i, zero), hn::Sub(hn::Set(di, -1), i), i);
        i = hn::IfThenElse(hn::Gt(i, last), hn::Sub(hn::Add(last, size), i), i);
    }
    return hn::Max(hn::Min(i, last), zero);
}

// 1, or 0 for a texel off the end where there is nothing.
template <class D, class VI>
hn::Vec<D> presence(D d, int32_t wrap, VI i, VI size) {
    const hn::RebindToSigned<D> di;
    const auto one = hn::Set(d, 1.0f);
    if (wrap != TRP_WRAP_BLACK) return one;
    const auto within = hn::And(hn::Gt(i, hn::Set(di, -1)), hn::Lt(i, size));
    return hn::IfThenElseZero(hn::RebindMask(d, within), one);
}

// A pyramid and how it is read, as lanes see it.
template <class D>
struct Reader {
    using V = hn::Vec<D>;
    using VI = hn::Vec<hn::RebindToSigned<D>>;
    D d;
    hn::RebindToSigned<D> di;
    const MipPyramid& pyramid;
    const TextureSampler& sampler;

    VI level_size(uint32_t size, VI level) const {
        return hn::Max(hn::Shr(hn::Set(di, static_cast<int32_t>(size)), level), hn::Set(di, 1));
    }
    void add(Texel<V>& sum, V weight, VI x, VI y, VI width, VI height, VI offset) const {
        weight =
            hn::Mul(weight, hn::Mul(presence(d, sampler.wrap_u, x, width), presence(d, sampler.wrap_v, y, height)));
        const VI row = hn::Add(hn::Mul(wrapped(di, sampler.wrap_v, y, height), width), offset);
        const auto texel = load_texels(d, pyramid, hn::Add(row, wrapped(di, sampler.wrap_u, x, width)));
        sum.r = hn::MulAdd(weight, texel.r, sum.r);
        sum.g = hn::MulAdd(weight, texel.g, sum.g);
        sum.b = hn::MulAdd(weight, texel.b, sum.b);
        sum.a = hn::MulAdd(weight, texel.a, sum.a);
    }
    void add_nearest(Texel<V>& sum, V u, V v) const {
        const VI width = level_size(pyramid.width(), hn::Zero(di)), height = level_size(pyramid.height(), hn::Zero(di));
        auto place = [&](V t, VI size) { return hn::ConvertTo(di, hn::Floor(hn::Mul(t, hn::ConvertTo(d, size)))); };
        add(sum, hn::Set(d, 1.0f), place(u, width), place(v, height), width, height, hn::Zero(di));
    }
    void add_bilinear(Texel<V>& sum, V weight, V u, V v, VI level) const {
        const VI width = level_size(pyramid.width(), level), height = level_size(pyramid.height(), level);
        const VI offset = hn::GatherIndex(di, pyramid.offsets(), level);
        const V half = hn::Set(d, 0.5f);
        const V x = hn::MulSub(u, hn::ConvertTo(d, width), half), y = hn::MulSub(v, hn::ConvertTo(d, height), half);
        const V x0 = hn::Floor(x), y0 = hn::Floor(y);
        const V fx = hn::Sub(x, x0), fy = hn::Sub(y, y0);
        const VI i = hn::ConvertTo(di, x0), j = hn::ConvertTo(di, y0), one = hn::Set(di, 1);
        const V upper = hn::Mul(weight, fy), lower = hn::Sub(weight, upper);
        const V upper_right = hn::Mul(upper, fx), lower_right = hn::Mul(lower, fx);
        add(sum, hn::Sub(lower, lower_right), i, j, width, height, offset);
        add(sum, lower_right, hn::Add(i, one), j, width, height, offset);
        add(sum, hn::Sub(upper, upper_right), i, hn::Add(j, one), width, height, offset);
        add(sum, upper_right, hn::Add(i, one), hn::Add(j, one), width, height, offset);
    }
    void add_trilinear(Texel<V>& sum, V weight, V u, V v, VI level, V between) const {
        u = reduce(d, sampler.wrap_u, u), v = reduce(d, sampler.wrap_v, v);
        const V coarse = hn::Mul(weight, between);
        add_bilinear(sum, hn::Sub(weight, coarse), u, v, level);
        if (hn::AllTrue(d, hn::Eq(coarse, hn::Zero(d)))) return;
        add_bilinear(sum, coarse, u, v, hn::Min(hn::Add(level, hn::Set(di, 1)), hn::Set(di, pyramid.levels() - 1)));
    }
};

template <class D, class V>
Texel<V> filter_lanes(D d, const MipPyramid& pyramid, const TextureSampler& sampler, V u, V v, V dudx, V dvdx, V dudy,
                      V dvdy) {
    const hn::RebindToSigned<D> di;
    const Reader<D> reader{d, di, pyramid, sampler};
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    Texel<V> sum{zero, zero, zero, zero};
    if (sampler.filter == TRP_FILTER_NEAREST) {
        reader.add_nearest(sum, reduce(d, sampler.wrap_u, u), reduce(d, sampler.wrap_v, v));
        return sum;
    }
    // The footprint is an ellipse, the image of a circle under the derivatives J in texels; its axes are the
    // eigenvectors of J Jᵀ, their lengths squared the eigenvalues.
    const V width = hn::Set(d, static_cast<float>(pyramid.width())),
            height = hn::Set(d, static_cast<float>(pyramid.height()));
    dudx = hn::Mul(dudx, width), dudy = hn::Mul(dudy, width);
    dvdx = hn::Mul(dvdx, height), dvdy = hn::Mul(dvdy, height);
    const V uu = hn::MulAdd(dudx, dudx, hn::Mul(dudy, dudy)), vv = hn::MulAdd(dvdx, dvdx, hn::Mul(dvdy, dvdy)),
            uv = hn::MulAdd(dudx, dvdx, hn::Mul(dudy, dvdy));
    const V half = hn::Set(d, 0.5f);
    const V mean = hn::Mul(hn::Add(uu, vv), half), difference = hn::Mul(hn::Sub(uu, vv), half);
    const V root = hn::Sqrt(hn::MulAdd(difference, difference, hn::Mul(uv, uv)));
    // Footprints may be huge, or not numbers, at grazing angles.
    const V most = hn::Set(d, 1e8f);
    const V longer = hn::Min(hn::Sqrt(hn::Add(mean, root)), most);
    const V shorter = hn::Max(hn::Sqrt(hn::Max(hn::Sub(mean, root), zero)), one);
    const V probes = hn::Min(hn::Max(hn::Floor(hn::MulAdd(longer, hn::Div(one, shorter), half)), one),
                             hn::Set(d, static_cast<float>(kMostProbes)));
    const V share = hn::Div(one, probes);
    const V top = hn::Set(d, static_cast<float>(pyramid.levels() - 1));
    const V level = hn::Max(hn::Min(hn::Log2(d, hn::Max(hn::Mul(longer, share), one)), top), zero),
            fine = hn::Floor(level);
    const auto fine_level = hn::ConvertTo(di, fine);
    const V between = hn::Sub(level, fine);

    if (hn::AllTrue(d, hn::Eq(probes, one))) {
        reader.add_trilinear(sum, one, u, v, fine_level, between);
        return sum;
    }
    const auto along_u = hn::Ge(difference, zero);
    V axis_u = hn::IfThenElse(along_u, hn::Add(root, difference), uv),
      axis_v = hn::IfThenElse(along_u, uv, hn::Sub(root, difference));
    const V length = hn::Sqrt(hn::MulAdd(axis_u, axis_u, hn::Mul(axis_v, axis_v)));
    const V scale = hn::IfThenElseZero(hn::Gt(length, zero), hn::Div(longer, hn::Max(length, hn::Set(d, 1e-30f))));
    axis_u = hn::Div(hn::Mul(axis_u, scale), width), axis_v = hn::Div(hn::Mul(axis_v, scale), height);
    for (int k = 0; k < kMostProbes; ++k) {
        const auto wanted = hn::Gt(probes, hn::Set(d, static_cast<float>(k)));
        if (hn::AllFalse(d, wanted)) break;
        const V t = hn::MulSub(hn::Set(d, static_cast<float>(k) + 0.5f), share, half);
        reader.add_trilinear(sum, hn::IfThenElseZero(wanted, share), hn::MulAdd(axis_u, t, u), hn::MulAdd(axis_v, t, v),
                             fine_level, between);
    }
    return sum;
}

void filter_batch(const MipPyramid& pyramid, const TextureSampler& sampler, size_t count, const TextureCoordinates& at,
                  float* const rgba[4]) {
    const hn::ScalableTag<float> d;
    const size_t lanes = hn::Lanes(d);
    const auto scale = hn::Set(d, pyramid.integers() ? 1.0f / 65535 : 1.0f);
    const float* const in[6] = {at.u, at.v, at.dudx, at.dvdx, at.dudy, at.dvdy};
    alignas(64) float padded[6][HWY_MAX_BYTES / sizeof(float)] = {}, part[4][HWY_MAX_BYTES / sizeof(float)];
    for (size_t i = 0; i < count; i += lanes) {
        const bool whole = i + lanes <= count;
        if (!whole)
            for (int k = 0; k < 6; ++k) std::copy_n(in[k] + i, count - i, padded[k]);
        auto load = [&](int k) { return whole ? hn::LoadU(d, in[k] + i) : hn::Load(d, padded[k]); };
        const auto texel = filter_lanes(d, pyramid, sampler, load(0), load(1), load(2), load(3), load(4), load(5));
        const decltype(texel.r) values[4] = {hn::Mul(texel.r, scale), hn::Mul(texel.g, scale), hn::Mul(texel.b, scale),
                                             hn::Mul(texel.a, scale)};
        for (int c = 0; c < 4; ++c) {
            if (whole) {
                hn::StoreU(values[c], d, rgba[c] + i);
            } else {
                hn::Store(values[c], d, part[c]);
                std::copy_n(part[c], count - i, rgba[c] + i);
            }
        }
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(filter_batch);

void filter_texture(const MipPyramid& pyramid, const TextureSampler& sampler, size_t count,
                    const TextureCoordinates& at, float* const rgba[4]) {
    HWY_DYNAMIC_DISPATCH(filter_batch)(pyramid, sampler, count, at, rgba);
}

}  // namespace trp
#endif
