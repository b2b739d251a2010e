// The core's handles as C++ owners. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "error.h"

namespace triptych::cli {

struct DestroyScene {
    void operator()(TrpScene* scene) const { trp_scene_destroy(scene); }
};
struct DestroyRender {
    void operator()(TrpRender* render) const { trp_render_destroy(render); }
};
struct DestroyRadiosity {
    void operator()(TrpRadiosity* radiosity) const { trp_radiosity_destroy(radiosity); }
};
using SceneHandle = std::unique_ptr<TrpScene, DestroyScene>;
using RenderHandle = std::unique_ptr<TrpRender, DestroyRender>;
using RadiosityHandle = std::unique_ptr<TrpRadiosity, DestroyRadiosity>;

inline SceneHandle make_scene() {
    TrpScene* scene = nullptr;
    check(trp_scene_create(&scene));
    return SceneHandle(scene);
}

inline RenderHandle make_render(TrpScene* scene, const std::string& method) {
    TrpRender* render = nullptr;
    check(trp_render_create(scene, method.c_str(), &render));
    return RenderHandle(render);
}

}  // namespace triptych::cli
