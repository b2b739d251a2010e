# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of a radiosity solution: their attributes against the core's numbers, and what they leave alone."""

from math import atan, log, pi, sqrt

import bpy
import numpy as np
import pytest
import stage
from test_radiosity_steps import fails, floor, look, step  # noqa: F401 - a fixture
from triptych import as_rendered, compat, generated, radiosity, radiosity_panel

pytestmark = pytest.mark.library

FACES = {
    **dict.fromkeys(("radiosity", "irradiance", "unshot", "emission", "reflectance"), ("FLOAT_VECTOR", "FACE")),
    **{"area": ("FLOAT", "FACE"), "element": ("INT", "FACE")},
}


def make():
    """The mesh object, brought up to date."""
    assert bpy.ops.triptych.radiosity_mesh() == {"FINISHED"}
    return generated.find(bpy.context.scene, generated.MESH)


def links():
    look().links = True
    make()
    return generated.find(bpy.context.scene, generated.LINKS).data


def values(mesh, name):
    return compat.mesh_values(mesh, name)


# ----------------------------------------------------------------------------------------------------------- attributes


@pytest.mark.parametrize("solver", ["matrix", "hierarchical", "progressive"])
def test_attributes_are_the_cores_numbers(scene, solver):
    scene.triptych.radiosity_solver = solver
    step()
    mesh = make().data
    solution = radiosity.kept().solution
    offsets, corners = solution.polygons()
    np.testing.assert_array_equal(compat.mesh_face_offsets(mesh), offsets)
    np.testing.assert_array_equal(compat.mesh_corner_vertices(mesh), corners)
    np.testing.assert_array_equal(compat.mesh_positions(mesh), solution.read("vertex_position"))
    np.testing.assert_array_equal(values(mesh, "element"), np.arange(len(offsets) - 1))
    for name, kind in FACES.items():
        assert (mesh.attributes[name].data_type, mesh.attributes[name].domain) == kind
        if name != "element":
            np.testing.assert_array_equal(values(mesh, name), solution.read(name))
    assert values(mesh, "radiosity").max() > 0
    assert (mesh.color_attributes["vertex_radiosity"].data_type, mesh.attributes["vertex_radiosity"].domain) == (
        "FLOAT_COLOR",
        "POINT",
    )
    at_vertices = solution.read("vertex_radiosity")
    np.testing.assert_array_equal(values(mesh, "vertex_radiosity")[:, :3], at_vertices)
    radiosities = values(mesh, "radiosity")
    if solver != "hierarchical":  # which is linear over its elements
        assert radiosities.min() <= at_vertices.min() and at_vertices.max() <= radiosities.max()
    assert mesh.color_attributes.active_color.name == "shown"
    np.testing.assert_allclose(values(mesh, "shown")[:, :3], at_vertices[corners] / pi, rtol=1e-6)


def test_numbers_that_are_known_otherwise(scene):
    """Of the floor's elements: E = P h / (4 π d³) under a point lamp, at their middles to what an element averages."""
    make()
    solution, mesh = radiosity.kept().solution, generated.find(scene, generated.MESH).data
    centre, normal = solution.read("centre"), solution.read("normal")
    on_floor = normal[:, 2] > 0.9
    assert on_floor.sum() == 16
    d = np.linalg.norm(centre[on_floor] - (0, 0, 1), axis=1)
    expected = 100 / (4 * pi) / d**3
    assert values(mesh, "irradiance")[on_floor, 1] == pytest.approx(expected, rel=0.05)
    assert values(mesh, "reflectance") == pytest.approx(np.full((32, 3), 0.5))
    assert values(mesh, "area") == pytest.approx(np.full(32, 0.25))
    radiosities, irradiances = values(mesh, "radiosity"), values(mesh, "irradiance")
    assert radiosities == pytest.approx(0.5 * irradiances, rel=1e-6)


