# SPDX-License-Identifier: GPL-3.0-or-later
"""Final renders through Blender: pictures, passes, borders, errors."""

import time
from math import pi

import bpy
import numpy as np
import pytest
import stage
from triptych import core, engine, properties
from triptych.as_rendered import export_as_rendered
from triptych.export_scene import export_scene

pytestmark = pytest.mark.library


@pytest.fixture(autouse=True)
def ray_casting(scene):
    scene.triptych.method = "ray_casting"
    scene.triptych.samples = 4


def lit_plane(scene, energy=4 * pi * 9, size=10.0, **camera):
    """A grey plane in the picture, one watt per steradian and square metre of distance squared above its middle."""
    plane = stage.plane(scene, size)
    stage.material(plane, Color=(0.5, 0.5, 0.5))
    stage.light(scene, "POINT", (0, 0, 3), energy, shadow_soft_size=0)
    stage.camera(scene, (0, 0, 4), **camera)
    return plane


def test_default_scene_has_lit_pixels(scene):
    bpy.ops.wm.read_factory_settings()
    scene = bpy.context.scene
    scene.render.engine = "TRIPTYCH"
    scene.triptych.method = "ray_casting"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 128, 96, 50
    pixels = stage.render(scene)
    assert stage.status() == "" and pixels.shape == (48, 64, 4)
    assert np.isfinite(pixels).all() and (pixels[..., 3] == 1).all()
    middle, corner = pixels[24, 32, :3], pixels[0, 0, :3]
    assert 0.1 < middle.mean() < 5 and corner == pytest.approx([0.05] * 3, abs=2e-3)


def test_brightness_of_a_plane(scene):
    """I = K_D E/π, with E = I/d² under the light and I/d² cos³ aside of it."""
    lit_plane(scene)
    pixels = stage.render(scene)
    assert pixels[23:25, 31:33, :3].mean() == pytest.approx(0.5 / pi, rel=5e-3)


def test_row_0_is_below(scene):
    lit_plane(scene)
    scene.objects["Point"].location = (0, 1.2, 1)
    pixels = stage.render(scene)[..., :3].mean(axis=2)
    assert pixels[36:].mean() > 3 * pixels[:12].mean()


def test_film_size_and_percentage(scene):
    lit_plane(scene)
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 101, 57, 50
    assert stage.render(scene).shape == (28, 50, 4)


@pytest.mark.parametrize("crop", [True, False])
def test_border(scene, crop):
    """A border gives the same pixels as the whole picture."""
    plane = lit_plane(scene)
    plane.location.x = 1
    whole = stage.render(scene)
    render = scene.render
    render.use_border, render.use_crop_to_border = True, crop
    render.border_min_x, render.border_max_x = 0.25, 0.75
    render.border_min_y, render.border_max_y = 0.5, 0.8
    part = stage.render(scene)
    assert stage.status() == ""
    y1 = 24 + (part.shape[0] if crop else 14)
    if crop:
        assert part.shape[1] == 32 and part.shape[0] in {14, 15}
        assert np.array_equal(part, whole[24:y1, 16:48])
    else:
        assert part.shape == whole.shape
        assert np.array_equal(part[24:y1, 16:48], whole[24:y1, 16:48]) and not part[:23].any()


def test_passes_arrive(scene):
    plane = lit_plane(scene)
    plane.pass_index = 3
    plane.material_slots[0].material.pass_index = 4
    layer = scene.view_layers[0]
    names = {}
    for row in core.passes():
        if row.name == "Combined" or properties.light_group(row.name) or not row.used_by("ray_casting"):
            continue
        name, switch = properties.blender_pass(row.name)
        setattr(layer if switch else layer.triptych, switch or properties.pass_switch(row.name), True)
        names[row.name] = name
    channels = stage.render(scene, multilayer=True)
    prefix = layer.name + "."

    def middle(name, letters):
        return np.array([channels[f"{prefix}{names[name]}.{letter}"][24, 32] for letter in letters])

    assert set(names.values()) <= {name.split(".")[1] for name in channels}
    assert middle("Depth", "Z") == pytest.approx([4], abs=1e-3)
    assert middle("Normal", "XYZ") == pytest.approx([0, 0, 1], abs=1e-4)
    assert middle("Position", "XYZ") == pytest.approx([0, 0, 0], abs=0.1)
    assert middle("IndexOB", "X") == 3 and middle("IndexMA", "X") == 4
    assert middle("Albedo", "RGB") == pytest.approx([0.5] * 3, abs=1e-4)
    assert middle("Shadow", "RGB") == pytest.approx([1] * 3, abs=1e-4)
    assert channels[prefix + "Combined.R"][24, 32] == pytest.approx(0.5 / pi, rel=1e-2)


