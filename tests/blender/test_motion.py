# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur through Blender: what moves while the shutter is open, against the time that it covers each place."""

import numpy as np
import pytest
import stage

pytestmark = pytest.mark.library


@pytest.fixture
def blurred(scene):
    """A glowing square, 1 m wide, seen from above, 10 pixels to the metre; the shutter is open for a frame."""
    scene.triptych.method = "ray_casting"
    scene.triptych.samples = 256
    scene.triptych.film_filter, scene.triptych.film_filter_width = "box", 1
    scene.render.resolution_x, scene.render.resolution_y = 60, 20
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    stage.camera(scene, (0, 0, 5), type="ORTHO", ortho_scale=6)
    square = stage.plane(scene, 1.0)
    stage.material(square, "ShaderNodeEmission", Color=(1.0, 1.0, 1.0))
    scene.frame_set(10)
    return square


def drive(target, path, expression, index=-1):
    """`expression`: of the frame, with its fraction."""
    target.driver_add(path, index).driver.expression = expression


def row(scene):
    return stage.render(scene)[6:14, :, 0].mean(axis=0)


def expected():
    """The share of the time that the square covers each column, as it moves from x = −1 to x = 1."""
    x = (np.arange(60 * 16) + 0.5) / 160 - 3
    covered = np.clip((x + 1.5) / 2, 0, 1) - np.clip((x + 0.5) / 2, 0, 1)
    return covered.reshape(60, 16).mean(axis=1)


def test_an_object_that_moves(scene, blurred):
    drive(blurred, "location", "2 * (frame - 10)", 0)
    scene.frame_set(10)
    assert row(scene) == pytest.approx(expected(), abs=8e-3)
    assert scene.frame_current == 10 and scene.frame_subframe == 0, "back where it was"


def test_a_camera_that_moves(scene, blurred):
    drive(scene.camera, "location", "2 * (10 - frame)", 0)
    scene.frame_set(10)
    assert row(scene) == pytest.approx(expected(), abs=8e-3)


def test_a_mesh_that_bends(scene, blurred):
    blurred.shape_key_add(name="Basis")
    key = blurred.shape_key_add(name="Moved")
    for point in key.data:
        point.co.x += 4
    blurred.location.x = -2
    drive(key, "value", "(frame - 9) / 2")
    scene.frame_set(10)
    assert row(scene) == pytest.approx(expected(), abs=8e-3)


def test_only_where_asked_for(scene, blurred):
    drive(blurred, "location", "2 * (frame - 10)", 0)
    still = np.where(np.abs(np.arange(60) - 29.5) < 5, 1.0, 0.0)
    scene.frame_set(10)
    scene.render.use_motion_blur = False
    assert row(scene) == pytest.approx(still, abs=1e-3)
    scene.render.use_motion_blur = True
    scene.triptych.method = "phong"
    assert row(scene) == pytest.approx(still, abs=1e-3)


def test_a_mesh_that_changes_its_vertices(scene, blurred):
    """It is shown as it is at the frame, and that is said."""
    array = blurred.modifiers.new("Array", "ARRAY")
    array.relative_offset_displace = (0, 0.1, 0)
    drive(array, "count", "5 if frame > 10.2 else 1")
    scene.frame_set(10)
    assert row(scene).max() == pytest.approx(1, abs=1e-3)


def test_a_camera_that_is_cut(scene, blurred):
    """A marker that binds another camera to a time within the shutter moves none."""
    other = stage.camera(scene, (50, 0, 5), type="ORTHO", ortho_scale=6)
    here = next(thing for thing in scene.objects if thing.type == "CAMERA" and thing != other)
    drive(blurred, "location", "2 * (frame - 10)", 0)
    for frame, camera in ((9, other), (10, here)):
        scene.timeline_markers.new(f"Cut {frame}", frame=frame).camera = camera
    scene.frame_set(10)
    assert scene.camera == here
    assert row(scene) == pytest.approx(expected(), abs=8e-3)