def test_colours(scene):
    step()
    made = make()
    mesh, solution = made.data, radiosity.kept().solution
    offsets, corners = solution.polygons()
    of_corners = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))

    def shown():
        return values(mesh, "shown")[:, :3]

    look().shown = "irradiance"
    np.testing.assert_allclose(shown(), solution.read("vertex_irradiance")[corners] / pi, rtol=1e-6)
    look().shown = "unshot"
    np.testing.assert_allclose(shown(), solution.read("unshot")[of_corners] / pi, rtol=1e-6)
    look().shown = "reflectance"
    assert shown() == pytest.approx(np.full((len(corners), 3), 0.5))
    look().scale = 2
    assert shown() == pytest.approx(np.full((len(corners), 3), 0.25))
    scene.triptych.radiosity_smooth = False
    for value in ("radiosity", "form_factor"):  # none was found yet
        look().shown, look().scale = value, 1
        make()
        np.testing.assert_allclose(shown(), solution.read("radiosity")[of_corners], rtol=1e-6)
    assert len(radiosity_panel.hints(scene, look())) == 1


def shading():
    areas = bpy.context.window.screen.areas
    return next(area.spaces.active.shading for area in areas if area.type == "VIEW_3D")


def colored():
    return (shading().light, shading().color_type) == ("FLAT", "VERTEX")


@pytest.mark.parametrize("make_it", [make, step])
def test_viewports_show_the_colours_while_there_is_a_mesh(scene, make_it):
    shading().light, shading().color_type = "MATCAP", "OBJECT"
    make_it()
    assert colored()
    bpy.ops.triptych.radiosity_clear()
    assert (shading().light, shading().color_type) == ("MATCAP", "OBJECT")
    make_it()
    bpy.data.objects.remove(generated.find(scene, generated.MESH))
    assert colored()
    bpy.context.view_layer.update()
    assert (shading().light, shading().color_type) == ("MATCAP", "OBJECT")


def test_viewports_show_what_the_user_chooses(scene):
    step()
    shading().color_type = "RANDOM"
    step()
    assert shading().color_type == "RANDOM"
    bpy.ops.triptych.radiosity_clear()
    assert shading().color_type == "RANDOM"
    shading().type = "WIREFRAME"
    step()
    shading().type = "SOLID"
    assert shading().color_type == "RANDOM"
    make()
    assert colored()


def test_an_update_keeps_the_object_and_what_hangs_on_it(scene):
    made = make()
    material = bpy.data.materials.new("Mine")
    made.data.materials.append(material)
    made.data.attributes.new("mine", "FLOAT", "POINT")
    made.location.z = 3
    step()
    assert make() == made and made.data.materials[0] == material and made.location.z == 3
    assert "mine" in made.data.attributes, "as long as the elements are the same"
    scene.triptych.radiosity_solver = "hierarchical"
    assert make() == made and made.data.materials[0] == material


# --------------------------------------------------------------------------------------------------------- form factors


def test_a_row_of_form_factors(scene):
    """Of two squares that share an edge: F = 0.2000438, by the closed form of ANCHORS."""
    scene.triptych.radiosity_element_size = 0
    made = make()
    mesh = made.data
    assert len(mesh.polygons) == 2
    closed = (2 * atan(1) - sqrt(2) * atan(1 / sqrt(2)) + log(3 / 4) / 4) / pi
    assert closed == pytest.approx(0.2000438, abs=1e-7)
    for active in (0, 1):
        mesh.polygons.active = active
        assert bpy.ops.triptych.radiosity_form_factors() == {"FINISHED"}
        row = values(mesh, "form_factor")
        assert row[1 - active] == pytest.approx(closed, abs=2e-6) and row[active] == 0
        assert look().shown == "form_factor"
        # White is four times the mean by area: F / 4 m² of one of two, in 4 F / 8 m².
        assert values(mesh, "shown")[:, 0].max() == pytest.approx(0.5, rel=1e-6)
    assert mesh.attributes["form_factor"].domain == "FACE"


def test_form_factors_are_the_cores(scene):
    mesh = make().data
    mesh.polygons.active = 5
    bpy.ops.triptych.radiosity_form_factors()
    np.testing.assert_array_equal(
        values(mesh, "form_factor"), radiosity.kept().solution.form_factors(5).astype(np.float32)
    )


