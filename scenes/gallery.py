# SPDX-License-Identifier: GPL-3.0-or-later
"""A furnished gallery for radiosity: a columned hall with tall windows, coffers, pictures and sculptures.

The architecture is one mesh of some hundred large quads cut from a rectilinear grid, so that it is sealed but for its
four windows and no faces overlap; what stands in it reaches 1 cm into floor or wall. Light comes from the sky and the
sun through the windows and from area lights in the coffers. The room is 10 m wide, 14 m long and 4.8 m high, x across,
y away from the viewer. `gallery_coarse` is the same with fewer faces. 960 × 540 pixels.
"""

import common
import numpy as np
import pictures
import shapes

WIDTH, LENGTH, HEIGHT, COFFER_TOP = 10.0, 14.0, 4.8, 5.35
BAYS = 4
BAY = LENGTH / BAYS
PILASTER = 0.30  # half width and depth
WINDOW_HALF, SILL, HEAD, REVEAL = 0.80, 0.90, 4.0, 0.45
COFFERS = ((0.30, 3.10), (3.60, 6.40), (6.90, 9.70))
DOOR, DOOR_HEIGHT, DOOR_DEPTH = (4.20, 5.80), 2.90, 0.40
VESTIBULE, VESTIBULE_END, VESTIBULE_HEIGHT = (3.60, 6.40), 17.4, 3.4
SUNK = 0.01  # how far things reach into floors and walls


def build():
    build_gallery(1.0)


def build_gallery(detail):
    """`detail` scales the number of faces along each direction of what is curved."""
    common.start("Gallery", 960, 540)

    def n(count, least=6):
        return max(least, round(count * detail))

    materials = {
        "white": common.principled("Stone", (0.64, 0.61, 0.55), roughness=0.75, specular=0.2),
        "bronze": common.principled("Bronze", (0.62, 0.36, 0.16), roughness=0.32, metallic=0.6),
        "marble": common.principled("Marble", (0.74, 0.72, 0.68), roughness=0.30),
        "steel": common.principled("Steel", (0.62, 0.63, 0.65), roughness=0.25, metallic=0.7),
        "walnut": common.principled("Walnut", (0.20, 0.095, 0.045), roughness=0.4),
        "blue": common.principled("Blue Glaze", (0.03, 0.10, 0.30), roughness=0.15, specular=0.6),
        "ochre": common.principled("Ochre Glaze", (0.66, 0.36, 0.07), roughness=0.2, specular=0.6),
        "green": common.principled("Green Leather", (0.05, 0.16, 0.11), roughness=0.45),
        "shell": common.principled("Chair Shell", (0.70, 0.26, 0.06), roughness=0.35),
        "black": common.principled("Black Wood", (0.03, 0.028, 0.026), roughness=0.35),
    }
    architecture(materials)
    columns(n, materials)
    windows(materials)
    hung_pictures(materials)
    sculptures(n, materials)
    furniture(n, materials)
    lights()
    common.camera((4.72, 1.90, 1.55), (5.02, 8.0, 1.70), lens=24)


def centres():
    return [(k + 0.5) * BAY for k in range(BAYS)]


