# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in the .glb: what the triangles say is not said again in the extras. Needs no library."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
import stage
from glb import Glb, written
from triptych import data, gltf
from triptych.as_rendered import export_as_rendered


def z_up(vectors):
    return np.stack([vectors[:, 0], -vectors[:, 2], vectors[:, 1]], axis=1)


def test_mesh_arrays_survive(scene, tmp_path):
    bpy.ops.mesh.primitive_cylinder_add(vertices=7)
    cylinder = bpy.context.object
    for k, face in enumerate(cylinder.data.polygons):
        face.use_smooth = k % 2 == 0
        face.material_index = k % 2
    stage.material(cylinder, name="A")
    stage.material(cylinder, name="B")
    cylinder.data.color_attributes.new("Paint", "FLOAT_COLOR", "POINT").data[3].color = (0.1, 0.2, 0.3, 0.4)
    stage.camera(scene)
    mesh = export_as_rendered(scene).meshes[0]
    glb = written(scene, tmp_path)
    extras = glb.extras(glb.json["meshes"][0])
    assert np.array_equal(z_up(glb.array(extras["positions"])), mesh.positions)
    for name in ("face_offsets", "corner_vertices", "face_materials", "face_smooth"):
        assert np.array_equal(glb.array(extras[name]), getattr(mesh, name)), name
    assert "edges" not in extras  # they are the faces' sides
    assert ("corner_normals" in extras) == (mesh.corner_normals is not None)
    if mesh.corner_normals is not None:
        assert np.array_equal(z_up(glb.array(extras["corner_normals"])), mesh.corner_normals)
    assert np.array_equal(glb.array(extras["uv_sets"][0]["accessor"]), mesh.uv_sets[0].values)
    assert extras["colors"][0]["domain"] == "vertex"
    assert np.array_equal(glb.array(extras["colors"][0]["accessor"]), mesh.colors[0].values)
    assert extras["materials"] == [0, 1] and len(glb.json["meshes"][0]["primitives"]) == 2


def test_triangles_have_the_area_and_side_of_the_faces(scene, tmp_path):
    """A concave face: its triangles cover it once, and turn the way its normal points."""
    arrow = [(0, 0, 0), (2, 1, 0), (0, 2, 0), (0.8, 1, 0)]
    stage.mesh(scene, "Arrow", arrow, [(0, 1, 2, 3)])
    stage.camera(scene)
    glb = written(scene, tmp_path)
    primitive = glb.json["meshes"][0]["primitives"][0]
    places = z_up(glb.array(primitive["attributes"]["POSITION"]))
    a, b, c = places[glb.array(primitive["indices"]).reshape(-1, 3)].transpose(1, 0, 2)
    doubled = np.cross(b - a, c - a)
    assert (doubled[:, 2] > 0).all() and doubled[:, 2].sum() / 2 == pytest.approx(2 - 0.8)


def test_loose_edges_are_lines(scene, tmp_path):
    stage.mesh(scene, "Wire", [(0, 0, 0), (0, 0, 1)], [], edges=[(0, 1)])
    stage.camera(scene)
    glb = written(scene, tmp_path)
    assert glb.json["meshes"][0]["primitives"][0]["mode"] == 1
    assert "corner_vertices" not in glb.extras(glb.json["meshes"][0])


# -------------------------------------------------------------------------------------------------- a mesh of triangles

POINTS = np.float32([(1, 1, 1), (-1, -1, 1), (1, -1, -1), (-1, 1, -1)])
CORNERS = np.uint32([0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2])
EDGES = np.uint32([(3, 2), (0, 1), (0, 2), (3, 0), (1, 2), (1, 3)])
ROUND = POINTS[CORNERS] / np.float32(np.sqrt(3))  # normals that agree at each vertex
SMOOTH, FLAT = np.ones(4, np.uint8), np.zeros(4, np.uint8)


def solid(**values):
    """A tetrahedron with flat faces, and whatever else is given."""
    normals = values.get("corner_normals", ROUND)
    triangulation = data.Triangulation(np.arange(12, dtype=np.uint32).reshape(4, 3), np.arange(4), normals)
    offsets = np.arange(0, 13, 3, dtype=np.uint32)
    mesh = data.Mesh("Solid", POINTS, offsets, CORNERS, face_smooth=FLAT, edges=EDGES, triangulation=triangulation)
    return replace(mesh, **values)


def written_mesh(mesh, tmp_path):
    """(Glb, its mesh, its first primitive)"""
    gltf.write_scene(tmp_path / "scene.glb", data.Scene(meshes=[mesh]))
    glb = Glb(tmp_path / "scene.glb")
    result = glb.json["meshes"][0]
    return glb, result, result["primitives"][0]


