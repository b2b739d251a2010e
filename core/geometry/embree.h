// The one place that knows which Embree is there: 3.13 (Debian 12) or 4. Packets of 16.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define TRP_EMBREE 4
#else
#include <embree3/rtcore.h>
#define TRP_EMBREE 3
#endif

#include <memory>
#include <type_traits>

namespace trp {

// What rays ask for, as bits of RTCRay::mask and of a geometry's mask.
enum RayMask : unsigned {
    kSeenByCamera = 1,
    kCastsShadow = 2,      // and is opaque everywhere
    kFiltersShadow = 4,    // casts shadows that its alpha makes lighter
    kTransmitsShadow = 8,  // casts shadows that its transmission may make lighter, as the settings say
};

// Coherent packets trace 3-4 times as fast where rays lie close together, but a hit may then depend on the other lanes
// at shared edges: they are for packets whose lanes are fixed to the film.
enum class Coherence { coherent, incoherent };

inline void intersect16(RTCScene scene, const int* valid, RTCRayHit16& rays, Coherence coherence) {
#if TRP_EMBREE == 4
    RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.flags = coherence == Coherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, &rays, &args);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, &context, &rays);
#endif
}

// A lane that is blocked comes back with tfar = −∞.
inline void occluded16(RTCScene scene, const int* valid, RTCRay16& rays, Coherence coherence) {
#if TRP_EMBREE == 4
    RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.flags = coherence == Coherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcOccluded16(valid, scene, &rays, &args);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcOccluded16(valid, scene, &context, &rays);
#endif
}

struct ReleaseEmbree {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseEmbree>;
using EmbreeGeometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, ReleaseEmbree>;

}  // namespace trp
