# SPDX-License-Identifier: GPL-3.0-or-later
"""The library as Python objects: its tables, scenes and renders.

    with core.Scene() as scene:
        scene.fill(data_scene)          # a data.Scene
        scene.commit()
        with core.Render(scene, "ray_casting") as render:
            render.set("samples", "16")
            render.run(progress=..., tile=...)
            pixels = render.read("Combined", 0, 0, 960, 540)

What abi.py raises passes through: LibraryMissing where there is no library, Error where a call fails.
"""

import ctypes as c
import os

import numpy as np

from . import abi, data

# --------------------------------------------------------------------------------------------------------------- tables


def _table(name, structure):
    rows = []
    for index in range(getattr(abi.library(), f"trp_{name}_count")()):
        row = structure(struct_size=c.sizeof(structure))
        abi.call(f"{name}_info", index, c.byref(row))
        rows.append(row)
    return rows


def _words(value):
    return (value or b"").decode()


def methods():
    """[(name, label, description), …]"""
    return [(_words(row.name), _words(row.label), _words(row.description)) for row in _table("method", abi.MethodInfo)]


class Setting:
    """A row of the settings' table: name, type (of abi.SETTING_TYPES), label, description, unit, default (text),
    minimum, maximum, choices, methods (a set of names; {"*"}: all), method_defaults ({method: text} where it is not
    the default)."""

    def __init__(self, row):
        self.type = abi.SETTING_TYPES[row.type]
        for name in ("name", "label", "description", "unit"):
            setattr(self, name, _words(getattr(row, name)))
        self.default = _words(row.default_value)
        self.minimum, self.maximum = row.minimum, row.maximum
        self.methods = set(_words(row.methods).split())
        self.method_defaults = dict(word.split("=", 1) for word in _words(row.method_defaults).split())
        self.choices = []
        while row.choices and row.choices[len(self.choices)]:
            self.choices.append(_words(row.choices[len(self.choices)]))

    def used_by(self, method):
        return method in self.methods or "*" in self.methods

    def default_for(self, method):
        return self.method_defaults.get(method, self.default)


def settings():
    """The table of settings, in the library's order."""
    return [Setting(row) for row in _table("setting", abi.SettingInfo)]


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
    return [Pass(row) for row in _table("pass", abi.PassInfo)]


def node_types():
    """{name: TRP_NODE_… value}"""
    return {_words(row.name): row.type for row in _table("node", abi.NodeInfo)}


# ---------------------------------------------------------------------------------------------------------------- scene


def _array(values):
    """An abi.Array on numpy's memory, which must outlive the call; n or n × k numbers. None: not given."""
    if values is None:
        return abi.Array()
    if not len(values):
        return abi.Array(None, 0, 0, abi.FORMAT[values.dtype.str[1:]])
    if not values.flags.c_contiguous:
        raise ValueError("the core takes packed arrays")
    return abi.Array(values.ctypes.data, len(values), values.strides[0], abi.FORMAT[values.dtype.str[1:]])


def _floats(values):
    return values.ctypes.data_as(abi.floats)


def _matrix(rows):
    return np.ascontiguousarray(rows, np.float32).reshape(-1)


def _ids(values):
    return (abi.u32 * len(values))(*values)


def _warnings(kind, handle):
    lines = []
    for index in range(getattr(abi.library(), f"trp_{kind}_warning_count")(handle)):
        warning = abi.Warning_(struct_size=c.sizeof(abi.Warning_))
        abi.call(f"{kind}_warning", handle, index, c.byref(warning))
        lines.append(warning.text.decode(errors="replace"))
    return lines


