# SPDX-License-Identifier: GPL-3.0-or-later
"""Matrices as the core takes them."""

import numpy as np


def rows(matrix):
    """The upper 3 × 4 of a mathutils.Matrix, float32, row-major."""
    return np.array(matrix, dtype=np.float32)[:3].copy()
