# SPDX-License-Identifier: GPL-3.0-or-later
"""Brightness against Cycles. The mean over lit pixels within 1 %.

One diffuse plane under one light without bounces; then path tracing: diffuse walls, mirrors and glass; and ray tracing
of mirrors and glass alone.
"""

from math import pi

import bpy
import numpy as np
import pytest
import stage
from triptych import compat

pytestmark = [pytest.mark.library, pytest.mark.slow]

SAMPLES = 256


@pytest.fixture(autouse=True)
def cycles(scene):
    """A plane of 8 m in the view from above, that Cycles can render."""
    try:
        scene.render.engine = "CYCLES"
    except TypeError:
        bpy.ops.preferences.addon_enable(module="cycles")
        scene.render.engine = "CYCLES"
    settings = scene.cycles
    settings.device, settings.samples, settings.max_bounces = "CPU", SAMPLES, 0
    settings.use_denoising = settings.use_adaptive_sampling = False
    settings.sample_clamp_direct = settings.sample_clamp_indirect = 0
    scene.triptych.method = "ray_casting"
    plane = stage.plane(scene, 8)
    stage.material(plane, Color=(0.8, 0.5, 0.3))
    stage.camera(scene, (0, 0, 12), lens=60)


def spots_are_comparable():
    if compat.VERSION < (4, 0):
        pytest.skip("Cycles of that version dims a spot by the cosine to its axis; Triptych follows the later ones")


def compare(scene, tolerance=0.01, least=0.02):
    """Means of both pictures over pixels that are lit in both."""
    scene.render.engine = "CYCLES"
    theirs = stage.render(scene)[..., :3]
    scene.render.engine = "TRIPTYCH"
    scene.triptych.samples = SAMPLES
    ours = stage.render(scene)[..., :3]
    assert stage.status() == ""
    bright = theirs.max(axis=2)
    lit = bright > least * bright.max()
    assert bright.max() > 0 and np.count_nonzero(lit) > 100
    ratio = ours[lit].mean(axis=0) / theirs[lit].mean(axis=0)
    assert ratio == pytest.approx([1, 1, 1], abs=tolerance)
    # The same shape too, not just the same sum: blocks of 8 × 8 pixels, where Cycles' noise has averaged out.
    blocks = [picture.mean(axis=2).reshape(6, 8, 8, 8).mean(axis=(1, 3)) for picture in (ours, theirs)]
    bright = blocks[1] > 0.25 * blocks[1].max()
    assert blocks[0][bright] / blocks[1][bright] == pytest.approx(np.ones(np.count_nonzero(bright)), abs=0.04)


@pytest.mark.parametrize("radius", [0, 0.5])
def test_point(scene, radius):
    stage.light(scene, "POINT", (0.5, 0.3, 2), 200, shadow_soft_size=radius, color=(1, 0.7, 0.4))
    compare(scene)


@pytest.mark.parametrize("size, blend, radius", [(1.2, 0.0, 0), (1.2, 0.15, 0), (1.8, 1.0, 0), (1.2, 0.5, 0.3)])
def test_spot(scene, size, blend, radius):
    spots_are_comparable()
    rotation = (20, 10, 0)
    stage.light(scene, "SPOT", (0, 1, 4), 500, rotation, spot_size=size, spot_blend=blend, shadow_soft_size=radius)
    compare(scene)


@pytest.mark.parametrize("angle", [0, 0.2])
def test_sun(scene, angle):
    stage.light(scene, "SUN", (0, 0, 5), 3, (40, 20, 0), angle=angle)
    compare(scene)


@pytest.mark.parametrize("shape", ["SQUARE", "RECTANGLE", "DISK", "ELLIPSE"])
@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 0.5, 3)])
def test_area(scene, shape, scale):
    lamp = stage.light(scene, "AREA", (0, 0.5, 2), 100, (20, 0, 0), shape=shape, size=1, size_y=2)
    lamp.scale = scale
    lamp.visible_camera = False
    compare(scene)


@pytest.mark.parametrize("spread", [pi / 2, pi / 4])
def test_area_spread(scene, spread):
    lamp = stage.light(scene, "AREA", (0, 0.5, 2), 100, shape="RECTANGLE", size=1, size_y=2, spread=spread)
    lamp.visible_camera = False
    compare(scene)


def falloff(light, output, strength=1.0):
    light.use_nodes = True
    tree = light.node_tree
    emission = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeEmission")
    emission.inputs["Color"].default_value = (0.5, 1, 0.8, 1)
    node = tree.nodes.new("ShaderNodeLightFalloff")
    node.inputs["Strength"].default_value = strength
    tree.links.new(node.outputs[output], emission.inputs["Strength"])


