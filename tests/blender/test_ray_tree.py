# SPDX-License-Identifier: GPL-3.0-or-later
"""The ray tree of a pixel: its numbers against the picture's, its curves against its rays, and what it leaves alone."""

import bpy
import numpy as np
import pytest
import stage
from triptych import abi, core, data, ray_tree

pytestmark = pytest.mark.library

WIDTH, HEIGHT = 64, 48


def tint(made, name, **coefficients):
    """Gives an object a material of classic coefficients."""
    material, _, _ = stage.material(made, name=name)
    classic = material.triptych
    classic.override = classic.use_mirror = True
    values = {"diffuse": (0.2, 0.3, 0.4), "specular": (0, 0, 0), "mirror": (0, 0, 0), **coefficients}
    for key, value in values.items():
        setattr(classic, key, value)


def mirror_and_glass(scene):
    """A mirror on the left and a pane of thin glass on the right of the middle, over a floor, in a grey world."""
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    tint(stage.plane(scene, 20, "Floor", location=(0, 0, -1)), "Matt")
    tint(stage.plane(scene, 1.8, "Mirror", location=(-1, 0, 0), rotation=(0, 20, 0)), "Silver", mirror=(0.5, 0.6, 0.7))
    pane = stage.plane(scene, 1.8, "Pane", location=(1, 0, 0))
    tint(pane, "Glass", mirror=(0.1,) * 3, transmission=(0.8,) * 3, thin=True)
    stage.light(scene, location=(0, 1, 4), energy=300)
    stage.world_color(scene, (0.1, 0.2, 0.3))
    stage.camera(scene, (0, 0, 6), lens=40)
    scene.triptych.method = "ray_tracing"
    scene.triptych.samples, scene.triptych.film_filter_width = 1, 0


MIRROR, PANE, FLOOR = (20, 24), (44, 24), (32, 2)  # pixels at which they are seen, from the top left


def listed():
    return bpy.context.window_manager.triptych_ray_tree


def curves():
    """{kind: object} of the curves in the file."""
    return {made[ray_tree.MARK]: made for made in bpy.data.objects if ray_tree.MARK in made}


def numbers(values):
    return np.array(values, np.float32)


# -------------------------------------------------------------------------------------------------------------- numbers


@pytest.mark.parametrize("pixel", [MIRROR, PANE, FLOOR, (0, 0), (63, 47)])
def test_the_root_is_the_pixel(scene, pixel):
    mirror_and_glass(scene)
    picture = stage.render(scene)
    assert bpy.ops.triptych.ray_tree(pixel=pixel) == {"FINISHED"}
    assert tuple(listed().pixel) == pixel
    assert numbers(listed().rays[0].intensity) == pytest.approx(picture[HEIGHT - 1 - pixel[1], pixel[0], :3], rel=1e-5)


def test_kinds_ends_and_names(scene):
    mirror_and_glass(scene)

    def rows(pixel):
        bpy.ops.triptych.ray_tree(pixel=pixel)
        return [(ray.level, ray.kind, ray.end, ray.object, ray.material) for ray in listed().rays]

    floor = (0, "primary", "surface", "Floor", "Matt")
    assert rows(FLOOR) == [floor]
    assert rows(MIRROR) == [
        (0, "primary", "surface", "Mirror", "Silver"),
        (1, "reflection", "background", "", ""),
    ]
    assert rows(PANE) == [
        (0, "primary", "surface", "Pane", "Glass"),
        (1, "reflection", "background", "", ""),
        (1, "transmission", "surface", "Floor", "Matt"),
    ]
    assert [ray.name for ray in listed().rays] == [
        "Primary: Pane (Glass)",
        "Reflection: background",
        "Transmission: Floor (Matt)",
    ]
    scene.triptych.trace_depth = 0
    assert [row[1:3] for row in rows(PANE)[1:]] == [("reflection", "depth"), ("transmission", "depth")]


def test_each_intensity_is_local_and_weighted_sum(scene):
    mirror_and_glass(scene)
    bpy.ops.triptych.ray_tree(pixel=PANE)
    root, mirrored, through = listed().rays
    total = numbers(root.local)
    for ray in (mirrored, through):
        assert numbers(ray.intensity) == pytest.approx(numbers(ray.local))
        total += numbers(ray.weight) * numbers(ray.intensity)
    assert numbers(root.intensity) == pytest.approx(total, rel=1e-5)
    assert numbers(mirrored.weight) == pytest.approx(0.1) and numbers(through.weight) == pytest.approx(0.8)
    assert numbers(mirrored.intensity) == pytest.approx(numbers([0.1, 0.2, 0.3]))
    assert root.distance == pytest.approx(np.linalg.norm(numbers(root.position) - numbers(root.origin)), rel=1e-5)
    assert numbers(root.normal) == pytest.approx(numbers([0, 0, 1]), abs=1e-5)
    assert numbers(mirrored.direction)[2] == pytest.approx(-root.direction[2], abs=1e-5)


