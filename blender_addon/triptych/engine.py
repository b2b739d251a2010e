# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: final renders and material previews."""

import sys
import time

import bpy
import numpy as np

from . import abi, compat, core, data, export_motion, properties, radiosity, settings
from .export_scene import export_scene, film_size

_DISPLAY_SECONDS = 0.2  # between updates of the picture while it renders
_PREVIEW_METHODS = ("ray_tracing", "ray_casting")  # the first that the library has
_PREVIEW_SETTINGS = {"samples": "16"}


class TriptychEngine(bpy.types.RenderEngine):
    bl_idname = "TRIPTYCH"
    bl_label = "Triptych"
    bl_use_preview = True
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False
    bl_use_postprocess = True

    last_error = ""  # of the last render, empty where it went well: the operator tells a script nothing

    def update_render_passes(self, scene=None, renderlayer=None):
        """Declares the passes that the view layer asks for and the method gives."""
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for row, name in properties.wanted_passes(renderlayer, scene.triptych.method):
            kind = "COLOR" if row.channels.startswith("RGB") else "VECTOR" if row.channel_count > 1 else "VALUE"
            self.register_pass(scene, renderlayer, name, row.channel_count, row.channels, kind)

    def render(self, depsgraph):
        """Renders one view layer. Blender crashes where no result is begun and ended, so that one always is."""
        job = _Job(self, depsgraph)
        try:
            message = job.run()
        except (abi.LibraryMissing, abi.Error, data.ExportError) as error:
            message = str(error)
        except Exception as error:
            import traceback

            traceback.print_exc()
            message = f"{type(error).__name__}: {error} (a fault of the add-on; please report it)"
        job.finish()
        if message:
            self.error_set(f"Triptych: {message}")
            if bpy.app.background:  # where nobody sees the report
                print(f"Triptych: error: {message}", file=sys.stderr, flush=True)
        TriptychEngine.last_error = message