class Scene:
    """A scene of the core. Use it as a context manager."""

    def __init__(self):
        self._handle = c.c_void_p()
        abi.call("scene_create", c.byref(self._handle))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._handle:
            abi.library().trp_scene_destroy(self._handle)
            self._handle = c.c_void_p()

    def fill(self, scene):
        """Adds everything of a data.Scene, whose references are places in its lists. Error names the item.

        Gives the ids of its instances.
        """
        textures = [self.add_texture(texture) for texture in scene.textures]
        materials = [self.add_material(material, textures) for material in scene.materials]
        meshes = [self.add_mesh(mesh, materials) for mesh in scene.meshes]
        instances = [self.add_instance(instance, meshes, materials) for instance in scene.instances]
        for light in scene.lights:
            self.add_light(light)
        self.set_world(scene.world, textures)
        cameras = [self.add_camera(camera) for camera in scene.cameras]
        abi.call("scene_set_camera", self._handle, abi.NO_ID if scene.camera == data.NONE else cameras[scene.camera])
        return instances

    def commit(self, threads=0):
        """Makes the snapshot that renders see."""
        abi.call("scene_commit", self._handle, threads)

    def info(self):
        """abi.SceneInfo of the last commit."""
        info = abi.SceneInfo(struct_size=c.sizeof(abi.SceneInfo))
        abi.call("scene_info", self._handle, c.byref(info))
        return info

    def warnings(self):
        """The lines of the last commit."""
        return _warnings("scene", self._handle)

    def _add(self, kind, desc):
        number = abi.u32()
        abi.call(f"{kind}_add", self._handle, c.byref(desc), c.byref(number))
        return number.value

    def add_mesh(self, mesh, materials):
        desc = abi.init("mesh_desc", abi.MeshDesc)
        desc.name = mesh.name.encode()
        desc.positions = _array(mesh.positions.reshape(-1, 3))
        desc.time_count = len(mesh.positions) if mesh.positions.ndim == 3 else 1
        desc.corner_vertices = _array(mesh.corner_vertices)
        if len(mesh.corner_vertices):
            desc.face_offsets = _array(mesh.face_offsets)
            desc.normals = _array(mesh.corner_normals)
            desc.normal_domain = abi.DOMAIN["corner"]
        uv_sets, colors = _attributes(mesh.uv_sets), _attributes(mesh.colors)
        desc.uv_sets, desc.uv_set_count = uv_sets, len(mesh.uv_sets)
        desc.colors, desc.color_count = colors, len(mesh.colors)
        desc.materials, desc.material_count = _ids(_named(mesh.materials, materials)), len(mesh.materials)
        for name in ("face_materials", "face_smooth", "edges", "edge_flags", "edge_creases", "vertex_creases"):
            setattr(desc, name, _array(getattr(mesh, name)))
        return self._add("mesh", desc)

    def add_instance(self, instance, meshes, materials):
        desc = abi.init("instance_desc", abi.InstanceDesc)
        desc.name, desc.mesh = instance.name.encode(), meshes[instance.mesh]
        matrix = _matrix(instance.world_from_object)
        desc.world_from_object, desc.time_count = _floats(matrix), len(matrix) // 12
        desc.materials, desc.material_count = _ids(_named(instance.materials, materials)), len(instance.materials)
        desc.color[:] = instance.color
        desc.index = instance.index
        desc.visible_camera, desc.visible_shadow = instance.visible_camera, instance.visible_shadow
        return self._add("instance", desc)

    def add_texture(self, texture):
        desc = abi.init("texture_desc", abi.TextureDesc)
        desc.name = texture.name.encode()
        desc.color_space = abi.COLOR_SPACE[texture.color_space]
        desc.wrap_u, desc.wrap_v = (abi.WRAP[wrap] for wrap in texture.wrap)
        desc.filter = abi.FILTER[texture.filter]
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
        desc = abi.init("material_desc", abi.MaterialDesc)
        desc.name = material.name.encode()
        nodes = (abi.Node * len(material.nodes))()
        types = node_types() if material.nodes else {}
        for node, source in zip(nodes, material.nodes, strict=True):
            abi.call("node_init", c.byref(node), types[source.type])
            node.inputs[:] = source.inputs
            node.value[:], node.value2[:], node.value3[:] = source.values
            node.texture = abi.NO_ID if source.texture == data.NONE else textures[source.texture]
            node.name = source.name.encode()
        desc.nodes, desc.node_count = nodes, len(nodes)
        for name in data.COEFFICIENTS:
            source = getattr(material, name)
            if source is not None:
                value = tuple(source.value) + (0.0,) * (3 - len(source.value))
                setattr(desc, name, abi.Coefficient((abi.f32 * 3)(*value), source.node))
        desc.ambient_is_diffuse = material.ambient is None
        desc.mirror_is_specular = material.mirror is None
        desc.normal, desc.thin, desc.double_sided = material.normal, material.thin, material.double_sided
        desc.index, desc.fresnel, desc.priority = material.index, material.fresnel, material.priority
        desc.absorption[:] = material.absorption
        return self._add("material", desc)

    def add_light(self, light):
        desc = abi.init("light_desc", abi.LightDesc)
        desc.name, desc.type = light.name.encode(), abi.LIGHT[light.type]
        matrix = _matrix(light.world_from_light)
        desc.world_from_light, desc.time_count = _floats(matrix), len(matrix) // 12
        desc.falloff, desc.shape = abi.FALLOFF[light.falloff], abi.SHAPE[light.shape]
        desc.emission[:], desc.size[:] = light.emission, light.size
        for name in ("radius", "angle", "blend", "cast_shadow", "visible_camera", "group"):
            setattr(desc, name, getattr(light, name))
        return self._add("light", desc)

    def set_world(self, world, textures):
        desc = abi.init("world_desc", abi.WorldDesc)
        desc.texture = abi.NO_ID if world.texture == data.NONE else textures[world.texture]
        desc.radiance[:] = world.radiance
        matrix = _matrix(world.world_from_texture)
        desc.world_from_texture = _floats(matrix)
        desc.visible_camera, desc.light = world.visible_camera, world.light
        abi.call("scene_set_world", self._handle, c.byref(desc))

    def add_camera(self, camera):
        desc = abi.init("camera_desc", abi.CameraDesc)
        desc.name, desc.type, desc.fit = camera.name.encode(), abi.CAMERA[camera.type], abi.FIT[camera.fit]
        matrix = _matrix(camera.world_from_camera)
        desc.world_from_camera, desc.time_count = _floats(matrix), len(matrix) // 12
        desc.shift[:], desc.shutter[:] = camera.shift, camera.shutter
        for name in (
            *("field_of_view", "width", "clip_start", "clip_end", "aperture_radius", "focus_distance"),
            *("blade_count", "blade_rotation", "pixel_aspect"),
        ):
            setattr(desc, name, getattr(camera, name))
        return self._add("camera", desc)


