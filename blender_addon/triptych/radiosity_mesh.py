# SPDX-License-Identifier: GPL-3.0-or-later
"""The elements and links of a radiosity solution as meshes, whose attributes are what the solver knows of them.

Of faces, in W/m²: radiosity, irradiance, unshot, emission; reflectance; area (m²), element (its number), and the
form_factor of a chosen element towards each. Of vertices: vertex_radiosity and vertex_irradiance. Of corners: shown,
the colours of the viewport's Solid mode. Of links, which are edges: factor, receiver and source (−1: a group). The
mesh's own property is the iteration that it is of.
"""

from math import dist, pi

import bpy
import numpy as np

from . import abi, compat, data, generated

_OF_FACES = ("radiosity", "irradiance", "unshot", "emission", "reflectance")
_SMOOTH = {"radiosity": "vertex_radiosity", "irradiance": "vertex_irradiance"}
SHOWN = "shown"
_LIFT = 2e-4  # of the scene's size: how far the mesh stands before the surfaces, which it coincides with
_WHITE_FORM_FACTORS = 4  # times the mean by area are white


# ------------------------------------------------------------------------------------------------------------- elements


def update(scene, solution, look):
    """The mesh object of a core.Radiosity in a bpy.types.Scene, made or brought up to date.

    look: window_manager.triptych_radiosity.
    """
    offsets, corners = solution.polygons()
    made = generated.find_or_make(scene, generated.MESH, "Radiosity Mesh")
    mesh = made.data
    _check_mode(made)
    positions = solution.read("vertex_position")
    if not _is_of(mesh, offsets, corners):
        _build(mesh, offsets, corners, positions)
    mesh.vertices.foreach_set("co", positions.ravel())
    elements = compat.mesh_values(mesh, "element")
    for name in _OF_FACES:
        compat.set_mesh_values(mesh, name, "FACE", solution.read(name)[elements])
    compat.set_mesh_values(mesh, "area", "FACE", solution.read("area")[elements])
    compat.set_mesh_values(mesh, "vertex_radiosity", "POINT", _opaque(solution.read("vertex_radiosity")))
    compat.set_mesh_values(mesh, "vertex_irradiance", "POINT", solution.read("vertex_irradiance"))
    mesh["iteration"] = solution.info().iterations
    color(mesh, look.shown, look.scale, scene.triptych.radiosity_smooth)
    if not made.modifiers and len(positions):
        _lift(made, _LIFT * dist(positions.min(axis=0), positions.max(axis=0)))
    show_colors()
    return made


def edited(scene):
    """What there is to say of a mesh of ours that is in Edit Mode, where it cannot be changed; or an empty string."""
    found = (generated.find(scene, mark) for mark in (generated.MESH, generated.LINKS))
    return next((_edited(made) for made in found if made is not None and made.data.is_editmode), "")


def _edited(made):
    return f"'{made.name}' is being edited: leave Edit Mode to see it change"


def _check_mode(made):
    if made.data.is_editmode:
        raise data.ExportError(_edited(made))


def _is_of(mesh, offsets, corners):
    """Whether the mesh has these polygons."""
    return (
        mesh.attributes.get("element") is not None
        and np.array_equal(compat.mesh_face_offsets(mesh), offsets)
        and np.array_equal(compat.mesh_corner_vertices(mesh), corners)
    )


def _build(mesh, offsets, corners, positions):
    mesh.clear_geometry()
    compat.set_mesh_polygons(mesh, positions, offsets, corners)
    compat.set_mesh_values(mesh, "element", "FACE", np.arange(len(offsets) - 1, dtype=np.int32))
    mesh.validate()  # takes elements without an area out
    mesh.update()


def _lift(made, height):
    """Moves the mesh out of the surfaces where it is seen; its data stay in them."""
    modifier = made.modifiers.new("Lift", "DISPLACE")
    modifier.strength, modifier.mid_level = height, 0
    modifier.show_in_editmode = modifier.show_on_cage = True


