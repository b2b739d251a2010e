# SPDX-License-Identifier: GPL-3.0-or-later
"""The radiosity solution of the last render, kept as long as the scene stands: a walk of the camera solves once."""

import bpy

from . import abi, core

# What a solution does not depend on.
_VIEW = ("radiosity.view", "radiosity.view_scale", "radiosity.mesh", "radiosity.smooth", "radiosity.ambient")

_kept = None  # (settings, core.Radiosity)


def show(scene, render, values, progress):
    """Has a core.Render show the solution of its core.Scene with these settings, found now or before.

    Where that was cancelled, the render shows what there was by then, and what is missing is found the next time; False
    where that is nothing.
    """
    global _kept
    settings = {name: value for name, value in values.items() if _matters(name)}
    if _kept is not None and not (_kept[0] == settings and _fits(render, _kept[1])):
        forget()
    if _kept is None:
        _kept = (settings, core.Radiosity(scene))
        for name, value in values.items():
            _kept[1].set(name, value)
    _kept[1].solve(progress)
    if not _fits(render, _kept[1]):
        forget()
    return _kept is not None


def forget(*_):
    """Gives the memory back."""
    global _kept
    if _kept is not None:
        _kept[1].close()
        _kept = None


def _matters(name):
    return name in ("seed", "shadows") or (name.startswith(("radiosity.", "shading.")) and name not in _VIEW)


def _fits(render, solution):
    try:
        render.show(solution)
    except abi.Error as error:
        if error.status != "STATE":
            raise
        return False
    return True


@bpy.app.handlers.persistent
def _on_load(*_):
    forget()


def register():
    bpy.app.handlers.load_pre.append(_on_load)


def unregister():
    bpy.app.handlers.load_pre.remove(_on_load)
    forget()