def _attributes(layers):
    result = (abi.Attribute * len(layers))()
    for attribute, layer in zip(result, layers, strict=True):
        attribute.name, attribute.values = layer.name.encode(), _array(layer.values)
        attribute.domain, attribute.components = abi.DOMAIN[layer.domain], layer.values.shape[1]
    return result


def _named(places, ids):
    return [abi.NO_ID if place == data.NONE else ids[place] for place in places]


# ------------------------------------------------------------------------------------------------------- calls that run


def _run(name, *arguments, progress=None, tile=None, log=None):
    """A call that takes callbacks; False where it was cancelled. See Render.run."""
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

    callbacks = abi.init("callbacks", abi.Callbacks)
    if progress is not None:
        callbacks.progress = abi.ProgressFunction(guarded(progress, lambda pointer: pointer.contents))
    if tile is not None:
        callbacks.tile = abi.TileFunction(guarded(tile, lambda pointer: pointer.contents))
    if log is not None:
        callbacks.log = abi.LogFunction(guarded(log, lambda line: line.decode(errors="replace")))
    status = abi.call(name, *arguments, c.byref(callbacks))
    if raised:
        raise raised[0]
    return status != abi.CANCELLED


# ------------------------------------------------------------------------------------------------------------ radiosity

_SCALARS = {"area", "instance", "face"}  # values of one number; others have three


class Radiosity:
    """A radiosity solution of a scene's last commit, which it outlives. Close it."""

    def __init__(self, scene):
        self._handle = c.c_void_p()
        abi.call("radiosity_create", scene._handle, c.byref(self._handle))

    def close(self):
        if self._handle:
            abi.library().trp_radiosity_destroy(self._handle)
            self._handle = c.c_void_p()

    def set(self, name, value):
        """A setting, as text; before the first step."""
        abi.call("radiosity_set", self._handle, name.encode(), value.encode())

    def prepare(self, progress=None):
        """Makes the elements, without a step; see solve()."""
        return _run("radiosity_prepare", self._handle, progress=progress)

    def step(self, count, progress=None):
        """Goes on by so many steps, or until it is solved; see solve()."""
        return _run("radiosity_step", self._handle, count, progress=progress)

    def solve(self, progress=None):
        """Goes on until it is solved; False where it was cancelled, which leaves what was done. See Render.run."""
        return _run("radiosity_solve", self._handle, progress=progress)

    def info(self):
        """abi.RadiosityInfo of what was done so far."""
        info = abi.RadiosityInfo(struct_size=c.sizeof(abi.RadiosityInfo))
        abi.call("radiosity_info", self._handle, c.byref(info))
        return info

    def warnings(self):
        """The lines of its making."""
        return _warnings("radiosity", self._handle)

    def read(self, name):
        """Values of all elements or vertices, as triptych.h names them: n × 3 or n float32."""
        info = self.info()
        count = info.vertex_count if name.startswith("vertex_") else info.element_count
        values = np.empty((count, 3) if name not in _SCALARS else count, np.float32)
        abi.call("radiosity_read", self._handle, name.encode(), _floats(values), values.size)
        return values

    def polygons(self):
        """(elements + 1 offsets, vertices) of the elements' polygons, uint32."""
        info = self.info()
        offsets, vertices = np.empty(info.element_count + 1, np.uint32), np.empty(info.corner_count, np.uint32)
        abi.call(
            "radiosity_polygons",
            self._handle,
            *(offsets.ctypes.data_as(c.POINTER(abi.u32)), offsets.size),
            *(vertices.ctypes.data_as(c.POINTER(abi.u32)), vertices.size),
        )
        return offsets, vertices

    def form_factors(self, element):
        """The row of an element: n float64."""
        row = np.empty(self.info().element_count)
        pointer = row.ctypes.data_as(c.POINTER(abi.f64))
        abi.call("radiosity_form_factors", self._handle, element, pointer, row.size)
        return row

    def links(self):
        """All links, as an array with the fields of TrpRadiosityLink; abi.NO_ELEMENT as there."""
        links = (abi.RadiosityLink * self.info().links)()
        function, size = abi.library().trp_radiosity_link, c.sizeof(abi.RadiosityLink)
        for index, link in enumerate(links):  # as abi.call, which takes twice the time
            link.struct_size = size
            if function(self._handle, index, link):
                abi.call("radiosity_link", self._handle, index, link)
        return np.frombuffer(links, abi.RadiosityLink) if len(links) else np.empty(0, abi.RadiosityLink)