def color(mesh, value, scale, smooth):
    """Colours the mesh by one of its attributes, for viewports in Solid mode; scale: the value that is white, or 0.

    Form factors that were not found of these elements are shown as radiosity.
    """
    if value == "form_factor" and not has_form_factors(mesh):
        value = "radiosity"
    known = _SMOOTH.get(value) if smooth else None
    values = compat.mesh_values(mesh, known or value)
    if values is None:
        values = np.zeros(len(mesh.polygons))
    white = pi  # as pictures have it: radiance, which is radiosity by π
    if value == "form_factor":  # of elements of any size, so by their areas
        area = compat.mesh_values(mesh, "area")
        white = _WHITE_FORM_FACTORS * values.sum() / max(area.sum(), 1e-30) or 1
        values = values / np.maximum(area, 1e-30)
    elif value == "reflectance":
        white = 1
    if values.ndim == 1:
        values = np.repeat(values[:, None], 3, axis=1)
    offsets = compat.mesh_face_offsets(mesh)
    of_corners = compat.mesh_corner_vertices(mesh) if known else np.repeat(np.arange(len(values)), np.diff(offsets))
    compat.set_mesh_values(mesh, SHOWN, "CORNER", _opaque(values[of_corners, :3] / (scale or white)))
    mesh.color_attributes.active_color = mesh.color_attributes[SHOWN]
    mesh.update()


def _opaque(colors):
    return np.hstack([colors, np.ones((len(colors), 1))]).astype(np.float32)


def has_form_factors(mesh):
    return "form_factor" in mesh.attributes


def set_form_factors(made, solution):
    """Gives the faces the row of form factors of the active one. (its element, the row's sum)"""
    _check_mode(made)
    mesh = made.data
    elements = compat.mesh_values(mesh, "element")
    active = mesh.polygons.active
    if elements is None or not 0 <= active < len(elements):
        raise data.ExportError(f"'{made.name}' has no active face: select one in Edit Mode")
    element = int(elements[active])
    offsets, corners = solution.polygons()
    if element >= len(offsets) - 1 or elements.max() >= len(offsets) - 1:
        raise data.ExportError(f"'{made.name}' is of other elements than the solution: press Radiosity Mesh")
    row = solution.form_factors(element)
    compat.set_mesh_values(mesh, "form_factor", "FACE", row[elements].astype(np.float32))
    return element, row.sum()


# ---------------------------------------------------------------------------------------------------------------- links


def update_links(scene, solution, most):
    """The object of the links of a core.Radiosity, at most so many, the largest factors first. Gives how many there are
    in all."""
    links = solution.links()
    total = len(links)
    size = links["factor"].mean(axis=1)
    links = links[np.argsort(-size, kind="stable")[:most]]
    made = generated.find_or_make(scene, generated.LINKS, "Radiosity Links")
    made.display_type = "WIRE"
    mesh = made.data
    _check_mode(made)
    mesh.clear_geometry()
    mesh.vertices.add(2 * len(links))
    mesh.vertices.foreach_set("co", np.stack([links["from"], links["to"]], axis=1).ravel())
    mesh.edges.add(len(links))
    mesh.edges.foreach_set("vertices", np.arange(2 * len(links), dtype=np.int32))
    compat.set_mesh_values(mesh, "factor", "EDGE", links["factor"])
    for name in ("source", "receiver"):
        numbers = np.where(links[name] == abi.NO_ELEMENT, -1, links[name].astype(np.int64))
        compat.set_mesh_values(mesh, name, "EDGE", numbers.astype(np.int32))
    mesh.update(calc_edges_loose=True)
    return total


# ------------------------------------------------------------------------------------------------------------- viewport


_BEFORE = "triptych_shading"  # of a screen: {number of an area: what its Solid mode was like before}
_COLORED = ["FLAT", "VERTEX"]


def show_colors(anew=False):
    """Has viewports in Solid mode that have a mesh show its colours, as they are; each once, unless anew."""
    for window, before in _screens():
        if generated.find(window.scene, generated.MESH) is None:
            continue
        for number, shading in _solid(window.screen):
            if number not in before:
                before[number] = [shading.light, shading.color_type]
            elif not anew:
                continue
            shading.light, shading.color_type = _COLORED
        window.screen[_BEFORE] = before


def hide_colors():
    """Has viewports whose mesh is gone show what they did before, where the user has chosen nothing else since."""
    for window, before in _screens():
        if not before or generated.find(window.scene, generated.MESH) is not None:
            continue
        for number, shading in _solid(window.screen):
            was = before.pop(number, None)
            if was and [shading.light, shading.color_type] == _COLORED:
                shading.light, shading.color_type = was
        window.screen[_BEFORE] = before


def _screens():
    """[(window, what its screen's viewports were like)]"""
    windows = bpy.context.window_manager.windows
    return [(window, dict(window.screen.get(_BEFORE, {}))) for window in windows]


def _solid(screen):
    """[(number of the area, shading)] of a screen's viewports in Solid mode."""
    spaces = ((str(number), area.spaces.active) for number, area in enumerate(screen.areas) if area.type == "VIEW_3D")
    return [(number, space.shading) for number, space in spaces if space.shading.type == "SOLID"]
