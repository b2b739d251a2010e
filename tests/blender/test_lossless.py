# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene gives the same picture through the engine and through .glb and the command: nothing is lost."""

import json
import subprocess

import bpy
import exr
import numpy as np
import pytest
import stage
from triptych import gltf

pytestmark = pytest.mark.library


def both(scene, cli, tmp_path, method="ray_casting", samples=8):
    """(Blender's picture, the command's)"""
    scene.triptych.method = method
    scene.triptych.samples = samples
    pixels = stage.render(scene)
    assert stage.status() == ""
    glb, out = str(tmp_path / "scene.glb"), str(tmp_path / "out.exr")
    gltf.write(glb, scene)
    command = [cli, "render", glb, "--method", method, "--output", out, "--quiet"]
    subprocess.run(command, check=True, timeout=300)
    return pixels, exr.image(_combined(exr.read(out)))


def _combined(channels):
    return {name.split(".")[-1]: values for name, values in channels.items() if "Combined" in name or "." not in name}


def same(scene, cli, tmp_path, **arguments):
    ours, theirs = both(scene, cli, tmp_path, **arguments)
    assert ours.shape == theirs.shape
    assert ours[..., :3].max() > 0.05, "the picture is black"
    difference = np.abs(ours - theirs).max(axis=2)
    assert difference.max() <= 1e-4, f"{np.count_nonzero(difference > 1e-4)} pixels, worst {difference.max()}"
    return ours


