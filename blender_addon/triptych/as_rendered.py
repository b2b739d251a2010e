# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports a scene exactly as F12 sees it.

Only a render engine is given a depsgraph of Blender's render mode (render visibility, render levels of subdivision), so
one is registered for the moment of the export and asked to render.
"""

from contextlib import contextmanager

import bpy

from . import data, settings
from .export_scene import export_scene

RENDER_SLOT = "Triptych Export"

# What would run after the engine, or in its place.
_SWITCHED_OFF = ("use_compositing", "use_sequencer", "use_freestyle", "use_border", "use_multiview")


def export_as_rendered(scene, view_layer=None, triangulate=False):
    """The data.Scene of a bpy.types.Scene; view_layer: its name, or the active or first one.

    Without a camera Blender does not render: the viewport's depsgraph stands in, with a warning.
    """
    if view_layer is None:
        active = bpy.context.view_layer
        view_layer = active.name if scene.view_layers.get(active.name) == active else scene.view_layers[0].name
    if scene.camera is None:
        depsgraph = scene.view_layers[view_layer].depsgraph
        depsgraph.update()
        result = export_scene(depsgraph, triangulate, require_camera=False)
        result.warn(f"scene '{scene.name}': there is no camera; what the viewport shows is exported")
        return result

    done = {}

    class Exporter(bpy.types.RenderEngine):
        bl_idname = "TRIPTYCH_EXPORT"
        bl_label = "Triptych Export"

        def render(self, depsgraph):
            try:
                done["scene"] = export_scene(depsgraph, triangulate, require_camera=False)
            except Exception as error:  # handed on below: Blender would only print it
                done["error"] = error
            self.end_result(self.begin_result(0, 0, self.resolution_x, self.resolution_y))

    render = scene.render
    before = {name: getattr(render, name) for name in ("engine", *_SWITCHED_OFF)}
    bpy.utils.register_class(Exporter)
    try:
        render.engine = Exporter.bl_idname
        for name in _SWITCHED_OFF:
            setattr(render, name, False)
        with _render_result_kept():
            bpy.ops.render.render(layer=view_layer, scene=scene.name)
    finally:
        for name, value in before.items():
            setattr(render, name, value)
        bpy.utils.unregister_class(Exporter)
    if "error" in done:
        raise done["error"]
    if "scene" not in done:
        raise data.ExportError(f"scene '{scene.name}': Blender did not start the export")
    return done["scene"]


def export_to_render(scene, view_layer=None):
    """As export_as_rendered, for a render by the add-on itself: with the scene's number of threads among the settings.

    ExportError where there is no camera to render from.
    """
    if scene.camera is None:
        raise data.ExportError(f"scene '{scene.name}': there is no camera")
    result = export_as_rendered(scene, view_layer)
    if result.camera == data.NONE:
        raise data.ExportError(result.warnings[0])  # of the camera, which is exported first
    settings.set_threads(result.settings, scene)
    return result


def no_render_runs(operator):
    """For the poll of an operator that exports, which a render that is running would not let it do."""
    if bpy.app.is_job_running("RENDER"):
        operator.poll_message_set("A render is running")
        return False
    return True


@contextmanager
def _render_result_kept():
    """The export goes by way of a render; it gets a slot of its own, so that the user's picture stays."""
    result = bpy.data.images.get("Render Result")
    if result is None:
        yield
        return
    slots = result.render_slots
    before = slots.active_index
    names = [slot.name for slot in slots]
    if RENDER_SLOT not in names:
        names.append(slots.new(name=RENDER_SLOT).name)
    slots.active_index = names.index(RENDER_SLOT)
    try:
        yield
    finally:
        slots.active_index = before
