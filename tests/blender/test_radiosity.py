# SPDX-License-Identifier: GPL-3.0-or-later
"""Radiosity through Blender: solutions are kept while the scene stands."""

import numpy as np
import pytest
import stage
from triptych import radiosity

pytestmark = pytest.mark.library


@pytest.fixture(autouse=True)
def room(scene):
    """A floor and a wall on it under a lamp, by radiosity."""
    scene.triptych.method = "radiosity"
    floor = stage.plane(scene, 4)
    stage.material(floor, Color=(0.5, 0.5, 0.5))
    stage.light(scene, "POINT", (0, 0, 1), 100, shadow_soft_size=0)
    stage.camera(scene, (0, 0, 4))
    yield floor
    radiosity.forget()


def test_a_walk_of_the_camera_solves_once(scene):
    first = stage.render(scene)
    kept = radiosity._kept
    assert kept is not None and first[24, 32, 0] > 0
    scene.camera.location.x = 1
    moved = stage.render(scene)
    assert radiosity._kept is kept and not np.array_equal(first, moved)
    radiosity.forget()
    np.testing.assert_array_equal(stage.render(scene), moved)


def test_what_the_scene_changes_is_solved_again(scene, room):
    before = stage.render(scene)
    kept = radiosity._kept
    room.location.z = 0.5
    after = stage.render(scene)
    assert radiosity._kept is not kept and after[24, 32, 0] > 2 * before[24, 32, 0]
    kept = radiosity._kept
    scene.triptych.seed = 3
    stage.render(scene)
    assert radiosity._kept is not kept


def test_another_method_gives_the_memory_back(scene):
    stage.render(scene)
    assert radiosity._kept is not None
    scene.triptych.method = "ray_casting"
    stage.render(scene)
    assert radiosity._kept is None


def test_a_matrix_beyond_its_memory_is_refused_with_its_size(scene):
    settings = scene.triptych
    settings.radiosity_solver, settings.radiosity_element_size, settings.radiosity_memory = "matrix", 0.1, 1
    stage.render(scene)
    assert "MiB" in stage.status() and "radiosity.memory" in stage.status()
    settings.radiosity_memory = 2048
    assert stage.render(scene)[24, 32, 0] > 0


@pytest.mark.parametrize("kind", ["hemicube", "hemisphere", "analytic"])
def test_form_factors_and_subdivisions_show_what_the_lamp_does(scene, kind):
    settings = scene.triptych
    settings.method, settings.radiosity_solver, settings.radiosity_element_size = "ray_casting", "matrix", 0.5
    known = stage.render(scene)[..., :3].mean()  # nothing but the floor is there to give it light
    settings.method, settings.radiosity_form_factors, settings.radiosity_subdivisions = "radiosity", kind, 2
    assert abs(stage.render(scene)[..., :3].mean() / known - 1) < 0.02