def checker(name="Checker", size=64):
    y, x = np.mgrid[0:size, 0:size]
    board = (x // 8 + y // 8) % 2
    return stage.picture(name, np.stack([board * 0.8 + 0.1, x / size, y / size], axis=2).astype(np.float32))


def normals(name="Normals", size=64):
    x = np.arange(size) / size
    slope = 0.4 * np.cos(x * 2 * np.pi * 4)
    length = np.sqrt(slope**2 + 1)
    rgb = np.stack([slope / length * 0.5 + 0.5, np.full(size, 0.5), 0.5 / length + 0.5], axis=1)
    return stage.picture(name, np.broadcast_to(rgb, (size, size, 3)).astype(np.float32), "Non-Color", True)


def ground(scene):
    plane = stage.plane(scene, 20)
    stage.material(plane, Color=(0.6, 0.6, 0.6), name="Ground")
    return plane


def view(scene, **values):
    return stage.camera(scene, (6, -8, 5), (0, 0, 0.5), lens=40, **values)


def test_meshes(scene, cli, tmp_path):
    """n-gons, concave faces, split normals, flat and smooth faces, mirrored instances."""
    ground(scene)
    stage.light(scene, "POINT", (3, -3, 6), 600)
    arrow = [(0, 0, 1), (2, 1, 1.2), (0, 2, 1), (0.8, 1, 1.1)]
    stage.mesh(scene, "Arrow", arrow, [(0, 1, 2, 3)], location=(-3, 0, 0))
    bpy.ops.mesh.primitive_cylinder_add(vertices=9, location=(0, 0, 1))
    cylinder = bpy.context.object
    for k, face in enumerate(cylinder.data.polygons):
        face.use_smooth = k % 3 > 0
    if hasattr(cylinder.data, "use_auto_smooth"):
        cylinder.data.use_auto_smooth = True
    else:
        for edge in cylinder.data.edges:
            edge.use_edge_sharp = edge.index % 2 == 0
    stage.link(scene, "Mirrored", cylinder.data, (2.5, 0, 1), rotation=(20, 0, 0), scale=(-1, 1, 0.5))
    bpy.ops.mesh.primitive_uv_sphere_add(location=(0, 2.5, 1), segments=12, ring_count=8)
    for face in bpy.context.object.data.polygons:
        face.use_smooth = True
    view(scene)
    same(scene, cli, tmp_path)


@pytest.mark.parametrize("kind", ["flat", "smooth", "own normals", "slots", "seams"])
def test_triangles(scene, cli, tmp_path, kind):
    """Nothing but triangles, most of which glTF can say: bright highlights are the same, and no vertex is split."""
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    cube = stage.mesh(scene, "Cube", corners, [(face[0], *face[k : k + 2]) for face in faces for k in (1, 2)])
    _, tree, node = stage.material(cube, "ShaderNodeBsdfGlossy", name="Shiny", Color=(0.9, 0.7, 0.3), Roughness=0.1)
    stage.material(cube, name="Dull", Color=(0.2, 0.6, 0.3))
    for k, face in enumerate(cube.data.polygons):
        face.use_smooth = kind != "flat"
        face.material_index = k % 2 if kind == "slots" else 0
    if kind == "own normals":
        if hasattr(cube.data, "use_auto_smooth"):
            cube.data.use_auto_smooth = True
        cube.data.normals_split_custom_set_from_vertices([(x, y, z + 0.3) for x, y, z in corners])
    elif kind == "seams":
        cube.data.uv_layers.new()  # each face has the same corner of the picture
        image = tree.nodes.new("ShaderNodeTexImage")
        image.image = checker()
        tree.links.new(image.outputs[0], node.inputs["Color"])
    again = stage.link(scene, "Again", cube.data, (1.5, 1.5, -0.5), rotation=(0, 30, 20))
    again.material_slots[0].link, again.material_slots[0].material = "OBJECT", bpy.data.materials["Dull"]
    stage.light(scene, "POINT", (3, -3, 6), 2000)
    stage.camera(scene, (4, -5, 4), lens=100)
    same(scene, cli, tmp_path)
    command = [cli, "info", "--json", str(tmp_path / "scene.glb")]
    told = json.loads(subprocess.run(command, check=True, timeout=300, capture_output=True).stdout)
    assert (told["instances"], told["faces"], told["vertices"]) == (2, 2 * 12, 2 * 8)


def test_materials(scene, cli, tmp_path):
    """Textures, a normal map, vertex colours, object colours, mixes, alpha, slots."""
    board, bumps = checker(), normals()
    plane = stage.plane(scene, 12)
    _, tree, node = stage.material(plane, "ShaderNodeBsdfPrincipled", name="Board", Metallic=0.0)
    image, mapping = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeMapping")
    coordinate = tree.nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Scale"].default_value = (2, 3, 1)
    mapping.inputs["Rotation"].default_value = (0, 0, 0.4)
    mapping.inputs["Location"].default_value = (0.1, 0.2, 0)
    image.image = board
    tree.links.new(coordinate.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], image.inputs["Vector"])
    tree.links.new(image.outputs["Color"], node.inputs["Base Color"])
    tree.links.new(image.outputs["Color"], node.inputs["Roughness"])
    second, turn = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeNormalMap")
    second.image = bumps
    tree.links.new(second.outputs["Color"], turn.inputs["Color"])
    tree.links.new(turn.outputs[0], node.inputs["Normal"])

    painted = stage.plane(scene, 2, name="Painted", location=(-1, -1, 1), rotation=(40, 0, 0))
    colors = painted.data.color_attributes.new("Paint", "BYTE_COLOR", "CORNER")
    for k, value in enumerate([(1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1), (1, 1, 0, 1)]):
        colors.data[k].color = value
    _, tree, node = stage.material(painted, name="Paint")
    paint, tint = tree.nodes.new("ShaderNodeVertexColor"), tree.nodes.new("ShaderNodeObjectInfo")
    paint.layer_name = "Paint"
    mix = tree.nodes.new("ShaderNodeMixRGB")
    mix.blend_type = "MULTIPLY"
    mix.inputs["Fac"].default_value = 0.5
    tree.links.new(paint.outputs["Color"], mix.inputs["Color1"])
    tree.links.new(tint.outputs["Color"], mix.inputs["Color2"])
    tree.links.new(mix.outputs[0], node.inputs["Color"])
    painted.color = (0.5, 1, 0.25, 1)

    shiny = stage.plane(scene, 2, name="Shiny", location=(2, 0, 1), rotation=(30, 30, 0))
    stage.material(shiny, "ShaderNodeBsdfGlossy", name="Shiny", Color=(0.9, 0.7, 0.3), Roughness=0.3)
    _, tree, node = stage.material(None, "ShaderNodeBsdfDiffuse", name="Own", Color=(0.2, 0.3, 0.9))
    again = stage.link(scene, "Again", shiny.data, (0, 2, 1), rotation=(60, 0, 0))
    again.material_slots[0].link, again.material_slots[0].material = "OBJECT", bpy.data.materials["Own"]

    glow = stage.plane(scene, 1, name="Glow", location=(3, -2, 0.5), rotation=(70, 0, 20))
    stage.material(glow, "ShaderNodeEmission", name="Glow", Color=(1.0, 0.4, 0.1), Strength=2.0)
    veil = stage.plane(scene, 2, name="Veil", location=(1, -3, 1), rotation=(80, 0, 30))
    _, tree, node = stage.material(veil, "ShaderNodeBsdfPrincipled", name="Veil", Alpha=0.5)
    stage.light(scene, "POINT", (2, -4, 6), 900)
    view(scene)
    same(scene, cli, tmp_path, samples=16)


