# SPDX-License-Identifier: GPL-3.0-or-later
"""A data.Mesh to a glTF mesh: triangles for every program, and extras.triptych for what these do not say.

A mesh of triangles with one material needs no extras where its faces are flat, or where it has normals of its own that
agree at each vertex. Others have them for these reasons, and no more in them than the reason asks for:

    n-gons, loose or marked edges   glTF has none
    several materials               a primitive to each, whose vertices the reader keeps apart
    normals that part a vertex      glTF splits it
    UV sets, colours                glTF has no names for them, and its v, which runs down, rounds ours
    smooth without own normals      the core averages the faces; Blender's averages are up to 5e-5 off, which highlights
                                    show. A flag to each face says it, all else is the primitive's
"""

import numpy as np

from . import data
from .glb import ARRAY_BUFFER, ELEMENT_BUFFER


def gltf_mesh(glb, mesh, with_colors):
    """The glTF mesh of a data.Mesh, whose arrays are added to a Glb. with_colors: the triangles have COLOR_0."""
    positions = _turned(mesh.positions)
    vertices = glb.accessor(positions, ARRAY_BUFFER, bounds=True)
    if len(mesh.corner_vertices):
        primitives = _primitives(glb, mesh, positions, vertices, with_colors)
    else:
        lines = glb.accessor(mesh.edges.reshape(-1), ELEMENT_BUFFER)
        primitives = [{"attributes": {"POSITION": vertices}, "indices": lines, "mode": 1}]
    result = {"name": mesh.name, "primitives": primitives}
    extras = _extras(glb, mesh, vertices, primitives)
    if extras:
        result["extras"] = {"triptych": extras}
    return result


def _turned(vectors):
    """n × 3 vectors with Y up."""
    result = np.empty_like(vectors)
    result[:, 0], result[:, 1], result[:, 2] = vectors[:, 0], vectors[:, 2], -vectors[:, 1]
    return result + np.float32(0)  # no −0


def _is_triangles(mesh):
    return (np.diff(mesh.face_offsets) == 3).all()


def _normals_tell_smoothness(mesh):
    """Whether all faces are smooth and there are own normals, or all flat and there are none: a reader's default."""
    return mesh.face_smooth is None or (mesh.face_smooth == (mesh.corner_normals is not None)).all()


# ----------------------------------------------------------------------------------------------------------- primitives


def _primitives(glb, mesh, positions, vertices, with_colors):
    """One primitive of triangles to each slot in use, all on the same vertices.

    vertices: the accessor of the mesh's own, which are taken unless one has to be split.
    """
    columns = _columns(mesh, with_colors)
    attributes = {"POSITION": vertices}
    vertex = mesh.corner_vertices
    corner = np.zeros(len(positions), np.intp)  # one of each vertex
    corner[vertex] = np.arange(len(vertex))
    if not all(np.array_equal(values, values[corner[vertex]]) for values in columns.values()):
        # Corners that are alike in everything become one vertex.
        table = np.hstack([mesh.corner_vertices.view(np.float32)[:, None], *columns.values()])
        rows = np.ascontiguousarray(table).view(np.dtype((np.void, table.shape[1] * 4))).reshape(-1)
        _, corner, vertex = np.unique(rows, return_index=True, return_inverse=True)
        vertex = vertex.reshape(-1).astype(np.uint32)
        attributes["POSITION"] = glb.accessor(positions[mesh.corner_vertices[corner]], ARRAY_BUFFER, bounds=True)
    for name, values in columns.items():
        attributes[name] = glb.accessor(values[corner], ARRAY_BUFFER)
    triangles = vertex[mesh.triangulation.corners]
    slots = np.zeros(len(triangles), np.uint32)
    if mesh.face_materials is not None:
        slots = mesh.face_materials[mesh.triangulation.faces]
    primitives = []
    for slot in np.unique(slots):
        indices = glb.accessor(triangles[slots == slot].reshape(-1), ELEMENT_BUFFER)
        primitive = {"attributes": attributes, "indices": indices}
        if slot < len(mesh.materials) and mesh.materials[slot] != data.NONE:
            primitive["material"] = mesh.materials[slot]
        primitives.append(primitive)
    return primitives


def _columns(mesh, with_colors):
    """{attribute: corners × 2..4} without POSITION. Flat triangles have no NORMAL, by glTF's own rule."""
    flat = mesh.corner_normals is None and _normals_tell_smoothness(mesh) and _is_triangles(mesh)
    columns = {} if flat else {"NORMAL": _turned(mesh.triangulation.normals)}
    if mesh.uv_sets:
        columns["TEXCOORD_0"] = mesh.uv_sets[0].values * np.float32([1, -1]) + np.float32([0, 1])
    if mesh.colors and with_colors:
        layer = mesh.colors[0]
        columns["COLOR_0"] = layer.values[mesh.corner_vertices] if layer.domain == "vertex" else layer.values
    return columns


# --------------------------------------------------------------------------------------------------------------- extras


def _extras(glb, mesh, vertices, primitives):
    """What the primitives do not say and then all else that the reader needs; empty where they say everything."""
    extras = {}

    def put(key, values):
        accessor = glb.accessor(values)
        if accessor is not None:
            extras[key] = accessor

    if not _is_triangles(mesh):
        put("face_offsets", mesh.face_offsets)
    for key, layers in (("uv_sets", mesh.uv_sets), ("colors", mesh.colors)):
        if layers:
            extras[key] = [
                {"name": layer.name, "accessor": glb.accessor(layer.values), "domain": layer.domain} for layer in layers
            ]
    if mesh.face_materials is not None:
        small = mesh.face_materials.max() < 65536
        put("face_materials", mesh.face_materials.astype(np.uint16 if small else np.uint32))
    if not _normals_tell_smoothness(mesh):
        put("face_smooth", mesh.face_smooth)
    if _has_own_edges(mesh):
        put("edges", mesh.edges.reshape(-1))
        put("edge_flags", mesh.edge_flags)
        put("edge_creases", mesh.edge_creases)
    put("vertex_creases", mesh.vertex_creases)
    shares_vertices = primitives[0]["attributes"]["POSITION"] == vertices
    if mesh.corner_normals is not None and (extras or not shares_vertices):
        put("corner_normals", _turned(mesh.corner_normals))
    if not extras:
        return extras
    extras["positions"] = vertices
    if mesh.materials:
        extras["materials"] = list(mesh.materials)
    if len(mesh.corner_vertices) and shares_vertices and len(primitives) == 1 and _is_triangles(mesh):
        extras["corner_vertices"] = primitives[0]["indices"]
    else:
        put("corner_vertices", mesh.corner_vertices)
    return extras


def _has_own_edges(mesh):
    """Whether edges bear numbers, or are not the faces' sides, which a reader takes where none are given."""
    if mesh.edges is None:
        return False
    if mesh.edge_flags is not None or mesh.edge_creases is not None:
        return True
    following = np.arange(1, len(mesh.corner_vertices) + 1)
    following[mesh.face_offsets[1:] - 1] = mesh.face_offsets[:-1]
    sides = np.stack([mesh.corner_vertices, mesh.corner_vertices[following]], axis=1)
    kept, implied = (np.unique(np.sort(pairs, axis=1).view(np.uint64)) for pairs in (mesh.edges, sides))
    return not np.array_equal(kept, implied)