def test_only_asked_passes(scene):
    lit_plane(scene)
    channels = stage.render(scene, multilayer=True)
    assert {name.split(".")[1] for name in channels} <= {"Combined", "Depth"}  # Blender asks for Z by itself


def in_groups(scene, *names):
    layer = scene.view_layers[0]
    for name in names:
        layer.lightgroups.add(name=name)
    return layer


def test_light_groups_are_passes(scene):
    """Each group of the view layer is a pass with its name, as Cycles calls it: the picture of its lamps alone."""
    plane = stage.plane(scene)
    stage.material(plane, Color=(0.5, 0.5, 0.5))
    stage.camera(scene, (0, 0, 4))
    layer = in_groups(scene, "Empty", "Key light", "Fill")
    lamps = {
        "Key light": stage.light(scene, "POINT", (1, 0, 2), 100, color=(1, 0.5, 0.2)),
        "Fill": stage.light(scene, "SUN", (0, 0, 3), 1),
        "": stage.light(scene, "POINT", (-1, 1, 1), 30),
    }
    for name, lamp in lamps.items():
        lamp.lightgroup = name

    def picture(channels, name):
        return np.stack([channels[f"{layer.name}.{name}.{letter}"] for letter in "RGB"], axis=2)

    channels = stage.render(scene, multilayer=True)
    assert stage.status() == ""
    parts = {name: picture(channels, f"Combined_{name}") for name in ("Empty", "Key light", "Fill")}
    assert not any("LightGroup" in name for name in channels)
    assert not parts["Empty"].any()
    for name in ("Key light", "Fill"):
        for other, lamp in lamps.items():
            lamp.hide_render = other != name
        alone = picture(stage.render(scene, multilayer=True), "Combined")
        assert alone.mean() > 0.01 and parts[name] == pytest.approx(alone, rel=1e-5, abs=1e-6)
    # The same name may be another group of another view layer.
    second = scene.view_layers.new("Second")
    second.lightgroups.add(name="Fill")
    for lamp in lamps.values():
        lamp.hide_render = False
    channels = stage.render(scene, multilayer=True)
    assert picture(channels, "Combined_Fill") == pytest.approx(parts["Fill"], rel=1e-5, abs=1e-6)
    assert np.array_equal(channels["Second.Combined_Fill.G"], channels[f"{layer.name}.Combined_Fill.G"])
    assert "Second.Combined_Empty.R" not in channels


def test_light_groups_where_there_are_none(scene):
    """The rasterizer gives no such passes; what else gives light is in no group; and there are eight."""
    plane = lit_plane(scene)
    layer = in_groups(scene, *(f"G{k}" for k in range(9)))
    scene.triptych.method = "flat"
    channels = stage.render(scene, multilayer=True)
    assert stage.status() == "" and not any("Combined_" in name for name in channels)
    scene.triptych.method = "ray_casting"
    channels = stage.render(scene, multilayer=True)
    assert stage.status() == ""
    assert sorted({name.split(".")[1] for name in channels if "Combined_" in name}) == [
        f"Combined_G{k}" for k in range(8)
    ]
    plane.lightgroup = scene.world.lightgroup = "G0"
    stage.world_color(scene, (1, 1, 1))
    stage.material(plane, "ShaderNodeEmission", name="Glow")
    layer.update()
    lines = export_scene(bpy.context.evaluated_depsgraph_get()).warnings
    for start in ("object 'Plane': light groups", "world 'World': light groups", "light group 'G8' has no pass"):
        assert any(line.startswith(start) for line in lines), lines


def test_view_layers(scene):
    plane = lit_plane(scene)
    inner = bpy.data.collections.new("Inner")
    scene.collection.children.link(inner)
    inner.objects.link(plane)
    scene.collection.objects.unlink(plane)
    second = scene.view_layers.new("Second")
    second.layer_collection.children["Inner"].exclude = True
    channels = stage.render(scene, multilayer=True)
    first = scene.view_layers[0].name
    assert channels[f"{first}.Combined.R"].max() > 0.1 and channels["Second.Combined.R"].max() == 0