def test_branches_follow_the_ray_that_they_are_of(scene):
    """The list's order in a deep tree: a level is at most one deeper, and starts where its parent ends."""
    mirror_and_glass(scene)
    second = stage.plane(scene, 1.8, "Second", location=(1, 0, -0.5))
    tint(second, "Half", mirror=(0.3,) * 3, transmission=(0.5,) * 3, thin=True)
    bpy.ops.triptych.ray_tree(pixel=PANE)
    above = []
    for ray in listed().rays:
        del above[ray.level :]
        assert len(above) == ray.level
        if above:
            assert numbers(ray.origin) == pytest.approx(numbers(above[-1].position), abs=1e-3)
        above.append(ray)
    assert max(ray.level for ray in listed().rays) > 3


# --------------------------------------------------------------------------------------------------------------- curves


@pytest.mark.parametrize("pixel", [MIRROR, PANE, FLOOR])
def test_curves_are_the_rays(scene, pixel):
    mirror_and_glass(scene)
    bpy.ops.triptych.ray_tree(pixel=pixel)
    drawn = curves()
    assert set(drawn) == {ray.kind for ray in listed().rays}
    for kind, made in drawn.items():
        rays = [ray for ray in listed().rays if ray.kind == kind]
        assert len(made.data.splines) == len(rays)
        assert np.array(made.matrix_world) == pytest.approx(np.eye(4))
        for spline, ray in zip(made.data.splines, rays, strict=True):
            start, end = (numbers(point.co[:3]) for point in spline.points)
            assert start == pytest.approx(numbers(ray.origin), abs=1e-6)
            if ray.end == "surface":
                assert np.array_equal(end, numbers(ray.position))
            else:
                way = end - start
                assert way / np.linalg.norm(way) == pytest.approx(numbers(ray.direction), abs=1e-5)
                assert 1 < np.linalg.norm(way) < 30  # as long as the scene is large
        assert list(made.data.materials[0].diffuse_color) == pytest.approx([*ray_tree.COLORS[kind], 1])
        assert made.hide_render and made.hide_select and 0 < made.data.bevel_depth < 0.1
    assert [collection.name for collection in scene.collection.children] == [ray_tree.NAME]
    assert set(scene.collection.children[0].objects) == set(drawn.values())


def test_rays_end_at_lights(scene):
    """A mirror that shows an area light."""
    mirror_and_glass(scene)
    scene.objects["Mirror"].rotation_euler = (0, 0, 0)
    bpy.data.objects.remove(scene.objects["Point"])
    stage.light(scene, "AREA", (0, 0, 8), shape="SQUARE", size=8)
    bpy.ops.triptych.ray_tree(pixel=MIRROR)
    ray = listed().rays[1]
    assert (ray.kind, ray.end) == ("reflection", "light")
    end = curves()["reflection"].data.splines[0].points[1].co
    assert end[2] == pytest.approx(8, abs=1e-4) and ray.distance == pytest.approx(8 / ray.direction[2], rel=1e-4)


def test_the_background_alone(scene):
    stage.camera(scene)
    bpy.ops.triptych.ray_tree(pixel=(3, 4))
    assert [(ray.kind, ray.end) for ray in listed().rays] == [("primary", "background")]
    assert len(curves()["primary"].data.splines) == 1


def test_curves_are_in_no_picture_and_no_tree(scene):
    mirror_and_glass(scene)
    before = stage.render(scene)
    bpy.ops.triptych.ray_tree(pixel=PANE)
    names = [ray.name for ray in listed().rays]
    assert np.array_equal(stage.render(scene), before)
    bpy.ops.triptych.ray_tree(pixel=PANE)
    assert [ray.name for ray in listed().rays] == names


def test_the_chosen_ray_is_thicker(scene):
    mirror_and_glass(scene)
    bpy.ops.triptych.ray_tree(pixel=PANE)

    def thick():
        return {kind for kind, made in curves().items() if made.data.splines[0].points[1].radius > 1}

    assert thick() == {"primary"}
    listed().active = 2
    assert thick() == {"transmission"}
    assert curves()["primary"].data.splines[0].points[0].radius == 0


