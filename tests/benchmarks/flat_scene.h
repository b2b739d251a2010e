// The peer's scene: the same triangles in one Embree scene without instances, of medium build quality and robust, as a
// program that never edits would build it.
#pragma once

#include "scene_spy.h"

namespace trp_bench {

class FlatScene {
  public:
    // Builds at once, on `threads` threads. `meshes` stays where it is while the scene is used.
    FlatScene(const FlatMeshes& meshes, unsigned threads);

    RTCScene embree() const { return scene_.get(); }
    double build_seconds() const { return build_seconds_; }  // from the first geometry to the end of the commit

  private:
    trp::EmbreeScene scene_;
    double build_seconds_ = 0;
};

}  // namespace trp_bench