def test_settings_reach_the_core(scene):
    lit_plane(scene)
    stage.plane(scene, 0.5, name="Blocker", location=(0, 0, 2)).visible_camera = False
    assert stage.render(scene)[23:25, 31:33, :3].max() == 0
    scene.triptych.shadows = False
    assert stage.render(scene)[23:25, 31:33, :3].mean() == pytest.approx(0.5 / pi, rel=5e-3)
    scene.triptych.shading_ambient = (1, 2, 4)
    difference = stage.render(scene)[24, 32, :3] - 0.5 / pi
    assert difference == pytest.approx([0.5, 1, 2], rel=1e-2)


def test_film_transparent(scene):
    stage.camera(scene)
    stage.world_color(scene, (1, 1, 1))
    scene.render.film_transparent = True
    assert not stage.render(scene).any()


def test_object_visibility(scene):
    plane = lit_plane(scene)
    plane.visible_camera = False
    assert not stage.render(scene)[..., :3].any()


def test_mirrored_object_is_lit_the_same(scene):
    plane = lit_plane(scene)
    plain = stage.render(scene)
    plane.scale = (-1, 1, 1)
    assert np.allclose(stage.render(scene), plain, atol=1e-5)


def test_collection_instances(scene):
    plane = lit_plane(scene, size=0.5)
    inner = bpy.data.collections.new("Inner")
    inner.objects.link(plane)
    scene.collection.objects.unlink(plane)
    assert not stage.render(scene)[..., :3].any()
    for x in (-1, 1):
        empty = stage.link(scene, "Empty", None, (x, 0, 0))
        empty.instance_type, empty.instance_collection = "COLLECTION", inner
    lit = stage.render(scene)[24, :, 0] > 0
    assert np.count_nonzero(np.diff(lit.astype(int)) == 1) == 2


def test_image_texture_is_the_right_way_up(scene):
    plane = lit_plane(scene, size=2.0)
    material, tree, node = stage.material(None, "ShaderNodeEmission")
    plane.material_slots[0].material = material
    pixels = np.zeros((2, 2, 3), np.float32)
    pixels[0, 0], pixels[1, 1] = (1, 0, 0), (0, 1, 0)  # red at (0, 0), green at (1, 1)
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image, image.interpolation = stage.picture("Corners", pixels, "Non-Color", True), "Closest"
    tree.links.new(image.outputs[0], node.inputs["Color"])
    scene.objects["Camera"].data.type, scene.objects["Camera"].data.ortho_scale = "ORTHO", 2
    picture = stage.render(scene)
    assert picture[6, 8, :3] == pytest.approx([1, 0, 0], abs=1e-3)
    assert picture[42, 56, :3] == pytest.approx([0, 1, 0], abs=1e-3)
    assert picture[6, 56, :3] == pytest.approx([0, 0, 0], abs=1e-3)


def test_srgb_image(scene):
    """A byte of 188 (0.737) is 0.503 of light."""
    plane = lit_plane(scene, size=2.0)
    material, tree, node = stage.material(None, "ShaderNodeEmission")
    plane.material_slots[0].material = material
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = stage.picture("Grey", np.full((8, 8, 3), 188 / 255, np.float32))
    tree.links.new(image.outputs[0], node.inputs["Color"])
    assert stage.render(scene)[24, 32, :3] == pytest.approx([0.50289] * 3, rel=2e-3)


# --------------------------------------------------------------------------------- what must not crash, what is said


def test_empty_scene(scene):
    stage.camera(scene)
    assert stage.render(scene).shape == (48, 64, 4) and stage.status() == ""


def test_odd_meshes(scene):
    lit_plane(scene)
    stage.mesh(scene, "Empty", [], [])
    stage.mesh(scene, "Points", [(0, 0, 1)], [])
    stage.mesh(scene, "Wire", [(0, 0, 1), (1, 0, 1)], [], edges=[(0, 1)])
    stage.mesh(scene, "Degenerate", [(0, 0, 1), (1, 0, 1), (2, 0, 1)], [(0, 1, 2)])
    slots = stage.plane(scene, 0.1, name="Slots")
    slots.data.materials.append(None)
    slots.data.polygons[0].material_index = 9
    flat = stage.plane(scene, 0.1, name="Flat", scale=(0, 1, 1))
    assert flat
    pixels = stage.render(scene)
    assert stage.status() == "" and pixels[..., :3].max() > 0.1