def test_flat_triangles_have_no_extras(tmp_path):
    """Nor normals: glTF has flat triangles where there are none."""
    glb, mesh, primitive = written_mesh(solid(), tmp_path)
    assert "extras" not in mesh and set(primitive["attributes"]) == {"POSITION"}
    assert np.array_equal(z_up(glb.array(primitive["attributes"]["POSITION"])), POINTS)
    assert np.array_equal(glb.array(primitive["indices"]), CORNERS)
    assert len(glb.binary) == 4 * 12 + 12 * 4


def test_normals_that_agree_at_each_vertex_have_no_extras(tmp_path):
    glb, mesh, primitive = written_mesh(solid(corner_normals=ROUND, face_smooth=SMOOTH), tmp_path)
    assert "extras" not in mesh
    assert np.array_equal(z_up(glb.array(primitive["attributes"]["NORMAL"]))[CORNERS], ROUND)
    assert np.array_equal(glb.array(primitive["indices"]), CORNERS)
    assert len(glb.binary) == 4 * 24 + 12 * 4


def test_smooth_triangles_add_a_flag_to_each_face(tmp_path):
    """The core averages the faces itself; all other arrays are the primitive's."""
    glb, mesh, primitive = written_mesh(solid(face_smooth=SMOOTH), tmp_path)
    extras = glb.extras(mesh)
    assert np.array_equal(glb.array(extras.pop("face_smooth")), SMOOTH)
    assert extras == {"positions": primitive["attributes"]["POSITION"], "corner_vertices": primitive["indices"]}
    assert np.array_equal(glb.array(primitive["indices"]), CORNERS)
    assert len(glb.binary) == 4 * 24 + 12 * 4 + 4


UV = np.linspace(0, 1, 24, dtype=np.float32).reshape(12, 2)
UNSAID = {  # by the keys of the extras
    "face_smooth": {"face_smooth": np.uint8([1, 0, 0, 1])},
    "face_smooth corner_normals": {"corner_normals": ROUND},
    "corner_normals": {"corner_normals": ROUND[::-1].copy(), "face_smooth": SMOOTH},
    "face_materials materials": {"face_materials": np.uint32([0, 1, 1, 0]), "materials": [data.NONE] * 2},
    "uv_sets": {"uv_sets": [data.Layer("First", UV), data.Layer("Second", UV[::-1].copy())]},
    "uv_sets corner_normals": {"uv_sets": [data.Layer("Map", UV)], "corner_normals": ROUND, "face_smooth": SMOOTH},
    "colors": {"colors": [data.Layer("Paint", np.ones((4, 4), np.float32), "vertex")]},
    "edges edge_flags": {"edge_flags": np.uint8([0, data.EDGE_SHARP, 0, 0, 0, 0])},
    "edges edge_creases": {"edge_creases": np.linspace(0, 1, 6, dtype=np.float32)},
    "vertex_creases": {"vertex_creases": np.linspace(0, 1, 4, dtype=np.float32)},
    "edges": {"positions": np.vstack([POINTS, POINTS[:1] * 2]), "edges": np.vstack([EDGES, np.uint32([[0, 4]])])},
}


@pytest.mark.parametrize("keys", UNSAID)
def test_what_triangles_do_not_say_is_in_the_extras(keys, tmp_path):
    source = solid(**UNSAID[keys])
    glb, mesh, _ = written_mesh(source, tmp_path)
    extras = glb.extras(mesh)
    assert set(extras) == {"positions", "corner_vertices", *keys.split()}
    assert np.array_equal(z_up(glb.array(extras["positions"])), source.positions)
    for key in set(extras) - {"positions", "materials"}:
        expected = getattr(source, key)
        if key in {"uv_sets", "colors"}:
            assert [one["name"] for one in extras[key]] == [layer.name for layer in expected]
            for one, layer in zip(extras[key], expected, strict=True):
                assert one["domain"] == layer.domain and np.array_equal(glb.array(one["accessor"]), layer.values)
        elif key == "corner_normals":
            assert np.array_equal(z_up(glb.array(extras[key])), expected)
        else:
            assert np.array_equal(glb.array(extras[key]), expected.reshape(-1)), key


def test_slots_share_the_vertices(tmp_path):
    glb, mesh, _ = written_mesh(solid(**UNSAID["face_materials materials"]), tmp_path)
    places = {primitive["attributes"]["POSITION"] for primitive in mesh["primitives"]}
    assert len(mesh["primitives"]) == 2 and places == {glb.extras(mesh)["positions"]}


def test_triangles_of_blender_keep_their_order(scene, tmp_path):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, calc_uvs=False)
    stage.camera(scene)
    source = export_as_rendered(scene).meshes[0]
    glb = written(scene, tmp_path)
    mesh = glb.json["meshes"][0]
    primitive = mesh["primitives"][0]
    assert "extras" not in mesh
    assert np.array_equal(z_up(glb.array(primitive["attributes"]["POSITION"])), source.positions)
    assert np.array_equal(glb.array(primitive["indices"]), source.corner_vertices)
