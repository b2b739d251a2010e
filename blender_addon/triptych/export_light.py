# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's lights to data.Light, as bright as Cycles has them.

Of P watts: a point or spot light has the intensity P/4π; a sun's strength is its irradiance; an area light's radiance
is P/πA (P/4A before 4.0). A node tree multiplies that by an Emission node's colour and strength.
"""

from math import pi, sin

from . import compat, data
from .nodes import TreeReader, Unsupported, output_node
from .transforms import rows

_FALLOFF_OUTPUTS = {"Quadratic": "physical", "Linear": "linear", "Constant": "constant"}


def export_light(light_object, matrix, textures, warn, group=0):
    """The data.Light of an evaluated light object at a world matrix."""
    light = light_object.data
    result = data.Light(
        name=light_object.name,
        type=light.type.lower(),
        world_from_light=rows(matrix),
        emission=(0.0, 0.0, 0.0),
        cast_shadow=light.use_shadow,
        visible_camera=light.type == "AREA" and light_object.visible_camera,
        group=group,
    )
    factor = light.energy * 2 ** getattr(light, "exposure", 0.0)
    if light.type in {"POINT", "SPOT"}:
        result.radius = light.shadow_soft_size
        if _normalized(light):
            factor /= 4 * pi
        else:  # the disk has the radiance P/π; a point counts as a disk of 1 m²
            factor *= result.radius**2 if result.radius > 0 else 1 / pi
    if light.type == "SPOT":
        result.angle, result.blend = light.spot_size, light.spot_blend
    elif light.type == "SUN":
        result.angle = light.angle
        if not _normalized(light) and light.angle > 0:
            factor *= pi * sin(light.angle / 2) ** 2
    elif light.type == "AREA":
        factor *= _fill_area(result, light, matrix)
    tint, result.falloff = _emission(light, textures, warn)
    override = getattr(light, "triptych", None)
    if override is not None and override.falloff != "AUTO":
        result.falloff = override.falloff.lower()
    if getattr(light, "use_temperature", False):
        tint = tuple(a * b for a, b in zip(tint, light.temperature_color, strict=True))
    emission = [factor * a * b for a, b in zip(tint, light.color, strict=True)]
    if min(emission) < 0:
        warn(f"light '{light_object.name}': negative light is not supported; 0 is used")
    result.emission = tuple(max(channel, 0.0) for channel in emission)
    return result


def _normalized(light):
    """Whether a light keeps its power when its size changes; it always does before 4.5."""
    return getattr(light, "normalize", True)


def _fill_area(result, light, matrix):
    """Sets size, shape and spread; gives the radiance for a watt."""
    width = light.size
    height = light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else light.size
    round_shape = light.shape in {"DISK", "ELLIPSE"}
    result.size = (width, height)
    result.shape = "ellipse" if round_shape else "rectangle"
    result.angle = light.spread
    if not _normalized(light):
        return compat.area_light_factor()
    scale = matrix.to_3x3()
    area = width * scale.col[0].length * height * scale.col[1].length * (pi / 4 if round_shape else 1)
    return compat.area_light_factor() / area if area > 0 else 0.0


def _emission(light, textures, warn):
    """(colour · strength of the light's nodes, falloff); white and physical without nodes."""
    if not compat.uses_nodes(light):
        return (1.0, 1.0, 1.0), "physical"
    reader = TreeReader(f"light '{light.name}'", textures, warn)
    output = output_node(light.node_tree)
    node, _, stack = reader.source(output.inputs["Surface"], ()) if output is not None else (None, None, ())
    if node is None:
        return (0.0, 0.0, 0.0), "physical"
    if node.bl_idname != "ShaderNodeEmission":
        reader.warn_node(node, "is not supported; the light's own colour is used")
        return (1.0, 1.0, 1.0), "physical"
    tint, falloff = (1.0, 1.0, 1.0), "physical"
    try:
        tint = reader.constant(node.inputs["Color"], stack)[:3]
    except Unsupported as error:
        reader.warn_node(node, f"{error}; white is used")
    strength = node.inputs["Strength"]
    source, socket, at = reader.source(strength, stack)
    if source is not None and source.bl_idname == "ShaderNodeLightFalloff":
        falloff = _FALLOFF_OUTPUTS[socket.identifier]
        strength, stack = source.inputs["Strength"], at
        if not reader.value(source.inputs["Smooth"], at).is_always(0):
            reader.warn_node(source, "is smoothed, which is not supported; no smoothing is used")
    try:
        factor = reader.constant(strength, stack)[0]
    except Unsupported as error:
        reader.warn_node(node, f"{error}; 1 is used")
        factor = 1.0
    return tuple(channel * factor for channel in tint), falloff