# -------------------------------------------------------------------------------------------------- what is left behind


def everything():
    kinds = ("objects", "collections", "curves", "materials", "meshes", "images", "scenes")
    return {kind: sorted(item.name for item in getattr(bpy.data, kind)) for kind in kinds}


def test_a_second_tree_takes_the_place_of_the_first(scene):
    mirror_and_glass(scene)
    bpy.ops.triptych.ray_tree(pixel=PANE)
    before = everything()
    bpy.ops.triptych.ray_tree(pixel=PANE)
    assert everything() == before
    bpy.ops.triptych.ray_tree(pixel=FLOOR)
    assert set(curves()) == {"primary"} and len(listed().rays) == 1


def test_clear_leaves_what_was(scene):
    mirror_and_glass(scene)
    before = everything()
    assert not bpy.ops.triptych.ray_tree_clear.poll()
    bpy.ops.triptych.ray_tree(pixel=PANE)
    after_first = everything()
    assert after_first != before
    assert bpy.ops.triptych.ray_tree_clear() == {"FINISHED"}
    left = everything()
    left["images"] = before["images"]  # Blender's Render Result
    assert left == before and not listed().rays
    assert not bpy.ops.triptych.ray_tree_clear.poll()


def test_what_the_user_made_is_not_touched(scene):
    """Neither things of the same names, nor what was put into the collection."""
    mirror_and_glass(scene)
    mine = bpy.data.collections.new(ray_tree.NAME)
    scene.collection.children.link(mine)
    for name in ("Primary Rays", "Reflection Rays"):
        mine.objects.link(bpy.data.objects.new(name, bpy.data.curves.new(name, "CURVE")))
        bpy.data.materials.new(name).use_fake_user = True
    floor = scene.objects["Floor"]
    bpy.ops.triptych.ray_tree(pixel=PANE)
    made = next(collection for collection in bpy.data.collections if ray_tree.MARK in collection)
    made.objects.link(floor)
    bpy.ops.triptych.ray_tree(pixel=PANE)
    assert made.name in bpy.data.collections and list(made.objects) == [floor]
    bpy.ops.triptych.ray_tree_clear()
    assert list(made.objects) == [floor] and floor.name in scene.objects
    assert [one.name for one in mine.objects] == ["Primary Rays", "Reflection Rays"]
    assert {"Primary Rays", "Reflection Rays"} <= set(bpy.data.materials.keys())
    assert not curves()


def test_selection_and_settings_stay(scene):
    mirror_and_glass(scene)
    scene.triptych.method = "flat"
    scene.objects["Floor"].select_set(True)
    bpy.context.view_layer.objects.active = scene.objects["Pane"]
    bpy.ops.triptych.ray_tree(pixel=PANE)
    assert bpy.context.selected_objects == [scene.objects["Floor"]]
    assert bpy.context.view_layer.objects.active == scene.objects["Pane"]
    assert scene.triptych.method == "flat" and scene.render.engine == "TRIPTYCH"


