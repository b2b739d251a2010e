# SPDX-License-Identifier: GPL-3.0-or-later
"""The still life: Triptych's signature picture, and the subject of its progression from wireframe to reflection.

A table by a window: what is curved (jug, vase, bowl, fruit), faceted (Dürer's solid, an icosahedron), metal (copper,
silver), glass, textured (wood, linen, painted bowl, books) and bumpy (orange and lemon skin), lit by a large soft light
from the left, a weak fill, a light from behind and a dim room. The table's top is z = 0. 960 × 540 pixels.
"""

import common
import numpy as np
import pictures
import shapes

TABLE_FRONT, TABLE_BACK, TABLE_HALF_WIDTH, TABLE_THICKNESS = -0.36, 0.50, 0.95, 0.04
CLOTH_LIFT = 0.0025  # the runner's height above the table
SUN_DIRECTION = (0.55, 0.80, -0.125)  # the way its light goes


def build():
    common.start("Still Life", 960, 540)
    room()
    runner()
    books(-0.385, 0.02)
    durer_solid((-0.395, 0.03, 0.0685))
    vase((-0.225, 0.20, 0))
    jug((0.235, 0.165, 0))
    fruit_bowl((0.005, 0.02, CLOTH_LIFT))
    goblet((0.415, -0.02, 0))
    silver_ball((-0.185, -0.125, 0))
    amethyst((-0.065, -0.205, CLOTH_LIFT))
    oranges([((0.275, -0.085, CLOTH_LIFT + 0.036), (20, -25, 0), 0.95), ((-0.041, 0.038, 0.070), (15, -20, 0), 1.02),
             ((0.045, 0.054, 0.069), (-24, 28, 40), 0.98)])
    lemons([((0.165, -0.175, CLOTH_LIFT + 0.029), (0, 4, 28), 1.0), ((0.019, -0.020, 0.077), (8, 22, -18), 1.02)])
    lights()
    common.camera((0.03, -1.80, 0.46), (0.015, 0.05, 0.135), lens=61)


def lights():
    common.area_light("Key", (-1.20, -0.70, 0.95), (0, 0.02, 0.08), (0.60, 0.75), 24, (1.0, 0.93, 0.83))
    common.area_light("Fill", (1.35, -1.35, 0.75), (0, 0, 0.1), (1.0, 1.0), 4.5, (0.72, 0.84, 1.0))
    common.area_light("Rim", (0.75, 0.50, 0.75), (0.05, 0.02, 0.12), (0.35, 0.25), 3.5, (1.0, 0.86, 0.68))
    sky = common.image("Dim Room", pictures.studio_sky(512, 256))
    common.world(picture=sky, strength=0.3)
    common.sun_light("Sun", SUN_DIRECTION, 3.0, (1.0, 0.74, 0.46), angle=0.45)
    window((0.30, 0.80, 0.235))


def window(target):
    """A wall behind the viewer with six panes in it, through which the low sun falls on the `target`."""
    forward = shapes.unit(np.array(SUN_DIRECTION))
    right = shapes.unit(np.cross(forward, [0, 0, 1]))
    frame = np.stack([right, np.cross(right, forward), forward], 1)
    xs, ys, air = [-2.8], [-2.2], np.zeros((7, 9), bool)
    for k in range(3):
        xs += [-0.43 + 0.30 * k, -0.43 + 0.30 * k + 0.26]
    for k in range(4):
        ys += [-0.47 + 0.24 * k, -0.47 + 0.24 * k + 0.21]
    xs, ys = np.array(xs + [2.2]), np.array(ys + [2.6])
    air[1::2, 1::2] = True
    # Each solid cell is one face; the wall is thin and casts its shadow from either side.
    faces, columns = [], len(ys)
    for i, j in np.argwhere(~air):
        faces.append((i * columns + j, (i + 1) * columns + j, (i + 1) * columns + j + 1, i * columns + j + 1))
    x, y = np.meshgrid(xs, ys, indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), np.full(x.size, -4.0)], 1) @ frame.T + target
    common.mesh_object("Window", shapes.polygons(points, faces), common.diffuse("Window Wall", (0.30, 0.26, 0.22)))


