# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scenes' scripts share: meshes from arrays, materials, pictures, lights and cameras, in Blender 3.4 to 5.

A scene is built into an emptied file (bpy.ops.wm.read_factory_settings(use_empty=True)). Units: metres, watts, linear
Rec. 709; angles in degrees.
"""

import math

import bpy
import numpy as np
from mathutils import Vector

RENAMED_SOCKETS = {  # Principled BSDF, Blender 4.0
    "Transmission": "Transmission Weight",
    "Specular": "Specular IOR Level",
    "Emission": "Emission Color",
}


def start(name, width, height):
    """Names the scene and sets the picture's size; gives the scene."""
    scene = bpy.context.scene
    scene.name = name
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    return scene


def link(name, data, location=(0, 0, 0)):
    thing = bpy.data.objects.new(name, data)
    thing.location = location
    bpy.context.scene.collection.objects.link(thing)
    return thing


# ---------------------------------------------------------------------------------------------------------- geometry


def mesh_object(name, shape, materials, smooth=False, sharp_angle=None, location=(0, 0, 0)):
    """A mesh object from a shapes.Shape. `materials`: one, or a list by slot. Edges whose faces meet at more than
    `sharp_angle` (degrees) are marked sharp; None marks none, and then nothing but vertices and faces is stored."""
    mesh = bpy.data.meshes.new(name)
    sizes = np.asarray(shape.sizes, np.int32)
    starts = np.cumsum(sizes, dtype=np.int32) - sizes
    mesh.vertices.add(len(shape.vertices))
    mesh.vertices.foreach_set("co", np.asarray(shape.vertices, np.float32).ravel())
    mesh.loops.add(len(shape.corners))
    mesh.loops.foreach_set("vertex_index", np.asarray(shape.corners, np.int32))
    mesh.polygons.add(len(sizes))
    mesh.polygons.foreach_set("loop_start", starts)
    if bpy.app.version < (4, 1, 0):
        mesh.polygons.foreach_set("loop_total", sizes)
    for material in materials if isinstance(materials, (list, tuple)) else [materials]:
        mesh.materials.append(material)
    if shape.slots is not None:
        mesh.polygons.foreach_set("material_index", np.asarray(shape.slots, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.full(len(sizes), smooth, dtype=bool))
    if shape.uv is not None:
        layer = mesh.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", np.asarray(shape.uv, np.float32).ravel())
    mesh.update(calc_edges=True)
    if mesh.validate():
        raise ValueError(f"{name}: Blender had to mend the mesh")
    if smooth and sharp_angle is not None:
        _mark_sharp(mesh, sharp_angle)
    return link(name, mesh, location)


def _mark_sharp(mesh, angle):
    normals = np.empty(len(mesh.polygons) * 3, np.float32)
    mesh.polygons.foreach_get("normal", normals)
    sizes = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    edge = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edge)
    face = np.repeat(np.arange(len(sizes)), sizes)
    order = np.argsort(edge, kind="stable")
    edge, face = edge[order], face[order]
    pair = np.flatnonzero(edge[1:] == edge[:-1])
    cosine = (normals.reshape(-1, 3)[face[pair]] * normals.reshape(-1, 3)[face[pair + 1]]).sum(1)
    sharp = np.zeros(len(mesh.edges), dtype=bool)
    sharp[edge[pair[cosine < math.cos(math.radians(angle))]]] = True
    mesh.edges.foreach_set("use_edge_sharp", sharp)
    if hasattr(mesh, "use_auto_smooth"):  # until 4.0: sharp edges count only where this is set
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
    mesh.update()


# ---------------------------------------------------------------------------------------------- pictures and materials


def image(name, pixels, color=True):
    """A packed 8-bit picture from an array (rows from the bottom, columns, 3). Colours are linear Rec. 709, 0 to 1, and
    stored as sRGB; numbers (normal maps) are stored as they are."""
    height, width = pixels.shape[:2]
    picture = bpy.data.images.new(name, width, height, alpha=False)
    picture.colorspace_settings.name = "sRGB" if color else "Non-Color"
    pixels = np.clip(pixels, 0, 1)
    if color:
        pixels = np.where(pixels <= 0.0031308, 12.92 * pixels, 1.055 * pixels ** (1 / 2.4) - 0.055)
    rgba = np.ones((height, width, 4), np.float32)
    rgba[..., :3] = np.round(pixels * 255) / 255
    picture.pixels.foreach_set(rgba.ravel())
    picture.update()
    picture.pack()
    return picture


