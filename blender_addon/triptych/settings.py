# SPDX-License-Identifier: GPL-3.0-or-later
"""Between the library's settings ("shading.specular") and the properties of scene.triptych ("shading_specular")."""

# Of the library's table, filled when properties.py registers: setting name -> property name.
PROPERTIES = {}


def property_name(setting):
    return setting.replace(".", "_")


def choice_name(setting):
    """The property that holds the text of a value whose default is the method's; empty: not set."""
    return property_name(setting) + "_choice"


def as_text(value):
    """A property's value as trp_render_set takes it."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, (int, str)):
        return str(value)
    if isinstance(value, float):
        return f"{value:.9g}"
    return ",".join(f"{number:.9g}" for number in value)


def changed(scene):
    """{setting: text} of those that the user has set on a bpy.types.Scene."""
    group = getattr(scene, "triptych", None)
    if group is None:
        return {}
    result = {}
    if scene.render.film_transparent and "film.transparent" in PROPERTIES:
        result["film.transparent"] = "on"
    for setting, name in PROPERTIES.items():
        choice = getattr(group, choice_name(setting), None)
        if group.is_property_set(name) if choice is None else choice:
            result[setting] = as_text(getattr(group, name))
    return result


def set_threads(values, scene):
    """Adds the number of threads that a bpy.types.Scene fixes for itself, unless {setting: text} has one."""
    if scene.render.threads_mode == "FIXED":
        values.setdefault("threads", str(scene.render.threads))
