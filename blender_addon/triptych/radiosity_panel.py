# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of a radiosity solution: step, play and reset, how far it is, and as what it is shown.

What is chosen here stands in the window manager, which no file keeps.
"""

from decimal import Decimal

import bpy

from . import generated, radiosity, radiosity_mesh, radiosity_play
from .panels import ENGINE

_VALUES = (
    ("radiosity", "Radiosity", "What leaves the surface, W/m²"),
    ("irradiance", "Irradiance", "What arrives, W/m²"),
    ("unshot", "Unshot", "Radiosity that the progressive solver has still to shoot, W/m²"),
    ("emission", "Emission", "What the surface emits itself, W/m²"),
    ("reflectance", "Reflectance", "The share of what arrives that is reflected"),
    ("form_factor", "Form Factor", "The share of what leaves the chosen element that arrives at each"),
)
# What TrpRadiosityInfo.residual is.
_RESIDUALS = {
    "matrix": "{:.3g} of the greatest changed",
    "progressive": "{:.3g} unshot",
    "hierarchical": "{:.3g} W/m² (estimated)",
}
_UNUSED = {"matrix": {"Links", "Unshot"}, "progressive": {"Links"}, "hierarchical": {"Unshot"}}


def _recolor(look, context):
    scene = context.scene
    made = generated.find(scene, generated.MESH)
    if made is not None and not made.data.is_editmode:
        radiosity_mesh.color(made.data, look.shown, look.scale, scene.triptych.radiosity_smooth)


class TriptychRadiosityLook(bpy.types.PropertyGroup):
    steps: bpy.props.IntProperty(
        name="Steps", description="So many steps are made before what is shown is refreshed", default=1, min=1
    )
    mesh: bpy.props.BoolProperty(name="Mesh", description="Refresh the mesh of the elements", default=True)
    links: bpy.props.BoolProperty(
        name="Links", description="Refresh the mesh of the hierarchical solver's links; off: it goes"
    )
    picture: bpy.props.BoolProperty(
        name="Picture", description="Refresh the picture in the Image Editor, by a render that solves no further"
    )
    shown: bpy.props.EnumProperty(
        name="Color", description="What viewports in Solid mode show", items=_VALUES, update=_recolor
    )
    scale: bpy.props.FloatProperty(
        name="White",
        description=(
            "The value that is shown as white, of form factors by the elements' areas. "
            "0: π W/m², as in pictures; 1 for reflectance; four times the mean form factor"
        ),
        min=0,
        update=_recolor,
    )
    most_links: bpy.props.IntProperty(
        name="Most Links", description="Of more than these, the largest are shown", default=10000, min=1, soft_max=10**6
    )


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {ENGINE}


class TRIPTYCH_RENDER_PT_radiosity_solution(_Panel, bpy.types.Panel):
    bl_label = "Solution"
    bl_order = -8

    @classmethod
    def poll(cls, context):
        return radiosity_play.is_chosen(context.scene)

    def draw(self, context):
        layout, playing = self.layout, radiosity_play.is_playing()
        row = layout.row(align=True)
        row.operator("triptych.radiosity_step", icon="FRAME_NEXT")
        row.operator(
            "triptych.radiosity_play", text="Pause" if playing else "Play", icon="PAUSE" if playing else "PLAY"
        )
        row.operator("triptych.radiosity_reset", text="", icon="LOOP_BACK")
        kept = radiosity.kept()
        if kept is None or kept.info is None:
            layout.label(text="Working" if playing else "Nothing is solved yet", icon="SORTTIME" if playing else "NONE")
            return
        if kept.scene != context.scene.name:
            layout.label(text=f"Of scene '{kept.scene}'", icon="INFO")
        elif kept.outdated:
            layout.label(text="Of the scene before it changed", icon="INFO")
        column = layout.column(align=True)
        for name, value in state(kept):
            line = column.split(factor=0.35)
            left = line.row()
            left.alignment = "RIGHT"
            left.label(text=name)
            line.label(text=value)


def state(kept):
    """[(name, value)] of how far a radiosity.Kept is."""
    info = kept.info
    iterations = str(info.iterations) + (f" of {kept.limit}" if kept.limit else "")
    rows = [
        ("Iteration", iterations + radiosity_play.end_of(info)),
        ("Elements", f"{info.element_count:,}"),
        ("Links", f"{info.links:,}"),
        ("Residual", _RESIDUALS[kept.solver].format(info.residual)),
        ("Rays", f"{info.rays:,}"),
        ("Power", _watts(info.power)),
        ("Unshot", _watts(info.unshot)),
        ("Time", f"{info.seconds:.2f} s"),
    ]
    return [row for row in rows if row[0] not in _UNUSED[kept.solver]]


def _watts(values):
    """Plain digits; what is below a ten-thousandth counts for nothing."""
    return "  ".join(f"{Decimal(f'{round(value, 4):.3g}'):,f}" for value in values) + " W"


class TRIPTYCH_RENDER_PT_radiosity_shown(_Panel, bpy.types.Panel):
    bl_label = "Shown As"
    bl_parent_id = "TRIPTYCH_RENDER_PT_radiosity_solution"

    def draw(self, context):
        layout, look = self.layout, context.window_manager.triptych_radiosity
        row = layout.row(align=True)
        row.operator("triptych.radiosity_mesh", icon="MESH_GRID")
        row.operator("triptych.radiosity_clear", text="", icon="X")
        layout.operator("triptych.radiosity_form_factors", icon="LIGHT_HEMI")
        layout.use_property_split, layout.use_property_decorate = True, False
        column = layout.column(heading="Refresh")
        for name in ("mesh", "links", "picture"):
            column.prop(look, name)
        column = layout.column()
        for name in ("steps", "shown", "scale", "most_links"):
            column.prop(look, name)
        for line in hints(context.scene, look):
            layout.label(text=line, icon="INFO")


def hints(scene, look):
    """Lines on where the mesh is not what the panel says."""
    made, kept = generated.find(scene, generated.MESH), radiosity.kept()
    if made is None:
        return []
    lines = []
    if look.shown == "form_factor" and not radiosity_mesh.has_form_factors(made.data):
        lines.append("No form factors: radiosity is shown")
    if kept is not None and kept.info is not None and made.data.get("iteration") != kept.info.iterations:
        lines.append(f"The mesh is of iteration {made.data.get('iteration')}")
    return lines


_CLASSES = (TriptychRadiosityLook, TRIPTYCH_RENDER_PT_radiosity_solution, TRIPTYCH_RENDER_PT_radiosity_shown)


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.WindowManager.triptych_radiosity = bpy.props.PointerProperty(type=TriptychRadiosityLook)


def unregister():
    del bpy.types.WindowManager.triptych_radiosity
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
