# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's scene to plain data. Needs no library."""

from math import pi, radians

import bpy
import numpy as np
import pytest
import stage
from triptych import compat, data
from triptych.as_rendered import export_as_rendered


def export(scene, with_camera=True):
    if with_camera and scene.camera is None:
        stage.camera(scene)
    return export_as_rendered(scene)


# --------------------------------------------------------------------------------------------------------------- meshes


def test_n_gons_and_edges(scene):
    pentagon = [(0, 0, 0), (1, 0, 0), (1.5, 1, 0), (0.5, 2, 0), (-0.5, 1, 0), (5, 5, 5), (6, 5, 5)]
    stage.mesh(scene, "N", pentagon, [(0, 1, 2, 3, 4)], edges=[(5, 6)])
    mesh = export(scene).meshes[0]
    assert mesh.face_offsets.tolist() == [0, 5]
    assert mesh.corner_vertices.tolist() == [0, 1, 2, 3, 4]
    assert np.array_equal(mesh.positions, np.float32(pentagon))
    assert len(mesh.edges) == 6 and [5, 6] in mesh.edges.tolist()
    assert mesh.corner_normals is None and mesh.face_smooth.tolist() == [0]


def test_loose_edges_and_empty_meshes(scene):
    stage.mesh(scene, "Wire", [(0, 0, 0), (0, 0, 1)], [], edges=[(0, 1)])
    stage.mesh(scene, "Empty", [], [])
    stage.mesh(scene, "Points", [(0, 0, 0)], [])
    result = export(scene)
    assert [mesh.name for mesh in result.meshes] == ["Wire"]
    assert len(result.instances) == 1 and not len(result.meshes[0].corner_vertices)


def test_marks_and_creases(scene):
    plane = stage.plane(scene)
    mesh = plane.data
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = True
    if hasattr(mesh.edges[1], "use_freestyle_mark"):
        mesh.edges[1].use_freestyle_mark = True
        mesh.edges[0].use_freestyle_mark = False  # Blender 3.4 puts the very first mark there
        mesh.edges[1].use_freestyle_mark = True
    else:
        mesh.attributes.new("freestyle_edge", "BOOLEAN", "EDGE").data[1].value = True
    if compat.VERSION >= (4, 0):
        mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data[2].value = 0.75
    else:
        mesh.edges[2].crease = 0.75
    mesh.edges[0].use_edge_sharp = True
    result = export(scene).meshes[0]
    assert result.edge_flags.tolist() == [data.EDGE_SHARP, data.EDGE_MARKED, 0, 0]
    assert result.edge_creases.tolist() == pytest.approx([0, 0, 0.75, 0], abs=0.01)


def test_split_normals_only_where_the_mesh_has_them(scene):
    bpy.ops.mesh.primitive_cylinder_add(vertices=8)
    cylinder = bpy.context.object.data
    for face in cylinder.polygons:
        face.use_smooth = True
    assert export(scene).meshes[0].corner_normals is None
    if hasattr(cylinder, "use_auto_smooth"):
        cylinder.use_auto_smooth, cylinder.auto_smooth_angle = True, radians(60)
    else:
        for edge in cylinder.edges:
            a, b = (cylinder.vertices[k].co.z for k in edge.vertices)
            edge.use_edge_sharp = a == b  # the rims
    mesh = export(scene).meshes[0]
    assert mesh.corner_normals.shape == (len(mesh.corner_vertices), 3)
    for face in range(len(mesh.face_offsets) - 1):
        corners = slice(mesh.face_offsets[face], mesh.face_offsets[face + 1])
        upright = len(mesh.corner_vertices[corners]) == 8
        assert np.allclose(np.abs(mesh.corner_normals[corners][:, 2]), 1 if upright else 0, atol=1e-3)


def test_uv_and_colors(scene):
    plane = stage.plane(scene)
    mesh = plane.data
    second = mesh.uv_layers.new(name="Second")
    second.active_render = True
    color = mesh.color_attributes.new("Paint", "BYTE_COLOR", "CORNER")
    color.data[0].color = (0.5, 0.25, 1, 1)
    vertex = mesh.color_attributes.new("Vertex", "FLOAT_COLOR", "POINT")
    vertex.data[3].color = (2, 3, 4, 0.5)
    result = export(scene).meshes[0]
    assert [layer.name for layer in result.uv_sets] == ["Second", "UVMap"]
    assert result.uv_sets[1].values[2].tolist() == [1, 1]
    paint = next(layer for layer in result.colors if layer.name == "Paint")
    assert paint.domain == "corner" and paint.values[0] == pytest.approx([0.5, 0.25, 1, 1], abs=5e-3)
    vertex = next(layer for layer in result.colors if layer.name == "Vertex")
    assert vertex.domain == "vertex" and vertex.values[3].tolist() == [2, 3, 4, 0.5]


