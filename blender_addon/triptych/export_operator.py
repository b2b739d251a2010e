# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Export > Triptych glTF (.glb)."""

import bpy
from bpy_extras.io_utils import ExportHelper

from . import data, gltf


class EXPORT_SCENE_OT_triptych(bpy.types.Operator, ExportHelper):
    """Write the scene, as Triptych renders it, for the command triptych and for other programs"""

    bl_idname = "export_scene.triptych"
    bl_label = "Export Triptych glTF"
    filename_ext = ".glb"
    filter_glob: bpy.props.StringProperty(default="*.glb", options={"HIDDEN"})

    def execute(self, context):
        try:
            warnings = gltf.write(self.filepath, context.scene, context.view_layer.name)
        except (data.ExportError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for line in warnings:
            self.report({"WARNING"}, line)
        return {"FINISHED"}


def _draw(self, context):
    self.layout.operator(EXPORT_SCENE_OT_triptych.bl_idname, text="Triptych glTF (.glb)")


def register():
    bpy.utils.register_class(EXPORT_SCENE_OT_triptych)
    bpy.types.TOPBAR_MT_file_export.append(_draw)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(_draw)
    bpy.utils.unregister_class(EXPORT_SCENE_OT_triptych)
