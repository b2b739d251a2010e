# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces as plain arrays, for the scenes: grids, lathes, tubes, spheres, boxes, rooms. Metres, Z up, numpy only.

Every function gives a Shape. Faces turn counter-clockwise seen from outside; closed bodies share their vertices, so
that no edge is open.
"""

from dataclasses import dataclass

import numpy as np


@dataclass
class Shape:
    """A mesh of n-gons. `uv` has one row per corner, v up, or is None; `slots` one material slot per face."""

    vertices: np.ndarray  # (n, 3) float
    corners: np.ndarray  # (m,) int: the vertex of each face corner
    sizes: np.ndarray  # (f,) int: corners per face
    uv: np.ndarray | None = None  # (m, 2) float
    slots: np.ndarray | None = None  # (f,) int

    @property
    def triangle_count(self):
        return int(np.sum(self.sizes - 2))

    def moved(self, offset):
        """A copy, moved by `offset`."""
        return self._with(self.vertices + np.asarray(offset, float))

    def scaled(self, factor):
        """A copy, scaled about the origin by a number or three (whose product is positive)."""
        return self._with(self.vertices * np.asarray(factor, float))

    def turned(self, axis, degrees):
        """A copy, turned about the x, y or z axis through the origin, counter-clockwise seen from its tip."""
        return self._with(self.vertices @ rotation(axis, degrees).T)

    def displaced(self, function):
        """A copy whose vertices are function(vertices)."""
        return self._with(function(self.vertices))

    def flipped(self):
        """A copy whose faces look the other way."""
        starts = np.repeat(np.cumsum(self.sizes) - self.sizes, self.sizes)
        ends = np.repeat(np.cumsum(self.sizes), self.sizes)
        order = starts + ends - 1 - np.arange(len(self.corners))
        uv = None if self.uv is None else self.uv[order]
        return Shape(self.vertices, self.corners[order], self.sizes, uv, self.slots)

    def triangulated(self):
        """A copy in triangles: each face as a fan from its first corner."""
        starts = np.cumsum(self.sizes) - self.sizes
        fans = np.repeat(np.arange(len(self.sizes)), self.sizes - 2)
        step = np.arange(len(fans)) - np.repeat(np.cumsum(self.sizes - 2) - (self.sizes - 2), self.sizes - 2)
        pick = (starts[fans][:, None] + np.stack([np.zeros_like(step), step + 1, step + 2], 1)).ravel()
        uv = None if self.uv is None else self.uv[pick]
        slots = None if self.slots is None else self.slots[fans]
        return Shape(self.vertices, self.corners[pick], np.full(len(fans), 3), uv, slots)

    def slotted(self, slot):
        """A copy, all faces of which use one material slot."""
        return Shape(self.vertices, self.corners, self.sizes, self.uv, np.full(len(self.sizes), slot))

    def without_uv(self):
        return Shape(self.vertices, self.corners, self.sizes, None, self.slots)

    def with_uv(self, function):
        """A copy whose texture coordinates are function(positions of the corners): (m, 3) to (m, 2)."""
        return Shape(self.vertices, self.corners, self.sizes, function(self.vertices[self.corners]), self.slots)

    def _with(self, vertices):
        return Shape(vertices, self.corners, self.sizes, self.uv, self.slots)


def rotation(axis, degrees):
    """The 3 × 3 matrix of a turn about axis "x", "y" or "z"."""
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix = np.eye(3)
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix[first, first] = matrix[second, second] = cosine
    matrix[first, second], matrix[second, first] = -sine, sine
    return matrix


def unit(vectors):
    """Vectors of length 1; zero stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1)


def smoothstep(low, high, x):
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def joined(*shapes):
    """Several shapes as one mesh. Texture coordinates are kept where all have them."""
    offsets = np.cumsum([0] + [len(s.vertices) for s in shapes[:-1]])
    with_uv = all(s.uv is not None for s in shapes)
    slots = None
    if any(s.slots is not None for s in shapes):
        slots = np.concatenate([np.zeros(len(s.sizes), int) if s.slots is None else s.slots for s in shapes])
    return Shape(
        np.concatenate([s.vertices for s in shapes]),
        np.concatenate([s.corners + o for s, o in zip(shapes, offsets, strict=True)]),
        np.concatenate([s.sizes for s in shapes]),
        np.concatenate([s.uv for s in shapes]) if with_uv else None,
        slots,
    )


