# SPDX-License-Identifier: GPL-3.0-or-later
"""scene.triptych, view_layer.triptych, material.triptych and light.triptych.

Settings and methods are made from the library's own tables when the add-on is registered. Without the library there is
only the method, from a list of the names that never change.
"""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from . import abi, core, settings

METHODS = (
    *("wireframe", "hidden_line", "visible_surface", "flat", "gouraud", "phong", "ray_casting", "ray_tracing"),
    *("radiosity", "two_pass", "path_tracing"),
)
DEFAULT_METHOD = "ray_tracing"

_UNITS = {"radians": "ROTATION", "m": "LENGTH"}
_NAMES = {"blackman_harris": "Blackman-Harris"}  # that are not made of words
_INT_LIMIT = 2**31 - 1

# The library's passes: name -> (Blender's name, Blender's switch on the view layer; None: ours). Others keep theirs.
BLENDER_PASSES = {
    "Depth": ("Depth", "use_pass_z"),
    "Position": ("Position", "use_pass_position"),
    "Normal": ("Normal", "use_pass_normal"),
    "UV": ("UV", "use_pass_uv"),
    "Albedo": ("DiffCol", "use_pass_diffuse_color"),
    "Emission": ("Emit", "use_pass_emit"),
    "IndexOB": ("IndexOB", "use_pass_object_index"),
    "IndexMA": ("IndexMA", "use_pass_material_index"),
    "Shadow": ("Shadow", "use_pass_shadow"),
    "Environment": ("Env", "use_pass_environment"),
    "SampleCount": ("Debug Sample Count", None),
}

# The library's tables as they were at registration: core.Setting and core.Pass.
SETTINGS = []
PASSES = []


def blender_pass(name):
    """(Blender's name, Blender's switch or None) for a pass of the library."""
    return BLENDER_PASSES.get(name, (name, None))


def pass_switch(name):
    """The property of view_layer.triptych for a pass that Blender has no switch for."""
    return "use_pass_" + "".join(letter.lower() if letter.isalnum() else "_" for letter in name)


LIGHT_GROUPS = 8  # that have a pass, as triptych.h says
_LIGHT_GROUP = "LightGroup"  # the library's name of it, before the number


def light_group(name):
    """The number, from 1, of the light group that a pass of the library shows; 0: it shows none."""
    number = name[len(_LIGHT_GROUP) :]
    return int(number) if name.startswith(_LIGHT_GROUP) and number.isdigit() else 0


def light_groups(view_layer):
    """{name: number in the library} of a view layer's light groups. Those beyond the library's last have no pass."""
    return {group.name: number for number, group in enumerate(view_layer.lightgroups, 1)}


def wanted_passes(view_layer, method):
    """[(core.Pass, Blender's name)] of the passes that a view layer asks for and the method gives; without Combined.

    A light group has a pass, named as Cycles does, because it is there.
    """
    groups = {number: name for name, number in light_groups(view_layer).items()}
    result = []
    for row in PASSES:
        if row.name == "Combined" or not row.used_by(method):
            continue
        group = light_group(row.name)
        if group:
            if group in groups:
                result.append((row, f"Combined_{groups[group]}"))
            continue
        name, switch = blender_pass(row.name)
        owner = view_layer if switch else getattr(view_layer, "triptych", None)
        if owner is not None and getattr(owner, switch or pass_switch(row.name), False):
            result.append((row, name))
    return result


# ------------------------------------------------------------------------------------------- properties from the tables


def _shown_as_the_method_has_it(setting, from_text):
    """get and set of a property that shows the method's own default until it is set."""
    choice = settings.choice_name(setting.name)

    def get(group):
        return from_text(getattr(group, choice) or setting.default_for(group.method))

    def set(group, value):
        setattr(group, choice, settings.as_text(value))

    return {"get": get, "set": set}


def _bool(setting, common):
    if setting.method_defaults:
        return BoolProperty(**_shown_as_the_method_has_it(setting, lambda text: text == "on"), **common)
    return BoolProperty(default=setting.default == "on", **common)


def _int(setting, common):
    least, most = max(setting.minimum, -_INT_LIMIT - 1), min(setting.maximum, _INT_LIMIT)
    common = dict(common, min=int(least), max=int(most))
    if setting.method_defaults:
        return IntProperty(**_shown_as_the_method_has_it(setting, int), **common)
    return IntProperty(default=min(max(int(float(setting.default)), int(least)), int(most)), **common)


def _float(setting, common):
    common = dict(common, unit=_UNITS.get(setting.unit, "NONE"))
    default = float(setting.default)
    # A step of digits that shows small defaults whole.
    precision = 3 if default == 0 or abs(default) >= 0.01 else 6
    return FloatProperty(default=default, min=setting.minimum, max=setting.maximum, precision=precision, **common)


def _color(setting, common):
    default = [float(number) for number in setting.default.split(",")]
    default = default * 3 if len(default) == 1 else default
    return FloatVectorProperty(
        default=default, size=3, subtype="COLOR", min=setting.minimum, max=setting.maximum, soft_max=1, **common
    )


def _enum(setting, common):
    items = [(choice, _NAMES.get(choice) or _title(choice.replace("_", " ")), "") for choice in setting.choices]
    return EnumProperty(items=items, default=setting.default, **common)


_MAKERS = {"BOOL": _bool, "INT": _int, "FLOAT": _float, "COLOR": _color, "ENUM": _enum}


def _title(words):
    """A label as Blender writes it."""
    return " ".join(word[0].upper() + word[1:] for word in words.replace("olour", "olor").split())