def architecture(materials):
    ys = {0.0, LENGTH, LENGTH + DOOR_DEPTH, VESTIBULE_END}
    for k in range(1, BAYS):
        ys |= {k * BAY - PILASTER, k * BAY + PILASTER}
    for y in centres():
        ys |= {y - WINDOW_HALF, y + WINDOW_HALF}
    xs = {-REVEAL, 0.0, WIDTH, PILASTER, WIDTH - PILASTER, *DOOR, *VESTIBULE, *(x for pair in COFFERS for x in pair)}
    zs = {0.0, SILL, DOOR_HEIGHT, VESTIBULE_HEIGHT, HEAD, HEIGHT, COFFER_TOP}
    xs, ys, zs = (np.array(sorted(lines)) for lines in (xs, ys, zs))
    x, y, z = np.meshgrid(*((lines[1:] + lines[:-1]) / 2 for lines in (xs, ys, zs)), indexing="ij")

    def between(values, low, high):
        return (values > low) & (values < high)

    from_pilaster = np.min([np.abs(y - k * BAY) for k in range(1, BAYS)], 0)
    from_centre = np.min([np.abs(y - c) for c in centres()], 0)
    hall = between(x, 0, WIDTH) & between(y, 0, LENGTH)
    air = hall & (z < HEIGHT)
    air &= ~((from_pilaster < PILASTER) & ((x < PILASTER) | (x > WIDTH - PILASTER)))
    coffer = np.any([between(x, *pair) for pair in COFFERS], 0) & (from_pilaster > PILASTER)
    air |= hall & (z > HEIGHT) & coffer
    air |= (x < 0) & (y < LENGTH) & (from_centre < WINDOW_HALF) & between(z, SILL, HEAD)
    air |= between(y, LENGTH, LENGTH + DOOR_DEPTH) & between(x, *DOOR) & (z < DOOR_HEIGHT)
    air |= (y > LENGTH + DOOR_DEPTH) & between(x, *VESTIBULE) & (z < VESTIBULE_HEIGHT)
    hall_mesh, centre, normal = shapes.room(xs, ys, zs, air, open_faces=((0, -1),))

    floor, wall, ceiling, vestibule = 0, 1, 2, 3
    slots = np.where(normal[:, 2] > 0.5, floor, wall)
    slots[(normal[:, 2] > 0.5) & (centre[:, 2] > 0.1)] = wall  # window sills
    slots[(centre[:, 2] > HEIGHT - 0.01) | (normal[:, 2] < -0.5)] = ceiling
    slots[(centre[:, 1] > LENGTH + DOOR_DEPTH - 0.01) & (slots == wall)] = vestibule
    hall_mesh.slots = slots
    hall_mesh = hall_mesh.with_uv(lambda p: p[:, :2] / 2.4)
    parquet = common.image("Parquet", pictures.parquet(9, 512, (0.13, 0.062, 0.026), (0.42, 0.24, 0.115)))
    common.mesh_object("Hall", hall_mesh, [
        common.principled("Parquet", (0.26, 0.14, 0.065), roughness=0.35, specular=0.4, texture=parquet),
        common.principled("Wall", (0.55, 0.52, 0.455), roughness=0.9, specular=0.1),
        common.principled("Ceiling", (0.70, 0.685, 0.65), roughness=0.9, specular=0.1),
        common.principled("Vestibule", (0.62, 0.20, 0.10), roughness=0.9, specular=0.1),
    ])
    # Door frame: its lower bar lies under the floor.
    border, low = 0.16, 0.25
    surround = shapes.frame(DOOR[1] - DOOR[0] - 0.02, DOOR_HEIGHT + low - 0.01, border, 0.06 + SUNK)
    middle = ((DOOR[0] + DOOR[1]) / 2, LENGTH + SUNK, (DOOR_HEIGHT - low - 0.01) / 2)
    common.mesh_object("Door Frame", surround.moved(middle), materials["walnut"])


def columns(n, materials):
    base = [(0.285, -SUNK), (0.285, 0.09), (0.268, 0.10), (0.275, 0.125), (0.275, 0.155), (0.262, 0.18), (0.232, 0.195),
            (0.228, 0.21), (0.238, 0.225), (0.238, 0.245), (0.222, 0.265), (0.205, 0.285)]
    shaft_z = np.linspace(0.33, 4.30, n(13, 3))
    t = (shaft_z - 0.33) / 3.97
    shaft = np.stack([0.200 - 0.030 * t**1.8, shaft_z], 1)
    capital = [(0.170, 4.36), (0.186, 4.375), (0.186, 4.40), (0.172, 4.415), (0.172, 4.47), (0.195, 4.52),
               (0.238, 4.58), (0.248, 4.62), (0.235, 4.64), (0.275, 4.655), (0.275, HEIGHT + SUNK)]
    if len(shaft) < 8:  # coarse: fewer mouldings
        base, capital = base[:2] + base[4:5] + base[-1:], capital[:1] + capital[5:8:2] + capital[-2:]
    shape = shapes.lathe(np.concatenate([base, shaft, capital]), n(40, 10)).without_uv()
    _copies("Column", shape, materials["white"], [
        (x, k * BAY, 0.0) for x in (3.35, 6.65) for k in range(1, BAYS)], sharp_angle=32)


def windows(materials):
    width, height, border, depth = 2 * WINDOW_HALF, HEAD - SILL, 0.07, 0.07
    parts = [shapes.frame(width - 2 * border, height - 2 * border, border + SUNK, depth)]
    bar = 0.045
    inside = height - 2 * border
    upright = shapes.box((bar, depth - 0.012, inside + border))
    parts.append(upright.moved((0, -depth / 2, -(inside + border) / 2)))
    for k in (1, 2, 3):
        level = shapes.box((width - border, depth - 0.026, bar))
        parts.append(level.moved((0, -depth / 2, -inside / 2 + k * inside / 4 - bar / 2)))
    shape = shapes.joined(*(part.without_uv() for part in parts)).turned("z", 90)
    _copies("Window Frame", shape, materials["white"], [(-0.24, y, (SILL + HEAD) / 2) for y in centres()], smooth=False)