def test_the_list_is_in_no_file_and_the_curves_are_replaced_after_loading(scene, tmp_path):
    mirror_and_glass(scene)
    bpy.ops.triptych.ray_tree(pixel=PANE)
    path = str(tmp_path / "file.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, compress=False)
    assert b"Transmission: Floor" not in (tmp_path / "file.blend").read_bytes()
    bpy.ops.wm.open_mainfile(filepath=path)
    assert not listed().rays and set(curves()) == {"primary", "reflection", "transmission"}
    assert bpy.ops.triptych.ray_tree_clear.poll()
    bpy.ops.triptych.ray_tree(pixel=FLOOR)
    assert set(curves()) == {"primary"}


def test_undo(scene):
    mirror_and_glass(scene)
    bpy.ops.ed.undo_push(message="Scene")
    bpy.ops.triptych.ray_tree("EXEC_DEFAULT", True, pixel=PANE)
    bpy.ops.ed.undo()
    assert not curves() and ray_tree.NAME not in bpy.data.collections


# ------------------------------------------------------------------------------------------------------------ the click


def test_places_of_a_picture(scene):
    scene.render.resolution_x, scene.render.resolution_y = 40, 20

    def at(u, v):
        return ray_tree._in_picture(scene, u, v)

    assert [at(0, 0), at(0.9999, 0.9999), at(0.5, 0.5)] == [(0, 19), (39, 0), (20, 9)]
    for outside in ((-0.001, 0.5), (1, 0.5), (0.5, 1), (0.5, -0.001)):
        with pytest.raises(data.ExportError, match="inside the picture"):
            at(*outside)


def place_in_image(scene, image, u=0.25, v=0.75):
    """_of_image for an Image Editor that shows an image, of a region whose view coordinates are those of the image."""

    class Stub:
        type = "IMAGE_EDITOR"

    space, region = Stub(), Stub()
    space.image, region.view2d = image, Stub()
    region.view2d.region_to_view = lambda x, y: (x, y)
    return ray_tree._of_image(scene, space, region, (u, v))


def test_images_of_the_pictures_shape(scene):
    scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
    for width, height in ((1920, 1080), (960, 540), (100, 56), (3840, 2160)):
        assert place_in_image(scene, bpy.data.images.new("Picture", width, height)) == (0.25, 0.75)
    for width, height in ((1080, 1920), (960, 500), (64, 64)):
        with pytest.raises(data.ExportError, match="not the shape"):
            place_in_image(scene, bpy.data.images.new("Picture", width, height))
    with pytest.raises(data.ExportError, match="no picture"):
        place_in_image(scene, None)


def test_a_cropped_result_lies_in_the_whole_picture(scene):
    mirror_and_glass(scene)
    render = scene.render
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.5, 0.75, 0.25, 0.5
    stage.render(scene)
    result = bpy.data.images["Render Result"]
    assert place_in_image(scene, result, 0.5, 0.5) == (0.625, 0.375)
    render.use_crop_to_border = False
    assert place_in_image(scene, result, 0.5, 0.5) == (0.5, 0.5)


# --------------------------------------------------------------------------------------------------------------- errors


def fails(match, **values):
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.triptych.ray_tree(**values)
    assert not curves()


def test_without_a_camera(scene):
    mirror_and_glass(scene)
    scene.camera = None
    fails("there is no camera", pixel=PANE)
    scene.camera = scene.objects["Floor"]
    fails("no camera", pixel=PANE)


def test_pixels_outside(scene):
    mirror_and_glass(scene)
    fails(r"pixel \(64, 0\) lies outside the picture of 64 × 48", pixel=(64, 0))
    fails(r"pixel \(0, 48\) lies outside", pixel=(0, 48))
    scene.render.resolution_percentage = 50
    fails(r"\(32, 0\) lies outside the picture of 32 × 24", pixel=(32, 0))


def test_without_the_library(scene, monkeypatch):
    mirror_and_glass(scene)
    monkeypatch.setenv("TRIPTYCH_LIBRARY", "/nowhere/libtriptych.so")
    monkeypatch.setattr(abi, "_library", None)
    fails("/nowhere/libtriptych.so", pixel=PANE)


def test_a_tree_that_is_too_large(scene, monkeypatch):
    mirror_and_glass(scene)
    monkeypatch.setattr(ray_tree, "MOST_RAYS", 2)
    fails("3 rays, of which at most 2 can be shown; a lower Depth or a greater Least weight", pixel=PANE)
    labels = {setting.name: setting.label for setting in core.settings()}
    assert (labels["trace.depth"], labels["trace.least_weight"]) == ("Depth", "Least weight")


def test_an_error_leaves_the_last_tree(scene):
    mirror_and_glass(scene)
    bpy.ops.triptych.ray_tree(pixel=PANE)
    with pytest.raises(RuntimeError):
        bpy.ops.triptych.ray_tree(pixel=(640, 0))
    assert len(listed().rays) == 3 and len(curves()) == 3


def test_another_method_traces_no_tree(scene):
    with core.Scene() as one:
        one.fill(data.Scene(cameras=[data.Camera("Camera", "perspective", data.IDENTITY)], camera=0))
        one.commit()
        with core.Render(one, "ray_casting") as job, pytest.raises(abi.Error, match="ray_tracing does") as caught:
            job.trace_tree(0, 0, 10)
        assert caught.value.status == "STATE"


def test_unregister_takes_all_away(addon):
    assert hasattr(bpy.types.WindowManager, ray_tree.MARK)
    addon.unregister()
    try:
        assert not hasattr(bpy.types.WindowManager, ray_tree.MARK)
        assert "ray_tree" not in dir(bpy.ops.triptych)
        assert not hasattr(bpy.types, "TRIPTYCH_VIEW3D_PT_ray_tree")
    finally:
        addon.register()