def test_form_factors_of_a_face_that_is_selected_in_edit_mode(scene):
    made = make()
    bpy.context.view_layer.objects.active = made
    for one in scene.objects:  # all are edited together
        one.select_set(True)
    made.data.polygons.active = 3
    bpy.ops.object.mode_set(mode="EDIT")
    fails(bpy.ops.triptych.radiosity_mesh, "leave Edit Mode")
    assert bpy.ops.triptych.radiosity_form_factors() == {"FINISHED"}
    assert made.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    expected = radiosity.kept().solution.form_factors(3).astype(np.float32)
    np.testing.assert_array_equal(values(made.data, "form_factor"), expected)


def test_steps_while_the_mesh_is_edited(scene, capfd):
    made = make()
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.mode_set(mode="EDIT")
    assert step().info.iterations == 1 and made.mode == "EDIT"
    assert "leave Edit Mode" in capfd.readouterr().out
    bpy.ops.object.mode_set(mode="OBJECT")
    assert made.data["iteration"] == 0
    step()
    np.testing.assert_array_equal(values(made.data, "radiosity"), radiosity.kept().solution.read("radiosity"))


def test_form_factors_of_elements_that_were_divided(scene):
    group = scene.triptych
    group.radiosity_solver, group.radiosity_element_size, group.radiosity_tolerance = "hierarchical", 0, 0.001
    mesh = make().data
    mesh.polygons.active = 0
    bpy.ops.triptych.radiosity_form_factors()
    before = len(mesh.polygons)
    look().steps = 7
    step()
    assert len(mesh.polygons) > before and values(mesh, "form_factor") is None
    assert values(mesh, "shown")[:, :3].any()
    assert radiosity_panel.hints(scene, look()) == ["No form factors: radiosity is shown"]


def test_form_factors_without_a_mesh(scene):
    fails(bpy.ops.triptych.radiosity_form_factors, "press Radiosity Mesh")
    made = make()
    made.data.polygons.active = 0
    scene.triptych.radiosity_element_size = 2
    fails(bpy.ops.triptych.radiosity_form_factors, "other elements than the solution")
    made.data.clear_geometry()
    fails(bpy.ops.triptych.radiosity_form_factors, "no active face")


# ---------------------------------------------------------------------------------------------------------------- links


def test_links_are_edges(scene):
    group = scene.triptych
    group.radiosity_solver, group.radiosity_element_size, group.radiosity_tolerance = "hierarchical", 0, 0.001
    look().steps = 7
    step()
    mesh, solution = links(), radiosity.kept().solution
    all_links = solution.links()
    assert len(mesh.edges) == radiosity.kept().info.links == len(all_links) > 10
    factor, receiver, source = (values(mesh, name) for name in ("factor", "receiver", "source"))
    assert (mesh.attributes["factor"].data_type, mesh.attributes["factor"].domain) == ("FLOAT_VECTOR", "EDGE")
    size = factor.mean(axis=1)
    assert (np.diff(size) <= 0).all() and size[0] > 0
    np.testing.assert_array_equal(np.sort(size), np.sort(all_links["factor"].mean(axis=1)))
    assert receiver.min() >= -1 and receiver.max() < radiosity.kept().info.element_count
    centre = solution.read("centre")
    ends = compat.mesh_positions(mesh)[compat.mesh_edges(mesh)]
    for of, end in ((source, 0), (receiver, 1)):
        np.testing.assert_allclose(ends[of >= 0, end], centre[of[of >= 0]], atol=1e-5)
    assert (receiver >= 0).any() and (receiver == -1).any()

    look().most_links = 7
    few = links()
    assert len(few.edges) == 7
    np.testing.assert_array_equal(values(few, "factor").mean(axis=1), size[:7])


def test_the_first_links_join_whole_faces(scene):
    """The floor and the wall, each other's: F = 0.2 of two squares that share an edge."""
    scene.triptych.radiosity_solver, scene.triptych.radiosity_element_size = "hierarchical", 0
    step()
    mesh = links()
    assert sorted(zip(values(mesh, "source"), values(mesh, "receiver"), strict=True)) == [(0, 1), (1, 0)]
    # The solver's own estimate, by rays.
    assert values(mesh, "factor") == pytest.approx(np.full((2, 3), 0.2000438), rel=0.1)


