// The one equation, over any lane width (D is a Highway tag of float lanes; 1, 4, 8 or 16 of them):
//
//     I = I_E + K_A I_A + Σ_L (K_D (N·L) + K_S (V·R)^n) S_L I_L + K_S I_R + K_T I_T
//
// Speculars: Phong, "Illumination for Computer Generated Pictures" (1975); Blinn, "Models of Light Reflection for
// Computer Synthesized Pictures" (1977), where (N·H)^n stands for (V·R)^n. Both unnormalized, as their authors have
// them. Included once for each instruction set, within HWY_BEFORE_NAMESPACE.
#if defined(TRIPTYCH_EQUATION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIPTYCH_EQUATION_INL
#undef TRIPTYCH_EQUATION_INL
#else
#define TRIPTYCH_EQUATION_INL
#endif

#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"
#include "shading/equation.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vector3 {
    V x, y, z;
};

template <class D>
Vector3<hn::Vec<D>> load3(D d, const LaneVec3& v, int lane) {
    return {hn::Load(d, v.x + lane), hn::Load(d, v.y + lane), hn::Load(d, v.z + lane)};
}

template <class D, class V>
void store3(D d, const Vector3<V>& v, LaneVec3& out, int lane) {
    hn::Store(v.x, d, out.x + lane);
    hn::Store(v.y, d, out.y + lane);
    hn::Store(v.z, d, out.z + lane);
}

template <class V>
V dot3(const Vector3<V>& a, const Vector3<V>& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

template <class V>
Vector3<V> cross3(const Vector3<V>& a, const Vector3<V>& b) {
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

template <class V>
Vector3<V> operator+(const Vector3<V>& a, const Vector3<V>& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class V>
Vector3<V> operator-(const Vector3<V>& a, const Vector3<V>& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
Vector3<V> operator*(const Vector3<V>& a, V s) {
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
// a + b s
template <class V>
Vector3<V> add_scaled(const Vector3<V>& a, const Vector3<V>& b, V s) {
    return {hn::MulAdd(b.x, s, a.x), hn::MulAdd(b.y, s, a.y), hn::MulAdd(b.z, s, a.z)};
}
template <class M, class V>
Vector3<V> select3(M mask, const Vector3<V>& yes, const Vector3<V>& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}
template <class D, class V = hn::Vec<D>>
Vector3<V> broadcast(D d, const Vec3& v) {
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
template <class V>
V greatest_component(const Vector3<V>& a) {
    return hn::Max(hn::Abs(a.x), hn::Max(hn::Abs(a.y), hn::Abs(a.z)));
}

// x^n for x in [0, 1] and n ≥ 0.
template <class D, class V>
V power(D d, V x, V n) {
    const V smallest = hn::Set(d, 1e-30f);
    return hn::IfThenElseZero(hn::Ge(x, smallest), hn::Exp(d, hn::Mul(n, hn::Log(d, hn::Max(x, smallest)))));
}

// (V·R)^n, or what stands for it; 0 where the specular is none. N, V and L are unit vectors, n_dot_l = N·L.
template <class D, class V>
V highlight(D d, Specular specular, const Vector3<V>& n, const Vector3<V>& v, const Vector3<V>& l, V n_dot_l,
            V shininess) {
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    if (specular == Specular::none) return zero;
    V cosine;
    if (specular == Specular::phong) {
        // V·R with R = 2 (N·L) N − L
        cosine = hn::Sub(hn::Mul(hn::Add(n_dot_l, n_dot_l), dot3(n, v)), dot3(v, l));
    } else {
        // N·H with H = (L + V) / |L + V|
        const Vector3<V> h{hn::Add(l.x, v.x), hn::Add(l.y, v.y), hn::Add(l.z, v.z)};
        cosine = hn::Div(dot3(n, h), hn::Sqrt(hn::Max(dot3(h, h), hn::Set(d, 1e-20f))));
    }
    return power(d, hn::Min(hn::Max(cosine, zero), one), shininess);
}

// One channel of a light's term, (K_D (N·L) + K_S highlight) S_L I_L.
template <class V>
V light_term(V diffuse, V n_dot_l, V specular, V highlight, V light) {
    return hn::Mul(hn::MulAdd(diffuse, n_dot_l, hn::Mul(specular, highlight)), light);
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
