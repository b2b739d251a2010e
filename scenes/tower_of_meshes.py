# SPDX-License-Identifier: GPL-3.0-or-later
"""A tower of one million triangles: 87 different meshes in tiers, for speed. 1920 × 1080 pixels.

Blobs, tori, knots, lathe work, shells and twisted prisms, each a smooth mesh of triangles with its own vertices: no
instances, no textures, one point light, a black world. Behind and below runs a curved backdrop.
"""

import common
import numpy as np
import shapes

TRIANGLES = 1_000_000
TIERS = ((17, 4.45, 1.18), (16, 4.25, 1.12), (15, 3.95, 1.06), (13, 3.45, 1.02), (11, 2.80, 0.98), (7, 1.90, 0.95),
         (4, 0.95, 0.90))  # (meshes on the ring, its radius, the tier's height)
CORES = ((3.6, 1.9, 0), (3.2, 1.6, 2), (2.2, 1.7, 4))  # (radius, height, tier) of the blobs within
PALETTE = ((0.70, 0.19, 0.10), (0.80, 0.45, 0.10), (0.82, 0.70, 0.42), (0.14, 0.36, 0.42), (0.07, 0.16, 0.32),
           (0.55, 0.60, 0.50), (0.74, 0.69, 0.62), (0.42, 0.10, 0.16))


def blob(random, count):
    """A sphere with a smooth random relief."""
    ball = shapes.sphere(max(4, round(np.sqrt(count / 20))))
    relief = shapes.waves(random.randint(1 << 30), 10, 2.0, random.uniform(4, 9))
    return ball.displaced(lambda p: p * (1 + random.uniform(0.12, 0.26) * relief(p))[:, None])


def spiked(random, count):
    """A sphere with rounded spikes in rows."""
    ball = shapes.sphere(max(4, round(np.sqrt(count / 20))))
    centres = shapes.icosahedron().vertices
    if random.rand() < 0.5:
        centres = shapes.sphere(2).vertices
    sharp = 40.0 if len(centres) > 12 else 14.0
    return ball.displaced(lambda p: p * (0.78 + 0.32 * np.exp(sharp * (p @ centres.T - 1)).sum(1))[:, None])


def torus(random, count):
    """A torus with waves along or around it."""
    sides = round(np.sqrt(count / 2 / 2.6))
    steps = round(count / 2 / sides)
    fat, lobes, twist = random.uniform(0.28, 0.40), random.randint(3, 9), random.randint(-4, 5)
    u, v = np.meshgrid(np.arange(steps) * 2 * np.pi / steps, np.arange(sides) * 2 * np.pi / sides, indexing="ij")
    tube = fat * (1 + 0.22 * np.cos(lobes * v + twist * u))
    ring = 1 - fat
    out = ring + tube * np.cos(v)
    points = np.stack([out * np.cos(u), out * np.sin(u), tube * np.sin(v)], -1)
    return shapes.surface(points, True, True).turned("x", random.uniform(20, 90))


def knot(random, count):
    p, q = [(2, 3), (3, 2), (2, 5), (3, 4), (3, 5), (5, 2)][random.randint(6)]
    sides = 22
    shape = shapes.torus_knot(p, q, 0.62, 0.27, random.uniform(0.11, 0.15), round(count / 2 / sides), sides)
    return shape.turned("x", random.uniform(0, 90))


def lathe(random, count):
    """A vase or finial with flutes."""
    segments = round(np.sqrt(count / 2 * 1.2))
    rows = round(count / 2 / segments)
    z = np.linspace(-1, 1, 7)
    radius = np.concatenate([[0.55], random.uniform(0.28, 0.95, 5), [0.3]])
    curve = shapes.spline(np.stack([radius, z], 1), rows - 8)
    cap = np.linspace(0, 1, 5)[:-1, None]
    profile = np.concatenate([cap * curve[0], curve, curve[-1] * (1 - np.linspace(0, 1, 5)[1:, None] * [1, 0])])
    profile[:4, 1] = curve[0, 1]
    flutes, depth, turn = random.randint(5, 17), random.uniform(0.02, 0.09), random.uniform(-1.5, 1.5)

    def fluted(p):
        around = np.arctan2(p[:, 1], p[:, 0]) + turn * p[:, 2]
        scale = 1 + depth * np.cos(flutes * around)
        return p * np.stack([scale, scale, np.ones_like(scale)], 1)

    return shapes.lathe(profile, segments).displaced(fluted)


def shell(random, count):
    """A spiral horn whose radius grows as it winds."""
    sides = round(np.sqrt(count / 2 / 6))
    steps = round(count / 2 / sides)
    t = np.linspace(0, 1, steps)
    growth = np.exp(2.4 * (t - 1))
    turns = random.uniform(2.4, 3.4) * 2 * np.pi * t
    path = np.stack([0.62 * growth * np.cos(turns), 0.62 * growth * np.sin(turns), 1.3 * (1 - growth) - 0.55], 1)
    ribs = 1 + 0.07 * np.cos(2 * np.pi * random.randint(24, 44) * t)
    return shapes.tube(path, 0.40 * growth * ribs, sides).turned("x", random.uniform(-60, 60))