def test_other_solvers_have_no_links(scene):
    step()
    assert len(links().edges) == 0


def test_links_that_are_not_asked_for_go(scene):
    scene.triptych.radiosity_solver = "hierarchical"
    for refresh in (step, make):
        links()
        look().links = False
        refresh()
        assert generated.find(scene, generated.LINKS) is None and generated.find(scene, generated.MESH)


# --------------------------------------------------------------------------------------------------- what is left alone


def everything():
    kinds = ("objects", "collections", "materials", "meshes", "scenes")
    return {kind: sorted(item.name for item in getattr(bpy.data, kind)) for kind in kinds}


def test_meshes_are_in_no_picture_and_no_solution(scene):
    scene.triptych.radiosity_solver = "hierarchical"
    before = stage.render(scene)
    kept = radiosity.kept()
    links()
    objects = [generated.find(scene, mark) for mark in (generated.MESH, generated.LINKS)]
    for shown in (False, True):
        for made in objects:
            assert made.hide_render or shown
            made.hide_render = not shown
        for collection in scene.collection.children:
            collection.hide_render = not shown
        np.testing.assert_array_equal(stage.render(scene), before)
        assert radiosity.kept() is kept
    names = {instance.name for instance in as_rendered.export_as_rendered(scene).instances}
    scene.camera = None
    in_viewport = {instance.name for instance in as_rendered.export_as_rendered(scene).instances}
    assert names == in_viewport == {"Plane", "Wall"}
    assert not bpy.ops.triptych.radiosity_step.poll() or step() is not None


def test_a_copy_is_the_users_own(scene):
    made = make()
    copy = made.copy()
    copy.data = made.data.copy()
    scene.collection.objects.link(copy)
    copy.hide_render = False
    names = {instance.name for instance in as_rendered.export_as_rendered(scene).instances}
    assert names == {"Plane", "Wall", copy.name}
    assert bpy.ops.triptych.radiosity_clear() == {"FINISHED"}
    assert copy.name in scene.objects and len(copy.data.polygons) == 32


def test_clear_leaves_what_was(scene):
    before = everything()
    assert not bpy.ops.triptych.radiosity_clear.poll()
    links()
    assert everything() != before
    assert bpy.ops.triptych.radiosity_clear() == {"FINISHED"}
    assert everything() == before and radiosity.kept() is not None


def test_what_the_user_made_is_not_touched(scene, floor):  # noqa: F811
    mine = bpy.data.collections.new("Triptych Radiosity")
    scene.collection.children.link(mine)
    for name in ("Radiosity Mesh", "Radiosity Links"):
        mine.objects.link(bpy.data.objects.new(name, bpy.data.meshes.new(name)))
    links()
    collection = next(one for one in scene.collection.children if generated.is_generated(one))
    assert collection != mine and len(collection.objects) == 2
    collection.objects.link(floor)
    bpy.ops.triptych.radiosity_clear()
    assert list(collection.objects) == [floor] and len(mine.objects) == 2
    assert not any(len(one.data.vertices) for one in mine.objects)


def test_deleted_meshes_are_made_again(scene):
    made = make()
    bpy.data.objects.remove(made)
    assert make().name == "Radiosity Mesh"


def test_undo(scene):
    bpy.ops.ed.undo_push(message="Scene")
    bpy.ops.triptych.radiosity_mesh("EXEC_DEFAULT", True)
    bpy.ops.ed.undo()
    scene = bpy.context.scene
    assert generated.find(scene, generated.MESH) is None and not colored()
    bpy.ops.ed.redo()
    assert generated.find(bpy.context.scene, generated.MESH) is not None and colored()


def test_elements_without_an_area(scene):
    stage.mesh(scene, "Line", [(0, 0, 0.5), (0, 0, 0.5), (0.5, 0, 0.5)], [(0, 1, 2)])
    step()
    mesh = make().data
    solution = radiosity.kept().solution
    elements = values(mesh, "element")
    assert not mesh.validate()
    np.testing.assert_array_equal(values(mesh, "radiosity"), solution.read("radiosity")[elements])
    step()
    assert len(make().data.polygons) == len(elements) >= 32
