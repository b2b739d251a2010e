# SPDX-License-Identifier: GPL-3.0-or-later
"""What differs between Blender 3.4 and 5.x, in one place. Each function works in all of them."""

import bpy
import numpy as np

VERSION = bpy.app.version[:2]

# Principled BSDF: our word, then the socket's identifiers from the newest to the oldest.
PRINCIPLED_SOCKETS = {
    "base": ("Base Color",),
    "metallic": ("Metallic",),
    "roughness": ("Roughness",),
    "ior": ("IOR",),
    "alpha": ("Alpha",),
    "normal": ("Normal",),
    "transmission": ("Transmission Weight", "Transmission"),
    "specular": ("Specular IOR Level", "Specular"),
    "specular_tint": ("Specular Tint",),
    "emission": ("Emission Color", "Emission"),
    "emission_strength": ("Emission Strength",),
    "thin": ("Thin Wall",),
    "subsurface": ("Subsurface Weight", "Subsurface"),
    "coat": ("Coat Weight", "Clearcoat"),
    "sheen": ("Sheen Weight", "Sheen"),
    "anisotropic": ("Anisotropic",),
}


def principled_socket(node, word):
    """The input socket of a Principled BSDF for one of PRINCIPLED_SOCKETS, or None."""
    for identifier in PRINCIPLED_SOCKETS[word]:
        socket = node.inputs.get(identifier)
        if socket is not None:
            return socket
    return None


def principled_has_ior_level():
    """True from 4.0: the specular level scales the reflectance that the IOR gives; before, it is 0.08 · level."""
    return VERSION >= (4, 0)


def uses_nodes(owner):
    """Whether a material, world or light is drawn by its node tree.

    From 5.0, use_nodes is deprecated for materials and worlds, and always true.
    """
    if owner.node_tree is None:
        return False
    return True if VERSION >= (5, 0) and not isinstance(owner, bpy.types.Light) else owner.use_nodes


def area_light_factor():
    """Radiance · area of an area light of 1 W, as Cycles of this version has it."""
    return 1.0 / np.pi if VERSION >= (4, 0) else 0.25


# --------------------------------------------------------------------------------------------------------------- meshes


def _attribute(mesh, name, dtype, width=1):
    """A named attribute of the mesh as an array (n × width, or n), or None."""
    attribute = mesh.attributes.get(name)
    if attribute is None or not len(attribute.data):
        return None
    values = np.empty(len(attribute.data) * width, dtype)
    attribute.data.foreach_get("vector" if attribute.data_type in {"FLOAT_VECTOR", "FLOAT2"} else "value", values)
    return values.reshape(-1, width) if width > 1 else values


def _collect(items, name, dtype, width=1):
    """foreach_get of a property of every item of a collection."""
    values = np.empty(len(items) * width, dtype)
    items.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


def mesh_positions(mesh):
    """n × 3 float32."""
    values = _attribute(mesh, "position", np.float32, 3)
    return _collect(mesh.vertices, "co", np.float32, 3) if values is None else values


def mesh_corner_vertices(mesh):
    """The vertex of each corner, uint32."""
    values = _attribute(mesh, ".corner_vert", np.int32)
    return (_collect(mesh.loops, "vertex_index", np.int32) if values is None else values).view(np.uint32)


def mesh_face_offsets(mesh):
    """The first corner of each face and, last, the count of corners; uint32."""
    offsets = np.empty(len(mesh.polygons) + 1, np.int32)
    if len(mesh.polygons):
        offsets[:-1] = _collect(mesh.polygons, "loop_start", np.int32)
    offsets[-1] = len(mesh.loops)
    return offsets.view(np.uint32)


def mesh_edges(mesh):
    """n × 2 uint32."""
    values = _attribute(mesh, ".edge_verts", np.int32, 2)
    return (_collect(mesh.edges, "vertices", np.int32, 2) if values is None else values).view(np.uint32)


def mesh_face_materials(mesh):
    """The slot of each face (uint32), or None where all are 0."""
    values = _attribute(mesh, "material_index", np.int32)
    if values is None or not values.any():
        return None
    return np.maximum(values, 0).view(np.uint32)


def mesh_face_smooth(mesh):
    """1 where the face is smooth, uint8."""
    if hasattr(mesh, "normals_domain"):
        if mesh.normals_domain == "FACE":
            return np.zeros(len(mesh.polygons), np.uint8)
        sharp = _attribute(mesh, "sharp_face", np.bool_)
        return np.ones(len(mesh.polygons), np.uint8) if sharp is None else (~sharp).view(np.uint8)
    return _collect(mesh.polygons, "use_smooth", np.bool_).view(np.uint8)


def mesh_corner_normals(mesh, always=False):
    """corners × 3 float32 where the mesh has normals of its own (custom, sharp edges, auto smooth), else None.

    Blender computes what it hands out, so that vertex normals and face normals are left to the core unless `always`.
    """
    if hasattr(mesh, "normals_domain"):
        if not always and mesh.normals_domain != "CORNER":
            return None
        return _collect(mesh.corner_normals, "vector", np.float32, 3)
    if not always and not mesh.use_auto_smooth:
        return None
    mesh.calc_normals_split()
    normals = _collect(mesh.loops, "normal", np.float32, 3)
    mesh.free_normals_split()
    return normals


