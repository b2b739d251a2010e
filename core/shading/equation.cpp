#include "shading/equation.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/equation.cpp"
#include "hwy/foreach_target.h"

#include "shading/equation-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trp::HWY_NAMESPACE {

void add_ambient_lanes(const Points& points, const Coefficients& coefficients, const Vec3& ambient_light,
                       LaneVec3& radiance) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const auto hit = hn::RebindMask(d, hn::Ne(hn::Load(du, points.slot + i), hn::Set(du, kNoSlot)));
        for (int c = 0; c < 3; ++c) {
            const auto sum = hn::MulAdd(hn::Load(d, coefficients.ambient[c] + i), hn::Set(d, ambient_light[c]),
                                        hn::Load(d, coefficients.emission[c] + i));
            hn::Store(hn::IfThenElseZero(hit, sum), d, radiance[c] + i);
        }
    }
}

// `group`: null, or what the light's group adds to the radiance.
void add_light_lanes(Specular specular, const Points& points, const Coefficients& coefficients, const LaneVec3& weight,
                     const LightSamples& samples, const LaneVec3& visibility, const LightSums& sums, LaneVec3* group) {
    LaneVec3& radiance = sums.radiance;
    ArrivingLight* const arriving = sums.arriving;
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    using V = hn::Vec<decltype(d)>;
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        if (!samples.reaches(i)) continue;
        const auto hit = hn::RebindMask(d, hn::Ne(hn::Load(du, points.slot + i), hn::Set(du, kNoSlot)));
        const Vector3<V> n = load3(d, points.normal, i), l = load3(d, samples.direction, i);
        const V n_dot_l = hn::Max(dot3(n, l), hn::Zero(d));
        const auto lit = hn::And(hit, hn::Gt(n_dot_l, hn::Zero(d)));
        if (hn::AllFalse(d, lit)) continue;
        const V shine = highlight(d, specular, n, load3(d, points.to_viewer, i), l, n_dot_l,
                                  hn::Load(d, coefficients.shininess + i));
        for (int c = 0; c < 3; ++c) {
            const V s = hn::IfThenElseZero(lit, hn::Load(d, visibility[c] + i));
            const V light = hn::IfThenElseZero(lit, hn::Load(d, samples.light[c] + i));
            const V term = light_term(hn::Load(d, coefficients.diffuse[c] + i), n_dot_l, hn::Load(d, weight[c] + i),
                                      shine, hn::Mul(light, s));
            hn::Store(hn::Add(hn::Load(d, radiance[c] + i), term), d, radiance[c] + i);
            if (group) hn::Store(hn::Add(hn::Load(d, (*group)[c] + i), term), d, (*group)[c] + i);
            if (sums.diffuse) {
                const V part = hn::Mul(hn::Mul(hn::Load(d, coefficients.diffuse[c] + i), n_dot_l), hn::Mul(light, s));
                hn::Store(hn::Add(hn::Load(d, (*sums.diffuse)[c] + i), part), d, (*sums.diffuse)[c] + i);
            }
            if (!arriving) continue;
            const V unblocked = hn::Mul(light, n_dot_l);
            hn::Store(hn::Add(hn::Load(d, arriving->unblocked[c] + i), unblocked), d, arriving->unblocked[c] + i);
            hn::Store(hn::MulAdd(unblocked, s, hn::Load(d, arriving->blocked[c] + i)), d, arriving->blocked[c] + i);
        }
    }
}