def welded(shape, digits=7):
    """The shape with vertices at one place (to `digits` decimals) made one, and repeated corners of a face dropped."""
    keys = np.round(shape.vertices, digits) + 0.0
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    corners = inverse.reshape(-1)[shape.corners]
    face = np.repeat(np.arange(len(shape.sizes)), shape.sizes)
    last = np.cumsum(shape.sizes) - 1
    following = np.roll(corners, -1)
    following[last] = corners[last - shape.sizes + 1]
    keep = corners != following
    sizes = np.bincount(face[keep], minlength=len(shape.sizes))
    whole = sizes >= 3
    keep &= whole[face]
    uv = None if shape.uv is None else shape.uv[keep]
    slots = None if shape.slots is None else shape.slots[whole]
    return Shape(shape.vertices[first], corners[keep], sizes[whole], uv, slots)


def polygons(vertices, faces, uv=None):
    """A shape from lists: vertices, and faces as lists of vertex indices."""
    corners = np.array([index for face in faces for index in face], int)
    sizes = np.array([len(face) for face in faces], int)
    return Shape(np.asarray(vertices, float), corners, sizes, None if uv is None else np.asarray(uv, float))


def surface(points, close_u=False, close_v=False):
    """Quads over points (nu, nv, 3), looking to du × dv. u and v run from 0 to 1 over the indices."""
    nu, nv = points.shape[:2]
    mu, mv = nu - (not close_u), nv - (not close_v)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(mu), np.arange(mv), indexing="ij"))
    i_corner = np.stack([i, i + 1, i + 1, i], 1)
    j_corner = np.stack([j, j, j + 1, j + 1], 1)
    corners = (i_corner % nu * nv + j_corner % nv).ravel()
    uv = np.stack([i_corner / mu, j_corner / mv], -1).reshape(-1, 2)
    return Shape(points.reshape(-1, 3), corners, np.full(mu * mv, 4), uv)


def lathe(profile, segments):
    """The profile, rows of (radius, z), turned about the z axis; it looks outward where the profile rises.

    A radius of 0 is one vertex, a pole. u runs around once, v along the profile by length."""
    profile = np.asarray(profile, float)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(profile, axis=0), axis=1))])
    v = length / length[-1]
    angle = np.arange(segments) * (2 * np.pi / segments)
    rings, vertices, count = [], [], 0
    for radius, z in profile:
        if radius <= 1e-9:
            vertices.append(np.array([[0.0, 0.0, z]]))
            rings.append(np.full(segments, count))
        else:
            vertices.append(np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(segments, z)], 1))
            rings.append(count + np.arange(segments))
        count += len(vertices[-1])
    k = np.arange(segments)
    corners, sizes, uv = [], [], []
    for below in range(len(profile) - 1):
        low, high = rings[below], rings[below + 1]
        if low[0] == low[-1] and high[0] == high[-1]:
            continue
        u0, u1 = k / segments, (k + 1) / segments
        v0, v1 = np.full(segments, v[below]), np.full(segments, v[below + 1])
        quad = np.stack([low, np.roll(low, -1), np.roll(high, -1), high], 1)
        coordinates = np.stack([np.stack([u0, v0], 1), np.stack([u1, v0], 1), np.stack([u1, v1], 1),
                                np.stack([u0, v1], 1)], 1)
        if low[0] == low[-1]:
            quad, coordinates = quad[:, [0, 2, 3]], coordinates[:, [0, 2, 3]]
            coordinates[:, 0, 0] = (u0 + u1) / 2
        elif high[0] == high[-1]:
            quad, coordinates = quad[:, [0, 1, 2]], coordinates[:, [0, 1, 2]]
            coordinates[:, 2, 0] = (u0 + u1) / 2
        corners.append(quad.ravel())
        sizes.append(np.full(segments, quad.shape[1]))
        uv.append(coordinates.reshape(-1, 2))
    return Shape(np.concatenate(vertices), np.concatenate(corners), np.concatenate(sizes), np.concatenate(uv))


