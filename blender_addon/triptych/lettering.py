# SPDX-License-Identifier: GPL-3.0-or-later
"""Lettering in Blender's own font: as a curve for a scene, and as a mask that the library draws."""

from math import ceil

import bpy

from . import core, data
from .export_mesh import export_mesh

_ASCENT, _DESCENT = 0.8, 0.3  # room above and below the baseline, for a size of 1
_SETTINGS = {"film.transparent": "on", "raster.samples": "32"}


def curve(text, size):
    """A text curve that starts at x = 0, its baseline at y = 0."""
    made = bpy.data.curves.new(text, "FONT")
    made.body, made.size = text, size
    return made


def mask(text, size):
    """A line of text as the part of each pixel that it covers: rows × columns, row 0 at the bottom; size in pixels."""
    mesh = _mesh(text, size)
    width, height = ceil(mesh.positions[:, 0].max()) + 1, ceil((_ASCENT + _DESCENT) * size)
    above = data.IDENTITY.copy()
    above[:, 3] = width / 2, height / 2 - _DESCENT * size, 1
    source = data.Scene(meshes=[mesh], instances=[data.Instance(text, 0, data.IDENTITY)], camera=0)
    source.cameras.append(data.Camera(text, "orthographic", above, "horizontal", width=width))
    with core.Scene() as scene:
        scene.fill(source)
        scene.commit()
        with core.Render(scene, "visible_surface") as render:
            render.set_film(width, height)
            for name, value in _SETTINGS.items():
                render.set(name, value)
            render.run()
            return render.read("Combined", 0, 0, width, height)[..., 3]


def _mesh(text, size):
    """The data.Mesh of the letters. Nothing of it stays in Blender."""
    content = curve(text, size)
    words = bpy.data.objects.new(text, content)
    try:
        return export_mesh(words.to_mesh())
    finally:
        words.to_mesh_clear()
        bpy.data.objects.remove(words)
        bpy.data.curves.remove(content)
