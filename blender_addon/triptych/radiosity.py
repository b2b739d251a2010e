# SPDX-License-Identifier: GPL-3.0-or-later
"""The radiosity solution of the last render or step, kept while the scene stands: a walk of the camera solves once.

It is gone on with by renders, on their thread, or step by step, on a thread of its own.
"""

import threading
from contextlib import contextmanager

import bpy

from . import abi, core, data, settings
from .as_rendered import export_as_rendered

# What a solution does not depend on.
_VIEW = (
    "radiosity.view",
    "radiosity.view_scale",
    "radiosity.view_element",
    "radiosity.legend",
    "radiosity.mesh",
    "radiosity.smooth",
    "radiosity.ambient",
)


class Kept:
    """A core.Radiosity, what it is of and how far it is.

    scene: the name of its bpy.types.Scene; info: abi.RadiosityInfo after the last step, or None before the first;
    suspect: whether its scene may have changed since it was last compared; outdated: whether it had changed then.
    """

    def __init__(self, scene, values, solution):
        self.scene, self.solution = scene, solution
        self.values = _that_matter(values)
        self.info = None
        self.suspect = self.outdated = False
        self._thread = self._error = None
        self._stopping = self._closing = False
        self._in_use = threading.Lock()
        self._told = 0
        for name, value in values.items():
            solution.set(name, value)

    @property
    def solver(self):
        return self.values.get("radiosity.solver") or next(
            setting.default for setting in core.settings() if setting.name == "radiosity.solver"
        )

    @property
    def limit(self):
        """The number of steps after which it is not gone on with by itself; 0: none."""
        return int(self.values.get("radiosity.iterations", 0))

    def run(self, call, *arguments, progress=None):
        """Calls a method of the solution that advances it; False where that was cancelled."""

        def go_on(state):
            return not self._closing and (progress is None or progress(state))

        with self._in_use:
            if self._closing:
                return False
            try:
                return call(*arguments, progress=go_on)
            finally:
                self.info = self.solution.info()

    def is_shown_by(self, render):
        """Has a core.Render show it; False where that is of another scene, or there is nothing to show."""
        with self._in_use:
            if self._closing:
                return False
            try:
                render.show(self.solution)
            except abi.Error as error:
                if error.status != "STATE":
                    raise
                return False
            return True

    def close(self):
        """Gives the memory back, whoever runs it."""
        self._closing = True
        with self._in_use:
            self.solution.close()

    def start(self, steps):
        """Goes on by so many steps on a thread, which has nothing to do with Blender: a step may take seconds."""
        self._stopping = False
        self._thread = threading.Thread(target=self._step, args=(steps,))
        self._thread.start()

    def _step(self, steps):
        try:
            self.run(self.solution.step, steps, progress=lambda _: not self._stopping)
        except Exception as error:  # finish() raises it
            self._error = error

    def busy(self):
        """Whether what was started still runs."""
        return self._thread is not None and self._thread.is_alive()

    def wait(self):
        """Waits for what was started."""
        if self._thread is not None:
            self._thread.join()

    def finish(self):
        """As wait(), and raises what that raised."""
        self.wait()
        error, self._error = self._error, None
        if error is not None:
            raise error

    def stop(self):
        """Ends what was started; what was found by then stands."""
        self._stopping = True
        self.wait()

    def news(self):
        """The lines of warnings that were not told yet."""
        with self._in_use:
            lines = [] if self._closing else self.solution.warnings()[self._told :]
        self._told += len(lines)
        return lines


_kept = None
_as_it_is = False


def kept():
    """The Kept, or None."""
    return _kept


def forget(*_):
    """Gives the memory back."""
    global _kept
    before, _kept = _kept, None
    if before is not None:
        before.close()


def _that_matter(values):
    return {name: value for name, value in values.items() if _matters(name)}


def _matters(name):
    return name in ("seed", "shadows") or (name.startswith(("radiosity.", "shading.")) and name not in _VIEW)


def _stands(render, values):
    """Whether the Kept is what a core.Render of these settings would find."""
    _kept.stop()
    _kept.outdated = _kept.values != _that_matter(values) or not _kept.is_shown_by(render)
    return not _kept.outdated


def _begin(name, scene, values):
    global _kept
    forget()
    _kept = Kept(name, values, core.Radiosity(scene))


# -------------------------------------------------------------------------------------------------------------- renders


def show(name, scene, render, values, progress, report):
    """Has a core.Render show the solution of its core.Scene with these settings, found now or before.

    name: of the bpy.types.Scene. Where it was cancelled, the render shows what there was by then, and what is missing
    is found the next time; False where that is nothing. report: takes lines of warnings.
    """
    stands = _kept is not None and _stands(render, values)
    if _as_it_is:
        if not stands:
            raise data.ExportError(f"scene '{name}' has changed since its radiosity was found")
        return True
    if not stands:
        _begin(name, scene, values)
    kept = _kept  # which another thread may take away
    kept.scene = name
    kept.run(kept.solution.solve, progress=progress)
    report(kept.news())
    if kept.is_shown_by(render):
        return True
    forget()
    return False


@contextmanager
def as_it_is():
    """Renders show the solution without going on with it."""
    global _as_it_is
    _as_it_is = True
    try:
        yield
    finally:
        _as_it_is = False


# ---------------------------------------------------------------------------------------------------------------- steps


def at_hand(source):
    """Sees to it that the Kept is of a bpy.types.Scene as it stands now. Gives warnings where it is begun anew."""
    exported = _export(source)
    with core.Scene() as scene:
        if _compare(scene, exported):
            return []
        _begin(source.name, scene, exported.settings)
        return exported.warnings + scene.warnings()


def stands(source):
    """Whether the Kept, which was compared before, is of a bpy.types.Scene as it stands now."""
    _evaluate(source)
    if _kept.suspect:
        with core.Scene() as scene:
            _compare(scene, _export(source))
    return not _kept.outdated


def _export(source):
    abi.library()
    exported = export_as_rendered(source)
    _evaluate(source)
    if _kept is not None:
        _kept.suspect = False
    settings.set_threads(exported.settings, source)
    return exported


def _compare(scene, exported):
    """Fills a core.Scene and compares the Kept with it."""
    scene.fill(exported)
    scene.commit(int(exported.settings.get("threads", 0)))
    if _kept is None:
        return False
    with core.Render(scene, "radiosity") as render:
        return _stands(render, exported.settings)


@contextmanager
def unsuspected(source):
    """What is changed in a bpy.types.Scene within, to show the solution, is no reason to suspect it."""
    _evaluate(source)  # what the user has changed before
    before = _kept.suspect
    try:
        yield
    finally:
        _evaluate(source)
        _kept.suspect = before


def _evaluate(source):
    """Has handlers called for what has changed."""
    if bpy.context.scene == source:
        bpy.context.view_layer.update()


# ------------------------------------------------------------------------------------------------------------- handlers


@bpy.app.handlers.persistent
def _on_load(*_):
    forget()


@bpy.app.handlers.persistent
def _on_change(*_):
    if _kept is not None:
        _kept.suspect = True
        if _kept.scene not in bpy.data.scenes:
            forget()


_HANDLERS = {
    "load_pre": _on_load,
    **dict.fromkeys(("depsgraph_update_post", "frame_change_post", "undo_post", "redo_post"), _on_change),
}


def register():
    for name, function in _HANDLERS.items():
        getattr(bpy.app.handlers, name).append(function)


def unregister():
    for name, function in _HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(function)
    forget()
