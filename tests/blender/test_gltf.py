# SPDX-License-Identifier: GPL-3.0-or-later
"""The glTF writer: what stands in the file is what was exported. Needs no library."""

from math import radians

import bpy
import exr
import numpy as np
import pytest
import stage
from glb import Glb, written
from triptych import gltf
from triptych.as_rendered import export_as_rendered
from triptych.export_texture import exr_bytes, png_bytes


def test_transforms(scene, tmp_path):
    """An object's Z is up; cameras and lights look along their own −Z in both worlds."""
    plane = stage.plane(scene, location=(1, 2, 3), rotation=(30, 40, 50), scale=(-1, 2, 3))
    stage.light(scene, "AREA", (4, 5, 6), rotation=(10, 20, 30), shape="ELLIPSE", size=2, size_y=3, spread=1)
    camera = stage.camera(scene, (7, 8, 9))
    bpy.context.view_layer.update()
    glb = written(scene, tmp_path)
    turn = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])  # Z up from Y up
    nodes = {node["name"]: np.array(node["matrix"]).reshape(4, 4).T for node in glb.json["nodes"]}
    assert np.allclose(turn @ nodes["Plane"] @ turn.T, np.array(plane.matrix_world), atol=1e-6)
    assert np.allclose(turn @ nodes["Camera"], np.array(camera.matrix_world), atol=1e-6)
    assert np.allclose(turn @ nodes["Area"], np.array(bpy.data.objects["Area"].matrix_world), atol=1e-6)
    root = glb.extras(glb.json["scenes"][0])
    assert glb.json["nodes"][root["camera"]]["name"] == "Camera"
    assert root["film"] == {"width": 64, "height": 48}
    light = next(glb.extras(node)["light"] for node in glb.json["nodes"] if node["name"] == "Area")
    assert light["size"] == [2, 3] and light["shape"] == "ellipse" and light["angle"] == 1


def test_images(scene, tmp_path):
    plane = stage.plane(scene)
    rng = np.random.default_rng(1)
    bytes_, floats = rng.random((5, 3, 4), np.float32), rng.random((4, 6, 4), np.float32) * 10
    material, tree, node = stage.material(plane, "ShaderNodeEmission")
    first, second = (tree.nodes.new("ShaderNodeTexImage") for _ in range(2))
    first.image = stage.picture("Bytes", bytes_)
    second.image = stage.picture("Floats", floats, "Non-Color", True)
    second.extension, second.interpolation = "EXTEND", "Closest"
    tree.links.new(first.outputs["Color"], node.inputs["Color"])
    tree.links.new(second.outputs["Color"], node.inputs["Strength"])
    stage.camera(scene)
    glb = written(scene, tmp_path)
    textures = {texture["name"]: texture for texture in glb.json["textures"]}
    content = {name: glb.image(texture["source"]) for name, texture in textures.items()}
    assert content["Bytes"].startswith(b"\x89PNG") and content["Floats"].startswith(b"\x76\x2f\x31\x01")
    assert glb.extras(textures["Bytes"]) == {"color_space": "srgb", "wrap": ["repeat"] * 2, "filter": "smooth"}
    assert glb.extras(textures["Floats"]) == {"color_space": "linear", "wrap": ["clamp"] * 2, "filter": "nearest"}
    (tmp_path / "f.exr").write_bytes(content["Floats"])
    assert np.array_equal(exr.image(exr.read(tmp_path / "f.exr")), floats)


def test_picture_bytes_are_read_by_blender(scene, tmp_path):
    rng = np.random.default_rng(2)
    for channels in (3, 4):
        pixels = rng.integers(0, 256, (7, 5, channels), np.uint8)
        path = tmp_path / f"{channels}.png"
        path.write_bytes(png_bytes(pixels))
        image = bpy.data.images.load(str(path))
        image.colorspace_settings.name, image.alpha_mode = "Non-Color", "CHANNEL_PACKED"
        found = np.empty(7 * 5 * 4, np.float32)
        image.pixels.foreach_get(found)
        assert np.allclose(found.reshape(7, 5, 4)[..., :channels] * 255, pixels, atol=1e-3)
        floats = rng.random((7, 5, channels), np.float32) * 100
        path = tmp_path / f"{channels}.exr"
        path.write_bytes(exr_bytes(floats))
        image = bpy.data.images.load(str(path))
        image.colorspace_settings.name, image.alpha_mode = "Non-Color", "CHANNEL_PACKED"
        image.pixels.foreach_get(found)
        assert np.array_equal(found.reshape(7, 5, 4)[..., :channels], floats)


