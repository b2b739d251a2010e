# SPDX-License-Identifier: GPL-3.0-or-later
"""The shared library: triptych.h in ctypes, and nothing else in the add-on knows ctypes.

    with core.Scene() as scene:
        scene.fill(data_scene)          # a data.Scene
        scene.commit()
        with core.Render(scene, "ray_casting") as render:
            render.set("samples", "16")
            render.run(progress=..., tile=...)
            pixels = render.read("Combined", 0, 0, 960, 540)

The library is loaded at the first use, from TRIPTYCH_LIBRARY or from beside this file. LibraryMissing says where it was
looked for; Error carries a status and the library's own message.
"""

import ctypes as c
import os
import sys

import numpy as np

from . import data

VERSION = 100  # the TRP_VERSION that this file is written for
NO_ID = 0

STATUS = ("OK", "ARGUMENT", "ID", "STATE", "MEMORY", "FILE", "INTERNAL", "CANCELLED")
CANCELLED = 7

FLOAT32, UINT8, UINT16, UINT32, INT32 = range(5)
_FORMATS = {"f4": FLOAT32, "u1": UINT8, "u2": UINT16, "u4": UINT32, "i4": INT32}
TYPES = ("BOOL", "INT", "FLOAT", "COLOR", "ENUM")

_DOMAIN = {"vertex": 0, "corner": 1}
_COLOR_SPACE = {"auto": 0, "srgb": 1, "linear": 2}
_WRAP = {"repeat": 0, "clamp": 1, "mirror": 2, "black": 3}
_FILTER = {"smooth": 0, "nearest": 1}
_LIGHT = {"point": 0, "spot": 1, "sun": 2, "area": 3}
_SHAPE = {"rectangle": 0, "ellipse": 1}
_FALLOFF = {"physical": 0, "linear": 1, "constant": 2}
_CAMERA = {"perspective": 0, "orthographic": 1}
_FIT = {"auto": 0, "horizontal": 1, "vertical": 2}

u32, i32, u64, f32, f64, text = c.c_uint32, c.c_int32, c.c_uint64, c.c_float, c.c_double, c.c_char_p
floats = c.POINTER(f32)


class LibraryMissing(Exception):
    """The shared library is not there, or is not one that this add-on can use."""


class Error(Exception):
    """A call failed. `status` is one of STATUS; the message is the library's."""

    def __init__(self, status, message):
        super().__init__(message)
        self.status = STATUS[status] if 0 <= status < len(STATUS) else str(status)


# ----------------------------------------------------------------------------------------------------------- structures


class Array(c.Structure):
    _fields_ = [("data", c.c_void_p), ("count", u64), ("stride", u32), ("format", i32)]


class Attribute(c.Structure):
    _fields_ = [("name", text), ("values", Array), ("domain", i32), ("components", i32)]


class SceneInfo(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        *((name, u32) for name in ("mesh_count", "instance_count", "material_count", "texture_count")),
        *((name, u32) for name in ("light_count", "camera_count")),
        *((name, u64) for name in ("face_count", "triangle_count", "vertex_count")),
        ("bounds_min", f32 * 3),
        ("bounds_max", f32 * 3),
        *((name, u64) for name in ("mesh_bytes", "held_bytes", "bvh_bytes")),
        ("commit_seconds", f64),
        ("bvh_seconds", f64),
    ]


class Warning_(c.Structure):
    _fields_ = [("struct_size", u32), ("code", i32), ("item", u32), ("text", text)]


class MeshDesc(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("time_count", u32),
        ("name", text),
        ("positions", Array),
        ("face_offsets", Array),
        ("corner_vertices", Array),
        ("normals", Array),
        ("normal_domain", i32),
        ("uv_set_count", u32),
        ("uv_sets", c.POINTER(Attribute)),
        ("colors", c.POINTER(Attribute)),
        ("color_count", u32),
        ("material_count", u32),
        ("materials", c.POINTER(u32)),
        ("face_materials", Array),
        ("face_smooth", Array),
        ("edges", Array),
        ("edge_flags", Array),
        ("edge_creases", Array),
        ("vertex_creases", Array),
    ]


class InstanceDesc(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("mesh", u32),
        ("name", text),
        ("world_from_object", floats),
        ("time_count", u32),
        ("material_count", u32),
        ("materials", c.POINTER(u32)),
        ("color", f32 * 3),
        ("index", i32),
        ("visible_camera", i32),
        ("visible_shadow", i32),
    ]


