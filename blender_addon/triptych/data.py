# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as plain data: what triptych.h describes, with lists for ids.

Items name each other by their place in the scene's lists; NONE (-1) is "none". Arrays are numpy, C-contiguous, in the
units and axes of triptych.h (metres, radians, Z up). Words for enumerations are those of extras_triptych.md. Nothing
here knows Blender or the library, so that both sinks (core.py and gltf.py) get the same numbers.
"""

from dataclasses import dataclass, field

import numpy as np

NONE = -1

IDENTITY = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]], dtype=np.float32)


@dataclass
class Layer:
    """Named numbers on a mesh: UV (n × 2) or colour (n × 3 or 4, linear); domain is "corner" or "vertex"."""

    name: str
    values: np.ndarray
    domain: str = "corner"


@dataclass
class Triangulation:
    """What only other readers of a glTF file need: Blender's own triangles and shading normals."""

    corners: np.ndarray  # triangles × 3, uint32: indices of corners; 0, 1, 2, … in a mesh of triangles
    faces: np.ndarray  # the face of each triangle
    normals: np.ndarray  # corners × 3: the mesh's own, where it has them


@dataclass
class Mesh:
    name: str
    positions: np.ndarray  # n × 3 float32, or time samples × n × 3
    face_offsets: np.ndarray  # faces + 1, uint32
    corner_vertices: np.ndarray  # uint32
    corner_normals: np.ndarray = None  # corners × 3, only where the mesh has split normals of its own
    uv_sets: list = field(default_factory=list)  # of Layer; the first is the default
    colors: list = field(default_factory=list)  # of Layer; the first is the default
    materials: list = field(default_factory=list)  # material by slot
    face_materials: np.ndarray = None  # uint32
    face_smooth: np.ndarray = None  # uint8
    edges: np.ndarray = None  # n × 2 uint32
    edge_flags: np.ndarray = None  # uint8, EDGE_* bits
    edge_creases: np.ndarray = None  # float32
    vertex_creases: np.ndarray = None  # float32
    triangulation: Triangulation = None


EDGE_SHARP = 1
EDGE_MARKED = 2


@dataclass
class Instance:
    name: str
    mesh: int
    world_from_object: np.ndarray  # 3 × 4, or time samples × 3 × 4
    materials: list = field(default_factory=list)  # by slot, in place of the mesh's; NONE keeps the mesh's
    color: tuple = (1.0, 1.0, 1.0)
    index: int = 0
    visible_camera: bool = True
    visible_shadow: bool = True


@dataclass
class Texture:
    """A picture from one of: path, file_data (an image file's bytes), pixels (height × width × channels, bottom up)."""

    name: str
    path: str = ""
    file_data: bytes = b""
    pixels: np.ndarray = None
    color_space: str = "auto"  # auto, srgb, linear
    wrap: tuple = ("repeat", "repeat")  # along u and v: repeat, clamp, mirror, black
    filter: str = "smooth"  # smooth, nearest


@dataclass
class Node:
    """One step of a material's program. An input that is NONE reads values[k]."""

    type: str
    inputs: tuple = (NONE, NONE, NONE)
    values: tuple = ((0.0,) * 4, (0.0,) * 4, (0.0,) * 4)
    texture: int = NONE
    name: str = ""


@dataclass
class Coefficient:
    """value · node, or value alone where node is NONE. A scalar has a value of one number."""

    value: tuple
    node: int = NONE


COEFFICIENTS = ("emission", "ambient", "diffuse", "specular", "mirror", "transmission", "shininess", "ior", "alpha")
SCALARS = ("shininess", "ior", "alpha")


@dataclass
class Material:
    """Coefficients of the equation; ambient None is "as diffuse", mirror None is "as specular"."""

    name: str
    nodes: list = field(default_factory=list)
    emission: Coefficient = field(default_factory=lambda: Coefficient((0.0, 0.0, 0.0)))
    ambient: Coefficient = None
    diffuse: Coefficient = field(default_factory=lambda: Coefficient((0.8, 0.8, 0.8)))
    specular: Coefficient = field(default_factory=lambda: Coefficient((0.0, 0.0, 0.0)))
    shininess: Coefficient = field(default_factory=lambda: Coefficient((30.0,)))
    mirror: Coefficient = None
    transmission: Coefficient = field(default_factory=lambda: Coefficient((0.0, 0.0, 0.0)))
    ior: Coefficient = field(default_factory=lambda: Coefficient((1.5,)))
    alpha: Coefficient = field(default_factory=lambda: Coefficient((1.0,)))
    normal: int = NONE
    thin: bool = False
    double_sided: bool = True
    index: int = 0
    fresnel: bool = False
    priority: int = 0
    absorption: tuple = (0.0, 0.0, 0.0)  # 1/m


@dataclass
class Light:
    name: str
    type: str  # point, spot, sun, area
    world_from_light: np.ndarray  # as world_from_object
    emission: tuple  # W/sr (point, spot), W/m² (sun), W/(m² sr) (area)
    radius: float = 0.0
    angle: float = -1.0  # negative: the default of the type
    blend: float = 0.15
    size: tuple = (1.0, 1.0)
    shape: str = "rectangle"  # rectangle, ellipse
    falloff: str = "physical"  # physical, linear, constant
    cast_shadow: bool = True
    visible_camera: bool = False
    group: int = 0


@dataclass
class World:
    radiance: tuple = (0.0, 0.0, 0.0)
    texture: int = NONE
    world_from_texture: np.ndarray = field(default_factory=lambda: IDENTITY.copy())
    visible_camera: bool = True
    light: bool = True


@dataclass
class Camera:
    name: str
    type: str  # perspective, orthographic
    world_from_camera: np.ndarray  # as world_from_object
    fit: str = "auto"  # auto, horizontal, vertical
    field_of_view: float = 0.69
    width: float = 6.0
    shift: tuple = (0.0, 0.0)
    clip_start: float = 0.01
    clip_end: float = 1000.0
    aperture_radius: float = 0.0
    focus_distance: float = 10.0
    blade_count: int = 0
    blade_rotation: float = 0.0
    shutter: tuple = (0.0, 1.0)
    pixel_aspect: float = 1.0


@dataclass
class Scene:
    name: str = ""
    meshes: list = field(default_factory=list)
    instances: list = field(default_factory=list)
    textures: list = field(default_factory=list)
    materials: list = field(default_factory=list)
    lights: list = field(default_factory=list)
    cameras: list = field(default_factory=list)
    camera: int = NONE  # the one that renders
    world: World = field(default_factory=World)
    film: tuple = (960, 540)
    settings: dict = field(default_factory=dict)  # "shading.specular": "phong"; those that differ from their defaults
    warnings: list = field(default_factory=list)  # lines for the user

    def warn(self, text):
        """Adds a line, once."""
        if text not in self.warnings:
            self.warnings.append(text)


class ExportError(Exception):
    """A scene that cannot be rendered; the message names the item."""