def spline(points, count, closed=False):
    """`count` points, evenly spaced along the Catmull-Rom curve (centripetal by chord) through `points`."""
    points = np.asarray(points, float)
    padded = (np.concatenate([points[-1:], points, points[:2]]) if closed
              else np.concatenate([2 * points[:1] - points[1:2], points, 2 * points[-1:] - points[-2:-1]]))
    t = np.linspace(0, 1, 33)[:-1]
    pieces = []
    for p0, p1, p2, p3 in zip(padded, padded[1:], padded[2:], padded[3:], strict=False):
        d0, d1, d2 = (np.sqrt(max(np.linalg.norm(b - a), 1e-12)) for a, b in ((p0, p1), (p1, p2), (p2, p3)))
        m1 = p2 - p1 + d1 * ((p1 - p0) / d0 - (p2 - p0) / (d0 + d1))
        m2 = p2 - p1 + d1 * ((p3 - p2) / d2 - (p3 - p1) / (d1 + d2))
        x = t[:, None]
        pieces.append((2 * x**3 - 3 * x**2 + 1) * p1 + (x**3 - 2 * x**2 + x) * m1 + (3 * x**2 - 2 * x**3) * p2
                      + (x**3 - x**2) * m2)
    curve = np.concatenate(pieces + [points[:1] if closed else points[-1:]])
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    at = np.linspace(0, length[-1], count + 1)[:-1] if closed else np.linspace(0, length[-1], count)
    return np.stack([np.interp(at, length, curve[:, axis]) for axis in range(curve.shape[1])], 1)


def frames(path, closed=False):
    """Two unit vectors across the path at each point, carried along without twist; closed paths meet themselves."""
    following = np.roll(path, -1, 0) - path
    before = path - np.roll(path, 1, 0)
    if not closed:
        following[-1], before[0] = before[-1], following[0]
    tangent = unit(following + before)
    across = np.empty_like(path)
    start = np.eye(3)[np.argmin(np.abs(tangent[0]))]
    across[0] = unit(start - tangent[0] * (start @ tangent[0]))
    for k in range(1, len(path)):
        across[k] = unit(across[k - 1] - tangent[k] * (across[k - 1] @ tangent[k]))
    if closed:
        last = across[-1] - tangent[0] * (across[-1] @ tangent[0])
        error = np.arctan2(np.cross(across[0], last) @ tangent[0], across[0] @ last)
        turn = (-error * np.arange(len(path)) / len(path))[:, None]
        across = across * np.cos(turn) + np.cross(tangent, across) * np.sin(turn)
    return across, np.cross(tangent, across)


def tube(path, radius, sides, closed=False, section=None):
    """A tube about the path. `radius`: one number or one per point; `section` (sides, 2) replaces the circle of
    radius 1. Open tubes end in flat caps with a centre vertex."""
    path = np.asarray(path, float)
    radius = np.broadcast_to(np.asarray(radius, float), len(path))
    first, second = frames(path, closed)
    if section is None:
        angle = np.arange(sides) * (2 * np.pi / sides)
        section = np.stack([np.cos(angle), np.sin(angle)], 1)
    ring = section[None, :, :] * radius[:, None, None]
    points = path[:, None] + ring[..., :1] * first[:, None] + ring[..., 1:] * second[:, None]
    # The surface looks to d(path) × d(around) = inward for a circle; swap u and v to look outward.
    sheet = surface(points.transpose(1, 0, 2), close_u=True, close_v=closed)
    if closed:
        return sheet
    count = len(path)
    k = np.arange(len(section))
    base = len(sheet.vertices)
    rim = k * count
    following = np.roll(k, -1) * count
    start = np.stack([np.full_like(k, base), following, rim], 1)
    end = np.stack([np.full_like(k, base + 1), rim + count - 1, following + count - 1], 1)
    corners = np.concatenate([sheet.corners, start.ravel(), end.ravel()])
    sizes = np.concatenate([sheet.sizes, np.full(2 * len(k), 3)])
    uv = np.concatenate([sheet.uv, np.full((6 * len(k), 2), 0.5)])
    return Shape(np.concatenate([sheet.vertices, path[[0, -1]]]), corners, sizes, uv)