def test_material_slots(scene):
    cube = stage.mesh(scene, "Two", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 1, 2), (1, 3, 2)])
    red, _, _ = stage.material(cube, name="Red")
    cube.data.materials.append(None)
    cube.data.polygons[1].material_index = 1
    result = export(scene)
    assert result.meshes[0].materials == [0, data.NONE]
    assert result.meshes[0].face_materials.tolist() == [0, 1]
    cube.data.materials.pop(index=1)
    cube.data.polygons[1].material_index = 5  # of a slot that is gone
    result = export(scene)
    assert result.meshes[0].materials == [0] and not np.any(result.meshes[0].face_materials)
    cube.data.materials.clear()
    assert export(scene).meshes[0].materials == []


# ------------------------------------------------------------------------------------------------------------ instances


def test_shared_meshes(scene):
    first = stage.plane(scene)
    second = stage.link(scene, "Second", first.data, (3, 0, 0), scale=(-1, 1, 1))
    third = stage.link(scene, "Third", first.data, (6, 0, 0))
    third.modifiers.new("Bevel", "SOLIDIFY")
    stage.material(first, name="Shared")
    second.material_slots[0].link = "OBJECT"
    second.material_slots[0].material = stage.material(name="Own")[0]
    second.pass_index, second.color, second.visible_camera, second.visible_shadow = 7, (1, 0.5, 0, 1), False, False
    result = export(scene)
    by_name = {instance.name: instance for instance in result.instances}
    assert by_name["Plane"].mesh == by_name["Second"].mesh != by_name["Third"].mesh
    own = by_name["Second"]
    assert [result.materials[k].name for k in own.materials] == ["Own"]
    assert (own.index, own.color, own.visible_camera, own.visible_shadow) == (7, (1, 0.5, 0), False, False)
    assert np.array_equal(own.world_from_object, np.float32([[-1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0]]))
    assert by_name["Plane"].materials == []


def test_collection_instances_share_the_mesh(scene):
    inner = bpy.data.collections.new("Inner")
    content = bpy.data.objects.new("Inside", stage.plane(scene).data)
    content.location = (1, 0, 0)
    inner.objects.link(content)
    for k in range(3):
        empty = stage.link(scene, f"Empty{k}", None, (0, k, 0))
        empty.instance_type, empty.instance_collection = "COLLECTION", inner
    result = export(scene)
    places = sorted(tuple(instance.world_from_object[:, 3]) for instance in result.instances)
    assert places == [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 2, 0)] and len(result.meshes) == 1


def test_curves_texts_and_metaballs(scene):
    bpy.ops.curve.primitive_bezier_circle_add()
    bpy.context.object.data.bevel_depth = 0.1
    bpy.ops.object.text_add()
    bpy.ops.object.metaball_add()
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    result = export(scene)
    assert len(result.instances) == 4 and all(len(result.meshes[one.mesh].corner_vertices) for one in result.instances)


def test_render_visibility_and_levels(scene):
    hidden = stage.plane(scene, name="Hidden")
    hidden.hide_render = True
    shown = stage.plane(scene, name="Shown")
    shown.hide_viewport = True
    levels = shown.modifiers.new("Subdivision", "SUBSURF")
    levels.levels, levels.render_levels = 1, 2
    lamp = stage.light(scene)
    lamp.hide_render = True
    result = export(scene)
    assert [instance.name for instance in result.instances] == ["Shown"] and result.lights == []
    assert len(result.meshes[0].face_offsets) - 1 == 16


def test_modifier_instances(scene):
    """Instances on points, made by geometry nodes."""
    if compat.VERSION < (4, 0):
        pytest.skip("the node interface is another")
    target = stage.plane(scene, size=0.5, name="Leaf")
    host = stage.mesh(scene, "Host", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], [])
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", "GeometryNodeInstanceOnPoints", "NodeGroupOutput")]
    info = tree.nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = target
    tree.links.new(nodes[0].outputs[0], nodes[1].inputs["Points"])
    tree.links.new(info.outputs["Geometry"], nodes[1].inputs["Instance"])
    tree.links.new(nodes[1].outputs[0], nodes[2].inputs[0])
    host.modifiers.new("Nodes", "NODES").node_group = tree
    result = export(scene)
    assert len(result.instances) == 4 and len({instance.mesh for instance in result.instances}) <= 2
    assert sorted(float(one.world_from_object[0, 3]) for one in result.instances) == [0, 0, 1, 2]


# -------------------------------------------------------------------------------------------------------------- cameras