def mesh_sharp_edges(mesh):
    """True for edges that averaged normals do not cross, or None where there is none."""
    if hasattr(mesh, "use_auto_smooth"):  # up to 4.0, marks mean nothing without auto smooth
        if not mesh.use_auto_smooth:
            return None
        values = _collect(mesh.edges, "use_edge_sharp", np.bool_)
    else:
        values = _attribute(mesh, "sharp_edge", np.bool_)
    return values if values is not None and values.any() else None


def mesh_marked_edges(mesh):
    """True for Freestyle's marks, or None where there is none."""
    values = _attribute(mesh, "freestyle_edge", np.bool_)
    if values is None and len(mesh.edges) and "use_freestyle_mark" in bpy.types.MeshEdge.bl_rna.properties:
        values = _collect(mesh.edges, "use_freestyle_mark", np.bool_)
    return values if values is not None and values.any() else None


def mesh_edge_creases(mesh):
    """0 to 1 for each edge, or None where all are 0."""
    values = _attribute(mesh, "crease_edge", np.float32)
    if values is None and getattr(mesh, "has_crease_edge", False):
        values = _collect(mesh.edges, "crease", np.float32)
    return np.clip(values, 0, 1) if values is not None and values.any() else None


def mesh_vertex_creases(mesh):
    """0 to 1 for each vertex, or None where all are 0."""
    values = _attribute(mesh, "crease_vert", np.float32)
    if values is None and len(getattr(mesh, "vertex_creases", None) or ()):
        values = _collect(mesh.vertex_creases[0].data, "value", np.float32)
    return np.clip(values, 0, 1) if values is not None and values.any() else None


def mesh_uv(layer):
    """corners × 2 float32 of a UV layer."""
    if hasattr(layer, "uv"):
        return _collect(layer.uv, "vector", np.float32, 2)
    return _collect(layer.data, "uv", np.float32, 2)


def mesh_triangles(mesh):
    """(triangles × 3 corner indices, the face of each)."""
    mesh.calc_loop_triangles()
    corners = _collect(mesh.loop_triangles, "loops", np.int32, 3)
    return corners.view(np.uint32), _collect(mesh.loop_triangles, "polygon_index", np.int32)


def mesh_values(mesh, name):
    """A named attribute as an array (n, or n × 3 or 4), or None."""
    attribute = mesh.attributes.get(name)
    if attribute is None:
        return None
    dtype, word, width = _ATTRIBUTE_TYPES[attribute.data_type]
    values = np.empty(len(attribute.data) * width, dtype)
    attribute.data.foreach_get(word, values)
    return values.reshape(-1, width) if width > 1 else values


def set_mesh_values(mesh, name, domain, values):
    """Gives a mesh the attribute: n int32 or float32, n × 3 (vectors) or n × 4 (colours)."""
    width = values.shape[1] if values.ndim > 1 else 1
    kind = next(key for key, row in _ATTRIBUTE_TYPES.items() if row[0] == values.dtype and row[2] == width)
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.data_type, attribute.domain) != (kind, domain):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(name, kind, domain)
    attribute.data.foreach_set(_ATTRIBUTE_TYPES[kind][1], values.ravel())


# Blender's type: numpy's, the word of foreach_get, numbers of each item.
_ATTRIBUTE_TYPES = {
    "INT": (np.int32, "value", 1),
    "FLOAT": (np.float32, "value", 1),
    "FLOAT_VECTOR": (np.float32, "vector", 3),
    "FLOAT_COLOR": (np.float32, "color", 4),
}


def set_mesh_polygons(mesh, positions, offsets, corners):
    """Fills an empty mesh: n × 3 float32, faces + 1 first corners, and the vertex of each corner, uint32."""
    mesh.vertices.add(len(positions))
    mesh.loops.add(len(corners))
    mesh.polygons.add(len(offsets) - 1)
    mesh.vertices.foreach_set("co", positions.ravel())
    mesh.loops.foreach_set("vertex_index", corners.view(np.int32))
    mesh.polygons.foreach_set("loop_start", offsets[:-1].view(np.int32))
    if VERSION < (4, 1):  # read-only afterwards, and found from where the next face starts
        mesh.polygons.foreach_set("loop_total", np.diff(offsets).astype(np.int32))
    mesh.update(calc_edges=True)


# -------------------------------------------------------------------------------------------------------------- results


def set_pass(render_pass, pixels):
    """Writes height × width × channels float32, row 0 at the bottom, into a render pass of that size."""
    pixels = np.ascontiguousarray(pixels, np.float32)
    if VERSION < (4, 0):
        render_pass.rect.foreach_set(pixels.reshape(-1, pixels.shape[-1]))
    else:
        render_pass.rect.foreach_set(pixels.reshape(-1))