@pytest.mark.parametrize("kind", ["POINT", "SPOT", "AREA"])
@pytest.mark.parametrize("output", ["Quadratic", "Linear", "Constant"])
def test_falloff(scene, kind, output):
    if kind == "SPOT":
        spots_are_comparable()
    lamp = stage.light(scene, kind, (0.3, 0.5, 2), 100)
    if kind == "AREA":
        lamp.data.size, lamp.visible_camera = 0.5, False
    else:
        lamp.data.shadow_soft_size = 0
    falloff(lamp.data, output, 1.5)
    compare(scene)


def test_world(scene):
    stage.world_color(scene, (0.5, 0.7, 1), 1.5)
    compare(scene)


def test_environment(scene):
    """A picture with a bright patch, turned about the vertical: the plane is lit by half of it."""
    tree, background = stage.world_color(scene, (1, 1, 1))
    image, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
    pixels = np.full((32, 64, 3), 0.2, np.float32)
    pixels[20:28, 5:15] = (3, 2, 1)
    image.image = stage.picture("Sky", pixels, "Non-Color", True)
    coordinate = tree.nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Rotation"].default_value = (0, 0, 0.7)
    tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], image.inputs["Vector"])
    tree.links.new(image.outputs[0], background.inputs["Color"])
    compare(scene)


def test_environment_direction(scene):
    """What the camera sees of a turned picture is the same, pixel by pixel."""
    bpy.data.objects.remove(scene.objects["Plane"])
    tree, background = stage.world_color(scene, (1, 1, 1))
    image, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
    y, x = np.mgrid[0:64, 0:128]
    pixels = np.stack([x / 128, y / 64, 0.5 + 0.5 * np.sin(x / 128 * 4 * pi)], axis=2).astype(np.float32)
    image.image = stage.picture("Sky", pixels, "Non-Color", True)
    coordinate = tree.nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Rotation"].default_value = (0.3, 0.5, 0.7)
    tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], image.inputs["Vector"])
    tree.links.new(image.outputs[0], background.inputs["Color"])
    scene.camera.rotation_euler = (1.2, 0.1, 0.8)
    scene.camera.data.lens = 20
    scene.render.engine = "CYCLES"
    theirs = stage.render(scene)[..., :3]
    scene.render.engine = "TRIPTYCH"
    assert stage.render(scene)[..., :3] == pytest.approx(theirs, abs=0.02)


def test_mesh_light(scene):
    panel = stage.plane(scene, 1, name="Panel", location=(0, 0.5, 2), rotation=(160, 0, 0))
    stage.material(panel, "ShaderNodeEmission", name="Glow", Color=(1.0, 0.8, 0.5), Strength=20.0)
    panel.visible_camera = False
    compare(scene)


def test_exposure_temperature_and_normalize(scene):
    if compat.VERSION < (4, 5):
        pytest.skip("lights have no such properties")
    lamp = stage.light(scene, "AREA", (0, 0.5, 2), 10, size=2, exposure=1.5, normalize=False)
    lamp.data.use_temperature, lamp.data.temperature = True, 3000
    lamp.visible_camera = False
    compare(scene)


@pytest.mark.parametrize("kind", ["POINT", "SPOT", "SUN"])
@pytest.mark.parametrize("size", [0, 0.3])
def test_not_normalized(scene, kind, size):
    if compat.VERSION < (4, 5):
        pytest.skip("lights are always normalized")
    lamp = stage.light(scene, kind, (0, 0.5, 2), 50, normalize=False)
    if kind == "SUN":
        lamp.data.angle = size
    else:
        lamp.data.shadow_soft_size = size
    compare(scene)


def textured(scene, normal_map):
    plane = scene.objects["Plane"]
    material, tree, node = stage.material(None, name="Textured")
    plane.material_slots[0].material = material
    y, x = np.mgrid[0:64, 0:64]
    image = tree.nodes.new("ShaderNodeTexImage")
    if normal_map:
        slope = 0.6 * np.sin(x / 64 * 2 * pi)
        length = np.sqrt(1 + slope**2 + 0.04)
        rgb = np.stack([slope / length, np.full_like(slope, 0.2) / length, 1 / length], axis=2) * 0.5 + 0.5
        image.image = stage.picture("Normals", rgb.astype(np.float32), "Non-Color", True)
        turn = tree.nodes.new("ShaderNodeNormalMap")
        tree.links.new(image.outputs["Color"], turn.inputs["Color"])
        tree.links.new(turn.outputs[0], node.inputs["Normal"])
    else:
        # Fine, as Cycles blends neighbouring pixels before it makes them linear.
        y, x = np.mgrid[0:1024, 0:1024] / 1024
        board = ((x * 4).astype(int) + (y * 4).astype(int)) % 2 * 0.6 + 0.2
        image.image = stage.picture("Board", np.stack([board, x, y], axis=2).astype(np.float32))
        tree.links.new(image.outputs["Color"], node.inputs["Color"])


