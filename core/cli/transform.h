// Transforms. Imath multiplies row vectors from the left, so that a matrix of glTF, column by column, is Imath's matrix
// row by row, and world = local · parent. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ImathMatrix.h>

#include <array>

#include "tinygltf_model.h"

namespace triptych::cli {

// 3 rows of 4 floats, as the core has them.
std::array<float, 12> rows_of(const Imath::M44d& matrix);

// glTF's Y up to the core's Z up: (x, y, z) becomes (x, -z, y).
Imath::M44d z_up_from_y_up();

// parent_from_node, of its matrix or of its translation, rotation and scale.
Imath::M44d local_transform(const tinygltf::Node& node);

// Scale, then rotation (a quaternion x, y, z, w), then translation.
Imath::M44d transform_of(const Imath::V3d& translation, const double rotation[4], const Imath::V3d& scale);

}  // namespace triptych::cli
