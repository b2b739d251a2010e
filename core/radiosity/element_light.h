// What elements are made of and what lamps give them: the material's colours averaged over each element, and the
// irradiance of all lights that are no elements themselves (lamps, the sun and the world).
#pragma once

#include <atomic>
#include <span>

#include "radiosity/elements.h"
#include "shading/lighting.h"

namespace trp {

struct ElementLight {
    Vec3 emission{0, 0, 0};                             // radiosity, W/m²: π times the radiance I_E
    Vec3 reflectance{0, 0, 0};                          // K_D, times alpha, below 1
    Vec3 irradiance{0, 0, 0};                           // of lamps, W/m²
    Vec3 irradiance_x{0, 0, 0}, irradiance_y{0, 0, 0};  // what it changes by per metre along the facet's PlaneAxes
    float unevenness = 0;  // the standard deviation of the irradiance from that over the element, as luminance
    float texture = 0;     // the standard deviation of the emission over the element, of the colour with the greatest
    float noise = 0;       // the standard deviation of the irradiance by chance, as luminance
    uint16_t lit = 0;      // the places that have an emission or light of lamps, a bit to each
    bool clamped = false;  // a reflectance of 1 or more was met
    bool dimmed = false;   // more than kGreatestLight was met
};

struct LightingJob {
    const Elements& elements;
    Illumination illumination;
    uint32_t seed = 0;
    std::atomic<bool>* cancelled = nullptr;
    std::atomic<uint64_t>* rays = nullptr;
    bool twice = true;  // pairs of samples of each light at each place, which say what of their differences is chance
};

inline constexpr float kGreatestReflectance = 0.999f;
inline constexpr float kGreatestLight = 1e12f;  // W/m², whose square is a number still

// Of the elements [first, first + out.size()). Runs in the current arena.
void light_elements(const LightingJob& job, uint32_t first, std::span<ElementLight> out);

}  // namespace trp