def room():
    wall = common.principled("Wall", (0.12, 0.18, 0.20), roughness=0.9, specular=0.1,
                             texture=common.image("Wall", pictures.plaster(3, 256, (0.125, 0.185, 0.205), 0.07)))
    x, z = np.meshgrid(np.linspace(-2.4, 2.4, 49), np.linspace(-0.9, 1.5, 25), indexing="ij")
    sheet = shapes.surface(np.stack([x, np.full_like(x, 0.80), z], -1)).with_uv(lambda p: p[:, [0, 2]] / 2.4)
    common.mesh_object("Wall", sheet, wall)

    grain = pictures.wood(11, 768, 384, 5, (0.075, 0.030, 0.012), (0.36, 0.18, 0.075))
    oak = common.principled("Table", (0.22, 0.11, 0.05), roughness=0.34, specular=0.4,
                            texture=common.image("Table", grain))
    depth = TABLE_BACK - TABLE_FRONT
    top = shapes.rounded_box((2 * TABLE_HALF_WIDTH, depth, TABLE_THICKNESS), 0.007, 2, (32, 15, 1))
    top = top.moved((0, (TABLE_FRONT + TABLE_BACK) / 2, -TABLE_THICKNESS))
    top = top.with_uv(lambda p: np.stack([p[:, 0] / 1.9 + 0.5, (p[:, 1] + p[:, 2] - TABLE_FRONT) / depth], 1))
    common.mesh_object("Table", top, oak, smooth=True)
    apron = shapes.box((2 * TABLE_HALF_WIDTH - 0.1, 0.02, 0.11), bottom=True).moved((0, TABLE_FRONT + 0.05, -0.152))
    apron = apron.with_uv(lambda p: np.stack([p[:, 0] / 1.9 + 0.21, (p[:, 2] + p[:, 1]) / depth], 1))
    common.mesh_object("Apron", apron, oak)


def runner():
    """A linen runner across the table that hangs over its front edge."""
    width, bend = 0.62, 0.011
    along = np.concatenate([np.linspace(0, 0.70, 47), np.linspace(0.70, 0.75, 11)[1:], np.linspace(0.75, 1.1, 18)[1:]])
    across = np.linspace(0, 1, 69)
    s, t = np.meshgrid(along, across, indexing="ij")
    x = -0.215 + width * t + 0.10 * (0.70 - s)
    x = x + 0.006 * np.sin(11 * s + 2.5 * t) + 0.003 * np.sin(23 * s + 4 * t)
    # The path of the cloth: flat, a quarter turn about the table's edge, straight down.
    flat = TABLE_BACK - 0.135 - TABLE_FRONT
    turn = np.clip((s - flat) / (bend + 0.007), 0, np.pi / 2)
    radius = bend + 0.007
    down = np.maximum(s - flat - radius * np.pi / 2, 0)
    y = TABLE_BACK - 0.135 - np.minimum(s, flat) - radius * np.sin(turn)
    z = CLOTH_LIFT - radius * (1 - np.cos(turn)) - down
    # Folds: narrow pleats that open where the cloth hangs, low ripples where it lies, none under what stands on it.
    pleat = np.sin(2 * np.pi * (3.1 * t + 0.35 * np.sin(4.2 * t + 0.6)) + 1.4 * (s - 0.7))
    pleat = pleat + 0.35 * np.sin(2 * np.pi * 6.7 * t + 1.0 + 2 * s)
    hang = 0.020 * shapes.smoothstep(0, 0.22, down) * (pleat + 0.6)
    free = np.ones_like(s)
    for cx, cy, r in ((0.005, 0.02, 0.085), (0.165, -0.175, 0.05), (-0.065, -0.205, 0.045), (0.235, 0.165, 0.09)):
        free *= shapes.smoothstep(r, r + 0.07, np.hypot(x - cx, y - cy))
    skew = np.stack([x + 0.6 * y, 0.55 * y - 0.2 * x, np.zeros_like(x)], -1)
    ripple = shapes.waves(8, 16, 20, 62)(skew.reshape(-1, 3)).reshape(x.shape)
    lie = 0.0105 * np.maximum(ripple + 0.05, 0) ** 1.3 * free * shapes.smoothstep(0.02, 0.14, s)
    points = np.stack([x, y - (hang + lie) * np.sin(turn), z + lie * np.cos(turn)], -1)
    cloth = shapes.surface(points)
    picture = common.image("Linen", pictures.linen(384, 384, (0.66, 0.60, 0.49), (0.10, 0.19, 0.30)))
    cloth = cloth.flipped()  # looks up
    common.mesh_object("Runner", cloth, common.principled("Linen", (0.66, 0.60, 0.49), roughness=0.9, specular=0.1,
                                                          texture=picture), smooth=True)