# --------------------------------------------------------------------------------------------------------------- render


class Ray:
    """A ray of a pixel's tree, in world space.

    kind (of abi.RAY_KINDS), end (of abi.RAY_ENDS), parent (its place in the list, or data.NONE), origin, direction.
    Where it ends at a surface: mesh and material (names), instance (an id), position, normal; there and at a light:
    distance (metres). intensity (W/(m² sr)) is local + Σ weight · intensity of its children.
    """

    def __init__(self, row):
        self.kind, self.end = abi.RAY_KINDS[row.kind], abi.RAY_ENDS[row.end]
        self.parent = data.NONE if row.parent == abi.NO_PARENT else row.parent
        self.mesh, self.material, self.instance = _words(row.object), _words(row.material), row.instance
        self.distance = row.distance
        for name in ("origin", "direction", "position", "normal", "local", "weight", "intensity"):
            setattr(self, name, tuple(getattr(row, name)))


class Render:
    """A render of a scene's last commit by a method. Use it as a context manager."""

    def __init__(self, scene, method):
        self._handle = c.c_void_p()
        abi.call("render_create", scene._handle, method.encode(), c.byref(self._handle))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._handle:
            abi.library().trp_render_destroy(self._handle)
            self._handle = c.c_void_p()

    def set_film(self, width, height, window=(0, 0, 0, 0)):
        """The picture's size, and the window (x, y, width, height) of it that is rendered, from the bottom left."""
        abi.call("render_set_film", self._handle, width, height, *window)

    def set(self, name, value):
        """A setting, as text."""
        abi.call("render_set", self._handle, name.encode(), value.encode())

    def add_pass(self, name):
        abi.call("render_add_pass", self._handle, name.encode())

    def run(self, progress=None, tile=None, log=None):
        """Renders; False where it was cancelled.

        progress(abi.Progress), tile(abi.Tile) and log(str) are called on this thread; a false answer cancels. What a
        callback raises cancels the render and is raised from here.
        """
        return _run("render_run", self._handle, progress=progress, tile=tile, log=log)

    def show(self, radiosity):
        """Has it show a Radiosity as it is now. Error STATE where that is of another scene, or has not been begun."""
        abi.call("render_set_radiosity", self._handle, radiosity._handle)

    def cancel(self):
        """Any thread."""
        abi.call("render_cancel", self._handle)

    def read(self, name, x, y, width, height, channels=4):
        """A rectangle of a pass: height × width × channels float32, row 0 at the bottom."""
        pixels = np.empty((height, width, channels), np.float32)
        abi.call("render_read", self._handle, name.encode(), x, y, width, height, _floats(pixels), pixels.size)
        return pixels

    def write(self, path):
        """Writes .exr or .png."""
        abi.call("render_write", self._handle, os.fsencode(path))

    def trace_tree(self, x, y, most):
        """[Ray] of the tree of a pixel, from the bottom left, parents before children. Error for more than `most`."""
        count = abi.u32()
        abi.call("render_trace_tree", self._handle, x, y, c.byref(count))
        if count.value > most:
            raise abi.Error(
                abi.STATUS.index("MEMORY"),
                f"the tree has {count.value} rays, of which at most {most} can be shown; "
                "a lower Depth or a greater Least weight makes it smaller",
            )
        row, rays = abi.Ray(struct_size=c.sizeof(abi.Ray)), []
        for index in range(count.value):
            abi.call("render_ray", self._handle, index, c.byref(row))
            rays.append(Ray(row))
        return rays

    def statistics(self):
        """abi.Statistics of the last run."""
        statistics = abi.Statistics(struct_size=c.sizeof(abi.Statistics))
        abi.call("render_statistics", self._handle, c.byref(statistics))
        return statistics