class TextureDesc(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("color_space", i32),
        ("name", text),
        ("path", text),
        ("file_data", c.c_void_p),
        ("file_size", u64),
        ("pixels", floats),
        ("width", u32),
        ("height", u32),
        ("channels", u32),
        ("wrap_u", i32),
        ("wrap_v", i32),
        ("filter", i32),
    ]


class Node(c.Structure):
    _fields_ = [
        ("type", i32),
        ("inputs", i32 * 3),
        ("value", f32 * 4),
        ("value2", f32 * 4),
        ("value3", f32 * 4),
        ("texture", u32),
        ("name", text),
    ]


class NodeInfo(c.Structure):
    _fields_ = [("struct_size", u32), ("type", i32), ("name", text), ("description", text), ("input_count", u32)]


class Coefficient(c.Structure):
    _fields_ = [("value", f32 * 3), ("node", i32)]


class MaterialDesc(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("node_count", u32),
        ("nodes", c.POINTER(Node)),
        ("name", text),
        *((name, Coefficient) for name in ("emission", "ambient", "diffuse", "specular", "shininess", "mirror")),
        *((name, Coefficient) for name in ("transmission", "ior", "alpha")),
        ("normal", i32),
        ("ambient_is_diffuse", i32),
        ("mirror_is_specular", i32),
        ("thin", i32),
        ("double_sided", i32),
        ("index", i32),
    ]


class LightDesc(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("type", i32),
        ("name", text),
        ("world_from_light", floats),
        ("time_count", u32),
        ("falloff", i32),
        ("emission", f32 * 3),
        ("radius", f32),
        ("angle", f32),
        ("blend", f32),
        ("size", f32 * 2),
        ("shape", i32),
        ("cast_shadow", i32),
        ("visible_camera", i32),
        ("group", u32),
    ]


class WorldDesc(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("texture", u32),
        ("radiance", f32 * 3),
        ("world_from_texture", floats),
        ("visible_camera", i32),
        ("light", i32),
    ]


class CameraDesc(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("type", i32),
        ("name", text),
        ("world_from_camera", floats),
        ("time_count", u32),
        ("fit", i32),
        ("field_of_view", f32),
        ("width", f32),
        ("shift", f32 * 2),
        ("clip_start", f32),
        ("clip_end", f32),
        ("aperture_radius", f32),
        ("focus_distance", f32),
        ("blade_count", u32),
        ("blade_rotation", f32),
        ("shutter", f32 * 2),
        ("pixel_aspect", f32),
    ]


class MethodInfo(c.Structure):
    _fields_ = [("struct_size", u32), ("name", text), ("label", text), ("description", text)]


class SettingInfo(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("type", i32),
        *((name, text) for name in ("name", "label", "description", "unit", "default_value")),
        ("minimum", f64),
        ("maximum", f64),
        ("choices", c.POINTER(text)),
        ("methods", text),
    ]


class PassInfo(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("channel_count", u32),
        *((name, text) for name in ("name", "channels", "description", "methods")),
    ]


class Progress(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("fraction", f64),
        ("seconds", f64),
        ("seconds_left", f64),
        ("pass_", u32),
        ("pass_count", u32),
        ("stage", text),
    ]


class Tile(c.Structure):
    _fields_ = [("struct_size", u32), *((name, u32) for name in ("x", "y", "width", "height", "pass_"))]


_PROGRESS = c.CFUNCTYPE(i32, c.c_void_p, c.POINTER(Progress))
_TILE = c.CFUNCTYPE(i32, c.c_void_p, c.POINTER(Tile))
_LOG = c.CFUNCTYPE(None, c.c_void_p, text)


class Callbacks(c.Structure):
    _fields_ = [("struct_size", u32), ("user", c.c_void_p), ("progress", _PROGRESS), ("tile", _TILE), ("log", _LOG)]


class Statistics(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("threads", u32),
        ("solve_seconds", f64),
        ("render_seconds", f64),
        *((f"{kind}_rays", u64) for kind in ("primary", "shadow", "reflection", "transmission", "gather")),
        ("triangles", u64),
        ("primary_seconds", f64),
        ("shadow_seconds", f64),
        ("shading_seconds", f64),
        ("peak_memory_bytes", u64),
    ]