def books(x, y):
    gold, cut = (0.62, 0.40, 0.12), common.image("Pages", pictures.pages(5, 64, 128))
    paper = common.principled("Pages", (0.7, 0.6, 0.45), roughness=0.9, specular=0.1, texture=cut)
    for name, size, degrees, height, leather in (
        ("Lower Book", (0.250, 0.185, 0.040), 10, 0.0, (0.245, 0.026, 0.022)),
        ("Upper Book", (0.215, 0.155, 0.028), -7, 0.0402, (0.022, 0.055, 0.075)),
    ):
        cover = common.principled(f"{name} Leather", leather, roughness=0.42, specular=0.45, texture=common.image(
            f"{name} Leather", pictures.book_cover(256, 64, leather, gold)))
        long, deep, thick = size
        board = 0.003
        parts = []
        for z in (0, thick - board):
            lid = shapes.rounded_box((long, deep, board), 0.0012, 1).moved((0, 0, z))
            parts.append(lid.with_uv(lambda p: np.stack([np.full(len(p), 0.04), np.full(len(p), 0.5)], 1)))
        # The spine: a half round shell along the front, its cross-section swept along x.
        angle = np.linspace(-np.pi / 2, np.pi / 2, 15)
        half, swell = thick / 2 - 0.0005, 0.011
        outer = np.stack([-deep / 2 + 0.004 - swell * np.cos(angle), half + half * np.sin(angle)], 1)
        inner = np.stack([-deep / 2 + 0.0065 - (swell - 0.002) * np.cos(angle),
                          half + (half - 0.002) * np.sin(angle)], 1)
        ring = np.concatenate([outer, inner[::-1]])
        ends = np.linspace(-long / 2, long / 2, 2)
        sheet = np.stack([np.stack([np.full(len(ring), e), ring[:, 0], ring[:, 1] + 0.0005], 1) for e in ends], 0)
        spine = shapes.surface(sheet, close_v=True)
        count = len(angle)
        caps = []
        for k in range(count - 1):
            a, b, c, d = k, k + 1, 2 * count - 2 - k, 2 * count - 1 - k
            caps += [(a, b, c, d)]
        caps = shapes.polygons(sheet[0], caps), shapes.polygons(sheet[1], caps).flipped()
        spine = shapes.welded(shapes.joined(spine, *caps).without_uv(), 8)
        spine = spine.with_uv(lambda p, long=long: np.stack([p[:, 0] / long + 0.5, p[:, 2] / 0.05], 1))
        body = shapes.joined(*parts, spine).turned("z", degrees).moved((x, y, height))
        common.mesh_object(name, body, cover, smooth=True, sharp_angle=40)
        block = shapes.box((long - 0.010, deep - 0.008, thick - 2 * board - 0.0004)).moved((0, -0.002, board + 0.0002))
        block = block.with_uv(lambda p, thick=thick: np.stack([(p[:, 0] + p[:, 1]) * 4, p[:, 2] / thick], 1))
        common.mesh_object(f"{name} Pages", block.turned("z", degrees).moved((x, y, height)), paper)


def durer_solid(location):
    """The solid of Dürer's Melencolia I: a rhombohedron of 72° cut at both ends so that a sphere passes through all
    its corners, on its lower triangle."""
    height = np.sqrt(0.809017 / 0.690983)  # of an edge of unit radius: (h² − ½)/(h² + 1) = cos 72°
    turn = np.radians([0, 120, 240])
    a = np.stack([np.cos(turn), np.sin(turn), np.full(3, height)], 1)
    b = np.array([a[0] + a[1], a[1] + a[2], a[2] + a[0]])
    top = a.sum(0)
    cut = 0.618034
    vertices = np.concatenate([cut * a, a, b, top - cut * a])  # top − cut·a: on the edges at the upper end
    faces = [(2, 1, 0), (9, 10, 11)]
    for k in range(3):
        following = (k + 1) % 3
        faces.append((k, following, 3 + following, 6 + k, 3 + k))
        # The upper rhombus about a[following], between b[k] and b[following].
        before, after = 9 + (k + 2) % 3, 9 + k
        faces.append((3 + following, 6 + following, after, before, 6 + k))
    solid = shapes.polygons(vertices, faces)
    solid = solid.moved((0, 0, -cut * height)).scaled(0.050).turned("z", -8).moved(location)
    common.mesh_object("Dürer's Solid", solid, common.principled("Alabaster", (0.70, 0.63, 0.53), roughness=0.38))


