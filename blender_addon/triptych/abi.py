# SPDX-License-Identifier: GPL-3.0-or-later
"""triptych.h in ctypes: its structures, enumerations and functions, and the library that has them.

The library is loaded at the first use, from TRIPTYCH_LIBRARY or from beside this file. LibraryMissing says where it was
looked for; Error carries a status and the library's own message.
"""

import ctypes as c
import os
import sys

VERSION = 100  # the TRP_VERSION that this file is written for
NO_ID = 0

STATUS = ("OK", "ARGUMENT", "ID", "STATE", "MEMORY", "FILE", "INTERNAL", "CANCELLED")
CANCELLED = 7

# Enumerations by our words: numpy's for formats, data.py's for the others.
FORMAT = {"f4": 0, "u1": 1, "u2": 2, "u4": 3, "i4": 4}
DOMAIN = {"vertex": 0, "corner": 1}
COLOR_SPACE = {"auto": 0, "srgb": 1, "linear": 2}
WRAP = {"repeat": 0, "clamp": 1, "mirror": 2, "black": 3}
FILTER = {"smooth": 0, "nearest": 1}
LIGHT = {"point": 0, "spot": 1, "sun": 2, "area": 3}
SHAPE = {"rectangle": 0, "ellipse": 1}
FALLOFF = {"physical": 0, "linear": 1, "constant": 2}
CAMERA = {"perspective": 0, "orthographic": 1}
FIT = {"auto": 0, "horizontal": 1, "vertical": 2}
SETTING_TYPES = ("BOOL", "INT", "FLOAT", "COLOR", "ENUM")
RAY_KINDS = ("primary", "reflection", "transmission")
RAY_ENDS = ("surface", "light", "background", "depth", "weight")
NO_PARENT = 0xFFFFFFFF
NO_ELEMENT = 0xFFFFFFFF

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
        ("fresnel", i32),
        ("priority", i32),
        ("absorption", f32 * 3),
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
        ("method_defaults", text),
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


ProgressFunction = c.CFUNCTYPE(i32, c.c_void_p, c.POINTER(Progress))
TileFunction = c.CFUNCTYPE(i32, c.c_void_p, c.POINTER(Tile))
LogFunction = c.CFUNCTYPE(None, c.c_void_p, text)


class Callbacks(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("user", c.c_void_p),
        ("progress", ProgressFunction),
        ("tile", TileFunction),
        ("log", LogFunction),
    ]


class Ray(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("kind", i32),
        ("end", i32),
        ("parent", u32),
        ("object", text),
        ("material", text),
        ("instance", u32),
        ("origin", f32 * 3),
        ("direction", f32 * 3),
        ("distance", f32),
        *((name, f32 * 3) for name in ("position", "normal", "local", "weight", "intensity")),
    ]


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
        ("elements", u64),
        ("links", u64),
        ("iterations", u32),
        ("residual", f64),
    ]


class RadiosityInfo(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        *((name, u32) for name in ("element_count", "vertex_count", "corner_count", "iterations")),
        ("solved", i32),
        ("links", u64),
        ("rays", u64),
        ("residual", f64),
        ("area", f64),
        ("power", f64 * 3),
        ("unshot", f64 * 3),
        ("seconds", f64),
        ("projection_side", u32),
        ("limited", i32),
    ]


class RadiosityLink(c.Structure):
    _fields_ = [
        ("struct_size", u32),
        ("receiver", u32),
        ("source", u32),
        *((name, f32 * 3) for name in ("factor", "from", "to")),
        ("level", i32),
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
FUNCTIONS = {
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
    "render_trace_tree": (i32, _handle, u32, u32, c.POINTER(u32)),
    "render_ray": (i32, _handle, u32, c.POINTER(Ray)),
    "render_set_radiosity": (i32, _handle, _handle),
    "radiosity_create": (i32, _handle, c.POINTER(_handle)),
    "radiosity_destroy": (None, _handle),
    "radiosity_set": (i32, _handle, text, text),
    "radiosity_prepare": (i32, _handle, c.POINTER(Callbacks)),
    "radiosity_step": (i32, _handle, u32, c.POINTER(Callbacks)),
    "radiosity_solve": (i32, _handle, c.POINTER(Callbacks)),
    "radiosity_info": (i32, _handle, c.POINTER(RadiosityInfo)),
    "radiosity_warning_count": (u32, _handle),
    "radiosity_warning": (i32, _handle, u32, c.POINTER(Warning_)),
    "radiosity_read": (i32, _handle, text, floats, c.c_size_t),
    "radiosity_polygons": (i32, _handle, c.POINTER(u32), c.c_size_t, c.POINTER(u32), c.c_size_t),
    "radiosity_form_factors": (i32, _handle, u32, c.POINTER(f64), c.c_size_t),
    "radiosity_link": (i32, _handle, u64, c.POINTER(RadiosityLink)),
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
        for name, (result, *arguments) in FUNCTIONS.items():
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


def call(name, *arguments):
    """Calls trp_<name>; Error where its status is one. Gives the status."""
    loaded = library()
    status = getattr(loaded, "trp_" + name)(*arguments)
    if status not in (0, CANCELLED):
        raise Error(status, (loaded.trp_error_message() or b"").decode(errors="replace") or f"trp_{name} failed")
    return status


def init(name, structure):
    """A descriptor with the library's defaults."""
    desc = structure()
    call(f"{name}_init", c.byref(desc), c.sizeof(desc))
    return desc