# -------------------------------------------------------------------------------------------------------------- library

_handle, _out = c.c_void_p, c.POINTER(c.c_void_p)
_id_out = c.POINTER(u32)


def _item_functions(name, desc):
    return {
        f"{name}_desc_init": (i32, c.POINTER(desc), c.c_size_t),
        f"{name}_add": (i32, _handle, c.POINTER(desc), _id_out),
        f"{name}_replace": (i32, _handle, u32, c.POINTER(desc)),
        f"{name}_remove": (i32, _handle, u32),
    }


# name without trp_: (result, arguments…)
_FUNCTIONS = {
    "version": (u32,),
    "error_message": (text,),
    "scene_create": (i32, _out),
    "scene_destroy": (None, _handle),
    "scene_commit": (i32, _handle, u32),
    "scene_info": (i32, _handle, c.POINTER(SceneInfo)),
    "scene_warning_count": (u32, _handle),
    "scene_warning": (i32, _handle, u32, c.POINTER(Warning_)),
    **_item_functions("mesh", MeshDesc),
    **_item_functions("instance", InstanceDesc),
    **_item_functions("texture", TextureDesc),
    **_item_functions("material", MaterialDesc),
    **_item_functions("light", LightDesc),
    **_item_functions("camera", CameraDesc),
    "node_init": (i32, c.POINTER(Node), i32),
    "node_count": (u32,),
    "node_info": (i32, u32, c.POINTER(NodeInfo)),
    "world_desc_init": (i32, c.POINTER(WorldDesc), c.c_size_t),
    "scene_set_world": (i32, _handle, c.POINTER(WorldDesc)),
    "scene_set_camera": (i32, _handle, u32),
    "method_count": (u32,),
    "method_info": (i32, u32, c.POINTER(MethodInfo)),
    "setting_count": (u32,),
    "setting_info": (i32, u32, c.POINTER(SettingInfo)),
    "pass_count": (u32,),
    "pass_info": (i32, u32, c.POINTER(PassInfo)),
    "render_create": (i32, _handle, text, _out),
    "render_destroy": (None, _handle),
    "render_set_film": (i32, _handle, u32, u32, u32, u32, u32, u32),
    "render_set": (i32, _handle, text, text),
    "render_add_pass": (i32, _handle, text),
    "callbacks_init": (i32, c.POINTER(Callbacks), c.c_size_t),
    "render_run": (i32, _handle, c.POINTER(Callbacks)),
    "render_cancel": (i32, _handle),
    "render_read": (i32, _handle, text, u32, u32, u32, u32, floats, c.c_size_t),
    "render_write": (i32, _handle, text),
    "render_statistics": (i32, _handle, c.POINTER(Statistics)),
}

_library = None


def library_path():
    """Where the library is looked for."""
    named = os.environ.get("TRIPTYCH_LIBRARY")
    if named:
        return os.path.abspath(named)
    name = {"win32": "triptych.dll", "darwin": "libtriptych.dylib"}.get(sys.platform, "libtriptych.so")
    return os.path.join(os.path.dirname(os.path.abspath(__file__)), name)


