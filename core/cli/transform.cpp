// Transforms of nodes. SPDX-License-Identifier: Apache-2.0
#include "transform.h"

#include <ImathQuat.h>

namespace triptych::cli {

std::array<float, 12> rows_of(const Imath::M44d& matrix) {
    std::array<float, 12> rows;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            rows[static_cast<size_t>(4 * row + column)] = static_cast<float>(matrix[column][row]);
        }
    }
    return rows;
}

Imath::M44d z_up_from_y_up() {
    // The rows are the images of the axes.
    return {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
}

Imath::M44d transform_of(const Imath::V3d& translation, const double rotation[4], const Imath::V3d& scale) {
    Imath::Quatd quaternion(rotation[3], rotation[0], rotation[1], rotation[2]);
    quaternion.normalize();
    Imath::M44d matrix = quaternion.toMatrix44();
    for (int axis = 0; axis < 3; ++axis) {
        for (int column = 0; column < 3; ++column) matrix[axis][column] *= scale[axis];
        matrix[3][axis] = translation[axis];
    }
    return matrix;
}

Imath::M44d local_transform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) {
        Imath::M44d matrix;
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column)
                matrix[row][column] = node.matrix[static_cast<size_t>(4 * row + column)];
        }
        return matrix;
    }
    const auto vector_of = [](const std::vector<double>& values, double missing) {
        return values.size() == 3 ? Imath::V3d(values[0], values[1], values[2]) : Imath::V3d(missing);
    };
    static const double unturned[4] = {0, 0, 0, 1};
    return transform_of(vector_of(node.translation, 0.0), node.rotation.size() == 4 ? node.rotation.data() : unturned,
                        vector_of(node.scale, 1.0));
}

}  // namespace triptych::cli
