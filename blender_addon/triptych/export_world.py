# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's world to data.World: a Background node with a constant colour or an Environment Texture."""

from math import cos, sin

import numpy as np

from . import compat, data
from .nodes import TreeReader, Unsupported, output_node


def export_world(world, textures, warn):
    """The data.World of a bpy.types.World; black for None."""
    if world is None:
        return data.World()
    result = _from_nodes(world, textures, warn) if compat.uses_nodes(world) else data.World(tuple(world.color))
    visibility = getattr(world, "cycles_visibility", None)
    if visibility is not None:
        result.visible_camera = visibility.camera
    result.light = any(channel > 0 for channel in result.radiance)
    return result


def _from_nodes(world, textures, warn):
    result = data.World()
    reader = TreeReader(f"world '{world.name}'", textures, warn)
    output = output_node(world.node_tree)
    node, _, stack = reader.source(output.inputs["Surface"], ()) if output is not None else (None, None, ())
    if node is None:
        return result
    if node.bl_idname not in {"ShaderNodeBackground", "ShaderNodeEmission"}:
        reader.warn_node(node, "is not supported as a world; the world's colour is used")
        result.radiance = tuple(world.color)
        return result
    try:
        strength = reader.constant(node.inputs["Strength"], stack)[0]
        picture, _, at = reader.source(node.inputs["Color"], stack)
        if picture is not None and picture.bl_idname == "ShaderNodeTexEnvironment":
            _environment(result, reader, picture, at, textures)
            tint = (1.0, 1.0, 1.0) if result.texture != data.NONE else (0.0, 0.0, 0.0)
        else:
            tint = reader.constant(node.inputs["Color"], stack)[:3]
    except Unsupported as error:
        reader.warn_node(node, f"{error}; the world's colour is used")
        strength, tint = 1.0, tuple(world.color)
    result.radiance = tuple(max(strength * channel, 0.0) for channel in tint)
    return result


def _environment(result, reader, node, stack, textures):
    if node.image is None:
        return
    if node.projection != "EQUIRECTANGULAR":
        reader.warn_node(node, f"has the projection {node.projection}; EQUIRECTANGULAR is used")
    filtering = "nearest" if node.interpolation == "Closest" else "smooth"
    result.texture = textures.add(node.image, node.image_user, ("repeat", "clamp"), filtering)
    mapping, _, at = reader.source(node.inputs["Vector"], stack)
    if mapping is None:
        return
    if mapping.bl_idname == "ShaderNodeMapping":
        rotation = reader.constant(mapping.inputs["Rotation"], at)
        scale = reader.constant(mapping.inputs["Scale"], at)
        if any(number != 1 for number in scale[:3]):
            reader.warn_node(mapping, "scales, which is not supported for the world; only the rotation is used")
        turn = _euler(*rotation[:3])
        # The node turns the direction that is looked up: texture from world. TEXTURE is its inverse.
        result.world_from_texture[:, :3] = turn if mapping.vector_type == "TEXTURE" else turn.T
        mapping, _, _ = reader.source(mapping.inputs["Vector"], at)
    if mapping is not None and mapping.bl_idname not in {"ShaderNodeTexCoord", "ShaderNodeNewGeometry"}:
        reader.warn_node(mapping, "is not supported for the world's direction; it is left out")


def _euler(x, y, z):
    """Rotation by XYZ Euler angles, as Blender's Mapping node does it: first about X, then Y, then Z."""
    about_x = np.array([[1, 0, 0], [0, cos(x), -sin(x)], [0, sin(x), cos(x)]])
    about_y = np.array([[cos(y), 0, sin(y)], [0, 1, 0], [-sin(y), 0, cos(y)]])
    about_z = np.array([[cos(z), -sin(z), 0], [sin(z), cos(z), 0], [0, 0, 1]])
    return about_z @ about_y @ about_x
