# SPDX-License-Identifier: GPL-3.0-or-later
"""data.Scene to a binary glTF 2.0 file (.glb) that `triptych` reads without a loss that changes a picture.

Plain glTF (triangles, PBR materials, punctual lights) is for other programs; what the core takes stands beside it in
extras.triptych, by the schema of core/cli/extras_triptych.md. glTF has Y up: (x, y, z) becomes (x, z, −y). Cameras and
lights look down their own −Z in both, so that only the world side of their transforms is turned.
"""

import json
import os
import struct
from math import atan, atan2, pi, tan

import numpy as np

from . import data
from .export_texture import exr_bytes

LUMENS_PER_WATT = 683.0  # as Blender's own glTF importer turns candela into W/sr

_FLOAT, _UINT8, _UINT16, _UINT32 = 5126, 5121, 5123, 5125
_COMPONENT = {"f4": _FLOAT, "u1": _UINT8, "u2": _UINT16, "u4": _UINT32}
_ARRAY_BUFFER, _ELEMENT_BUFFER = 34962, 34963
_MIME = {
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".jpeg": "image/jpeg",
    ".exr": "image/x-exr",
    ".hdr": "image/vnd.radiance",
    ".tif": "image/tiff",
    ".tiff": "image/tiff",
    ".tga": "image/x-tga",
    ".bmp": "image/bmp",
    ".webp": "image/webp",
}
_MAGIC = ((b"\x89PNG", ".png"), (b"\xff\xd8\xff", ".jpg"), (b"\x76\x2f\x31\x01", ".exr"), (b"#?", ".hdr"))
_WRAP = {"repeat": 10497, "clamp": 33071, "mirror": 33648, "black": 33071}

# World axes of glTF from Blender's.
_TURN = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], np.float64)


def write(path, source, view_layer=None):
    """Writes a .glb of a bpy.types.Depsgraph (as evaluated) or a bpy.types.Scene (as F12 would render it).

    The file appears whole or not at all; its folder must exist. Gives the list of warnings: what was left out and why.
    Raises data.ExportError for a scene that cannot be exported, and OSError for a file that cannot be written.
    """
    import bpy

    from .as_rendered import export_as_rendered
    from .export_scene import export_scene

    if isinstance(source, bpy.types.Depsgraph):
        scene = export_scene(source, triangulate=True, require_camera=False)
    else:
        scene = export_as_rendered(source, view_layer, triangulate=True)
    write_scene(path, scene)
    return scene.warnings


def write_scene(path, scene):
    """Writes a data.Scene whose meshes have their triangulation. Adds to scene.warnings what glTF cannot say."""
    content = _Writer(scene).glb()
    temporary = f"{path}.{os.getpid()}.part"
    try:
        with open(temporary, "wb") as file:
            file.write(content)
        os.replace(temporary, path)
    except OSError:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise


def _plain(value):
    """JSON of floats: the shortest text of what the core's float holds."""
    if isinstance(value, (tuple, list, np.ndarray)):
        return [_plain(one) for one in value]
    if isinstance(value, (float, np.floating)):
        short = float(str(np.float32(value)))
        return int(short) if abs(short) < 1e6 and short == int(short) else short
    return value


def _turned(vectors):
    """n × 3 vectors with Y up."""
    result = np.empty_like(vectors)
    result[:, 0], result[:, 1], result[:, 2] = vectors[:, 0], vectors[:, 2], -vectors[:, 1]
    return result + np.float32(0)  # no −0


def _matrix(rows, turn_object):
    """glTF's column-major 16 numbers of a 3 × 4; turn_object: the object's own axes have Z up too."""
    full = np.vstack([np.asarray(rows, np.float64), [0, 0, 0, 1]])
    full = _TURN @ full
    if turn_object:
        full = full @ _TURN.T
    return _plain((full + 0.0).T.reshape(-1))