// Coefficients that do not vary over a surface, from the table of rows.
void gather_constants(const float* rows, size_t stride, const Points& points, Coefficients& coefficients) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const struct {
        int row;
        LaneVec3* value;
    } colors[] = {{kEmission, &coefficients.emission},
                  {kAmbient, &coefficients.ambient},
                  {kDiffuse, &coefficients.diffuse},
                  {kSpecular, &coefficients.specular}};
    for (int i = 0; i < kBatch; i += static_cast<int>(hn::Lanes(d))) {
        const auto material = hn::Load(di, reinterpret_cast<const int32_t*>(points.material) + i);
        // Neighbouring lanes mostly show one material: then a number for all beats a gather.
        const auto first = hn::Set(di, static_cast<int32_t>(points.material[i]));
        const bool uniform = hn::AllTrue(di, hn::Eq(material, first));
        auto fill = [&](int row, float* out) {
            const float* values = rows + static_cast<size_t>(row) * stride;
            hn::Store(uniform ? hn::Set(d, values[points.material[i]]) : hn::GatherIndex(d, values, material), d,
                      out + i);
        };
        for (const auto& color : colors)
            for (int c = 0; c < 3; ++c) fill(color.row + c, (*color.value)[c]);
        for (int c = 0; c < 3 && points.any_transmission; ++c) fill(kTransmission + c, coefficients.transmission[c]);
        for (int c = 0; c < 3 && points.any_mirror; ++c) fill(kMirror + c, coefficients.mirror[c]);
        if (points.any_transmission || points.any_mirror) fill(kIor, coefficients.ior);
        fill(kShininess, coefficients.shininess);
        fill(kAlpha, coefficients.alpha);
    }
}

}  // namespace trp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trp {
HWY_EXPORT(add_ambient_lanes);
HWY_EXPORT(add_light_lanes);
HWY_EXPORT(gather_constants);

void add_ambient(const Points& points, const Coefficients& coefficients, const Vec3& ambient_light,
                 LaneVec3& radiance) {
    HWY_DYNAMIC_DISPATCH(add_ambient_lanes)(points, coefficients, ambient_light, radiance);
}

void add_light(Specular specular, const Points& points, const Coefficients& coefficients, const LaneVec3& weight,
               const LightSamples& samples, const LaneVec3& visibility, const LightSums& sums, uint32_t group) {
    LaneVec3* const of_group =
        sums.groups && group >= 1 && group <= kLightGroups ? &sums.groups->of[group - 1] : nullptr;
    HWY_DYNAMIC_DISPATCH(add_light_lanes)
    (specular, points, coefficients, weight, samples, visibility, sums, of_group);
}

namespace {

void darken(Coefficients& c, int lane) {
    for (LaneVec3* term : {&c.emission, &c.ambient, &c.diffuse, &c.specular, &c.mirror}) term->set(lane, {0, 0, 0});
}

}  // namespace

void evaluate(const Snapshot& snapshot, Points& points, Coefficients& coefficients, ProgramScratch& scratch,
              const uint8_t* light) {
    HWY_DYNAMIC_DISPATCH(gather_constants)
    (snapshot.material_rows.data(), snapshot.materials.size(), points, coefficients);
    if (points.any_program) {
        // Material by material, in the order in which they first appear.
        bool done[kBatch];
        for (int i = 0; i < kBatch; ++i)
            done[i] = points.slot[i] == kNoSlot || !(snapshot.material_flags[points.material[i]] & kHasProgram);
        int32_t lanes[kBatch] = {};
        for (int i = 0; i < kBatch; ++i) {
            if (done[i]) continue;
            int count = 0;
            for (int j = i; j < kBatch; ++j)
                if (!done[j] && points.material[j] == points.material[i]) {
                    lanes[count++] = j;
                    done[j] = true;
                }
            run_program(snapshot, snapshot.materials[points.material[i]], lanes, count, points, coefficients, scratch);
        }
    }
    if (points.any_holes)
        for (int i = 0; i < kBatch; ++i) {
            if (points.slot[i] == kNoSlot) continue;
            coefficients.alpha[i] = std::min(coefficients.alpha[i], 1.0f);
            if (!points.behind[i] || snapshot.materials[points.material[i]].double_sided) continue;
            if (light && light[i])
                darken(coefficients, i);
            else
                coefficients.alpha[i] = 0;
        }
}

}  // namespace trp
#endif
