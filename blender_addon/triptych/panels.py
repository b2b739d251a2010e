# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels: the method, its settings, comparisons, coefficients, light; and Blender's own panels opened to the engine."""

import bpy

from . import abi, export_motion, properties, settings

ENGINE = "TRIPTYCH"

# Panels of Blender's own engines that would show settings without an effect, or that ours replace.
_EXCLUDED = {
    *("RENDER_PT_gpencil", "RENDER_PT_grease_pencil_render", "RENDER_PT_grease_pencil_viewport"),
    *(
        "RENDER_PT_simplify_greasepencil",
        "RENDER_PT_stereoscopy",
        "RENDER_PT_output_views",
        "DATA_PT_camera_stereoscopy",
    ),
    *("DATA_PT_light", "DATA_PT_area", "DATA_PT_spot", "DATA_PT_distance", "DATA_PT_falloff_curve"),
    *("DATA_PT_volume_render", "OBJECT_PT_lineart", "VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes"),
}
# Panels of EEVEE's that do not depend on it.
_INCLUDED = {
    *("EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "EEVEE_WORLD_PT_surface"),
    *("EEVEE_NEXT_WORLD_PT_surface", "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture", "WORLD_PT_context_world"),
    *("DATA_PT_context_light", "MATERIAL_PT_preview", "WORLD_PT_preview", "DATA_PT_preview"),
}

_GROUP_LABELS = {
    "": "Sampling",
    "raster": "Rasterizer",
    "trace": "Ray Tracing",
    "adaptive": "Adaptive Sampling",
    "film": "Film",
    "lights": "Lights",
}

# Settings of radiosity that have no effect unless these properties have one of these values.
_BY_ROWS = {"radiosity_solver": {"matrix", "progressive"}}
_PROGRESSIVE = {"radiosity_solver": {"progressive"}}
_SCALED = {"radiosity_view": {"false_color", "illuminance", "form_factors"}}
_USED_WITH = {
    "radiosity.form_factors": _BY_ROWS,
    "radiosity.patch_levels": _PROGRESSIVE,
    "radiosity.subdivisions": _BY_ROWS,
    "radiosity.link_ratio": {"radiosity_solver": {"hierarchical"}},
    "radiosity.rays": _BY_ROWS,
    "radiosity.hemicube_resolution": {**_BY_ROWS, "radiosity_form_factors": {"hemicube"}},
    "radiosity.order": _PROGRESSIVE,
    "radiosity.ambient": _PROGRESSIVE,
    "radiosity.memory": {"radiosity_solver": {"matrix"}},
    "radiosity.view_scale": _SCALED,
    "radiosity.legend": _SCALED,
    "radiosity.view_element": {"radiosity_view": {"form_factors"}},
}


def is_used(chosen, setting):
    """Whether a setting of the chosen method has an effect beside the others of scene.triptych."""
    return all(getattr(chosen, name) in values for name, values in _USED_WITH.get(setting, {}).items())


def _blender_panels():
    """Blender's panels that are to be seen with this engine."""
    for panel in _all_subclasses(bpy.types.Panel):
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None or panel.__module__.startswith(__package__):
            continue
        if panel.__name__ in _EXCLUDED or "freestyle" in panel.__name__:
            continue
        if "BLENDER_RENDER" in engines or panel.__name__ in _INCLUDED:
            yield panel


def _all_subclasses(cls):
    for child in cls.__subclasses__():
        yield child
        yield from _all_subclasses(child)


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def _columns(self):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        return layout


def _warn_missing(layout):
    """Says where the library was looked for; gives whether it is missing."""
    message = abi.missing()
    if not message and properties.SETTINGS:
        return False
    box = layout.box().column(align=True)
    box.label(text="Triptych cannot render", icon="ERROR")
    message = message or "The library was found after the add-on was enabled: disable and enable it"
    for start in range(0, len(message), 60):
        box.label(text=message[start : start + 60])
    return True


class TRIPTYCH_RENDER_PT_method(_Panel, bpy.types.Panel):
    bl_label = "Method"
    bl_context = "render"
    bl_options = {"HIDE_HEADER"}
    bl_order = -10

    def draw(self, context):
        layout = self._columns()
        _warn_missing(layout)
        layout.prop(context.scene.triptych, "method")


def _settings_of(group, method):
    return [row for row in properties.SETTINGS if _group_of(row) == group and row.used_by(method)]


def _group_of(setting):
    return setting.name.split(".")[0] if "." in setting.name else ""


def _settings_panel(group):
    """A panel for the settings "group.…" that the chosen method uses."""

    def draw(self, context):
        chosen = context.scene.triptych
        column = self._columns().column()
        for row in _settings_of(group, chosen.method):
            line = column.row()
            line.active = is_used(chosen, row.name)
            line.prop(chosen, settings.property_name(row.name))

    def poll(cls, context):
        return context.engine == ENGINE and bool(_settings_of(group, context.scene.triptych.method))

    name = f"TRIPTYCH_RENDER_PT_{group or 'sampling'}"
    content = {
        "bl_idname": name,
        "bl_label": _GROUP_LABELS.get(group, group.replace("_", " ").title()),
        "bl_context": "render",
        "bl_order": -9,
        "draw": draw,
        "poll": classmethod(poll),
    }
    return type(name, (_Panel, bpy.types.Panel), content)


class TRIPTYCH_RENDER_PT_motion_blur(_Panel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_context = "render"
    bl_order = -8
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE and context.scene.triptych.method in export_motion.METHODS

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        render = context.scene.render
        column = self._columns().column()
        column.active = render.use_motion_blur
        column.prop(render, "motion_blur_shutter")
        if hasattr(render, "motion_blur_position"):
            column.prop(render, "motion_blur_position")
        column.prop(context.scene.triptych, "motion_steps")


class TRIPTYCH_RENDER_PT_compare(_Panel, bpy.types.Panel):
    bl_label = "Compare"
    bl_context = "render"
    bl_order = -8

    def draw(self, context):
        self.layout.operator("triptych.shading_sheet")


class TRIPTYCH_VIEWLAYER_PT_passes(_Panel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        column = self._columns().column()
        view_layer = context.view_layer
        for row in properties.PASSES:
            if row.name == "Combined" or not row.used_by(context.scene.triptych.method):
                continue
            if properties.light_group(row.name):  # those have a panel
                continue
            switch = properties.blender_pass(row.name)[1]
            if switch:
                column.prop(view_layer, switch, text=row.name)
            else:
                column.prop(view_layer.triptych, properties.pass_switch(row.name), text=row.name)


class TRIPTYCH_VIEWLAYER_PT_light_groups(_Panel, bpy.types.Panel):
    bl_label = "Light Groups"
    bl_context = "view_layer"
    bl_parent_id = "TRIPTYCH_VIEWLAYER_PT_passes"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE and any(
            properties.light_group(row.name) and row.used_by(context.scene.triptych.method) for row in properties.PASSES
        )

    def draw(self, context):
        view_layer = context.view_layer
        row = self.layout.row()
        row.template_list(
            "UI_UL_list",
            "triptych_light_groups",
            view_layer,
            "lightgroups",
            view_layer,
            "active_lightgroup_index",
            rows=3,
        )
        column = row.column(align=True)
        column.operator("scene.view_layer_add_lightgroup", icon="ADD", text="")
        column.operator("scene.view_layer_remove_lightgroup", icon="REMOVE", text="")
        column.operator("scene.view_layer_add_used_lightgroups", icon="PRESET_NEW", text="")


class TRIPTYCH_MATERIAL_PT_coefficients(_Panel, bpy.types.Panel):
    bl_label = "Classic Coefficients"
    bl_context = "material"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES and context.material is not None

    def draw_header(self, context):
        self.layout.prop(context.material.triptych, "override", text="")

    def draw(self, context):
        chosen = context.material.triptych
        layout = self._columns()
        layout.active = chosen.override
        column = layout.column(align=True)
        column.prop(chosen, "use_ambient")
        if chosen.use_ambient:
            column.prop(chosen, "ambient")
        column = layout.column()
        for name in ("diffuse", "specular", "shininess"):
            column.prop(chosen, name)
        column.prop(chosen, "use_mirror")
        if chosen.use_mirror:
            column.prop(chosen, "mirror")
        for name in ("transmission", "ior", "fresnel", "thin"):
            column.prop(chosen, name)
        solid = layout.column()
        solid.active = not chosen.thin
        for name in ("priority", "absorption"):
            solid.prop(chosen, name)


class TRIPTYCH_LIGHT_PT_light(_Panel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES and context.light is not None

    def draw(self, context):
        light = context.light
        layout = self._columns()
        layout.row().prop(light, "type", expand=True)
        column = layout.column()
        for name in ("use_temperature", "temperature") if hasattr(light, "temperature") else ():
            column.prop(light, name)
        column.prop(light, "color")
        column.prop(light, "energy")
        for name in ("exposure", "normalize"):
            if hasattr(light, name):
                column.prop(light, name)
        column = layout.column()
        if light.type == "AREA":
            column.prop(light, "shape")
            column.prop(light, "size")
            if light.shape in {"RECTANGLE", "ELLIPSE"}:
                column.prop(light, "size_y")
            column.prop(light, "spread")
        elif light.type == "SUN":
            column.prop(light, "angle")
        else:
            column.prop(light, "shadow_soft_size", text="Radius")
        if light.type == "SPOT":
            column.prop(light, "spot_size")
            column.prop(light, "spot_blend")
        if light.type != "SUN":
            layout.prop(light.triptych, "falloff")
        layout.prop(light, "use_shadow")
        layout.prop(light, "use_nodes")
        if context.object is not None and context.object.data == light:
            layout.prop_search(context.object, "lightgroup", context.view_layer, "lightgroups", text="Light Group")


_CLASSES = (
    TRIPTYCH_RENDER_PT_method,
    TRIPTYCH_RENDER_PT_motion_blur,
    TRIPTYCH_RENDER_PT_compare,
    TRIPTYCH_VIEWLAYER_PT_passes,
    TRIPTYCH_VIEWLAYER_PT_light_groups,
    TRIPTYCH_MATERIAL_PT_coefficients,
    TRIPTYCH_LIGHT_PT_light,
)
_registered = []


def register():
    groups = dict.fromkeys(_group_of(row) for row in properties.SETTINGS)  # in the table's order
    for panel in (*_CLASSES, *(_settings_panel(group) for group in groups)):
        bpy.utils.register_class(panel)
        _registered.append(panel)
    for panel in _blender_panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister():
    for panel in _all_subclasses(bpy.types.Panel):
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is not None and not panel.__module__.startswith(__package__):
            engines.discard(ENGINE)
    while _registered:
        bpy.utils.unregister_class(_registered.pop())