def hung_pictures(materials):
    gilt = common.principled("Gilt", (0.62, 0.40, 0.13), roughness=0.35, metallic=0.35)
    paint = {kind: common.principled(f"Picture {kind}", (0.5, 0.5, 0.5), roughness=0.6, specular=0.2,
                                     texture=common.image(f"Picture {kind}", pictures.painting(kind, *size)))
             for kind, size in (("fields", (288, 192)), ("hills", (288, 192)), ("rings", (192, 224)))}
    places = (  # (kind, (width, height), centre on the wall, degrees about z; 0 faces −y)
        ("hills", (2.0, 1.34), (WIDTH, 1.5 * BAY, 2.0), -90),
        ("fields", (2.0, 1.34), (WIDTH, 2.5 * BAY, 2.0), -90),
        ("rings", (1.20, 1.40), (WIDTH, 3.5 * BAY, 2.0), -90),
        ("rings", (1.38, 1.61), (1.95, LENGTH, 2.05), 0),
        ("hills", (2.1, 1.40), (8.05, LENGTH, 2.05), 0),
        ("fields", (1.8, 1.20), (WIDTH, 0.5 * BAY, 2.0), -90),
    )
    for kind, (width, height), position, degrees in places:
        border = 0.09
        # The far edge of the frame stands off the canvas; both reach behind each other.
        ring = shapes.frame(width - 0.02, height - 0.02, border, 0.055 + SUNK).moved((0, SUNK, 0))
        common.mesh_object("Picture Frame", ring.turned("z", degrees), gilt, location=position)
        x, z = width / 2, height / 2
        canvas = shapes.polygons([(-x, -0.02, -z), (x, -0.02, -z), (x, -0.02, z), (-x, -0.02, z)], [(0, 1, 2, 3)],
                                 [(0, 0), (1, 0), (1, 1), (0, 1)])
        common.mesh_object(f"Picture {kind}", canvas.turned("z", degrees), paint[kind], location=position)


