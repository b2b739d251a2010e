// What a file without a camera or a light is rendered with. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf_scene.h"

namespace triptych::cli {

// Adds a camera that has the whole scene in a film of this shape, and a headlight along the camera, where the file has
// none, and commits them.
void complete_scene(LoadedScene& loaded, uint32_t film_width, uint32_t film_height, uint32_t threads);

}  // namespace triptych::cli