def library():
    """The loaded library. Raises LibraryMissing; the next call tries again."""
    global _library
    if _library is not None:
        return _library
    path = library_path()
    if not os.path.isfile(path):
        raise LibraryMissing(f"Triptych's library is not at {path}; TRIPTYCH_LIBRARY can name another place")
    try:
        loaded = c.CDLL(path)
        for name, (result, *arguments) in _FUNCTIONS.items():
            function = getattr(loaded, "trp_" + name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        raise LibraryMissing(f"Triptych's library cannot be loaded: {error}") from error
    version = loaded.trp_version()
    # Before 1.0, a minor version may change the interface; a patch may not.
    if version // 100 != VERSION // 100:
        found, wanted = (f"{number // 10000}.{number // 100 % 100}.{number % 100}" for number in (version, VERSION))
        raise LibraryMissing(f"Triptych's library at {path} is version {found}; this add-on needs {wanted}")
    _library = loaded
    return loaded


def missing():
    """Why the library cannot be used, or an empty string."""
    try:
        library()
    except LibraryMissing as error:
        return str(error)
    return ""


def _call(name, *arguments):
    """Calls trp_<name>; Error where its status is one. Gives the status."""
    loaded = library()
    status = getattr(loaded, "trp_" + name)(*arguments)
    if status not in (0, CANCELLED):
        raise Error(status, (loaded.trp_error_message() or b"").decode(errors="replace") or f"trp_{name} failed")
    return status


def _init(name, structure):
    """A descriptor with the library's defaults."""
    desc = structure()
    _call(f"{name}_init", c.byref(desc), c.sizeof(desc))
    return desc


def _table(name, structure):
    rows = []
    for index in range(getattr(library(), f"trp_{name}_count")()):
        row = structure(struct_size=c.sizeof(structure))
        _call(f"{name}_info", index, c.byref(row))
        rows.append(row)
    return rows


def _words(value):
    return (value or b"").decode()


def methods():
    """[(name, label, description), …]"""
    return [(_words(row.name), _words(row.label), _words(row.description)) for row in _table("method", MethodInfo)]


class Setting:
    """A row of the settings' table: name, type (of TYPES), label, description, unit, default (text), minimum, maximum,
    choices, methods (a set of names; {"*"}: all)."""

    def __init__(self, row):
        self.type = TYPES[row.type]
        for name in ("name", "label", "description", "unit"):
            setattr(self, name, _words(getattr(row, name)))
        self.default = _words(row.default_value)
        self.minimum, self.maximum = row.minimum, row.maximum
        self.methods = set(_words(row.methods).split())
        self.choices = []
        while row.choices and row.choices[len(self.choices)]:
            self.choices.append(_words(row.choices[len(self.choices)]))

    def used_by(self, method):
        return method in self.methods or "*" in self.methods


def settings():
    """The table of settings, in the library's order."""
    return [Setting(row) for row in _table("setting", SettingInfo)]


class Pass:
    """A row of the passes' table: name, channels ("XYZ"), description, methods."""

    def __init__(self, row):
        for name in ("name", "channels", "description"):
            setattr(self, name, _words(getattr(row, name)))
        self.channel_count = row.channel_count
        self.methods = set(_words(row.methods).split())

    def used_by(self, method):
        return method in self.methods or "*" in self.methods


def passes():
    """The table of passes."""
    return [Pass(row) for row in _table("pass", PassInfo)]


def node_types():
    """{name: TRP_NODE_… value}"""
    return {_words(row.name): row.type for row in _table("node", NodeInfo)}


# ---------------------------------------------------------------------------------------------------------------- scene


def _array(values):
    """An Array on numpy's memory, which must outlive the call; n or n × k numbers. None: not given."""
    if values is None:
        return Array()
    if not len(values):
        return Array(None, 0, 0, _FORMATS[values.dtype.str[1:]])
    if not values.flags.c_contiguous:
        raise ValueError("the core takes packed arrays")
    return Array(values.ctypes.data, len(values), values.strides[0], _FORMATS[values.dtype.str[1:]])


def _floats(values):
    return values.ctypes.data_as(floats)


def _matrix(rows):
    return np.ascontiguousarray(rows, np.float32).reshape(-1)


def _ids(values):
    return (u32 * len(values))(*values)


class Scene:
    """A scene of the core. Use it as a context manager."""

    def __init__(self):
        self._handle = c.c_void_p()
        _call("scene_create", c.byref(self._handle))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._handle:
            library().trp_scene_destroy(self._handle)
            self._handle = c.c_void_p()

    def fill(self, scene):
        """Adds everything of a data.Scene, whose references are places in its lists. Error names the item."""
        textures = [self.add_texture(texture) for texture in scene.textures]
        materials = [self.add_material(material, textures) for material in scene.materials]
        meshes = [self.add_mesh(mesh, materials) for mesh in scene.meshes]
        for instance in scene.instances:
            self.add_instance(instance, meshes, materials)
        for light in scene.lights:
            self.add_light(light)
        self.set_world(scene.world, textures)
        cameras = [self.add_camera(camera) for camera in scene.cameras]
        _call("scene_set_camera", self._handle, NO_ID if scene.camera == data.NONE else cameras[scene.camera])

    def commit(self, threads=0):
        """Makes the snapshot that renders see."""
        _call("scene_commit", self._handle, threads)

    def info(self):
        """SceneInfo of the last commit."""
        info = SceneInfo(struct_size=c.sizeof(SceneInfo))
        _call("scene_info", self._handle, c.byref(info))
        return info

    def warnings(self):
        """The lines of the last commit."""
        lines = []
        for index in range(library().trp_scene_warning_count(self._handle)):
            warning = Warning_(struct_size=c.sizeof(Warning_))
            _call("scene_warning", self._handle, index, c.byref(warning))
            lines.append(warning.text.decode(errors="replace"))
        return lines

    def _add(self, kind, desc):
        number = u32()
        _call(f"{kind}_add", self._handle, c.byref(desc), c.byref(number))
        return number.value

    def add_mesh(self, mesh, materials):
        desc = _init("mesh_desc", MeshDesc)
        desc.name = mesh.name.encode()
        desc.positions = _array(mesh.positions)
        desc.corner_vertices = _array(mesh.corner_vertices)
        if len(mesh.corner_vertices):
            desc.face_offsets = _array(mesh.face_offsets)
            desc.normals = _array(mesh.corner_normals)
            desc.normal_domain = _DOMAIN["corner"]
        uv_sets, colors = _attributes(mesh.uv_sets), _attributes(mesh.colors)
        desc.uv_sets, desc.uv_set_count = uv_sets, len(mesh.uv_sets)
        desc.colors, desc.color_count = colors, len(mesh.colors)
        desc.materials, desc.material_count = _ids(_named(mesh.materials, materials)), len(mesh.materials)
        for name in ("face_materials", "face_smooth", "edges", "edge_flags", "edge_creases", "vertex_creases"):
            setattr(desc, name, _array(getattr(mesh, name)))
        return self._add("mesh", desc)

    def add_instance(self, instance, meshes, materials):
        desc = _init("instance_desc", InstanceDesc)
        desc.name, desc.mesh = instance.name.encode(), meshes[instance.mesh]
        matrix = _matrix(instance.world_from_object)
        desc.world_from_object = _floats(matrix)
        desc.materials, desc.material_count = _ids(_named(instance.materials, materials)), len(instance.materials)
        desc.color[:] = instance.color
        desc.index = instance.index
        desc.visible_camera, desc.visible_shadow = instance.visible_camera, instance.visible_shadow
        return self._add("instance", desc)

    def add_texture(self, texture):
        desc = _init("texture_desc", TextureDesc)
        desc.name = texture.name.encode()
        desc.color_space = _COLOR_SPACE[texture.color_space]
        desc.wrap_u, desc.wrap_v = (_WRAP[wrap] for wrap in texture.wrap)
        desc.filter = _FILTER[texture.filter]
        if texture.pixels is not None:
            pixels = np.ascontiguousarray(texture.pixels, np.float32)
            desc.height, desc.width, desc.channels = pixels.shape
            desc.pixels = _floats(pixels)
        elif texture.file_data:
            desc.file_data = c.cast(texture.file_data, c.c_void_p)
            desc.file_size = len(texture.file_data)
        else:
            desc.path = os.fsencode(texture.path or texture.name)
        return self._add("texture", desc)

    def add_material(self, material, textures):
        desc = _init("material_desc", MaterialDesc)
        desc.name = material.name.encode()
        nodes = (Node * len(material.nodes))()
        types = node_types() if material.nodes else {}
        for node, source in zip(nodes, material.nodes, strict=True):
            _call("node_init", c.byref(node), types[source.type])
            node.inputs[:] = source.inputs
            node.value[:], node.value2[:], node.value3[:] = source.values
            node.texture = NO_ID if source.texture == data.NONE else textures[source.texture]
            node.name = source.name.encode()
        desc.nodes, desc.node_count = nodes, len(nodes)
        for name in data.COEFFICIENTS:
            source = getattr(material, name)
            if source is not None:
                value = tuple(source.value) + (0.0,) * (3 - len(source.value))
                setattr(desc, name, Coefficient((f32 * 3)(*value), source.node))
        desc.ambient_is_diffuse = material.ambient is None
        desc.mirror_is_specular = material.mirror is None
        desc.normal, desc.thin, desc.double_sided = material.normal, material.thin, material.double_sided
        desc.index = material.index
        return self._add("material", desc)

    def add_light(self, light):
        desc = _init("light_desc", LightDesc)
        desc.name, desc.type = light.name.encode(), _LIGHT[light.type]
        matrix = _matrix(light.world_from_light)
        desc.world_from_light = _floats(matrix)
        desc.falloff, desc.shape = _FALLOFF[light.falloff], _SHAPE[light.shape]
        desc.emission[:], desc.size[:] = light.emission, light.size
        for name in ("radius", "angle", "blend", "cast_shadow", "visible_camera", "group"):
            setattr(desc, name, getattr(light, name))
        return self._add("light", desc)

    def set_world(self, world, textures):
        desc = _init("world_desc", WorldDesc)
        desc.texture = NO_ID if world.texture == data.NONE else textures[world.texture]
        desc.radiance[:] = world.radiance
        matrix = _matrix(world.world_from_texture)
        desc.world_from_texture = _floats(matrix)
        desc.visible_camera, desc.light = world.visible_camera, world.light
        _call("scene_set_world", self._handle, c.byref(desc))

    def add_camera(self, camera):
        desc = _init("camera_desc", CameraDesc)
        desc.name, desc.type, desc.fit = camera.name.encode(), _CAMERA[camera.type], _FIT[camera.fit]
        matrix = _matrix(camera.world_from_camera)
        desc.world_from_camera = _floats(matrix)
        desc.shift[:], desc.shutter[:] = camera.shift, camera.shutter
        for name in (
            *("field_of_view", "width", "clip_start", "clip_end", "aperture_radius", "focus_distance"),
            *("blade_count", "blade_rotation", "pixel_aspect"),
        ):
            setattr(desc, name, getattr(camera, name))
        return self._add("camera", desc)


def _attributes(layers):
    result = (Attribute * len(layers))()
    for attribute, layer in zip(result, layers, strict=True):
        attribute.name, attribute.values = layer.name.encode(), _array(layer.values)
        attribute.domain, attribute.components = _DOMAIN[layer.domain], layer.values.shape[1]
    return result


def _named(places, ids):
    return [NO_ID if place == data.NONE else ids[place] for place in places]


# --------------------------------------------------------------------------------------------------------------- render


class Render:
    """A render of a scene's last commit by a method. Use it as a context manager."""

    def __init__(self, scene, method):
        self._handle = c.c_void_p()
        _call("render_create", scene._handle, method.encode(), c.byref(self._handle))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._handle:
            library().trp_render_destroy(self._handle)
            self._handle = c.c_void_p()

    def set_film(self, width, height, window=(0, 0, 0, 0)):
        """The picture's size, and the window (x, y, width, height) of it that is rendered, from the bottom left."""
        _call("render_set_film", self._handle, width, height, *window)

    def set(self, name, value):
        """A setting, as text."""
        _call("render_set", self._handle, name.encode(), value.encode())

    def add_pass(self, name):
        _call("render_add_pass", self._handle, name.encode())

    def run(self, progress=None, tile=None, log=None):
        """Renders. progress(Progress), tile(Tile) and log(str) are called on this thread; a false answer cancels.

        False where it was cancelled. What a callback raises cancels the render and is raised from here.
        """
        raised = []

        def guarded(function, convert):
            def called(_, argument):
                if raised:
                    return 0
                try:
                    return 1 if function(convert(argument)) else 0
                except BaseException as error:  # nothing may pass through C
                    raised.append(error)
                    return 0

            return called

        callbacks = _init("callbacks", Callbacks)
        if progress is not None:
            callbacks.progress = _PROGRESS(guarded(progress, lambda pointer: pointer.contents))
        if tile is not None:
            callbacks.tile = _TILE(guarded(tile, lambda pointer: pointer.contents))
        if log is not None:
            callbacks.log = _LOG(guarded(log, lambda line: line.decode(errors="replace")))
        status = _call("render_run", self._handle, c.byref(callbacks))
        if raised:
            raise raised[0]
        return status != CANCELLED

    def cancel(self):
        """Any thread."""
        _call("render_cancel", self._handle)

    def read(self, name, x, y, width, height, channels=4):
        """A rectangle of a pass: height × width × channels float32, row 0 at the bottom."""
        pixels = np.empty((height, width, channels), np.float32)
        _call("render_read", self._handle, name.encode(), x, y, width, height, _floats(pixels), pixels.size)
        return pixels

    def write(self, path):
        """Writes .exr or .png."""
        _call("render_write", self._handle, os.fsencode(path))

    def statistics(self):
        """Statistics of the last run."""
        statistics = Statistics(struct_size=c.sizeof(Statistics))
        _call("render_statistics", self._handle, c.byref(statistics))
        return statistics
