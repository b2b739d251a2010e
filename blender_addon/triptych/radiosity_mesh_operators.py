# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that make and remove the meshes of a radiosity solution, and that find form factors of a chosen element."""

import bpy

from . import data, generated, radiosity, radiosity_mesh, radiosity_play


class _OfMesh:
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return radiosity_play.can_begin(cls, context)

    def execute(self, context):
        if radiosity_play.must_wait(self):
            return {"CANCELLED"}
        try:
            kept = self._elements(context.scene)
            with radiosity.unsuspected(context.scene):
                self._work(context, kept)
        except radiosity_play.FAILURES as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _elements(self, scene):
        """The kept solution of a scene, with elements."""
        for line in radiosity.at_hand(scene):
            self.report({"WARNING"}, line)
        kept = radiosity.kept()
        if kept.info is None or not kept.info.element_count:
            kept.run(kept.solution.prepare)
        for line in kept.news():
            self.report({"WARNING"}, line)
        return kept


class TRIPTYCH_OT_radiosity_mesh(_OfMesh, bpy.types.Operator):
    bl_idname = "triptych.radiosity_mesh"
    bl_label = "Radiosity Mesh"
    bl_description = (
        "Make a mesh of the elements, or bring it up to date: radiosity, irradiance, what is unshot and more "
        "are its attributes. Viewports in Solid mode show its colors. No picture has it in it, but the file that is "
        "saved does"
    )

    def _work(self, context, kept):
        scene, look = context.scene, context.window_manager.triptych_radiosity
        radiosity_mesh.update(scene, kept.solution, look)
        radiosity_mesh.show_colors(anew=True)
        if not look.links:
            generated.remove(scene, generated.LINKS)
        else:
            total = radiosity_mesh.update_links(scene, kept.solution, look.most_links)
            self.report({"INFO"}, f"{min(total, look.most_links)} of {total} links, the largest factors first")


class TRIPTYCH_OT_radiosity_form_factors(_OfMesh, bpy.types.Operator):
    bl_idname = "triptych.radiosity_form_factors"
    bl_label = "Form Factors"
    bl_description = (
        "Find the form factors of the element that is the active face of the radiosity mesh towards each other: the "
        "shares of what leaves it that arrive there. They are shown, and the mesh's attribute form_factor"
    )

    def execute(self, context):
        editing = context.mode == "EDIT_MESH"  # where meshes have no data to be read
        if editing:
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            return super().execute(context)
        finally:
            if editing:
                bpy.ops.object.mode_set(mode="EDIT")

    def _work(self, context, kept):
        made = generated.find(context.scene, generated.MESH)
        if made is None:
            raise data.ExportError("there is no radiosity mesh to choose an element of: press Radiosity Mesh")
        element, total = radiosity_mesh.set_form_factors(made, kept.solution)
        context.window_manager.triptych_radiosity.shown = "form_factor"
        self.report({"INFO"}, f"Element {element}: its form factors add up to {total:.4f}")


class TRIPTYCH_OT_radiosity_clear(bpy.types.Operator):
    bl_idname = "triptych.radiosity_clear"
    bl_label = "Clear Radiosity Mesh"
    bl_description = (
        "Remove the meshes of elements and links from the scene, and their colors from viewports; the solution stays"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return any(generated.find(context.scene, mark) for mark in (generated.MESH, generated.LINKS))

    def execute(self, context):
        generated.remove(context.scene, generated.MESH, generated.LINKS)
        radiosity_mesh.hide_colors()
        return {"FINISHED"}


_CLASSES = (TRIPTYCH_OT_radiosity_mesh, TRIPTYCH_OT_radiosity_form_factors, TRIPTYCH_OT_radiosity_clear)


@bpy.app.handlers.persistent
def _on_change(*_):
    radiosity_mesh.hide_colors()


@bpy.app.handlers.persistent
def _on_undo(*_):
    radiosity_mesh.show_colors()
    radiosity_mesh.hide_colors()


_HANDLERS = {"depsgraph_update_post": _on_change, "undo_post": _on_undo, "redo_post": _on_undo}


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    for name, function in _HANDLERS.items():
        getattr(bpy.app.handlers, name).append(function)


def unregister():
    for name, function in _HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(function)
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
