# SPDX-License-Identifier: GPL-3.0-or-later
"""Radiosity step by step: a step, or play until it is solved, with what shows the solution refreshed after each."""

import traceback

import bpy

from . import abi, data, generated, radiosity, radiosity_mesh
from .as_rendered import no_render_runs

METHOD = "radiosity"
_TICK = 0.05  # seconds between looks at whether a step is done
FAILURES = (abi.LibraryMissing, abi.Error, data.ExportError)

# What a refresh of the picture leaves out of what a render does.
_LEFT_OUT = ("use_compositing", "use_sequencer")


# -------------------------------------------------------------------------------------------------------------- refresh


def refresh(scene, solution, look):
    """Brings the mesh, the links and the picture up to date, as `look` (window_manager.triptych_radiosity) asks; links
    that it does not ask for are removed, and a scene that has changed has no picture.

    Gives what there is to say of meshes that are left for their being edited. ExportError where there is no picture.
    """
    draws = look.picture and radiosity.stands(scene)
    with radiosity.unsuspected(scene):
        edited = radiosity_mesh.edited(scene)
        if not edited:
            _refresh_meshes(scene, solution, look)
        if draws:
            _render(scene)
    return edited


def _refresh_meshes(scene, solution, look):
    if look.mesh:
        radiosity_mesh.update(scene, solution, look)
    if look.links:
        radiosity_mesh.update_links(scene, solution, look.most_links)
    else:
        generated.remove(scene, generated.LINKS)


def _render(scene):
    if scene.camera is None:
        raise data.ExportError(f"scene '{scene.name}': there is no camera to render the picture from")
    render = scene.render
    before = {name: getattr(render, name) for name in _LEFT_OUT}
    try:
        for name in _LEFT_OUT:
            setattr(render, name, False)
        with radiosity.as_it_is():
            bpy.ops.render.render(scene=scene.name)
        bpy.data.images["Render Result"].reload()  # else Image Editors draw what they have
    finally:
        for name, value in before.items():
            setattr(render, name, value)


