# SPDX-License-Identifier: GPL-3.0-or-later
"""Small Blender scenes, and rendering them to arrays."""

import os
import tempfile
from math import radians

import bpy
import exr
import numpy as np
from mathutils import Vector


def prepare(scene, width=64, height=48, engine="TRIPTYCH"):
    scene.render.engine = engine
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.dither_intensity = 0
    scene.display_settings.display_device = "sRGB"
    scene.world = bpy.data.worlds.new("World")
    scene.world.color = (0, 0, 0)
    if scene.world.node_tree is not None:  # from 5.0 a new world has nodes, which are grey
        scene.world.node_tree.nodes.clear()


def link(scene, name, content, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    """A new object; rotation in degrees."""
    made = bpy.data.objects.new(name, content)
    made.location, made.scale = location, scale
    made.rotation_euler = [radians(angle) for angle in rotation]
    scene.collection.objects.link(made)
    return made


def camera(scene, location=(0, 0, 5), target=(0, 0, 0), **values):
    content = bpy.data.cameras.new("Camera")
    for name, value in values.items():
        setattr(content, name, value)
    made = link(scene, "Camera", content, location)
    direction = Vector(target) - Vector(location)
    made.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    scene.camera = made
    return made


def light(scene, kind="POINT", location=(0, 0, 3), energy=100.0, rotation=(0, 0, 0), **values):
    content = bpy.data.lights.new(kind.title(), kind)
    content.energy = energy
    for name, value in values.items():
        setattr(content, name, value)
    return link(scene, kind.title(), content, location, rotation)


def mesh(scene, name, vertices, faces, edges=(), uv=False, **place):
    """A mesh object; uv: x and y as texture coordinates, from (−1, −1)..(1, 1) to the unit square."""
    content = bpy.data.meshes.new(name)
    content.from_pydata(vertices, edges, faces)
    if uv:
        layer = content.uv_layers.new(name="UVMap")
        for loop, corner in zip(content.loops, layer.data, strict=True):
            place_of = content.vertices[loop.vertex_index].co
            corner.uv = ((place_of.x + 1) / 2, (place_of.y + 1) / 2)
    return link(scene, name, content, **place)


def plane(scene, size=2.0, name="Plane", **place):
    half = size / 2
    corners = [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)]
    return mesh(scene, name, corners, [(0, 1, 2, 3)], uv=True, **place)


def material(target=None, shader="ShaderNodeBsdfDiffuse", name="Material", **inputs):
    """A material of one shader; gives (material, node tree, shader node). inputs: values of its sockets."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output, node = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new(shader)
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    for key, value in inputs.items():
        socket = node.inputs[key.replace("_", " ")]
        socket.default_value = (*value, 1.0) if isinstance(value, tuple) and len(value) == 3 else value
    if target is not None:
        target.data.materials.append(made)
    return made, tree, node


def picture(name, pixels, colorspace="sRGB", is_float=False):
    """A generated image of height × width × 3 or 4 numbers, row 0 at the bottom."""
    height, width, channels = pixels.shape
    made = bpy.data.images.new(name, width, height, float_buffer=is_float)
    made.colorspace_settings.name = colorspace
    full = np.ones((height, width, 4), np.float32)
    full[..., :channels] = pixels
    made.pixels.foreach_set(full.reshape(-1))
    made.update()
    return made


def world_color(scene, rgb, strength=1.0):
    """A Background node of that radiance."""
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    tree.nodes.clear()
    output, node = tree.nodes.new("ShaderNodeOutputWorld"), tree.nodes.new("ShaderNodeBackground")
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    node.inputs["Color"].default_value = (*rgb, 1)
    node.inputs["Strength"].default_value = strength
    return tree, node


def render(scene, multilayer=False):
    """Renders as F12 does. A height × width × 4 array, row 0 at the bottom; multilayer: {channel: array}."""
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE" if multilayer else "IMAGE"
    settings.file_format = "OPEN_EXR_MULTILAYER" if multilayer else "OPEN_EXR"
    settings.color_depth, settings.exr_codec = "32", "NONE"
    if hasattr(settings, "use_exr_interleave"):  # from 5.0; else each layer is a part of its own
        settings.use_exr_interleave = True
    if not multilayer:
        settings.color_mode = "RGBA"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.exr")
        scene.render.use_file_extension = False
        bpy.ops.render.render(write_still=True, scene=scene.name)
        channels = exr.read(scene.render.filepath)
    return channels if multilayer else exr.image(channels)


def status():
    """The message of the engine's last error, or an empty string."""
    from triptych.engine import TriptychEngine

    return TriptychEngine.last_error