def prism(random, count):
    """A twisted, rounded bar with a star for its section."""
    sides = round(np.sqrt(count / 2 * 1.3))
    rows = round(count / 2 / sides)
    points_of_star, depth, turn = random.randint(3, 7), random.uniform(0.12, 0.3), random.uniform(-2.2, 2.2)
    v = np.linspace(-1, 1, rows)
    profile = np.stack([0.78 * (1 - v**8) ** 0.5, v], 1)
    profile[[0, -1], 0] = 0

    def star(p):
        around = np.arctan2(p[:, 1], p[:, 0])
        scale = 1 + depth * np.cos(points_of_star * (around - turn * p[:, 2]))
        return p * np.stack([scale, scale, np.ones_like(scale)], 1)

    return shapes.lathe(profile, sides).displaced(star)


def lobed(random, count):
    """A supershape: lobes along longitude and latitude."""
    ball = shapes.sphere(max(4, round(np.sqrt(count / 20))))
    m, n, a = random.randint(3, 8), random.randint(2, 6), random.uniform(0.14, 0.28)

    def grown(p):
        around, up = np.arctan2(p[:, 1], p[:, 0]), np.arcsin(np.clip(p[:, 2], -1, 1))
        return p * (0.8 + a * np.cos(m * around) * np.cos(up) ** 2 + 0.6 * a * np.cos(2 * n * up) * np.cos(up))[:, None]

    return ball.displaced(grown)


KINDS = (blob, torus, lathe, knot, spiked, prism, shell, lobed)


def fitted(shape, width, height):
    """The shape's bounding box centred over the origin, standing on z = 0, scaled alike to fit."""
    low, high = shape.vertices.min(0), shape.vertices.max(0)
    size = high - low
    scale = min(width / max(size[0], size[1]), height / size[2])
    return shape.moved(-(low + high) / 2 * [1, 1, 0] - [0, 0, low[2]]).scaled(scale)


def build():
    common.start("Tower of Meshes", 1920, 1080)
    random = np.random.RandomState(1)
    colours = [common.principled(f"Colour {k + 1}", color, roughness=0.38) for k, color in enumerate(PALETTE)]
    each = TRIANGLES / (sum(count for count, _, _ in TIERS) + len(CORES) + 1)
    number = 0

    def place(shape, position, turn, color):
        nonlocal number
        number += 1
        shape = shape.turned("z", turn).triangulated().without_uv()
        common.mesh_object(f"Mesh {number:02d}", shape, colours[color], smooth=True, location=position)

    level = 0.0
    levels = []
    for tier, (count, radius, height) in enumerate(TIERS):
        levels.append(level)
        width = 2 * np.pi * radius / count * 1.2
        for k in range(count):
            angle = 2 * np.pi * (k + 0.5 * (tier % 2)) / count + 0.11 * tier
            kind = KINDS[(k * 3 + tier * 5 + random.randint(3)) % len(KINDS)]
            shape = fitted(kind(random, each), width, height * 1.16)
            position = (radius * np.cos(angle), radius * np.sin(angle), level)
            place(shape, position, random.uniform(0, 360), (k * 5 + tier * 3 + random.randint(2)) % len(colours))
        level += height * 0.93
    for radius, height, tier in CORES:
        core = fitted(blob(random, each), 2 * radius, 9.0).scaled((1, 1, 1))
        low, high = core.vertices.min(0), core.vertices.max(0)
        core = core.scaled((1, 1, (levels[tier + 1] + height - levels[tier]) / (high - low)[2]))
        place(core, (0, 0, levels[tier] - 0.05), 0, 4)
    place(fitted(knot(random, each), 1.1, 0.95), (0, 0, level - 0.02), 30, 1)

    backdrop()
    common.point_light("Lamp", (-4.0, -17.5, 8.5), 14500, (1.0, 0.95, 0.88))
    common.world((0, 0, 0))
    common.camera((0.0, -20.5, 2.4), (0.05, 0.0, 3.62), lens=52.5)


def backdrop():
    """Floor and wall in one sheet with a quarter round between."""
    radius, back, half = 5.0, 9.0, 26.0
    angle = np.linspace(0, np.pi / 2, 17)
    profile = np.concatenate([[(-30.0, 0)], np.stack([back - radius + radius * np.sin(angle),
                                                      radius - radius * np.cos(angle)], 1), [(back, 22.0)]])
    x = np.linspace(-half, half, 2)
    points = np.stack([np.column_stack([np.full(len(profile), end), profile]) for end in x])
    sheet = shapes.surface(points).triangulated().without_uv()
    common.mesh_object("Backdrop", sheet, common.principled("Backdrop", (0.30, 0.33, 0.36), roughness=0.9), smooth=True)
