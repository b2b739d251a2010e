# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated meshes to data.Mesh: n-gons, own edges, split normals, UV sets and colours, as Blender holds them."""

import numpy as np

from . import compat, data


def export_mesh(mesh, triangulate=False):
    """The data.Mesh of an evaluated bpy.types.Mesh, without its materials; None where there is nothing to draw.

    triangulate: adds Blender's triangles and normals, for readers of glTF files that know no n-gons.
    """
    if not len(mesh.edges) and not len(mesh.polygons):
        return None
    has_faces = len(mesh.polygons) > 0
    result = data.Mesh(
        name=mesh.name,
        positions=compat.mesh_positions(mesh),
        face_offsets=compat.mesh_face_offsets(mesh),
        corner_vertices=compat.mesh_corner_vertices(mesh) if has_faces else np.empty(0, np.uint32),
        edges=compat.mesh_edges(mesh) if len(mesh.edges) else None,
        edge_flags=_edge_flags(mesh),
        edge_creases=compat.mesh_edge_creases(mesh),
        vertex_creases=compat.mesh_vertex_creases(mesh),
    )
    if has_faces:
        result.face_materials = compat.mesh_face_materials(mesh)
        result.face_smooth = compat.mesh_face_smooth(mesh)
        result.corner_normals = compat.mesh_corner_normals(mesh)
        result.uv_sets = _uv_sets(mesh)
        result.colors = _colors(mesh)
        if triangulate:
            corners, faces = compat.mesh_triangles(mesh)
            normals = result.corner_normals
            if normals is None:
                normals = compat.mesh_corner_normals(mesh, always=True)
            result.triangulation = data.Triangulation(corners, faces, normals)
    return result


def _edge_flags(mesh):
    sharp, marked = compat.mesh_sharp_edges(mesh), compat.mesh_marked_edges(mesh)
    if sharp is None and marked is None:
        return None
    flags = np.zeros(len(mesh.edges), np.uint8)
    if sharp is not None:
        flags[sharp] |= data.EDGE_SHARP
    if marked is not None:
        flags[marked] |= data.EDGE_MARKED
    return flags


def _uv_sets(mesh):
    """The layer that renders comes first: it is the one that a texture without a UV Map node reads."""
    layers = sorted(mesh.uv_layers, key=lambda layer: not layer.active_render)
    return [data.Layer(layer.name, compat.mesh_uv(layer)) for layer in layers]


def _colors(mesh):
    attributes = list(mesh.color_attributes)
    render = mesh.color_attributes.render_color_index
    if 0 < render < len(attributes):
        attributes.insert(0, attributes.pop(render))
    layers = []
    for attribute in attributes:
        domain = {"POINT": "vertex", "CORNER": "corner"}.get(attribute.domain)
        if domain is None or not len(attribute.data):
            continue
        # "color" is linear for byte attributes too.
        values = np.empty(len(attribute.data) * 4, np.float32)
        attribute.data.foreach_get("color", values)
        layers.append(data.Layer(attribute.name, values.reshape(-1, 4), domain))
    return layers
