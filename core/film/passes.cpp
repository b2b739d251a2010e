#include "film/passes.h"

#include <cstring>

#include "base/error.h"

namespace trp {
namespace {

bool gives(const std::string& method, const Pass& pass) {
    const std::string names = fmt::format(" {} ", pass.methods);
    return names == " * " || names.find(fmt::format(" {} ", method)) != std::string::npos;
}

}  // namespace

const Pass kPasses[kPassCount] = {
    {"Combined", "RGBA", "The picture: radiance in W/(m² sr) and coverage, colour premultiplied by it", "*", true},
    {"Depth", "Z", "Distance from the camera along its axis in metres; 1e10 where nothing is seen", "*", false},
    {"Position", "XYZ", "World position in metres", "*", false},
    {"Normal", "XYZ", "World-space shading normal, on the side that is seen", kSeeingMethods, true},
    {"UV", "UVA", "Texture coordinates of the first UV set, and 1 where a surface is seen", kSeeingMethods, false},
    {"Albedo", "RGB", "Diffuse reflectance K_D", kSeeingMethods, true},
    {"Emission", "RGB", "Radiance I_E that is seen of surfaces that emit it, and of area lights, in W/(m² sr)",
     kSeeingMethods, true},
    {"IndexOB", "X", "The object's index", "*", false},
    {"IndexMA", "X", "The material's index", "*", false},
    {"Shadow", "RGB", "The share of the light of all lamps that reaches the surface; 1 where nothing is seen",
     kSurfaceMethods, true},
    {"SampleCount", "X", "Samples taken in the pixel", "*", false},
    {"Ambient", "RGB", "The part of the picture that is ambient light, K_A I_A, in W/(m² sr)", kRayMethods, true},
    {"DiffuseDirect", "RGB", "The part that lights give surfaces that are seen, by K_D, in W/(m² sr)", kRayMethods,
     true},
    {"SpecularDirect", "RGB", "The part that is the highlights of lights, K_S, in W/(m² sr)", kRayMethods, true},
    {"DiffuseIndirect", "RGB", "The part that other surfaces give those that are seen, by K_D, in W/(m² sr)",
     "path_tracing", true},
    {"Reflection", "RGB", "The part that is seen in mirrors and by gloss, in W/(m² sr)", kTreeMethods, true},
    {"Transmission", "RGB", "The part that is seen through surfaces, by K_T, in W/(m² sr)", kTreeMethods, true},
    {"Environment", "RGB", "The part that is the world, seen by the camera, in W/(m² sr)", kRayMethods, true},
    {"LightGroup1", "RGB", "The part of the picture that lamps of light group 1 give, in W/(m² sr)", kRayMethods, true},
    {"LightGroup2", "RGB", "The part of the picture that lamps of light group 2 give, in W/(m² sr)", kRayMethods, true},
    {"LightGroup3", "RGB", "The part of the picture that lamps of light group 3 give, in W/(m² sr)", kRayMethods, true},
    {"LightGroup4", "RGB", "The part of the picture that lamps of light group 4 give, in W/(m² sr)", kRayMethods, true},
    {"LightGroup5", "RGB", "The part of the picture that lamps of light group 5 give, in W/(m² sr)", kRayMethods, true},
    {"LightGroup6", "RGB", "The part of the picture that lamps of light group 6 give, in W/(m² sr)", kRayMethods, true},
    {"LightGroup7", "RGB", "The part of the picture that lamps of light group 7 give, in W/(m² sr)", kRayMethods, true},
    {"LightGroup8", "RGB", "The part of the picture that lamps of light group 8 give, in W/(m² sr)", kRayMethods, true},
    {"RayCount", "X", "Rays traced for the pixel, without those of shadows", kRayMethods, false},
    {"TreeDepth", "X", "The greatest number of reflections and transmissions in a row along the pixel's rays",
     kTreeMethods, false},
};

uint32_t channel_count(PassId pass) {
    return static_cast<uint32_t>(std::strlen(kPasses[pass].channels));
}

PassId find_pass(const std::string& name, const std::string& method) {
    for (uint32_t p = 0; p < kPassCount; ++p)
        if (name == kPasses[p].name && gives(method, kPasses[p])) return static_cast<PassId>(p);
    std::string known;
    for (const Pass& pass : kPasses)
        if (gives(method, pass)) known += std::string(known.empty() ? "" : ", ") + pass.name;
    fail(TRP_ERROR_ARGUMENT, "{} has no pass \"{}\"; its passes are {}", method, name, known);
}

}  // namespace trp