def vase(location):
    """A celadon vase with sprigs of eucalyptus."""
    outer = shapes.spline([(0.046, 0.004), (0.072, 0.045), (0.087, 0.105), (0.074, 0.165), (0.038, 0.212),
                           (0.028, 0.245), (0.033, 0.272), (0.042, 0.285)], 36)
    inner = shapes.spline([(0.0385, 0.2862), (0.029, 0.272), (0.0245, 0.245), (0.034, 0.210), (0.069, 0.163),
                           (0.082, 0.105), (0.067, 0.047), (0.040, 0.012)], 18)
    rim = [(0.0412, 0.2868), (0.0397, 0.2871)]
    profile = 0.8 * np.concatenate([[(0, 0), (0.043, 0), (0.0455, 0.0012)], outer, rim, inner, [(0, 0.010)]])
    body = shapes.lathe(profile, 56).without_uv()
    glaze = common.principled("Celadon", (0.36, 0.52, 0.44), roughness=0.20, specular=0.6)
    common.mesh_object("Vase", body, glaze, smooth=True, location=location)

    random = np.random.RandomState(4)
    stems, leaves = [], []
    tips = [(-0.160, 0.02, 0.345), (-0.085, 0.05, 0.412), (0.035, -0.02, 0.425), (0.125, 0.05, 0.385),
            (0.195, -0.03, 0.315), (-0.185, -0.05, 0.262)]
    for tip in tips:
        tip = np.array(tip)
        lip = 0.017 * shapes.unit(tip * [1, 1, 0])
        path = shapes.spline([lip * -0.7 + [0, 0, 0.12], lip + [0, 0, 0.228], 0.42 * tip + [0, 0, 0.185], tip], 25)
        stems.append(shapes.tube(path, np.linspace(0.0022, 0.0009, len(path)), 7))
        length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
        start = length[np.argmax(path[:, 2] > 0.236)]
        across, upward = shapes.frames(path)
        spin = random.uniform(0, 6.28)
        for k, at in enumerate(np.arange(start + 0.012, length[-1], 0.0195)):
            share = (at - start) / (length[-1] - start)
            size = 0.0300 * (1 - 0.62 * share) * random.uniform(0.85, 1.12)
            index = min(int(np.searchsorted(length, at)), len(path) - 1)
            point = np.array([np.interp(at, length, path[:, axis]) for axis in range(3)])
            along = shapes.unit(path[index] - path[index - 1])
            for side in (0, np.pi):
                angle = spin + k * 1.45 + side + random.uniform(-0.25, 0.25)
                out = np.cos(angle) * across[index] + np.sin(angle) * upward[index]
                leaves.append(leaf(point, along, out, size, random))
        leaves.append(leaf(path[-1], shapes.unit(path[-1] - path[-2]), across[-1], 0.016, random, straight=True))
    stem = common.principled("Stem", (0.20, 0.13, 0.07), roughness=0.6)
    common.mesh_object("Stems", shapes.joined(*stems).without_uv(), stem, smooth=True, sharp_angle=60,
                       location=location)
    green = common.principled("Leaf", (0.20, 0.33, 0.255), roughness=0.5, specular=0.35)
    common.mesh_object("Leaves", shapes.joined(*leaves).without_uv(), green, smooth=True, location=location)


def leaf(point, along, out, size, random, straight=False):
    """A round leaf, slightly cupped, from `point` outward."""
    lean = 0.15 if straight else random.uniform(0.8, 1.15)
    axis = shapes.unit(np.cos(lean) * along + np.sin(lean) * out)
    side = shapes.unit(np.cross(along, out) + random.normal(size=3) * 0.22)
    side = shapes.unit(side - axis * (side @ axis))
    normal = np.cross(side, axis)
    s = np.linspace(0, 1, 8)
    wide = 0.47 * np.sin(np.pi * s**0.85) ** 0.62
    wide[[0, -1]] = 0
    t = np.linspace(-1, 1, 5)
    cup = 0.16 * (t[None] * wide[:, None]) ** 2 * 4 * 0.5 - 0.14 * (s[:, None] ** 2) + 0 * t
    points = point + size * (axis * s[:, None, None] + side * (t[None, :, None] * wide[:, None, None])
                             + normal * cup[..., None])
    return shapes.welded(shapes.surface(points), 9)