def test_materials_keep_their_program(scene, tmp_path):
    plane = stage.plane(scene)
    material, tree, node = stage.material(plane, "ShaderNodeBsdfPrincipled")
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = stage.picture("Image", np.zeros((2, 2, 4), np.float32))
    tree.links.new(image.outputs[0], node.inputs["Roughness"])
    material.pass_index, material.use_backface_culling = 5, True
    stage.camera(scene)
    exported = export_as_rendered(scene).materials[0]
    glb = written(scene, tmp_path)
    extras = glb.extras(glb.json["materials"][0])
    assert [node["type"] for node in extras["nodes"]] == [node.type for node in exported.nodes]
    assert extras["shininess"] == {"value": 1, "node": exported.shininess.node}
    assert np.float32(extras["diffuse"]).tolist() == np.float32(exported.diffuse.value).tolist()
    assert extras["index"] == 5 and extras["double_sided"] is False and "ambient" not in extras


def test_missing_image_is_a_warning(scene, tmp_path):
    plane = stage.plane(scene)
    _, tree, node = stage.material(plane)
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = bpy.data.images.new("Gone", 2, 2)
    image.image.source, image.image.filepath = "FILE", "//gone.png"
    tree.links.new(image.outputs[0], node.inputs["Color"])
    stage.camera(scene)
    warnings = gltf.write(str(tmp_path / "scene.glb"), scene)
    assert any("Gone" in line for line in warnings)
    assert Glb(tmp_path / "scene.glb").json["images"][0]["uri"] == "gone.png"


def test_without_a_camera(scene, tmp_path):
    stage.plane(scene)
    warnings = gltf.write(str(tmp_path / "scene.glb"), scene)
    assert any("no camera" in line for line in warnings)
    assert "cameras" not in Glb(tmp_path / "scene.glb").json


def test_empty_scene(scene, tmp_path):
    gltf.write(str(tmp_path / "scene.glb"), scene)
    assert "meshes" not in Glb(tmp_path / "scene.glb").json


def test_depsgraph(scene, tmp_path):
    stage.plane(scene)
    gltf.write(str(tmp_path / "scene.glb"), bpy.context.evaluated_depsgraph_get())
    assert len(Glb(tmp_path / "scene.glb").json["nodes"]) == 1


def test_folder_that_is_not_there(scene, tmp_path):
    with pytest.raises(OSError):
        gltf.write(str(tmp_path / "none" / "scene.glb"), scene)


def test_operator_and_state(scene, tmp_path):
    """The scene is afterwards as it was."""
    stage.plane(scene)
    stage.camera(scene)
    scene.render.engine = "BLENDER_WORKBENCH"
    before = (scene.render.engine, scene.render.use_compositing, scene.render.use_border)
    path = str(tmp_path / "scene.glb")
    assert bpy.ops.export_scene.triptych(filepath=path) == {"FINISHED"}
    assert (scene.render.engine, scene.render.use_compositing, scene.render.use_border) == before
    with pytest.raises(TypeError):
        scene.render.engine = "TRIPTYCH_EXPORT"
    assert len(Glb(path).json["nodes"]) == 2


def test_orthographic_camera_and_world(scene, tmp_path):
    stage.camera(scene, type="ORTHO", ortho_scale=4)
    tree, background = stage.world_color(scene, (1, 0.5, 0.25), 2)
    node = tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = stage.picture("Sky", np.ones((4, 8, 3), np.float32), "Non-Color", True)
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = (0, 0, radians(30))
    tree.links.new(mapping.outputs[0], node.inputs["Vector"])
    tree.links.new(node.outputs[0], background.inputs["Color"])
    glb = written(scene, tmp_path)
    assert glb.json["cameras"][0]["orthographic"]["xmag"] == 2
    world = glb.extras(glb.json["scenes"][0])["world"]
    assert world["rotation"] == pytest.approx(radians(-30)) and world["radiance"] == [2, 2, 2] and world["texture"] == 0
