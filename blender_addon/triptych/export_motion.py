# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves while the shutter is open: transforms and meshes of a scene at several times."""

from math import floor

import numpy as np

from . import compat
from .transforms import rows

METHODS = frozenset({"ray_casting", "ray_tracing", "path_tracing"})  # those that blur motion


class Shutter:
    """The times of a frame's shutter, evenly spaced, and the way to them.

    scene: a bpy.types.Scene; frame_set(frame, subframe): brings its depsgraph to another time.
    """

    def __init__(self, scene, frame_set):
        render, steps = scene.render, scene.triptych.motion_steps
        self.now = scene.frame_current + scene.frame_subframe
        before = {"START": 0.0, "CENTER": 0.5, "END": 1.0}[getattr(render, "motion_blur_position", "CENTER")]
        length = render.motion_blur_shutter
        self.times = [self.now + length * (step / (steps - 1) - before) for step in range(steps)]
        self._frame_set = frame_set

    def go_to(self, time):
        """Frames, with a fraction."""
        self._frame_set(floor(time), time - floor(time))


class Motion:
    """Gathers where things are at the times of a shutter.

    places: {key: (item of data.py, the name of its transform)}; meshes: {key: data.Mesh} of those that may bend.
    """

    def __init__(self, places, meshes):
        self.places = places
        self.meshes = meshes
        self._transforms = {key: [] for key in places}
        self._positions = {id(mesh): [] for mesh in meshes.values()}
        self._noted = set()  # meshes, which several objects may show

    def begin_time(self):
        """What is noted next is at another time."""
        self._noted.clear()

    def note(self, key, matrix, mesh=None):
        """What is at the time that has been gone to: a matrix, and for what may bend a bpy.types.Mesh."""
        if key in self.places:
            self._transforms[key].append(rows(matrix))
        number = id(self.meshes.get(key))
        if key in self.meshes and number not in self._noted:
            self._noted.add(number)
            self._positions[number].append(compat.mesh_positions(mesh))

    def finish(self, steps, warn):
        """Gives items that were there at all times, and have moved, their motion."""
        for key, (item, name) in self.places.items():
            found = self._transforms[key]
            if len(found) == steps and any((matrix != found[0]).any() for matrix in found):
                setattr(item, name, np.stack(found))
        for mesh in {id(mesh): mesh for mesh in self.meshes.values()}.values():
            found = self._positions[id(mesh)]
            if len(found) != steps or any(len(positions) != len(mesh.positions) for positions in found):
                warn(f"mesh '{mesh.name}': its vertices are not the same while the shutter is open; it is not blurred")
            elif any((positions != found[0]).any() for positions in found):
                mesh.positions = np.stack(found)


def may_bend(shown):
    """Whether an evaluated object's mesh may change with time."""
    source = shown.original
    return bool(source.modifiers) or getattr(source.data, "shape_keys", None) is not None