def jug(location):
    """A copper jug with a lip and a handle."""
    outer = shapes.spline([(0.066, 0.003), (0.090, 0.035), (0.108, 0.088), (0.098, 0.140), (0.066, 0.188),
                           (0.052, 0.218), (0.056, 0.248), (0.070, 0.272)], 42)
    inner = shapes.spline([(0.0672, 0.2722), (0.0535, 0.248), (0.0493, 0.218), (0.063, 0.188), (0.095, 0.140),
                           (0.105, 0.088), (0.087, 0.036), (0.060, 0.006)], 20)
    profile = np.concatenate([[(0, 0), (0.061, 0), (0.0645, 0.001)], outer, [(0.0698, 0.2738), (0.0680, 0.2738)], inner,
                              [(0, 0.0055)]])
    spout = np.radians(200)

    def pulled(points):
        """Draws the rim out to a lip and lifts it."""
        around = np.arctan2(points[:, 1], points[:, 0])
        near = np.cos((around - spout + np.pi) % (2 * np.pi) - np.pi)
        pull = np.exp(-((1 - near) / 0.16)) * shapes.smoothstep(0.196, 0.275, points[:, 2])
        pinch = np.exp(-(((1 - near) - 0.45) / 0.25) ** 2) * shapes.smoothstep(0.20, 0.275, points[:, 2])
        out = np.stack([np.cos(spout), np.sin(spout), 0.0 * spout])
        radial = points * [1, 1, 0]
        moved = points + 0.036 * pull[:, None] * out - 0.07 * pinch[:, None] * radial
        moved[:, 2] += 0.012 * pull
        return moved

    body = shapes.lathe(profile, 80).without_uv().displaced(pulled)
    path = shapes.spline([(0.060, 0.252), (0.085, 0.263), (0.128, 0.252), (0.152, 0.208), (0.146, 0.150),
                          (0.120, 0.108), (0.100, 0.092)], 32)
    path = np.stack([path[:, 0], np.zeros(len(path)), path[:, 1]], 1)
    ring = np.arange(14) * (2 * np.pi / 14)
    section = np.stack([1.55 * np.cos(ring), 0.72 * np.sin(ring)], 1)
    first = shapes.frames(path)[0][0]
    if abs(first[1]) < 0.5:  # the long side of the section lies across the handle
        section = section[:, ::-1] * [1, -1]
    swell = 0.0076 * (1 + 0.35 * np.cos(np.linspace(0, 2 * np.pi, len(path))))
    handle = shapes.tube(path, swell, 14, section=section).without_uv().turned("z", -22)
    copper = common.principled("Copper", (0.90, 0.42, 0.23), roughness=0.26, metallic=0.62)
    common.mesh_object("Jug", shapes.joined(body, handle), copper, smooth=True, location=location)


def fruit_bowl(location):
    """A painted bowl; fruit lies in it."""
    outer = shapes.spline([(0.052, 0.010), (0.075, 0.016), (0.108, 0.037), (0.131, 0.066), (0.139, 0.086)], 20)
    inner = shapes.spline([(0.1345, 0.0862), (0.1265, 0.067), (0.104, 0.041), (0.072, 0.0215), (0.035, 0.015)], 16)
    foot = [(0, 0.004), (0.042, 0.004), (0.0455, 0.0), (0.0515, 0.0), (0.0525, 0.0015)]
    rim = [(0.1385, 0.0876), (0.1365, 0.0882), (0.1350, 0.0876)]
    profile = np.concatenate([foot, outer, rim, inner, [(0, 0.0145)]])
    body = shapes.lathe(profile, 80)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(profile, axis=0), axis=1))])
    length /= length[-1]
    lip = len(foot) + len(outer)
    body.uv[:, 1] = np.interp(body.uv[:, 1], [0, length[len(foot)], length[lip], 1], [0, 0.09, 0.53, 1])
    painted = pictures.glazed_bands(1024, 512, (0.72, 0.68, 0.58), (0.018, 0.065, 0.22), (0.56, 0.19, 0.05))
    glaze = common.principled("Painted Glaze", (0.7, 0.66, 0.56), roughness=0.20, specular=0.55,
                              texture=common.image("Painted Bowl", painted))
    common.mesh_object("Bowl", body, glaze, smooth=True, location=location)


def peel(seed, name):
    """A normal map of pores, one repeat to 24 mm."""
    height = -np.maximum(pictures.noise(seed, 256, 256, 0.06, slope=3.2) - 0.1, 0) ** 0.8 * 0.00042
    return common.image(name, pictures.normal_map(height, 0.024, 0.024), color=False)


