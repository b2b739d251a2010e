# SPDX-License-Identifier: GPL-3.0-or-later
"""A furnished room made of quads, for benchmarks of radiosity. Metres, Z up.

It is sealed, and its furniture stands off floor, walls and itself, so that no quad is covered by another body and each
row of form factors sums to 1.
"""

import sys

import numpy as np
from figures import ROOT

sys.path.insert(0, str(ROOT / "blender_addon" / "triptych"))
import glb  # noqa: E402

SIZE = (4.0, 3.0, 2.5)
WALL_QUADS = (12, 9, 8)
# Low and high corner, and quads along each side: a table, two benches, a cupboard.
FURNITURE = [
    ((1.2, 0.9, 0.70), (2.8, 2.1, 0.76), (8, 6, 1)),
    ((1.3, 0.3, 0.05), (2.7, 0.7, 0.45), (7, 2, 2)),
    ((1.3, 2.3, 0.05), (2.7, 2.7, 0.45), (7, 2, 2)),
    ((3.3, 0.8, 0.05), (3.9, 2.2, 2.00), (3, 6, 7)),
]
LAMP = ((1.8, 1.3, 1.70), (2.2, 1.7, 1.90), (2, 2, 1))


def box(low, high, counts, inward=False):
    """(n, 4, 3): the quads of a box's six sides, counter-clockwise as seen from where they face."""
    low, high = np.array(low, float), np.array(high, float)
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        i, j = (part.ravel() for part in np.meshgrid(range(counts[u]), range(counts[v]), indexing="ij"))
        for outward, at in ((False, low[axis]), (True, high[axis])):
            corners = np.full((i.size, 4, 3), at)
            for k, (du, dv) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
                corners[:, k, u] = low[u] + (high[u] - low[u]) * (i + du) / counts[u]
                corners[:, k, v] = low[v] + (high[v] - low[v]) * (j + dv) / counts[v]
            quads.append(corners if outward != inward else corners[:, ::-1])
    return np.concatenate(quads)


def room(fineness=1):
    """The quads of the room with its furniture, 966 · fineness², and those of the lamp in it, 16 · fineness²."""

    def cut(counts):
        return [fineness * count for count in counts]

    walls = box((0, 0, 0), SIZE, cut(WALL_QUADS), inward=True)
    furniture = [box(low, high, cut(counts)) for low, high, counts in FURNITURE]
    low, high, counts = LAMP
    return np.concatenate([walls, *furniture]), box(low, high, cut(counts))


def write_glb(path, parts):
    """A mesh of quads and their diffuse material's emission, W/(m² sr), to each part."""
    file = glb.Glb({"version": "2.0"})
    file.json["materials"], primitives = [], []
    for quads, emission in parts:
        points = quads.reshape(-1, 3)[:, (0, 2, 1)] * (1, 1, -1)  # Y up
        # Two triangles that begin with the same corner are one quad.
        corners = 4 * np.arange(len(quads), dtype=np.uint32)[:, None] + np.array((0, 1, 2, 0, 2, 3), np.uint32)
        attributes = {"POSITION": file.accessor(points.astype(np.float32), glb.ARRAY_BUFFER, bounds=True)}
        indices = file.accessor(corners.ravel(), glb.ELEMENT_BUFFER)
        primitives.append({"attributes": attributes, "indices": indices, "material": len(primitives)})
        file.extend(primitives[-1], "FB_ngon_encoding", {})
        coefficients = {"diffuse": 0.6, "specular": 0, "emission": emission}
        file.json["materials"].append({"extras": {"triptych": coefficients}})
    file.json["meshes"] = [{"primitives": primitives}]
    file.json["nodes"] = [{"mesh": 0}]
    file.json["scenes"] = [{"nodes": [0]}]
    file.write(path)