class _Writer:
    def __init__(self, scene):
        self.scene = scene
        self.binary = bytearray()
        self.json = {
            "asset": {"version": "2.0", "generator": "Triptych", "extras": {"triptych": {"version": 1}}},
            "scene": 0,
            "bufferViews": [],
            "accessors": [],
        }
        self.extensions = set()
        self.images = {}
        self.samplers = {}

    def glb(self):
        """The bytes of the file."""
        self._textures()
        self._materials()
        self._meshes()
        self._nodes()
        if self.extensions:
            self.json["extensionsUsed"] = sorted(self.extensions)
        if self.binary:
            self.json["buffers"] = [{"byteLength": len(self.binary)}]
        content = {key: value for key, value in self.json.items() if value != []}
        text = json.dumps(content, separators=(",", ":"), allow_nan=False, ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.binary)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
        if binary:
            chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
        return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks

    # --------------------------------------------------------------------------------------------------------- buffers

    def _view(self, content, target=None):
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(content)}
        if target:
            view["target"] = target
        self.binary += content
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.json["bufferViews"].append(view)
        return len(self.json["bufferViews"]) - 1

    def _accessor(self, values, target=None, bounds=False):
        """The index of an accessor for n or n × 2..4 numbers; None for None or nothing."""
        if values is None or not len(values):
            return None
        values = np.ascontiguousarray(values)
        kind = "SCALAR" if values.ndim == 1 else {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}[values.shape[1]]
        accessor = {
            "bufferView": self._view(values.tobytes(), target),
            "componentType": _COMPONENT[values.dtype.str[1:]],
            "count": len(values),
            "type": kind,
        }
        if bounds:
            accessor["min"], accessor["max"] = (
                [float(number) for number in np.atleast_1d(pick(axis=0))] for pick in (values.min, values.max)
            )
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    # -------------------------------------------------------------------------------------------------------- textures

    def _textures(self):
        self.json["textures"] = [self._texture(texture) for texture in self.scene.textures]

    def _texture(self, texture):
        sampler = (*(_WRAP[wrap] for wrap in texture.wrap), texture.filter)
        if sampler not in self.samplers:
            self.samplers[sampler] = len(self.samplers)
            nearest = texture.filter == "nearest"
            self.json.setdefault("samplers", []).append(
                {
                    "magFilter": 9728 if nearest else 9729,
                    "minFilter": 9728 if nearest else 9987,
                    "wrapS": sampler[0],
                    "wrapT": sampler[1],
                }
            )
        extras = {"color_space": texture.color_space, "wrap": list(texture.wrap), "filter": texture.filter}
        return {
            "name": texture.name,
            "sampler": self.samplers[sampler],
            "source": self._image(texture),
            "extras": {"triptych": extras},
        }

    def _image(self, texture):
        """The index of the glTF image: the file's bytes, as they are."""
        content, suffix, key = texture.file_data, "", texture.path
        if texture.pixels is not None:
            content, suffix = exr_bytes(texture.pixels), ".exr"
        elif texture.path:
            suffix = os.path.splitext(texture.path)[1].lower()
            try:
                with open(texture.path, "rb") as file:
                    content = file.read()
            except OSError:
                content = b""
        if content:
            key = content
        if key not in self.images:
            image = {"name": texture.name}
            if content:
                suffix = next((found for magic, found in _MAGIC if content.startswith(magic)), suffix)
                image["mimeType"] = _MIME.get(suffix, "application/octet-stream")
                image["bufferView"] = self._view(content)
            else:
                # Not readable: the reader says so too, with this name.
                image["uri"] = os.path.basename(texture.path) or "missing"
            self.images[key] = len(self.images)
            self.json.setdefault("images", []).append(image)
        return self.images[key]

    # ------------------------------------------------------------------------------------------------------- materials

    def _materials(self):
        self.json["materials"] = [self._material(material) for material in self.scene.materials]

    def _material(self, material):
        extras = {"nodes": [self._program_node(node) for node in material.nodes]}
        for key in data.COEFFICIENTS:
            coefficient = getattr(material, key)
            if coefficient is not None:
                extras[key] = self._coefficient(coefficient)
        if material.normal != data.NONE:
            extras["normal"] = material.normal
        extras.update(thin=material.thin, double_sided=material.double_sided, index=material.index)
        result = {"name": material.name, "doubleSided": material.double_sided, "extras": {"triptych": extras}}
        result.update(self._pbr(material))
        return result

    @staticmethod
    def _program_node(node):
        result = {"type": node.type}
        if any(k != data.NONE for k in node.inputs):
            result["inputs"] = list(node.inputs)
        for key, numbers in zip(("value", "value2", "value3"), node.values, strict=True):
            if any(numbers) or node.type in {"normal_map", "uv_transform"}:  # whose defaults are not 0
                result[key] = _plain(numbers)
        if node.texture != data.NONE:
            result["texture"] = node.texture
        if node.name:
            result["name"] = node.name
        return result

    @staticmethod
    def _coefficient(coefficient):
        value = _plain(coefficient.value)
        value = value[0] if len(value) == 1 else value
        return value if coefficient.node == data.NONE else {"value": value, "node": coefficient.node}

    def _pbr(self, material):
        """A likeness for other programs."""
        diffuse, specular = (list(material.diffuse.value), list(material.specular.value))
        alpha = material.alpha.value[0]
        metal = material.diffuse.node == data.NONE and max(diffuse) == 0 and max(specular) > 0
        base = [min(max(channel, 0), 1) for channel in (specular if metal else diffuse)]
        roughness = (2 / (4 * material.shininess.value[0] + 2)) ** 0.25
        if material.shininess.node != data.NONE:
            roughness = 0.5
        result = {
            "pbrMetallicRoughness": {
                "baseColorFactor": _plain([*base, alpha]),
                "metallicFactor": int(metal),
                "roughnessFactor": _plain(min(roughness, 1.0)),
            }
        }
        texture = self._first_image(material, (material.specular if metal else material.diffuse).node)
        if texture != data.NONE:
            result["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
        if material.alpha.node != data.NONE or alpha < 1:
            result["alphaMode"] = "BLEND"
        emission = material.emission.value
        if material.emission.node == data.NONE and max(emission) > 0:
            strength = max(1.0, *emission)
            result["emissiveFactor"] = _plain([max(channel, 0) / strength for channel in emission])
            if strength > 1:
                self._extend(result, "KHR_materials_emissive_strength", {"emissiveStrength": _plain(strength)})
        if material.transmission.node == data.NONE and max(material.transmission.value) > 0:
            self._extend(
                result,
                "KHR_materials_transmission",
                {"transmissionFactor": _plain(min(max(material.transmission.value), 1.0))},
            )
        if material.ior.node == data.NONE and material.ior.value[0] >= 1:
            self._extend(result, "KHR_materials_ior", {"ior": _plain(material.ior.value[0])})
        return result

    @staticmethod
    def _first_image(material, node):
        stack = [node]
        while stack:
            index = stack.pop()
            if index == data.NONE:
                continue
            if material.nodes[index].type == "image":
                return material.nodes[index].texture
            stack.extend(material.nodes[index].inputs)
        return data.NONE

    def _extend(self, item, name, content):
        self.extensions.add(name)
        item.setdefault("extensions", {})[name] = content

    # ---------------------------------------------------------------------------------------------------------- meshes

    def _meshes(self):
        self.json["meshes"] = [self._mesh(mesh) for mesh in self.scene.meshes]

    def _mesh(self, mesh):
        positions = _turned(mesh.positions)
        shared = self._accessor(positions, _ARRAY_BUFFER, bounds=True)
        extras = {"positions": shared}

        def put(key, values):
            accessor = self._accessor(values)
            if accessor is not None:
                extras[key] = accessor

        if len(mesh.corner_vertices):
            put("face_offsets", mesh.face_offsets)
            put("corner_vertices", mesh.corner_vertices)
            if mesh.corner_normals is not None:
                put("corner_normals", _turned(mesh.corner_normals))
            for key, layers in (("uv_sets", mesh.uv_sets), ("colors", mesh.colors)):
                if layers:
                    extras[key] = [
                        {"name": layer.name, "accessor": self._accessor(layer.values), "domain": layer.domain}
                        for layer in layers
                    ]
            if mesh.face_materials is not None:
                small = mesh.face_materials.max() < 65536
                put("face_materials", mesh.face_materials.astype(np.uint16 if small else np.uint32))
            put("face_smooth", mesh.face_smooth)
        if mesh.materials:
            extras["materials"] = list(mesh.materials)
        if mesh.edges is not None:
            put("edges", mesh.edges.reshape(-1))
        put("edge_flags", mesh.edge_flags)
        put("edge_creases", mesh.edge_creases)
        put("vertex_creases", mesh.vertex_creases)
        if len(mesh.corner_vertices):
            primitives = self._primitives(mesh, positions)
        else:
            lines = self._accessor(mesh.edges.reshape(-1), _ELEMENT_BUFFER)
            primitives = [{"attributes": {"POSITION": shared}, "indices": lines, "mode": 1}]
        return {"name": mesh.name, "primitives": primitives, "extras": {"triptych": extras}}

    def _primitives(self, mesh, positions):
        """One primitive of triangles to each slot in use, all on the same vertices."""
        triangulation = mesh.triangulation
        columns = {"POSITION": positions[mesh.corner_vertices], "NORMAL": _turned(triangulation.normals)}
        if mesh.uv_sets:
            columns["TEXCOORD_0"] = mesh.uv_sets[0].values * np.float32([1, -1]) + np.float32([0, 1])
        if mesh.colors and self._uses_colors(mesh):
            layer = mesh.colors[0]
            columns["COLOR_0"] = layer.values[mesh.corner_vertices] if layer.domain == "vertex" else layer.values
        # Corners that are alike in everything become one vertex.
        table = np.hstack([mesh.corner_vertices.view(np.float32)[:, None], *list(columns.values())[1:]])
        rows = np.ascontiguousarray(table).view(np.dtype((np.void, table.shape[1] * 4))).reshape(-1)
        _, first, vertex = np.unique(rows, return_index=True, return_inverse=True)
        attributes = {
            name: self._accessor(values[first], _ARRAY_BUFFER, bounds=name == "POSITION")
            for name, values in columns.items()
        }
        triangles = vertex.reshape(-1).astype(np.uint32)[triangulation.corners]
        slots = np.zeros(len(triangles), np.uint32)
        if mesh.face_materials is not None:
            slots = mesh.face_materials[triangulation.faces]
        primitives = []
        for slot in np.unique(slots):
            indices = self._accessor(triangles[slots == slot].reshape(-1), _ELEMENT_BUFFER)
            primitive = {"attributes": attributes, "indices": indices}
            if slot < len(mesh.materials) and mesh.materials[slot] != data.NONE:
                primitive["material"] = mesh.materials[slot]
            primitives.append(primitive)
        return primitives

    def _uses_colors(self, mesh):
        """Whether a material of the mesh reads vertex colours: other programs multiply the base colour by COLOR_0."""
        materials = [self.scene.materials[k] for k in mesh.materials if k != data.NONE]
        return any(node.type == "color" for material in materials for node in material.nodes)

    # ----------------------------------------------------------------------------------------------------------- nodes

    def _nodes(self):
        scene = self.scene
        nodes = [self._instance(instance) for instance in scene.instances]
        extras = {"film": {"width": scene.film[0], "height": scene.film[1]}, "world": self._world(scene.world)}
        lights = []
        for light in scene.lights:
            nodes.append(self._light(light, lights))
        if lights:
            self.extensions.add("KHR_lights_punctual")
            self.json["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
        self.json["cameras"] = [self._camera(camera) for camera in scene.cameras]
        for number, camera in enumerate(scene.cameras):
            if number == scene.camera:
                extras["camera"] = len(nodes)
            matrix = _matrix(_unscaled(camera.world_from_camera), turn_object=False)
            nodes.append({"name": camera.name, "camera": number, "matrix": matrix})
        # The count of threads is a matter of the machine.
        settings = {name: value for name, value in scene.settings.items() if name != "threads"}
        if settings:
            extras["settings"] = settings
        self.json["nodes"] = nodes
        root = {"name": scene.name, "extras": {"triptych": extras}}
        if nodes:
            root["nodes"] = list(range(len(nodes)))
        self.json["scenes"] = [root]

    def _instance(self, instance):
        node = {
            "name": instance.name,
            "mesh": instance.mesh,
            "matrix": _matrix(instance.world_from_object, turn_object=True),
        }
        default = data.Instance("", 0, None)
        extras = {
            key: _plain(getattr(instance, key))
            for key in ("index", "color", "visible_camera", "visible_shadow", "materials")
            if getattr(instance, key) != getattr(default, key)
        }
        if extras:
            node["extras"] = {"triptych": {"instance": extras}}
        return node

    def _light(self, light, punctual):
        extras = {
            key: _plain(getattr(light, key))
            for key in ("type", "emission", "radius", "blend", "size", "shape", "falloff", "cast_shadow")
        }
        extras.update(visible_camera=light.visible_camera, group=light.group)
        if light.angle >= 0:
            extras["angle"] = _plain(light.angle)
        node = {
            "name": light.name,
            "matrix": _matrix(light.world_from_light, turn_object=False),
            "extras": {"triptych": {"light": extras}},
        }
        if light.type != "area":  # glTF has no area lights
            brightest = max(light.emission)
            plain = {
                "name": light.name,
                "type": {"sun": "directional"}.get(light.type, light.type),
                "intensity": _plain(brightest * LUMENS_PER_WATT),
                "color": _plain([channel / brightest if brightest > 0 else 1.0 for channel in light.emission]),
            }
            if light.type == "spot":
                outer = min(max(light.angle / 2, 1e-3), pi / 2)
                plain["spot"] = {"innerConeAngle": _plain(outer * (1 - light.blend) * 0.999), "outerConeAngle": outer}
            node["extensions"] = {"KHR_lights_punctual": {"light": len(punctual)}}
            punctual.append(plain)
        return node

    def _camera(self, camera):
        extras = {
            key: _plain(getattr(camera, key))
            for key in (
                *("fit", "field_of_view", "width", "shift", "clip_start", "clip_end", "aperture_radius"),
                *("focus_distance", "blade_count", "blade_rotation", "shutter", "pixel_aspect"),
            )
        }
        width, height = self.scene.film[0] * camera.pixel_aspect, self.scene.film[1]
        horizontal = camera.fit == "horizontal" or (camera.fit == "auto" and width >= height)
        result = {"name": camera.name, "type": camera.type, "extras": {"triptych": extras}}
        if camera.type == "perspective":
            vertical = camera.field_of_view
            if horizontal:
                vertical = 2 * atan(tan(vertical / 2) * height / width)
            result["perspective"] = {
                "yfov": _plain(vertical),
                "aspectRatio": _plain(width / height),
                "znear": _plain(camera.clip_start),
                "zfar": _plain(camera.clip_end),
            }
        else:
            fitted = camera.width / 2 / (width if horizontal else height)
            result["orthographic"] = {
                "xmag": _plain(fitted * width),
                "ymag": _plain(fitted * height),
                "znear": _plain(camera.clip_start),
                "zfar": _plain(camera.clip_end),
            }
        return result

    def _world(self, world):
        extras = {"radiance": _plain(world.radiance), "visible_camera": world.visible_camera, "light": world.light}
        if world.texture != data.NONE:
            extras["texture"] = world.texture
            turn = world.world_from_texture
            if abs(turn[2, 2] - 1) > 1e-6:
                self.scene.warn("world: it is turned about X or Y, which a .glb cannot say; only Z is written")
            extras["rotation"] = _plain(atan2(turn[1, 0], turn[0, 0]))
        return extras


def _unscaled(rows):
    """A camera's transform without its scale, which the core ignores and glTF's readers may not."""
    result = np.array(rows, np.float64)
    result[:, :3] /= np.linalg.norm(result[:, :3], axis=0).clip(min=1e-30)
    return result
