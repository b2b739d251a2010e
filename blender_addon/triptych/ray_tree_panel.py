# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's tab "Triptych" in the Image Editor and the 3D Viewport: the ray tree as a list, one ray in full.

The list stands in the window manager, which no file keeps.
"""

import bpy

from . import ray_tree
from .panels import ENGINE

# A sidebar wider than this (pixels, at a scale of 1) has room for all numbers in the list; else it shows colours.
_WIDE = 640
_COLORS = ("weight", "local", "intensity")
_ICONS = {"primary": "COLLECTION_COLOR_03", "reflection": "COLLECTION_COLOR_01", "transmission": "COLLECTION_COLOR_05"}


# ------------------------------------------------------------------------------------------------------------- the list


class TriptychRay(bpy.types.PropertyGroup):
    """A ray of the list; `name` is what the list shows of it."""

    level: bpy.props.IntProperty()
    kind: bpy.props.StringProperty(name="Kind", description="Primary, reflection or transmission")
    end: bpy.props.StringProperty(
        name="End",
        description=(
            "Where the ray ends: at a surface, a light or the background; or untraced, by the limit of "
            "depth or since it counts for less than the least weight"
        ),
    )
    object: bpy.props.StringProperty(name="Object", description="The object that the ray meets")
    material: bpy.props.StringProperty(name="Material", description="The material of the surface that the ray meets")
    distance: bpy.props.FloatProperty(
        name="Distance", description="From the origin to where the ray ends", unit="LENGTH", precision=4
    )
    origin: bpy.props.FloatVectorProperty(
        name="Origin", description="Where the ray starts, in world space", subtype="XYZ", unit="LENGTH", precision=4
    )
    direction: bpy.props.FloatVectorProperty(
        name="Direction", description="Unit vector in world space", subtype="XYZ", precision=4
    )
    position: bpy.props.FloatVectorProperty(
        name="Position", description="Where the ray ends, in world space", subtype="XYZ", unit="LENGTH", precision=4
    )
    normal: bpy.props.FloatVectorProperty(
        name="Normal",
        description="The shading normal there, on the side that is seen: a unit vector in world space",
        subtype="XYZ",
        precision=4,
    )
    weight: bpy.props.FloatVectorProperty(
        name="Weight",
        description="What the ray before it takes of this ray's intensity: a factor for red, green and blue",
        subtype="COLOR",
        precision=4,
    )
    local: bpy.props.FloatVectorProperty(
        name="Local",
        description="What comes from the surface, light or background itself: radiance in W/(m² sr)",
        subtype="COLOR",
        precision=4,
    )
    intensity: bpy.props.FloatVectorProperty(
        name="Intensity",
        description="Local plus weight times intensity of each ray that follows: radiance in W/(m² sr)",
        subtype="COLOR",
        precision=4,
    )


def _choose(tree, context):
    ray_tree.thicken(tree.rays, tree.rays[tree.active] if tree.active < len(tree.rays) else None)


class TriptychRayTree(bpy.types.PropertyGroup):
    rays: bpy.props.CollectionProperty(type=TriptychRay)
    active: bpy.props.IntProperty(name="Ray", description="The ray whose values are shown", min=0, update=_choose)
    pixel: bpy.props.IntVectorProperty(
        name="Pixel", description="The pixel whose rays these are, in pixels from the top left", size=2
    )


# ----------------------------------------------------------------------------------------------------------- the panels


def _is_wide(context):
    return context.region.width > _WIDE * context.preferences.system.ui_scale


def _cells(layout, wide):
    """The cells of a line of the list: for the ray, its distance (None where that is not wide) and its colours."""
    line = layout.split(factor=0.34 if wide else 0.7)
    ray = line.row(align=True)
    if not wide:
        return ray, None, line.row(align=True)
    rest = line.split(factor=0.16)
    return ray, rest.row(), rest.grid_flow(row_major=True, columns=len(_COLORS), even_columns=True)


def _length(context, metres):
    units = context.scene.unit_settings
    return bpy.utils.units.to_string(units.system, "LENGTH", metres * units.scale_length, precision=4)


def _number(value):
    return f"{value:.3f}" if value < 10 else f"{value:.4g}"


class TRIPTYCH_UL_rays(bpy.types.UIList):
    bl_idname = "TRIPTYCH_UL_rays"

    def draw_item(self, context, layout, owner, item, icon, active_owner, active_property, index=0, filtered=0):
        wide = _is_wide(context)
        ray, distance, colors = _cells(layout, wide)
        for _ in range(item.level):
            ray.separator(factor=2 if wide else 1)
        ray.label(text=item.name if wide else item.name.split(": ", 1)[1], icon=_ICONS[item.kind])
        if wide:
            distance.label(text=_length(context, item.distance) if item.end in {"surface", "light"} else "")
        for name in _COLORS:
            if wide:
                colors.label(text=" ".join(_number(value) for value in getattr(item, name)))
            else:
                colors.prop(item, name, text="")


class _RayTreePanel:
    bl_label = "Ray Tree"
    bl_region_type = "UI"
    bl_category = "Triptych"

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE

    def draw(self, context):
        layout, wide, tree = self.layout, _is_wide(context), context.window_manager.triptych_ray_tree
        row = layout.row(align=True)
        row.operator("triptych.ray_tree", text="Click a Pixel", icon="EYEDROPPER")
        row.operator("triptych.ray_tree_clear", text="", icon="X")
        if not tree.rays:
            return
        layout.label(text=f"Pixel {tree.pixel[0]}, {tree.pixel[1]}: {len(tree.rays)} rays")
        column = layout.column(align=True)
        if wide:
            ray, distance, colors = _cells(column, wide)
            ray.label(text="Ray")
            distance.label(text="Distance")
            for name in _COLORS:
                colors.label(text=name.title())
        column.template_list("TRIPTYCH_UL_rays", "", tree, "rays", tree, "active", rows=8)
        if tree.active < len(tree.rays):
            _details(layout.column(), tree.rays[tree.active], wide)


def _details(layout, ray, wide):
    """Every value of a ray, to be read; what it meets only where it meets something."""
    layout.enabled = False
    names = ["kind", "end"]
    if ray.end == "surface":
        names += ["object", "material"]
    if ray.end in {"surface", "light"}:
        names.append("distance")
    names += ["origin", "direction"]
    if ray.end == "surface":
        names += ["position", "normal"]
    for name in (*names, *_COLORS):
        value = ray.bl_rna.properties[name]
        split = layout.split(factor=0.18 if wide else 0.36)
        split.label(text=value.name)
        cell = split.row(align=True) if wide else split.column(align=True)
        for index in range(3) if getattr(value, "is_array", False) else (-1,):
            cell.prop(ray, name, index=index, text="")


class TRIPTYCH_VIEW3D_PT_ray_tree(_RayTreePanel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"


class TRIPTYCH_IMAGE_PT_ray_tree(_RayTreePanel, bpy.types.Panel):
    bl_space_type = "IMAGE_EDITOR"


_CLASSES = (
    TriptychRay,
    TriptychRayTree,
    TRIPTYCH_UL_rays,
    TRIPTYCH_VIEW3D_PT_ray_tree,
    TRIPTYCH_IMAGE_PT_ray_tree,
)


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.WindowManager.triptych_ray_tree = bpy.props.PointerProperty(type=TriptychRayTree)


def unregister():
    del bpy.types.WindowManager.triptych_ray_tree
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