def redraw(context):
    """Has the panel and what shows the solution drawn again."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"PROPERTIES", "VIEW_3D", "IMAGE_EDITOR"}:
                area.tag_redraw()


def is_chosen(scene):
    """Whether a scene is rendered by radiosity."""
    return scene.render.engine == "TRIPTYCH" and scene.triptych.method == METHOD


# ----------------------------------------------------------------------------------------------------------------- play


class Player:
    """Goes on with the kept solution of a scene while the user works: steps on a thread, refreshes at ticks of a timer.

    edited: see refresh(); message: why it ended, where that was no wish of the user's; failed: whether that was an
    error.
    """

    def __init__(self, context, refreshes):
        self.scene = context.scene.name
        self.left = refreshes  # None: until it is solved
        self.started = self.shown = self.paused = False
        self.edited, self.message, self.failed = "", "", False

    def tick(self, context):
        """Does what there is to be done; False at the end."""
        if bpy.app.is_job_running("RENDER"):  # which has the solution
            return True
        if self.paused:
            return False
        try:
            return self._go_on(context)
        except FAILURES as error:
            return self._fail(str(error))
        except Exception as error:
            traceback.print_exc()
            return self._fail(f"{type(error).__name__}: {error} (a fault of the add-on; please report it)")

    def pause(self):
        """The next tick ends it."""
        self.paused = True

    def break_off(self, context):
        """Shows what a step found that was ended, if there are elements by then."""
        scene, kept = bpy.data.scenes.get(self.scene), radiosity.kept()
        if self.started and scene is not None and kept is not None:
            try:
                kept.finish()
                if kept.info is not None and kept.info.element_count:
                    self._show(context, scene, kept)
            except FAILURES as error:
                self._fail(str(error))

    def _go_on(self, context):
        scene, kept = bpy.data.scenes.get(self.scene), radiosity.kept()
        if scene is None:
            return self._end(f"scene '{self.scene}' is gone")
        if not is_chosen(scene):
            return self._end(f"scene '{self.scene}' is no longer rendered by radiosity")
        if kept is None or kept.scene != self.scene:
            return self._end("the solution was given back")
        if kept.busy():
            return True
        if self.started:
            self._show(context, scene, kept)
            if self.left is not None:
                self.left -= 1
        if not radiosity.stands(scene):
            return self._end(f"scene '{self.scene}' has changed: the next step begins anew")
        if self.left == 0 or is_done(kept, self.left is None):
            if not self.shown:  # of what a render has solved
                self._show(context, scene, kept)
            return False
        steps = context.window_manager.triptych_radiosity.steps
        kept.start(steps_left(kept, steps, self.left is None))
        self.started = True
        return True

    def _show(self, context, scene, kept):
        self.started, self.shown = False, True
        kept.finish()
        self.edited = refresh(scene, kept.solution, context.window_manager.triptych_radiosity)
        redraw(context)

    def _end(self, message):
        self.message = message
        return False

    def _fail(self, message):
        self.failed = True
        return self._end(message)


def is_done(kept, limited):
    """Whether there is no step left; limited: by the setting radiosity.iterations too."""
    info = kept.info
    return info is not None and (info.solved or (limited and 0 < kept.limit <= info.iterations))


def end_of(info):
    """What follows the number of iterations, of an abi.RadiosityInfo."""
    if not info.solved:
        return ""
    return ", ended at its limit" if info.limited else ", solved"


def steps_left(kept, steps, limited):
    """So many steps, or those that the setting radiosity.iterations leaves."""
    done = kept.info.iterations if kept.info is not None else 0
    return min(steps, kept.limit - done) if limited and kept.limit else steps


_player = None
_timer = None


def is_playing():
    return _player is not None


def begin(context, refreshes):
    """Makes the player, of the solution at hand or of a new one. Gives warnings, and raises one of FAILURES."""
    global _player
    warnings = radiosity.at_hand(context.scene)
    _player = Player(context, refreshes)
    return warnings


def stop():
    """Pauses; what was found stands."""
    global _player, _timer
    _player = None
    if _timer is not None:
        bpy.context.window_manager.event_timer_remove(_timer)
        _timer = None
    kept = radiosity.kept()
    if kept is not None:
        kept.stop()


# ------------------------------------------------------------------------------------------------- operators that step


def can_begin(operator, context):
    """For polls: whether the scene is one for radiosity, and no render runs.

    Not whether a step does, see must_wait(): a button that turns grey under the mouse stays so until it leaves.
    """
    if not is_chosen(context.scene):
        operator.poll_message_set("The method is not radiosity")
        return False
    return no_render_runs(operator)


def must_wait(operator):
    """Whether a step runs, which the operator tells."""
    if is_playing():
        operator.report({"INFO"}, "A step is running")
    return is_playing()


class _Advance:
    """An operator that goes on with the solution, modal where there is a user to work on meanwhile."""

    bl_options = {"REGISTER", "UNDO"}
    refreshes = None  # after which it ends; None: when it is solved

    @classmethod
    def poll(cls, context):
        return can_begin(cls, context)

    def execute(self, context):
        return self._run(context) if self._begin(context) else {"CANCELLED"}

    def invoke(self, context, event):
        return self._run_modal(context) if self._begin(context) else {"CANCELLED"}

    def _begin(self, context):
        """Makes the player; False where that fails, and the reason is told."""
        if must_wait(self):
            return False
        try:
            for line in begin(context, self.refreshes):
                self.report({"WARNING"}, line)
        except FAILURES as error:
            self.report({"ERROR"}, str(error))
            return False
        return True

    def _run(self, context):
        """All of it at once, for scripts."""
        while _player.tick(context):
            radiosity.kept().wait()
        return self._end(context)

    def _run_modal(self, context):
        global _timer
        _timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        redraw(context)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if _player is None:  # paused, or all was taken back
            redraw(context)
            return {"FINISHED"}
        if event.type == "ESC" and event.value == "PRESS" and not bpy.app.is_job_running("RENDER"):
            return self._end(context)
        if event.type == "TIMER" and not _player.tick(context):
            return self._end(context)
        return {"PASS_THROUGH"}

    def cancel(self, context):
        stop()

    def _end(self, context):
        player, kept = _player, radiosity.kept()
        stop()
        player.break_off(context)
        redraw(context)
        for line in kept.news() if kept is not None else ():
            self.report({"WARNING"}, line)
        if player.message:
            self.report({"ERROR" if player.failed else "WARNING"}, player.message)
        elif kept is not None:
            self.report({"INFO"}, player.edited or _told(kept.info))
        return {"FINISHED"} if player.shown else {"CANCELLED"}


def _told(info):
    if info is None or not (info.element_count or info.solved):
        return "Radiosity: ended before there were elements"
    return f"Radiosity: iteration {info.iterations}, {info.element_count} elements{end_of(info)}"


class TRIPTYCH_OT_radiosity_step(_Advance, bpy.types.Operator):
    bl_idname = "triptych.radiosity_step"
    bl_label = "Step"
    bl_description = (
        "Go on by a step: a shot of the progressive solver, a sweep over the matrix, or a refinement of the "
        "hierarchy. Esc ends it"
    )

    refreshes = 1


class TRIPTYCH_OT_radiosity_play(_Advance, bpy.types.Operator):
    bl_idname = "triptych.radiosity_play"
    bl_label = "Play"
    bl_description = "Go on step by step until it is solved, or pause. Esc pauses too"

    def execute(self, context):
        return self._pause() if is_playing() else super().execute(context)

    def invoke(self, context, event):
        return self._pause() if is_playing() else super().invoke(context, event)

    def _pause(self):
        _player.pause()
        return {"CANCELLED"}  # the undo step is that of the play


class TRIPTYCH_OT_radiosity_reset(bpy.types.Operator):
    bl_idname = "triptych.radiosity_reset"
    bl_label = "Reset"
    bl_description = "Give the solution back: the next step or render begins anew. What is shown of it stays until then"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        return radiosity.kept() is not None and no_render_runs(cls)

    def execute(self, context):
        stop()
        radiosity.forget()
        redraw(context)
        return {"FINISHED"}


_CLASSES = (TRIPTYCH_OT_radiosity_step, TRIPTYCH_OT_radiosity_play, TRIPTYCH_OT_radiosity_reset)


@bpy.app.handlers.persistent
def _on_load(*_):
    stop()


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.app.handlers.load_pre.append(_on_load)


def unregister():
    stop()
    bpy.app.handlers.load_pre.remove(_on_load)
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
