# SPDX-License-Identifier: GPL-3.0-or-later
"""data.Scene to a binary glTF 2.0 file (.glb) that `triptych` reads without a loss that changes a picture.

Plain glTF (triangles, PBR materials, punctual lights) is for other programs; what the core takes stands beside it in
extras.triptych, by the schema of core/cli/extras_triptych.md. glTF has Y up: (x, y, z) becomes (x, z, −y). Cameras and
lights look down their own −Z in both, so that only the world side of their transforms is turned.
"""

import os
from math import atan, atan2, pi, tan

import numpy as np

from . import data
from .export_texture import exr_bytes
from .glb import Glb, plain
from .gltf_mesh import gltf_mesh

LUMENS_PER_WATT = 683.0  # as Blender's own glTF importer turns candela into W/sr

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
    _Writer(scene).run().write(path)


def _matrix(rows, turn_object):
    """glTF's column-major 16 numbers of a 3 × 4; turn_object: the object's own axes have Z up too."""
    full = np.vstack([np.asarray(rows, np.float64), [0, 0, 0, 1]])
    full = _TURN @ full
    if turn_object:
        full = full @ _TURN.T
    return plain((full + 0.0).T.reshape(-1))


class _Writer:
    def __init__(self, scene):
        self.scene = scene
        self.glb = Glb({"version": "2.0", "generator": "Triptych", "extras": {"triptych": {"version": 1}}})
        self.json = self.glb.json
        self.images = {}
        self.samplers = {}

    def run(self):
        """The Glb of the scene."""
        self.json["textures"] = [self._texture(texture) for texture in self.scene.textures]
        self.json["materials"] = [self._material(material) for material in self.scene.materials]
        self.json["meshes"] = [gltf_mesh(self.glb, mesh, self._uses_colors(mesh)) for mesh in self.scene.meshes]
        self._nodes()
        return self.glb

    def _uses_colors(self, mesh):
        """Whether a material of the mesh reads vertex colours: other programs multiply the base colour by COLOR_0."""
        materials = [self.scene.materials[k] for k in mesh.materials if k != data.NONE]
        return any(node.type == "color" for material in materials for node in material.nodes)

    # -------------------------------------------------------------------------------------------------------- textures

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
                image["bufferView"] = self.glb.view(content)
            else:
                # Not readable: the reader says so too, with this name.
                image["uri"] = os.path.basename(texture.path) or "missing"
            self.images[key] = len(self.images)
            self.json.setdefault("images", []).append(image)
        return self.images[key]

    # ------------------------------------------------------------------------------------------------------- materials

    def _material(self, material):
        extras = {"nodes": [self._program_node(node) for node in material.nodes]}
        for key in data.COEFFICIENTS:
            coefficient = getattr(material, key)
            if coefficient is not None:
                extras[key] = self._coefficient(coefficient)
        if material.normal != data.NONE:
            extras["normal"] = material.normal
        extras.update(thin=material.thin, double_sided=material.double_sided, index=material.index)
        if material.fresnel:
            extras["fresnel"] = True
        if material.priority:
            extras["priority"] = material.priority
        if any(material.absorption):
            extras["absorption"] = plain(material.absorption)
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
                result[key] = plain(numbers)
        if node.texture != data.NONE:
            result["texture"] = node.texture
        if node.name:
            result["name"] = node.name
        return result

    @staticmethod
    def _coefficient(coefficient):
        value = plain(coefficient.value)
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
                "baseColorFactor": plain([*base, alpha]),
                "metallicFactor": int(metal),
                "roughnessFactor": plain(min(roughness, 1.0)),
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
            result["emissiveFactor"] = plain([max(channel, 0) / strength for channel in emission])
            if strength > 1:
                self.glb.extend(result, "KHR_materials_emissive_strength", {"emissiveStrength": plain(strength)})
        if material.transmission.node == data.NONE and max(material.transmission.value) > 0:
            self.glb.extend(
                result,
                "KHR_materials_transmission",
                {"transmissionFactor": plain(min(max(material.transmission.value), 1.0))},
            )
        if material.ior.node == data.NONE and material.ior.value[0] >= 1:
            self.glb.extend(result, "KHR_materials_ior", {"ior": plain(material.ior.value[0])})
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

    # ----------------------------------------------------------------------------------------------------------- nodes

    def _nodes(self):
        scene = self.scene
        nodes = [self._instance(instance) for instance in scene.instances]
        extras = {"film": {"width": scene.film[0], "height": scene.film[1]}, "world": self._world(scene.world)}
        lights = []
        for light in scene.lights:
            nodes.append(self._light(light, lights))
        if lights:
            self.glb.extend(self.json, "KHR_lights_punctual", {"lights": lights})
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
            key: plain(getattr(instance, key))
            for key in ("index", "color", "visible_camera", "visible_shadow", "materials")
            if getattr(instance, key) != getattr(default, key)
        }
        if extras:
            node["extras"] = {"triptych": {"instance": extras}}
        return node

    def _light(self, light, punctual):
        extras = {
            key: plain(getattr(light, key))
            for key in ("type", "emission", "radius", "blend", "size", "shape", "falloff", "cast_shadow")
        }
        extras.update(visible_camera=light.visible_camera, group=light.group)
        if light.angle >= 0:
            extras["angle"] = plain(light.angle)
        node = {
            "name": light.name,
            "matrix": _matrix(light.world_from_light, turn_object=False),
            "extras": {"triptych": {"light": extras}},
        }
        if light.type != "area":  # glTF has no area lights
            brightest = max(light.emission)
            likeness = {
                "name": light.name,
                "type": {"sun": "directional"}.get(light.type, light.type),
                "intensity": plain(brightest * LUMENS_PER_WATT),
                "color": plain([channel / brightest if brightest > 0 else 1.0 for channel in light.emission]),
            }
            if light.type == "spot":
                outer = min(max(light.angle / 2, 1e-3), pi / 2)
                likeness["spot"] = {"innerConeAngle": plain(outer * (1 - light.blend) * 0.999), "outerConeAngle": outer}
            self.glb.extend(node, "KHR_lights_punctual", {"light": len(punctual)})
            punctual.append(likeness)
        return node

    def _camera(self, camera):
        extras = {
            key: plain(getattr(camera, key))
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
                "yfov": plain(vertical),
                "aspectRatio": plain(width / height),
                "znear": plain(camera.clip_start),
                "zfar": plain(camera.clip_end),
            }
        else:
            fitted = camera.width / 2 / (width if horizontal else height)
            result["orthographic"] = {
                "xmag": plain(fitted * width),
                "ymag": plain(fitted * height),
                "znear": plain(camera.clip_start),
                "zfar": plain(camera.clip_end),
            }
        return result

    def _world(self, world):
        extras = {"radiance": plain(world.radiance), "visible_camera": world.visible_camera, "light": world.light}
        if world.texture != data.NONE:
            extras["texture"] = world.texture
            turn = world.world_from_texture
            about_z = abs(turn[2, 2] - 1) < 1e-6
            extras["rotation"] = plain(atan2(turn[1, 0], turn[0, 0]) if about_z else turn[:3, :3].reshape(-1))
        return extras


def _unscaled(rows):
    """A camera's transform without its scale, which the core ignores and glTF's readers may not."""
    result = np.array(rows, np.float64)
    result[:, :3] /= np.linalg.norm(result[:, :3], axis=0).clip(min=1e-30)
    return result