@pytest.mark.parametrize("kind", ["POINT", "SPOT", "SUN", "AREA", "DISK", "WORLD", "ENVIRONMENT"])
def test_lights(scene, cli, tmp_path, kind):
    ground(scene)
    bpy.ops.mesh.primitive_uv_sphere_add(location=(0, 0, 1))
    if kind == "POINT":
        stage.light(scene, "POINT", (2, -2, 4), 500, shadow_soft_size=0.5, color=(1, 0.8, 0.6))
    elif kind == "SPOT":
        stage.light(scene, "SPOT", (2, -2, 5), 900, rotation=(20, 20, 0), spot_size=1.0, spot_blend=0.4)
    elif kind == "SUN":
        stage.light(scene, "SUN", (0, 0, 5), 3, rotation=(30, 20, 0), angle=0.1)
    elif kind in {"AREA", "DISK"}:
        shape = "RECTANGLE" if kind == "AREA" else "ELLIPSE"
        lamp = stage.light(
            scene, "AREA", (1, -1, 3), 300, rotation=(20, 10, 0), shape=shape, size=1, size_y=2, spread=2
        )
        lamp.scale = (2, 1, 1)
    else:
        tree, background = stage.world_color(scene, (0.5, 0.7, 1), 1.5)
        if kind == "ENVIRONMENT":
            image = tree.nodes.new("ShaderNodeTexEnvironment")
            image.image = stage.picture(
                "Sky", np.random.default_rng(3).random((8, 16, 3), np.float32), "Non-Color", True
            )
            mapping = tree.nodes.new("ShaderNodeMapping")
            mapping.inputs["Rotation"].default_value = (0, 0, 0.5)
            coordinate = tree.nodes.new("ShaderNodeTexCoord")
            tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
            tree.links.new(mapping.outputs[0], image.inputs["Vector"])
            tree.links.new(image.outputs[0], background.inputs["Color"])
    view(scene)
    same(scene, cli, tmp_path)


@pytest.mark.parametrize("turn", [(0, 0, 0.5), (0.4, -0.7, 1.1)], ids=["z", "any"])
def test_world_picture(scene, cli, tmp_path, turn):
    tree, background = stage.world_color(scene, (1, 1, 1))
    image, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
    image.image = checker("Sky")
    mapping.inputs["Rotation"].default_value = turn
    tree.links.new(mapping.outputs[0], image.inputs["Vector"])
    tree.links.new(image.outputs[0], background.inputs["Color"])
    ground(scene)
    stage.camera(scene, (3, -3, 2), (0, 0, 1.5))
    same(scene, cli, tmp_path)


@pytest.mark.parametrize("kind", ["shift", "lens", "orthographic", "vertical", "aspect"])
def test_cameras(scene, cli, tmp_path, kind):
    ground(scene)
    bpy.ops.mesh.primitive_cube_add(location=(0, 0, 1))
    stage.light(scene, "POINT", (3, -3, 6), 600)
    camera = view(scene)
    if kind == "shift":
        camera.data.shift_x, camera.data.shift_y = 0.2, -0.1
    elif kind == "lens":
        dof = camera.data.dof
        dof.use_dof, dof.aperture_fstop, dof.aperture_blades, dof.aperture_rotation = True, 0.2, 5, 0.3
        dof.focus_object = scene.objects["Cube"]
    elif kind == "orthographic":
        camera.data.type, camera.data.ortho_scale = "ORTHO", 5
    elif kind == "vertical":
        camera.data.sensor_fit, camera.data.sensor_height = "VERTICAL", 20
    else:
        scene.render.pixel_aspect_x, scene.render.resolution_x, scene.render.resolution_y = 1.5, 40, 50
    same(scene, cli, tmp_path)


def test_settings_travel(scene, cli, tmp_path):
    ground(scene)
    stage.light(scene, "POINT", (3, -3, 6), 600)
    view(scene)
    plain = stage.render(scene)
    scene.triptych.shading_ambient = (0.1, 0.2, 0.4)
    scene.triptych.seed = 5
    assert np.abs(same(scene, cli, tmp_path) - plain).max() > 0.05


def test_every_method(scene, cli, tmp_path):
    from triptych import core

    ground(scene)
    bpy.ops.mesh.primitive_monkey_add(location=(0, 0, 1))
    stage.light(scene, "POINT", (3, -3, 6), 600)
    view(scene)
    for name, _, _ in core.methods():
        same(scene, cli, tmp_path, method=name)