def test_camera(scene):
    target = stage.link(scene, "Target", None, (0, 0, -2))
    camera = stage.camera(
        scene, (0, 0, 5), lens=35, sensor_width=30, sensor_fit="HORIZONTAL", shift_x=0.1, shift_y=-0.2, clip_end=50
    )
    scene.render.pixel_aspect_x = 2
    dof = camera.data.dof
    dof.use_dof, dof.aperture_fstop, dof.focus_object, dof.aperture_blades = True, 2.0, target, 6
    camera.scale = (2, 2, 2)
    result = export(scene)
    given = result.cameras[result.camera]
    assert given.field_of_view == pytest.approx(2 * np.arctan(30 / 70))
    assert given.fit == "horizontal" and given.shift == pytest.approx((0.1, -0.2)) and given.clip_end == 50
    assert given.aperture_radius == pytest.approx(0.035 / 4) and given.blade_count == 6
    assert given.focus_distance == pytest.approx(7) and given.pixel_aspect == 2


def test_orthographic_and_panoramic(scene):
    camera = stage.camera(scene, type="ORTHO", ortho_scale=3)
    result = export(scene)
    assert result.cameras[0].type == "orthographic" and result.cameras[0].width == 3
    camera.data.type = "PANO"
    assert "PANO" in "".join(export(scene).warnings)


def test_film(scene):
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 1000, 333, 29
    assert export(scene).film == (290, 96)


# --------------------------------------------------------------------------------------------------------------- lights


def test_point_spot_and_sun(scene):
    stage.light(scene, "POINT", energy=4 * pi, color=(1, 0.5, 0), shadow_soft_size=0.25)
    stage.light(scene, "SPOT", energy=4 * pi, spot_size=1, spot_blend=0.5)
    stage.light(scene, "SUN", energy=3, angle=0.1)
    point, spot, sun = export(scene).lights
    assert point.emission == pytest.approx((1, 0.5, 0)) and point.radius == 0.25 and point.falloff == "physical"
    assert spot.emission == pytest.approx((1, 1, 1)) and (spot.angle, spot.blend) == (1, 0.5)
    assert sun.emission == pytest.approx((3, 3, 3)) and sun.angle == pytest.approx(0.1)


@pytest.mark.parametrize("shape, area", [("SQUARE", 4), ("RECTANGLE", 6), ("DISK", pi), ("ELLIPSE", 1.5 * pi)])
def test_area_light(scene, shape, area):
    lamp = stage.light(scene, "AREA", energy=10, shape=shape, size=2, size_y=3, spread=1)
    lamp.scale = (2, 1, 1)
    given = export(scene).lights[0]
    watts = given.emission[0] * 2 * area / compat.area_light_factor()
    assert watts == pytest.approx(10) and given.angle == 1
    assert given.size == ((2, 3) if shape in {"RECTANGLE", "ELLIPSE"} else (2, 2))
    assert given.shape == ("ellipse" if shape in {"DISK", "ELLIPSE"} else "rectangle")


@pytest.mark.parametrize("output, falloff", [("Quadratic", "physical"), ("Linear", "linear"), ("Constant", "constant")])
def test_light_falloff(scene, output, falloff):
    lamp = stage.light(scene, energy=4 * pi).data
    lamp.use_nodes = True
    tree = lamp.node_tree
    emission = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeEmission")
    emission.inputs["Color"].default_value = (0.5, 1, 1, 1)
    node = tree.nodes.new("ShaderNodeLightFalloff")
    node.inputs["Strength"].default_value = 3
    tree.links.new(node.outputs[output], emission.inputs["Strength"])
    given = export(scene).lights[0]
    assert given.falloff == falloff and given.emission == pytest.approx((1.5, 3, 3))
    lamp.triptych.falloff = "CONSTANT"
    assert export(scene).lights[0].falloff == "constant"


# ---------------------------------------------------------------------------------------------------------------- world


def test_world(scene):
    scene.world.color = (0.1, 0.2, 0.3)
    if compat.VERSION < (5, 0):
        scene.world.use_nodes = False
        assert export(scene).world.radiance == pytest.approx((0.1, 0.2, 0.3))
    stage.world_color(scene, (0.5, 1, 2), 2)
    world = export(scene).world
    assert world.radiance == pytest.approx((1, 2, 4)) and world.light and world.texture == data.NONE
    scene.world = None
    assert export(scene).world.radiance == (0, 0, 0)


def test_environment_texture(scene):
    tree, background = stage.world_color(scene, (1, 1, 1), 2)
    node = tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = stage.picture("Sky", np.full((4, 8, 3), 0.5, np.float32), "Non-Color", True)
    mapping, coordinate = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], node.inputs["Vector"])
    tree.links.new(node.outputs[0], background.inputs["Color"])
    mapping.inputs["Rotation"].default_value = (0, 0, radians(90))
    result = export(scene)
    assert result.world.texture == 0 and result.world.radiance == (2, 2, 2) and result.warnings == []
    # A direction of the world is turned by 90° before it is looked up.
    looked_up = result.world.world_from_texture[:, :3].T @ np.array([1, 0, 0])
    assert looked_up == pytest.approx([0, 1, 0], abs=1e-6)
    assert result.textures[0].pixels.shape == (4, 8, 4)