class _Job:
    """One call of render()."""

    def __init__(self, engine, depsgraph):
        self.engine = engine
        self.depsgraph = depsgraph
        self.finished = False
        self.passes = []  # (core.Pass, Blender's name), without Combined
        self.render = None
        scene = depsgraph.scene
        self.film = film_size(scene.render)
        self.window = (0, 0, *self.film) if engine.is_preview else window(scene.render, self.film)
        self.shown = time.monotonic()

    def run(self):
        """Renders, and gives a message where something went wrong that is no exception."""
        engine, depsgraph = self.engine, self.depsgraph
        method, values = self._settings()
        engine.update_stats("", "Exporting the scene")
        scene = export_scene(depsgraph, shutter=self._shutter(method))
        if self.stopped():
            return ""
        threads = int(values.get("threads", 0))
        with core.Scene() as core_scene:
            engine.update_stats("", "Preparing the scene")
            core_scene.fill(scene)
            del scene.meshes[:], scene.textures[:]  # the core has its own copy now
            core_scene.commit(threads)
            if self.stopped():
                return ""
            self._report(scene.warnings + core_scene.warnings())
            with core.Render(core_scene, method) as render:
                self.render = render
                try:
                    self._render(core_scene, method, values)
                finally:
                    self.render = None
        return ""

    def _render(self, core_scene, method, values):
        engine, render = self.engine, self.render
        render.set_film(*self.film, self.window)
        for name, value in values.items():
            render.set(name, value)
        if not engine.is_preview:
            self.passes = properties.wanted_passes(self.depsgraph.view_layer, method)
        for row, _ in self.passes:
            render.add_pass(row.name)
        if method == "radiosity":
            name = self.depsgraph.scene.name
            if not radiosity.show(name, core_scene, render, values, self._progress, self._report):
                return
        elif not engine.is_preview:
            radiosity.forget()
        if self.stopped():  # a solution that is not whole is shown without asking again
            render.run()
        else:
            render.run(self._progress, None if bpy.app.background else self._tile)
        self.finish()

    def _shutter(self, method):
        """None where nothing is to be blurred."""
        source = self.depsgraph.scene
        if self.engine.is_preview or not source.render.use_motion_blur or method not in export_motion.METHODS:
            return None
        return export_motion.Shutter(source, self.engine.frame_set)

    def stopped(self):
        """Whether the user has cancelled."""
        return self.engine.test_break()

    def _settings(self):
        """(method, {setting: text})"""
        source = self.depsgraph.scene
        if self.engine.is_preview:
            known = [name for name, _, _ in core.methods()]
            return next((name for name in _PREVIEW_METHODS if name in known), known[0]), dict(_PREVIEW_SETTINGS)
        values = settings.changed(source)
        settings.set_threads(values, source)
        return source.triptych.method, values

    def _report(self, warnings):
        if not self.engine.is_preview:
            for line in warnings:
                self.engine.report({"WARNING"}, f"Triptych: {line}")

    # ----------------------------------------------------------------------------------- callbacks, on Blender's thread

    def _progress(self, progress):
        engine = self.engine
        engine.update_progress(progress.fraction)
        line = progress.stage.decode(errors="replace")
        if progress.pass_count > 1:
            line += f" | Pass {min(progress.pass_ + 1, progress.pass_count)}/{progress.pass_count}"
        elif progress.stage == b"Solving":
            line += f" | Iteration {progress.pass_}"
        if progress.seconds_left >= 0:
            line += f" | Remaining {_clock(progress.seconds_left)}"
        engine.update_stats("", line)
        return not self.stopped()

    def _tile(self, tile):
        """Shows a tile of the first pass over the film as it comes, later passes as a whole now and then."""
        if tile.pass_ == 0:
            self._show(tile.x, tile.y, tile.width, tile.height)
        elif time.monotonic() - self.shown > _DISPLAY_SECONDS:
            self._show(*self.window)
            self.shown = time.monotonic()
        return not self.stopped()

    def _show(self, x, y, width, height):
        """Puts a rectangle of the film, with Combined alone, into Blender's picture."""
        result = self._begin(x, y, width, height)
        try:
            self._put(result, x, y, (("Combined", "Combined", 4),))
        finally:
            self.engine.end_result(result)

    def _begin(self, x, y, width, height):
        layer = self.depsgraph.view_layer.name
        return self.engine.begin_result(x - self.window[0], y - self.window[1], width, height, layer=layer)

    def _put(self, result, x, y, passes):
        """Copies passes (the library's name, Blender's name, channels) into a result whose corner is at (x, y)."""
        if not result.layers:
            return
        width, height = result.resolution_x, result.resolution_y
        found = result.layers[0].passes
        for name, blender_name, channels in passes:
            if blender_name in found:
                compat.set_pass(found[blender_name], self.render.read(name, x, y, width, height, channels))

    def finish(self):
        """Hands the whole result over, once; black where there is none."""
        if self.finished:
            return
        self.finished = True
        result = self._begin(*self.window)
        try:
            if self.render is not None:
                passes = [(row.name, name, row.channel_count) for row, name in self.passes]
                self._put(result, *self.window[:2], [("Combined", "Combined", 4), *passes])
        finally:
            self.engine.end_result(result)


def window(render, film):
    """(x, y, width, height) of the border, or of the whole film, in pixels from the bottom left."""
    if not render.use_border:
        return (0, 0, *film)

    def pixels(least, most, size):
        # Blender's own rounding: down, in single precision.
        first = min(int(np.float32(least) * np.float32(size)), size - 1)
        return first, max(int(np.float32(most) * np.float32(size)) - first, 1)

    x, width = pixels(render.border_min_x, render.border_max_x, film[0])
    y, height = pixels(render.border_min_y, render.border_max_y, film[1])
    return x, y, width, height


def _clock(seconds):
    minutes, seconds = divmod(int(seconds + 0.5), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes:02}:{seconds:02}"


def register():
    bpy.utils.register_class(TriptychEngine)


def unregister():
    bpy.utils.unregister_class(TriptychEngine)