def test_missing_image_is_seen(scene):
    plane = lit_plane(scene)
    material, tree, node = stage.material(None, "ShaderNodeEmission")
    plane.material_slots[0].material = material
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = bpy.data.images.new("Gone", 2, 2)
    image.image.source, image.image.filepath = "FILE", "//gone.png"
    tree.links.new(image.outputs[0], node.inputs["Color"])
    pixels = stage.render(scene)
    assert stage.status() == "" and pixels[24, 32, 0] > 0.5 > pixels[24, 32, 1]


def test_no_camera(scene):
    stage.plane(scene)
    with pytest.raises(RuntimeError, match="camera"):
        stage.render(scene)


def test_panoramic_camera(scene):
    stage.camera(scene, type="PANO")
    pixels = stage.render(scene)
    assert "PANO" in stage.status() and not pixels.any()
    scene.camera.data.type = "PERSP"
    stage.render(scene)
    assert stage.status() == ""


def test_object_that_is_no_camera(scene):
    scene.camera = stage.plane(scene)
    stage.render(scene)
    assert "no camera" in stage.status()


def test_error_of_the_core_is_shown(scene):
    """NaN in a mesh: the message names the object's mesh."""
    plane = lit_plane(scene)
    plane.data.vertices[0].co.x = float("nan")
    stage.render(scene)
    assert "Plane" in stage.status()


def test_cancel(scene, monkeypatch):
    """A break ends the render soon, with what there is."""
    lit_plane(scene)
    scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
    scene.triptych.samples = 4096
    start = time.monotonic()
    asked = []

    def stopped(job):
        asked.append(time.monotonic())
        return time.monotonic() - start > 1.0

    monkeypatch.setattr(engine._Job, "stopped", stopped)
    pixels = stage.render(scene)
    assert time.monotonic() - start < 6 and len(asked) > 3
    assert pixels.shape == (1080, 1920, 4) and stage.status() == ""


def test_tiles_are_shown(scene, monkeypatch):
    """With tiles shown as they come, the picture is the same."""
    lit_plane(scene)
    scene.render.use_border, scene.render.border_min_x, scene.render.border_max_x = True, 0.3, 0.9
    plain = stage.render(scene)
    shown = []
    show = engine._Job._show
    monkeypatch.setattr(engine._Job, "_show", lambda job, *window: (shown.append(window), show(job, *window)))
    monkeypatch.setattr(engine.bpy, "app", type("App", (), {"background": False, "version": bpy.app.version}))
    again = stage.render(scene)
    assert shown and stage.status() == "" and np.array_equal(plain, again)


def test_warnings_name_the_node(scene):
    plane = lit_plane(scene)
    _, tree, node = stage.material(plane)
    noise = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs["Color"], node.inputs["Color"])
    stage.render(scene)
    assert stage.status() == ""
    assert any("Noise" in line for line in export_as_rendered(scene).warnings)


def test_every_method_renders(scene):
    lit_plane(scene)
    for name, _, _ in core.methods():
        scene.triptych.method = name
        pixels = stage.render(scene)
        assert stage.status() == "", name
        assert np.isfinite(pixels).all() and pixels[..., :3].max() > 0, name


def test_depth_of_field_and_orthographic(scene):
    """A lens blurs an edge that is out of focus, and leaves one in focus."""
    plane = lit_plane(scene, size=2.0)
    plane.location.x = 1
    scene.triptych.samples = 64
    camera = scene.camera.data
    camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 4.0, 0.1
    sharp = stage.render(scene)[24, 20:44, 0]
    camera.dof.focus_distance = 1.0
    blurred = stage.render(scene)[24, 20:44, 0]
    assert np.abs(np.diff(sharp)).max() > 3 * np.abs(np.diff(blurred)).max()


def test_animation_frames(scene, tmp_path):
    """Frames of an animation are each exported anew."""
    plane = lit_plane(scene)
    plane.keyframe_insert("hide_render", frame=1)
    plane.hide_render = True
    plane.keyframe_insert("hide_render", frame=2)
    scene.frame_set(1)
    assert stage.render(scene)[..., :3].any()
    scene.frame_set(2)
    assert not stage.render(scene)[..., :3].any()
