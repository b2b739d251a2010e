// Rays from surfaces to the elements that they meet: against the scene's own polygons, whose hits are mapped to
// elements. What is not diffuse is not black: rays go on through holes and glass (straight, by K_T) and from mirrors,
// with what is left of their weight.
#pragma once

#include <memory>
#include <vector>

#include "radiosity/find_elements.h"
#include "radiosity/hemisphere_rays.h"
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

inline constexpr uint32_t kMostTurns = 16;

// One to a thread.
class ElementTracer {
  public:
    // `most_turns`: surfaces that a ray may pass. `eye`: rays are its own, which backs of one-sided surfaces let
    // through; to light they are black.
    explicit ElementTracer(const Elements& elements, uint32_t most_turns = kMostTurns, bool eye = false);
    // Appends to `hits`, in an order that depends on the rays alone; returns the number of rays traced. `rays` is used
    // up.
    uint64_t trace(std::vector<ElementRay>& rays, std::vector<ElementHit>& hits);
    // Rays number `first`, a multiple of kBatch, to `first` + `count` (at most kBatch of them) into a hemisphere: adds
    // each to the count of the element that it meets, or to one more that is for none; and to `others`, as above, what
    // those meet that may go on from where they meet something. Returns the number of rays traced.
    uint64_t trace(const HemisphereRays& from, uint32_t first, int count, uint32_t* counts,
                   std::vector<ElementHit>& others);

  private:
    struct Passed {
        Points points;
        Coefficients coefficients;
        ProgramScratch program;
    };
    bool meet(int first, int count);
    void hold(int i, int k);
    void batch(const ElementRay* rays, int count, std::vector<ElementHit>& hits);
    void go_on(const ElementRay* rays, int count, std::vector<ElementHit>& hits);

    const Elements& elements_;
    uint32_t most_turns_;
    bool eye_;
    RTCRayHit16 packet_;
    alignas(64) uint32_t met_[kBatch];  // by the batch's rays
    LaneVec3 origins_, directions_;
    bool any_held_ = false;
    std::unique_ptr<Passed> passed_;  // by the batch's rays; made when it is needed
    std::vector<ElementRay> more_;
};

}  // namespace trp