def principled(name, color, *, roughness=0.5, metallic=0.0, transmission=0.0, ior=1.5, specular=0.5, emission=None,
               texture=None, normal_map=None, normal_strength=1.0):
    """A material of the Principled BSDF. `texture` and `normal_map` are pictures; the texture replaces the colour."""
    material, tree, output = _empty_material(name)
    material.diffuse_color = (*color, 1)
    shader = tree.nodes.new("ShaderNodeBsdfPrincipled")
    shader.location = (0, 0)
    values = {"Base Color": (*color, 1), "Roughness": roughness, "Metallic": metallic, "IOR": ior,
              "Transmission": transmission, "Specular": specular}
    if emission is not None:
        values["Emission"] = (*emission, 1)
        values["Emission Strength"] = 1.0
    for key, value in values.items():
        _socket(shader, key).default_value = value
    tree.links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    if texture is not None:
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image, node.location = texture, (-400, 100)
        tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    if normal_map is not None:
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image, node.location = normal_map, (-600, -300)
        turn = tree.nodes.new("ShaderNodeNormalMap")
        turn.inputs["Strength"].default_value, turn.location = normal_strength, (-250, -300)
        tree.links.new(node.outputs["Color"], turn.inputs["Color"])
        tree.links.new(turn.outputs["Normal"], shader.inputs["Normal"])
    return material


def diffuse(name, color):
    """A material of the Diffuse BSDF: reflectance `color`."""
    material, tree, output = _empty_material(name)
    material.diffuse_color = (*color, 1)
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1)
    tree.links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    return material


def emitter(name, radiance, color=None):
    """A surface that emits `radiance` (linear Rec. 709, W/(m² sr)) from its front, and reflects `color` if given."""
    if color is not None:
        strength = max(radiance)
        material = principled(name, color, roughness=1.0, specular=0.0, emission=[c / strength for c in radiance])
        shader = next(n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
        shader.inputs["Emission Strength"].default_value = strength
    else:
        material, tree, output = _empty_material(name)
        shader = tree.nodes.new("ShaderNodeEmission")
        strength = max(radiance)
        shader.inputs["Color"].default_value = (*(c / strength for c in radiance), 1)
        shader.inputs["Strength"].default_value = strength
        tree.links.new(shader.outputs["Emission"], output.inputs["Surface"])
    material.use_backface_culling = True
    return material


def _empty_material(name):
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    output.location = (350, 0)
    return material, tree, output


def _socket(shader, name):
    return shader.inputs[name] if name in shader.inputs else shader.inputs[RENAMED_SOCKETS[name]]


# ------------------------------------------------------------------------------------------ lights, world and cameras


def aim(thing, target):
    """Turns a light or camera so that its −Z points to the target, +Y up."""
    direction = Vector(target) - thing.location
    thing.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()


def area_light(name, location, target, size, power, color=(1, 1, 1)):
    """A rectangular light of `size` (width, height) and `power` in watts: its radiance is power/(π · area)."""
    light = bpy.data.lights.new(name, "AREA")
    light.shape, light.size, light.size_y = "RECTANGLE", *size
    # Until 4.0, Blender's area lights gave π/4 of that radiance.
    light.energy = power * (4 / math.pi if bpy.app.version < (4, 0, 0) else 1)
    light.color = color
    thing = link(name, light, location)
    aim(thing, target)
    return thing


def point_light(name, location, power, color=(1, 1, 1), radius=0.0):
    """A point light of `power` watts, as a sphere of that radius."""
    light = bpy.data.lights.new(name, "POINT")
    light.energy, light.color, light.shadow_soft_size = power, color, radius
    return link(name, light, location)


def spot_light(name, location, target, power, angle, blend=0.4, color=(1, 1, 1), radius=0.03):
    light = bpy.data.lights.new(name, "SPOT")
    light.energy, light.color, light.shadow_soft_size = power, color, radius
    light.spot_size, light.spot_blend = math.radians(angle), blend
    thing = link(name, light, location)
    aim(thing, target)
    return thing


def sun_light(name, direction, irradiance, color=(1, 1, 1), angle=0.53):
    """The sun: `direction` is the way its light goes, `irradiance` in W/m² on a surface that faces it."""
    light = bpy.data.lights.new(name, "SUN")
    light.energy, light.color, light.angle = irradiance, color, math.radians(angle)
    thing = link(name, light)
    aim(thing, direction)
    return thing


def world(color=(0, 0, 0), picture=None, strength=1.0):
    """The background, which lights too: radiance `color`, or `strength` times a latitude-longitude picture."""
    background = bpy.data.worlds.new("World")
    if background.node_tree is None:
        background.use_nodes = True
    bpy.context.scene.world = background
    tree = background.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputWorld")
    shader = tree.nodes.new("ShaderNodeBackground")
    tree.links.new(shader.outputs["Background"], output.inputs["Surface"])
    if picture is None:
        shader.inputs["Color"].default_value, shader.inputs["Strength"].default_value = (*color, 1), 1.0
    else:
        node = tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = picture
        tree.links.new(node.outputs["Color"], shader.inputs["Color"])
        shader.inputs["Strength"].default_value = strength
    return background


def camera(location, target, lens=50.0, sensor=36.0, shift=(0, 0)):
    """The scene's camera: focal length and film width in millimetres."""
    data = bpy.data.cameras.new("Camera")
    data.lens, data.sensor_width, data.shift_x, data.shift_y = lens, sensor, *shift
    data.clip_start, data.clip_end = 0.05, 200
    thing = link("Camera", data, location)
    aim(thing, target)
    bpy.context.scene.camera = thing
    return thing
