# SPDX-License-Identifier: GPL-3.0-or-later
"""A glass and a mirror sphere over a red and yellow checkerboard, after the picture in T. Whitted, "An Improved
Illumination Model for Shaded Display", Communications of the ACM 23(6), 1980.

The glass sphere is hollow, a bubble with a wall: its inner surface looks into the cavity, so that four boundaries lie
on the way through it. Both balls keep a little diffuse reflection, so that methods without recursion show their form.
"""

import common
import numpy as np
import pictures
import shapes

SQUARE = 1.0  # metres
SQUARES = (14, 24)  # across, away from the camera; even


def build():
    common.start("Whitted's Spheres", 960, 540)
    board = common.image("Checkerboard", pictures.checker((0.85, 0.60, 0.04), (0.60, 0.035, 0.02)))
    floor = common.principled("Checkerboard", (0.7, 0.3, 0.04), roughness=0.7, specular=0.15, texture=board)
    glass = common.principled("Glass", (0.80, 0.90, 0.96), roughness=0.18, transmission=0.85, ior=1.5)
    mirror = common.principled("Mirror", (0.90, 0.91, 0.93), roughness=0.18, metallic=0.8)

    x, y = SQUARES[0] * SQUARE / 2, SQUARES[1] * SQUARE
    low = -5.0
    corners = np.array([(-x, low, 0), (x, low, 0), (x, low + y, 0), (-x, low + y, 0)])
    plane = shapes.polygons(corners, [(0, 1, 2, 3)]).with_uv(lambda p: (p[:, :2] - [-x, low]) / (2 * SQUARE))
    common.mesh_object("Checkerboard", plane, floor)

    ball = shapes.sphere(36)
    bubble = shapes.joined(ball, ball.scaled(0.94).flipped())
    common.mesh_object("Glass Sphere", bubble.scaled(1.25), glass, smooth=True, location=(-0.75, -0.3, 2.0))
    common.mesh_object("Mirror Sphere", ball.scaled(1.25), mirror, smooth=True, location=(1.45, 2.3, 1.45))

    common.sun_light("Sun", (0.55, 0.75, -1.0), 2.6, (1.0, 0.97, 0.90), angle=1.0)
    common.area_light("Fill", (-5.0, -5.0, 5.0), (0, 1.5, 1.2), (3, 3), 260, (0.85, 0.92, 1.0))
    common.world((0.15, 0.32, 0.62))
    common.camera((-0.2, -7.6, 2.7), (0.3, 0.8, 1.55), lens=38)
