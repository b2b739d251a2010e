// The table of passes: one row each, from which the ABI, the film and the files are made.
#pragma once

#include <cstdint>
#include <string>

#include "shading/equation.h"

namespace trp {

// Methods, for the tables of passes and settings: that see surfaces (the others draw edges); of those, that trace rays;
// and of those, that follow reflections.
inline constexpr char kSurfaceMethods[] = "visible_surface flat gouraud phong ray_casting ray_tracing path_tracing";
inline constexpr char kRayMethods[] = "ray_casting ray_tracing path_tracing";
inline constexpr char kTreeMethods[] = "ray_tracing path_tracing";

// And those that see them by a solution found before.
inline constexpr char kSeeingMethods[] =
    "visible_surface flat gouraud phong ray_casting ray_tracing path_tracing radiosity";

enum PassId : uint32_t {
    kCombined,
    kDepth,
    kPosition,
    kNormal,
    kUv,
    kAlbedo,
    kEmit,
    kObjectIndex,
    kMaterialIndex,
    kShadow,
    kSampleCount,
    // Parts of the picture, which add up to it.
    kAmbientPart,
    kDiffuseDirect,
    kSpecularDirect,
    kDiffuseIndirect,
    kReflectionPart,
    kTransmissionPart,
    kEnvironment,
    // And by light groups, the first of kLightGroups.
    kLightGroup1,
    kLastLightGroup = kLightGroup1 + kLightGroups - 1,
    kRayCount,
    kTreeDepth,
    kPassCount
};

struct Pass {
    const char* name;
    const char* channels;
    const char* description;
    const char* methods;  // that give it, with a space between; "*": all
    bool averaged;        // over the samples of a pixel; else as it is: the first sample's value, or a count
};

extern const Pass kPasses[kPassCount];

uint32_t channel_count(PassId pass);
// Throws Error where the method has no such pass.
PassId find_pass(const std::string& name, const std::string& method);

}  // namespace trp