def sculptures(n, materials):
    def plinth(name, x, y, width, height):
        block = shapes.box((width, width, height + SUNK), bottom=False).without_uv()
        common.mesh_object(name, block, materials["white"], location=(x, y, -SUNK))
        return x, y, height - 0.003

    # A twisted ring of marble at the end of the hall.
    around, about = n(150, 20), n(40, 10)
    u, v = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(about) * 2 * np.pi / about, indexing="ij")
    wide, thin = 0.24, 0.075
    a = wide * np.sign(np.cos(v)) * np.abs(np.cos(v)) ** 0.7
    b = thin * np.sign(np.sin(v)) * np.abs(np.sin(v)) ** 0.7
    turn = u + 0.6
    out, up = a * np.cos(turn) - b * np.sin(turn), a * np.sin(turn) + b * np.cos(turn)
    ring = shapes.surface(np.stack([(0.62 + out) * np.cos(u), (0.62 + out) * np.sin(u), up], -1), True, True)
    ring = ring.without_uv().turned("x", 90).turned("z", 24)
    place = np.array(plinth("Low Plinth", 5.0, 10.3, 1.0, 0.62))
    lift = -ring.vertices[:, 2].min()
    common.mesh_object("Ring", ring, materials["marble"], smooth=True, location=place + [0, 0, lift])

    knot = shapes.torus_knot(2, 3, 0.27, 0.115, 0.068, n(260, 60), n(22, 7)).without_uv()
    knot = knot.turned("x", 78).turned("z", -30)
    place = np.array(plinth("Plinth", 8.10, 7.60, 0.52, 1.05))
    common.mesh_object("Knot", knot, materials["bronze"], smooth=True,
                       location=place + [0, 0, -knot.vertices[:, 2].min() - 0.004])

    flame = shapes.spline([(0.0, 0.0), (0.085, 0.004), (0.075, 0.06), (0.040, 0.16), (0.085, 0.34), (0.125, 0.56),
                           (0.095, 0.80), (0.030, 1.02), (0.0, 1.10)], n(64, 16))
    flame[[0, -1], 0] = 0
    bird = shapes.lathe(flame, n(40, 10)).without_uv()
    bird = bird.displaced(lambda p: np.stack([p[:, 0] + 0.10 * np.sin(2.6 * p[:, 2]), p[:, 1], p[:, 2]], 1))
    common.mesh_object("Bird", bird.turned("z", 150), materials["steel"], smooth=True, sharp_angle=50,
                       location=plinth("Plinth", 8.25, 9.75, 0.46, 0.95))

    relief = shapes.waves(33, 9, 3.0, 7.0)
    ball = shapes.sphere(n(30, 8)).displaced(lambda p: p * (1 + 0.20 * relief(p))[:, None]).scaled(0.33)
    place = np.array(plinth("Plinth", 1.72, 10.95, 0.50, 0.85))
    common.mesh_object("Stone", ball, materials["marble"], smooth=True,
                       location=place + [0, 0, -ball.vertices[:, 2].min() - 0.02])

    outer = [(0.0, 0.0), (0.10, 0.0), (0.135, 0.05), (0.205, 0.18), (0.200, 0.32), (0.105, 0.45), (0.080, 0.52),
             (0.105, 0.58)]
    inner = [(0.098, 0.583), (0.072, 0.52), (0.095, 0.45), (0.185, 0.32), (0.0, 0.06)]
    rows = n(44, 12)
    profile = np.concatenate([outer[:1], shapes.spline(outer[1:], rows), shapes.spline(inner[:-1], rows // 2),
                              inner[-1:]])
    vase = shapes.lathe(profile, n(48, 12)).without_uv()
    for name, material, position in (("Blue Vase", "blue", plinth("Plinth", 2.15, 12.35, 0.50, 1.0)),
                                     ("Ochre Vase", "ochre", plinth("Plinth", 7.85, 12.35, 0.50, 1.0))):
        common.mesh_object(name, vase, materials[material], smooth=True, sharp_angle=60, location=position)


def furniture(n, materials):
    rug = shapes.box((2.1, 9.2, 0.012 + SUNK), bottom=False).without_uv()
    common.mesh_object("Rug", rug, common.principled("Rug", (0.42, 0.055, 0.04), roughness=0.95, specular=0.05),
                       location=(5.0, 6.4, -SUNK))

    # A bench: three cushions on a frame with four legs.
    x, y = 5.15, 6.75
    cushion = shapes.rounded_box((0.62, 0.56, 0.14), 0.05, n(6, 2), (n(12, 2), n(12, 2), n(3, 1))).without_uv()
    cushion = cushion.displaced(
        lambda p: p + np.outer((p[:, 2] > 0.07) * 0.022 * (1 - (p[:, 0] / 0.31) ** 2) * (1 - (p[:, 1] / 0.28) ** 2),
                               [0, 0, 1]))
    _copies("Cushion", cushion, materials["green"], [(x + dx, y, 0.352) for dx in (-0.635, 0.0, 0.635)])
    board = shapes.rounded_box((1.96, 0.58, 0.05), 0.012, n(3, 1)).without_uv()
    common.mesh_object("Bench", board, materials["walnut"], smooth=True, sharp_angle=40, location=(x, y, 0.30))
    leg = shapes.tube([(0, 0, -SUNK), (0, 0, 0.31)], 0.022, n(16, 6)).without_uv()
    corners = [(x + dx, y + dy, 0.012) for dx in (-0.88, 0.88) for dy in (-0.22, 0.22)]
    _copies("Bench Leg", leg, materials["steel"], corners, sharp_angle=50)

    chair, legs = shell_chair(n)
    for name, part, material in (("Chair", chair, "shell"), ("Chair Legs", legs, "black")):
        places = ((1.55, 7.45, 0), (1.35, 9.35, 0))
        pair = _copies(name, part, materials[material], places, sharp_angle=60)
        for thing, degrees in zip(pair, (42, 118), strict=True):
            thing.rotation_euler = (0, 0, np.radians(degrees))

    # A round table between the chairs.
    top = [(0, 0.48), (0.26, 0.48), (0.293, 0.486), (0.30, 0.495), (0.293, 0.504), (0.26, 0.508), (0, 0.508)]
    post = shapes.spline([(0.19, -SUNK), (0.185, 0.015), (0.06, 0.03), (0.028, 0.09), (0.026, 0.40), (0.06, 0.485)],
                         n(24, 8))
    common.mesh_object("Table Top", shapes.lathe(top, n(48, 14)).without_uv(), materials["walnut"], smooth=True,
                       sharp_angle=40, location=(0.95, 8.45, 0))
    common.mesh_object("Table Post", shapes.lathe(post, n(32, 10)).without_uv(), materials["steel"], smooth=True,
                       sharp_angle=60, location=(0.95, 8.45, 0))
    pot = [(0, 0.506), (0.055, 0.506), (0.085, 0.55), (0.09, 0.60), (0.06, 0.65), (0.065, 0.67), (0.058, 0.672),
           (0.052, 0.65), (0.08, 0.60), (0, 0.53)]
    pot = np.concatenate([pot[:1], shapes.spline(pot[1:6], n(16, 5)), pot[6:]])
    common.mesh_object("Pot", shapes.lathe(pot, n(32, 10)).without_uv(), materials["ochre"], smooth=True,
                       sharp_angle=60, location=(0.98, 8.41, 0))


def shell_chair(n):
    """A chair of one bent shell, facing −y, and its legs; the seat is 0.44 m high."""
    centre = shapes.spline([(-0.235, 0.415), (-0.21, 0.442), (-0.10, 0.440), (0.05, 0.425), (0.16, 0.435),
                            (0.215, 0.50), (0.245, 0.62), (0.275, 0.78), (0.282, 0.81)], n(40, 10))
    s = np.linspace(0, 1, len(centre))
    half = 0.235 + 0.035 * np.sin(np.pi * s) - 0.05 * shapes.smoothstep(0.75, 1.0, s) ** 2
    half = half * np.sqrt(np.clip(1 - ((s - 0.5) / 0.515) ** 14, 0.02, 1))
    curl = 0.02 + 0.085 * shapes.smoothstep(0.25, 0.62, s) * (1 - 0.55 * shapes.smoothstep(0.7, 1.0, s))
    t = np.linspace(-1, 1, n(30, 8))
    tangent = shapes.unit(np.gradient(centre, axis=0))
    bend = curl[:, None] * np.abs(t[None]) ** 2.4
    points = np.stack([half[:, None] * t[None], centre[:, :1] - tangent[:, 1:] * bend,
                       centre[:, 1:] + tangent[:, :1] * bend], -1)
    shell = shapes.thickened(points[:, ::-1].copy(), 0.012)
    legs = []
    for side in (-1, 1):
        for top, foot in (((0.13 * side, -0.10, 0.435), (0.215 * side, -0.225, -SUNK)),
                          ((0.13 * side, 0.09, 0.425), (0.215 * side, 0.245, -SUNK))):
            legs.append(shapes.tube(np.linspace(foot, top, 3), [0.010, 0.012, 0.014], n(12, 6)))
    return shell, shapes.joined(*legs).without_uv()


def lights():
    sky = common.image("Sky", pictures.gradient_sky(17, 512, 256))
    common.world(picture=sky, strength=2.4)
    common.sun_light("Sun", (0.80, 0.34, -0.50), 12.0, (1.0, 0.86, 0.66), angle=0.6)
    for k, y in enumerate(centres()):
        for name, x, power in (("Nave", 5.0, 42.0), ("Aisle", 8.3, 52.0)):
            common.area_light(f"{name} Light {k + 1}", (x, y, COFFER_TOP - 0.06), (x, y, 0), (1.8, 1.8), power,
                              (1.0, 0.92, 0.80))
    for name, x in (("Left", 2.2), ("Right", 7.8)):
        light = common.area_light(f"{name} Uplight", (x, LENGTH / 2, 3.5), (x, LENGTH / 2, 9), (0.8, 12.5), 120,
                                  (1.0, 0.93, 0.83))
        light.rotation_euler = (np.pi, 0, 0)
    common.area_light("Vestibule Light", (5.0, 16.0, VESTIBULE_HEIGHT - 0.05), (5.0, 16.0, 0), (1.4, 1.4), 55,
                      (1.0, 0.80, 0.58))
    common.area_light("Entrance", (5.0, 0.08, 2.3), (5.0, 6.0, 1.6), (6.0, 3.4), 62, (0.94, 0.97, 1.0))


def _copies(name, shape, material, positions, smooth=True, sharp_angle=None):
    """Objects of one mesh at several places, as a list."""
    first = common.mesh_object(name, shape, material, smooth=smooth, sharp_angle=sharp_angle, location=positions[0])
    return [first] + [common.link(name, first.data, position) for position in positions[1:]]