@pytest.mark.parametrize("normal_map", [False, True])
@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1)])
def test_textured_plane(scene, normal_map, scale):
    textured(scene, normal_map)
    scene.objects["Plane"].scale = scale
    stage.light(scene, "SUN", (0, 0, 5), 3, (30, 20, 0), angle=0)
    compare(scene)


def test_principled_diffuse(scene):
    """A rough Principled surface without reflections is its base colour."""
    material, tree, node = stage.material(None, "ShaderNodeBsdfPrincipled", Roughness=1.0)
    compat.principled_socket(node, "specular").default_value = 0
    compat.principled_socket(node, "base").default_value = (0.7, 0.5, 0.2, 1)
    scene.objects["Plane"].material_slots[0].material = material
    stage.light(scene, "POINT", (0.5, 0.3, 2), 200, shadow_soft_size=0)
    compare(scene)


def ball(scene, location, radius=1.0):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=radius, location=location)
    made = bpy.context.object
    for polygon in made.data.polygons:
        polygon.use_smooth = True
    return made


def every_bounce(scene):
    settings = scene.cycles
    settings.max_bounces = settings.diffuse_bounces = settings.glossy_bounces = settings.transmission_bounces = 24
    settings.caustics_reflective = settings.caustics_refractive = True
    settings.blur_glossy = 0
    scene.triptych.method = "path_tracing"
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.6, 0.8, 1.0, 1)


@pytest.mark.parametrize("shader", ["ShaderNodeBsdfDiffuse", "ShaderNodeBsdfGlass", "ShaderNodeBsdfGlossy"])
def test_paths(scene, shader):
    """A ball on the plane under a sky: light goes between them, through the ball and by its mirror."""
    every_bounce(scene)
    values = {} if shader == "ShaderNodeBsdfDiffuse" else {"Roughness": 0.0}
    stage.material(ball(scene, (0.3, 0, 1.0)), shader, Color=(0.9, 0.8, 0.7), **values)
    stage.camera(scene, (0, -5, 4), (0, 0, 0.7))
    compare(scene)


@pytest.mark.parametrize("shaders", [["Glass"], ["Glossy"], ["Glass", "Glossy"]])
def test_trees(scene, shaders):
    """Glass and mirror balls on the plane, under a sky and an area light that they show. Surfaces do not light each
    other, in Cycles by a limit."""
    every_bounce(scene)
    scene.cycles.diffuse_bounces = 0
    scene.triptych.method = "ray_tracing"
    for name in ("trace_depth", "trace_reflection_depth", "trace_transmission_depth"):
        setattr(scene.triptych, name, 24)
    for name, location in zip(shaders, [(0.3, 0, 1.0), (-1.6, 0.8, 0.8)], strict=False):
        made = ball(scene, location, location[2])
        stage.material(made, f"ShaderNodeBsdf{name}", name=name, Color=(0.9, 0.8, 0.7), Roughness=0.0)
    lamp = stage.light(scene, "AREA", (1.5, -1, 4), 200, (20, 20, 0), shape="SQUARE", size=1.5)
    lamp.visible_camera = False
    stage.camera(scene, (0, -5, 4), (0, 0, 0.7))
    compare(scene)


def test_paths_in_a_room(scene):
    """Walls that light each other, from an area light."""
    every_bounce(scene)
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
    bpy.ops.mesh.primitive_cube_add(size=4, location=(0, 0, 2))
    room = bpy.context.object
    stage.material(room, Color=(0.7, 0.6, 0.5))
    bpy.data.objects.remove(scene.objects["Plane"])
    stage.material(ball(scene, (0.3, 0, 1.0), 0.7), Color=(0.2, 0.5, 0.8))
    lamp = stage.light(scene, "AREA", (0, 0, 3.9), 60, shape="SQUARE", size=1)
    lamp.visible_camera = False
    stage.camera(scene, (0, -1.9, 2), (0, 0, 1.5), lens=25)
    compare(scene)
