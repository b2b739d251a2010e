// Rays from surfaces to the elements that they meet: against the scene's own polygons, whose hits are mapped to
// elements. What is not diffuse is not black: rays go on through holes and glass (straight, by K_T) and from mirrors,
// with what is left of their weight.
#pragma once

#include <vector>

#include "radiosity/elements.h"
#include "shading/equation.h"

namespace trp {

// Rays to be traced, and where they met something.
struct ElementRay {
    Vec3 origin, direction;  // unit
    uint32_t id = 0;         // the caller's
    Vec3 weight{1, 1, 1};
    uint32_t turns = 0;     // surfaces that it has passed
    bool mirrored = false;  // by one of them at least
};

// `element`: kNoElement where the ray left the scene, or met a surface's side that takes no part. A ray may meet
// several, or none of which it is known.
struct ElementHit {
    uint32_t id, element;
    Vec3 weight;
    bool left = false;       // the scene
    bool mirrored = false;   // the ray came by a mirror
    Vec3 position{0, 0, 0};  // where it did not
};

// Whether a surface that is cut into elements mirrors.
bool has_mirrors(const Elements& elements);

// One to a thread.
class ElementTracer {
  public:
    // `most_turns`: surfaces that a ray may pass.
    explicit ElementTracer(const Elements& elements, uint32_t most_turns = 16)
        : elements_(elements), most_turns_(most_turns) {}
    // Appends to `hits`, in an order that depends on the rays alone; returns the number of rays traced. `rays` is used
    // up.
    uint64_t trace(std::vector<ElementRay>& rays, std::vector<ElementHit>& hits);

  private:
    void batch(const ElementRay* rays, int count, std::vector<ElementRay>& more, std::vector<ElementHit>& hits);
    void go_on(const ElementRay* rays, int count, std::vector<ElementRay>& more, std::vector<ElementHit>& hits);

    const Elements& elements_;
    uint32_t most_turns_;
    Points points_;
    Coefficients coefficients_;
    ProgramScratch program_;
    std::vector<ElementRay> more_;
};

// Directions about a normal.
class Hemisphere {
  public:
    explicit Hemisphere(const Vec3& normal);
    // For numbers in [0, 1), with a density of cosine over π (Malley's method).
    Vec3 direction(float u, float v) const;

  private:
    Vec3 x_, y_, normal_;
};

// How far from a surface rays start, so that they do not meet it (as Points::offset).
inline float clearance(const Vec3& p) {
    return 0x1p-18f * std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), 1e-3f});
}

// Rays number `first` to `first` + `count` of an element's sequence (at most kBatch of them): from points of it, in
// directions that are uniform in the base circle of its hemisphere. Their ids are their places in `out`, which is
// cleared before.
void make_hemisphere_rays(const Elements& elements, uint32_t element, uint32_t key, uint32_t first, uint32_t count,
                          std::vector<ElementRay>& out);

}  // namespace trp