def icosahedron():
    """The regular icosahedron of circumradius 1, in 20 flat triangles."""
    golden = (1 + np.sqrt(5)) / 2
    vertices = [(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0), (0, -1, golden), (0, 1, golden),
                (0, -1, -golden), (0, 1, -golden), (golden, 0, -1), (golden, 0, 1), (-golden, 0, -1), (-golden, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
             (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11),
             (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    return polygons(unit(np.array(vertices, float)), faces)


def sphere(frequency):
    """The unit sphere in 20 · frequency² nearly equal triangles: a divided icosahedron."""
    base = icosahedron()
    a, b, c = (base.vertices[base.corners.reshape(-1, 3)[:, k]] for k in range(3))
    i, j = (x.ravel() for x in np.meshgrid(np.arange(frequency + 1), np.arange(frequency + 1), indexing="ij"))
    i, j = i[i + j <= frequency], j[i + j <= frequency]
    index = np.full((frequency + 2, frequency + 2), -1)
    index[i, j] = np.arange(len(i))
    weights = np.stack([frequency - i - j, i, j], 1) / frequency
    points = unit(np.einsum("pk,kfx->fpx", weights, np.stack([a, b, c])))
    up = np.stack([index[i, j], index[i + 1, j], index[i, j + 1]], 1)
    down = np.stack([index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]], 1)
    triangles = np.concatenate([up[(up >= 0).all(1)], down[(down >= 0).all(1)]])
    corners = (triangles[None] + (np.arange(20) * len(i))[:, None, None]).reshape(-1)
    return welded(Shape(points.reshape(-1, 3), corners, np.full(20 * len(triangles), 3)))


def globe(segments, rings):
    """The unit sphere by longitude and latitude, with texture coordinates, in quads and triangles at the poles."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, rings + 1)
    profile = np.stack([np.cos(angle), np.sin(angle)], 1)
    profile[[0, -1], 0] = 0
    ball = lathe(profile, segments)
    return ball


def box(size, bottom=True):
    """A box of `size` (x, y, z), centred in x and y, standing on z = 0, in six quads (five without the bottom)."""
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    vertices = [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0), (-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z)]
    faces = [(4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    uv = [(0, 0), (1, 0), (1, 1), (0, 1)] * (6 if bottom else 5)
    return polygons(vertices, faces + [(0, 3, 2, 1)] * bottom, uv)


def rounded_box(size, radius, steps, inner=(1, 1, 1)):
    """A box of `size`, centred in x and y, standing on z = 0, whose edges are rounded by `radius` in `steps` quads
    to each side of an edge, with `inner` quads between along each axis. Its texture coordinates lie on each of the six
    sides."""
    half = np.asarray(size, float) / 2
    shapes = []
    for axis in range(3):
        u_axis, v_axis = (axis + 1) % 3, (axis + 2) % 3
        lines = []
        for a in (u_axis, v_axis):
            low = -half[a] + radius * (1 - np.tan(np.linspace(np.pi / 4, 0, steps + 1)))
            middle = np.linspace(low[-1], -low[-1], inner[a] + 1)[1:-1]
            lines.append(np.concatenate([low, middle, -low[::-1]]))
        u, v = np.meshgrid(*lines, indexing="ij")
        for sign in (1, -1):
            points = np.empty(u.shape + (3,))
            points[..., axis], points[..., u_axis], points[..., v_axis] = sign * half[axis], u, v
            sheet = surface(points)
            sheet.uv = np.stack([(u.ravel()[sheet.corners] / half[u_axis] + 1) / 2,
                                 (v.ravel()[sheet.corners] / half[v_axis] + 1) / 2], 1)
            shapes.append(sheet if sign > 0 else sheet.flipped())
    body = welded(joined(*shapes))
    core = np.clip(body.vertices, radius - half, half - radius)
    body.vertices = core + radius * unit(body.vertices - core)
    return body.moved((0, 0, half[2]))


def thickened(points, thickness):
    """A closed body about the sheet of points (nu, nv, 3): that far behind it, the rim in one row of quads."""
    nu, nv = points.shape[:2]
    normal = unit(np.cross(np.gradient(points, axis=0), np.gradient(points, axis=1)))
    front = surface(points)
    back = surface(points - thickness * normal).flipped()
    i, j = np.arange(nu), np.arange(nv)
    rim = np.concatenate([i[:-1] * nv, (nu - 1) * nv + j[:-1], i[:0:-1] * nv + nv - 1, j[:0:-1]])
    following = np.roll(rim, -1)
    count = nu * nv
    side = np.stack([following, rim, rim + count, following + count], 1)
    both = joined(front, back).without_uv()
    return Shape(both.vertices, np.concatenate([both.corners, side.ravel()]),
                 np.concatenate([both.sizes, np.full(len(side), 4)]))


def frame(width, height, border, depth):
    """A picture or window frame in the xz plane, its opening width × height about the origin, from y = 0 back to
    y = −depth, the border mitred: 16 quads, closed."""
    x, z = width / 2, height / 2
    rings = [[(-a, -c), (a, -c), (a, c), (-a, c)] for a, c in ((x, z), (x + border, z + border))]
    vertices = [(px, -d, pz) for d in (depth, 0) for ring in rings for px, pz in ring]
    faces = []
    for k in range(4):
        n = (k + 1) % 4
        faces += [(4 + k, 4 + n, n, k), (8 + k, 8 + n, 12 + n, 12 + k), (k, n, 8 + n, 8 + k),
                  (12 + k, 12 + n, 4 + n, 4 + k)]
    return polygons(vertices, faces)


def torus_knot(p, q, radius, depth, thickness, steps, sides):
    """A tube along the (p, q) torus knot: p times around the z axis, q times around the tube of radius `depth`."""
    t = np.arange(steps) * (2 * np.pi / steps)
    r = radius + depth * np.cos(q * t)
    path = np.stack([r * np.cos(p * t), r * np.sin(p * t), depth * np.sin(q * t)], 1)
    return tube(path, thickness, sides, closed=True)


def waves(seed, count, low, high):
    """A smooth random function of space: (n, 3) to (n,), about −1 to 1, with wave numbers from low to high (1/m)."""
    random = np.random.RandomState(seed)
    direction = unit(random.normal(size=(count, 3))) * random.uniform(low, high, (count, 1))
    phase = random.uniform(0, 2 * np.pi, count)
    return lambda points: np.sin(points @ direction.T + phase).sum(1) * np.sqrt(2.0 / count) / 1.5


def room(xs, ys, zs, air, open_faces=()):
    """The surface between air and solid cells of a rectilinear grid, looking into the air, in one quad to a cell side.

    `air`: bool (len(xs) − 1, len(ys) − 1, len(zs) − 1). All vertices are shared, so that the room is sealed and no
    two faces overlap. What lies beyond the grid is solid, but for the sides (axis, ±1) named in `open_faces`. Gives
    the shape and, for slots or selection, the face centres and normals."""
    lines = [np.asarray(a, float) for a in (xs, ys, zs)]
    padded = np.pad(air, 1, constant_values=False)
    counts = [len(a) for a in lines]
    faces, normals = [], []
    for axis in range(3):
        u_axis, v_axis = (axis + 1) % 3, (axis + 2) % 3
        ahead = np.take(padded, range(1, padded.shape[axis]), axis)
        behind = np.take(padded, range(padded.shape[axis] - 1), axis)
        inside = [slice(1, -1)] * 3
        inside[axis] = slice(None)
        ahead, behind = ahead[tuple(inside)], behind[tuple(inside)]
        for sign, where in ((1, ahead & ~behind), (-1, behind & ~ahead)):
            where = where.copy()
            edge = [slice(None)] * 3
            for open_axis, open_sign in open_faces:
                if open_axis == axis and open_sign == -sign:
                    edge[axis] = -1 if open_sign > 0 else 0
                    where[tuple(edge)] = False
            cell = np.argwhere(where)
            quad = np.repeat(cell[:, None], 4, 1)
            quad[:, [1, 2], u_axis] += 1
            quad[:, [2, 3], v_axis] += 1
            faces.append(quad if sign > 0 else quad[:, ::-1])
            normal = np.zeros((len(cell), 3))
            normal[:, axis] = sign
            normals.append(normal)
    faces, normals = np.concatenate(faces), np.concatenate(normals)
    flat = np.ravel_multi_index(faces.reshape(-1, 3).T, counts)
    used, corners = np.unique(flat, return_inverse=True)
    index = np.stack(np.unravel_index(used, counts), 1)
    vertices = np.stack([lines[axis][index[:, axis]] for axis in range(3)], 1)
    shape = Shape(vertices, corners.reshape(-1), np.full(len(faces), 4))
    return shape, vertices[shape.corners].reshape(-1, 4, 3).mean(1), normals