def _setting_property(setting):
    unit = f" ({setting.unit})" if setting.unit and setting.unit not in _UNITS else ""
    common = {"name": _title(setting.label), "description": setting.description.rstrip(".") + unit}
    return _MAKERS[setting.type](setting, common)


def _method_property(methods):
    if not methods:
        methods = [(name, name.replace("_", " ").title(), "") for name in METHODS]
    names = [name for name, _, _ in methods]
    return EnumProperty(
        name="Method",
        description="How the picture is made",
        items=[(name, label, description.rstrip(".")) for name, label, description in methods],
        default=DEFAULT_METHOD if DEFAULT_METHOD in names else names[-1],
    )


_MOTION_STEPS = IntProperty(
    name="Steps",
    description="Times between opening and closing of the shutter at which what moves is looked at; straight between",
    default=3,
    min=2,
    max=129,
)


def _scene_group():
    """The PropertyGroup of scene.triptych, by the library's tables."""
    SETTINGS.clear()
    PASSES.clear()
    settings.PROPERTIES.clear()
    methods = []
    if not abi.missing():
        methods = core.methods()
        SETTINGS.extend(core.settings())
        PASSES.extend(core.passes())
    annotations = {"method": _method_property(methods), "motion_steps": _MOTION_STEPS}
    for setting in SETTINGS:
        name = settings.property_name(setting.name)
        annotations[name] = _setting_property(setting)
        if setting.method_defaults:
            annotations[settings.choice_name(setting.name)] = StringProperty(options={"HIDDEN"})
        settings.PROPERTIES[setting.name] = name
    return type("TriptychSceneSettings", (bpy.types.PropertyGroup,), {"__annotations__": annotations})


def _view_layer_group():
    annotations = {
        pass_switch(row.name): BoolProperty(name=row.name, description=row.description.rstrip("."))
        for row in PASSES
        if row.name != "Combined" and not light_group(row.name) and blender_pass(row.name)[1] is None
    }
    return type("TriptychViewLayerSettings", (bpy.types.PropertyGroup,), {"__annotations__": annotations})


# ----------------------------------------------------------------------------------------------------- fixed properties


def _coefficient(name, description, default):
    return FloatVectorProperty(
        name=name, description=description, subtype="COLOR", size=3, default=default, min=0, soft_max=1
    )


class TriptychMaterialSettings(bpy.types.PropertyGroup):
    override: BoolProperty(
        name="Classic Coefficients",
        description="Use the coefficients below in place of those that the shader nodes give",
    )
    use_ambient: BoolProperty(name="Own Ambient", description="A coefficient of its own; otherwise as diffuse")
    ambient: _coefficient("Ambient", "K_A, the weight of the ambient light", (0.8, 0.8, 0.8))
    diffuse: _coefficient("Diffuse", "K_D, the diffuse reflectance", (0.8, 0.8, 0.8))
    specular: _coefficient("Specular", "K_S, the weight of highlights", (0.0, 0.0, 0.0))
    shininess: FloatProperty(
        name="Shininess", description="n, Phong's exponent", default=30, min=0, max=20000, soft_max=1000
    )
    use_mirror: BoolProperty(name="Own Mirror", description="A coefficient of its own; otherwise as specular")
    mirror: _coefficient("Mirror", "The weight of mirrored light", (0.0, 0.0, 0.0))
    transmission: _coefficient("Transmission", "K_T, 0 opaque, 1 clear", (0.0, 0.0, 0.0))
    ior: FloatProperty(
        name="IOR", description="η, the index of refraction", default=1.5, min=0.001, max=1000, soft_max=3
    )
    thin: BoolProperty(name="Thin", description="Transmitted light goes straight on")
    fresnel: BoolProperty(
        name="Fresnel",
        description="Fresnel's equations weigh mirrored and transmitted light too, by the angle and the IOR",
    )
    priority: IntProperty(
        name="Priority",
        description="Of solids that lie in each other, the one with the greater priority fills the space",
        min=-1000,
        max=1000,
    )
    absorption: FloatVectorProperty(
        name="Absorption",
        description="What a solid takes from light on its way, per metre: it fades as exp(-absorption · distance)",
        size=3,
        min=0,
        soft_max=10,
    )


class TriptychLightSettings(bpy.types.PropertyGroup):
    falloff: EnumProperty(
        name="Falloff",
        description="How light fades with the distance d",
        items=[
            ("AUTO", "From Nodes", "As the light's nodes say; physical without them"),
            ("PHYSICAL", "Physical", "1/d²"),
            ("LINEAR", "Linear", "1/d; as physical at one metre"),
            ("CONSTANT", "Constant", "The same at every distance; as physical at one metre"),
        ],
    )


class TriptychObjectSettings(bpy.types.PropertyGroup):
    """Empty as yet: Blender's own object.visible_camera and visible_shadow say what there is to say."""


_FIXED = (
    (TriptychMaterialSettings, bpy.types.Material),
    (TriptychLightSettings, bpy.types.Light),
    (TriptychObjectSettings, bpy.types.Object),
)
_registered = []


def register():
    made = ((_scene_group(), bpy.types.Scene), (_view_layer_group(), bpy.types.ViewLayer))
    for group, owner in (*made, *_FIXED):
        bpy.utils.register_class(group)
        owner.triptych = PointerProperty(type=group)
        _registered.append((group, owner))


def unregister():
    while _registered:
        group, owner = _registered.pop()
        del owner.triptych
        bpy.utils.unregister_class(group)