def orange_skin():
    return common.principled("Orange Skin", (0.80, 0.25, 0.020), roughness=0.36, specular=0.5,
                             normal_map=peel(21, "Orange Peel"))


def lemon_skin():
    return common.principled("Lemon Skin", (0.82, 0.58, 0.035), roughness=0.33, specular=0.5,
                             normal_map=peel(22, "Lemon Peel"), normal_strength=0.8)


def oranges(places):
    """Oranges of one mesh, of radius 40 mm, at (centre, turns in degrees, scale)."""
    radius = 0.040
    ball = shapes.globe(44, 22)
    dent = 1 - 0.09 * np.exp(-((1 - ball.vertices[:, 2]) / 0.03))
    ball = ball.displaced(lambda p: p * [1, 1, 0.95] * dent[:, None]).scaled(radius)
    ball.uv = ball.uv * [10, 5]  # repeats of 24 mm
    # The scar of the stalk, a second slot.
    scar = shapes.lathe([(0, -0.004), (0.0032, -0.002), (0.0034, 0.0006), (0.0018, 0.0012), (0, 0.0008)], 12)
    scar = scar.moved((0, 0, radius * 0.95 * 0.925)).slotted(1)
    stalk = common.principled("Orange Stalk", (0.13, 0.17, 0.05), roughness=0.8)
    _copies("Orange", shapes.joined(ball, scar), [orange_skin(), stalk], places)


def lemons(places):
    """Lemons of one mesh, 10 cm long along x, at (centre, turns in degrees, scale)."""
    t = np.linspace(0, np.pi, 27)
    z = -0.044 * np.cos(t) - 0.007 * np.cos(t) ** 15
    r = 0.0295 * np.sin(t) ** 0.9 * (1 - 0.08 * np.cos(t))
    r += 0.0035 * np.exp(-((np.abs(z) - 0.046) / 0.006) ** 2) * np.sin(t)
    r[[0, -1]] = 0
    body = shapes.lathe(np.stack([r, z], 1), 36)
    body.uv = body.uv * [8, 5]
    _copies("Lemon", body.turned("y", 90), lemon_skin(), places)


def _copies(name, shape, materials, places):
    first = None
    for location, turns, scale in places:
        thing = (common.mesh_object(name, shape, materials, smooth=True, location=location) if first is None
                 else common.link(name, first.data, location))
        thing.rotation_euler = np.radians(turns)
        thing.scale = (scale,) * 3
        first = first or thing


def goblet(location):
    profile = np.concatenate([
        [(0, 0), (0.036, 0), (0.0375, 0.0008)],
        shapes.spline([(0.0370, 0.0020), (0.024, 0.005), (0.0075, 0.014), (0.0046, 0.035), (0.0044, 0.060),
                       (0.0085, 0.079), (0.026, 0.093), (0.0405, 0.118), (0.0425, 0.145), (0.0365, 0.180)], 46),
        [(0.0360, 0.1808), (0.0354, 0.1808)],
        shapes.spline([(0.0350, 0.180), (0.0410, 0.145), (0.0390, 0.119), (0.0245, 0.0955), (0.0085, 0.0865)], 20),
        [(0, 0.0855)],
    ])
    glass = common.principled("Glass", (0.80, 0.93, 0.88), roughness=0.06, transmission=0.82, ior=1.5, specular=0.6)
    common.mesh_object("Goblet", shapes.lathe(profile, 48).without_uv(), glass, smooth=True, location=location)


def silver_ball(location):
    silver = common.principled("Silver", (0.83, 0.82, 0.79), roughness=0.10, metallic=0.72)
    x, y, z = location
    common.mesh_object("Silver Ball", shapes.sphere(18).scaled(0.046), silver, smooth=True, location=(x, y, z + 0.046))


def amethyst(location):
    """An icosahedron of coloured glass, on one of its faces."""
    stone = shapes.icosahedron()
    face = stone.vertices[stone.corners[:3]]
    normal = shapes.unit(face.mean(0))
    first = shapes.unit(face[0] - face.mean(0))
    frame = np.stack([first, np.cross(-normal, first), -normal])
    stone = stone.displaced(lambda p: p @ frame.T).turned("z", 35).scaled(0.034)
    low = stone.vertices[:, 2].min()
    violet = common.principled("Amethyst", (0.44, 0.13, 0.56), roughness=0.08, transmission=0.55, ior=1.5,
                               specular=0.6)
    common.mesh_object("Amethyst", stone.moved((0, 0, -low)), violet, location=location)
