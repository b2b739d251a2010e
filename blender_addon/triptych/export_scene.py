# SPDX-License-Identifier: GPL-3.0-or-later
"""A depsgraph to data.Scene: what renders, each mesh and material once, instances sharing them."""

from . import data, settings
from .export_camera import export_camera
from .export_light import export_light
from .export_material import export_material
from .export_mesh import export_mesh
from .export_texture import Textures
from .export_world import export_world
from .transforms import rows


def export_scene(depsgraph, triangulate=False, require_camera=True):
    """The data.Scene of an evaluated depsgraph.

    triangulate: see export_mesh. ExportError where there is no usable camera and one is required.
    """
    return _Exporter(depsgraph, triangulate).run(require_camera)


def film_size(render):
    """(width, height) in pixels of the whole picture, border or not."""
    percent = render.resolution_percentage
    return max(render.resolution_x * percent // 100, 1), max(render.resolution_y * percent // 100, 1)


class _Exporter:
    def __init__(self, depsgraph, triangulate):
        self.depsgraph = depsgraph
        self.triangulate = triangulate
        self.scene = data.Scene(name=depsgraph.scene.name)
        self.textures = Textures(self.scene)
        self.meshes = {}
        self.materials = {}
        self.groups = {"": 0}
        for number, group in enumerate(getattr(depsgraph.view_layer, "lightgroups", ()), 1):
            self.groups[group.name] = number

    def run(self, require_camera):
        source, result = self.depsgraph.scene, self.scene
        result.film = film_size(source.render)
        self._camera(source, require_camera)
        result.settings = settings.changed(source)
        result.world = export_world(source.world, self.textures, result.warn)
        for instance in self.depsgraph.object_instances:
            shown = instance.object
            if not instance.show_self or (self.depsgraph.mode != "RENDER" and shown.original.hide_render):
                continue
            if shown.type == "MESH":
                self._instance(instance, shown)
            elif shown.type == "LIGHT":
                group = self.groups.get(getattr(shown, "lightgroup", ""), 0)
                result.lights.append(
                    export_light(shown, instance.matrix_world.copy(), self.textures, result.warn, group)
                )
            elif shown.type in {"VOLUME", "CURVES", "POINTCLOUD", "GPENCIL", "GREASEPENCIL"}:
                result.warn(f"object '{shown.name}': {shown.type.lower()} objects are not supported; it is left out")
        return result

    def _camera(self, source, required):
        camera = source.camera
        if camera is None:
            if required:
                raise data.ExportError(f"scene '{source.name}': there is no camera")
            return
        try:
            # The depsgraph's own copy has drivers and constraints applied.
            self.scene.cameras.append(export_camera(camera.evaluated_get(self.depsgraph), source))
        except data.ExportError as error:
            if required:
                raise
            self.scene.warn(str(error))
            return
        self.scene.camera = 0

    def _instance(self, instance, shown):
        mesh = self._mesh(shown.data)
        if mesh is None:
            return
        own = [slot.material if slot.link == "OBJECT" else None for slot in shown.material_slots]
        result = data.Instance(
            name=shown.name,
            mesh=mesh,
            world_from_object=rows(instance.matrix_world),
            color=tuple(shown.color[:3]),
            index=shown.pass_index,
            visible_camera=shown.visible_camera,
            visible_shadow=shown.visible_shadow,
        )
        if any(own):
            result.materials = [self._material(material) for material in own]
        self.scene.instances.append(result)

    def _mesh(self, mesh):
        """The index of an evaluated mesh, which objects may share; None where it has nothing to draw."""
        key = mesh.as_pointer()
        if key not in self.meshes:
            exported = export_mesh(mesh, self.triangulate)
            if exported is None:
                self.meshes[key] = None
            else:
                exported.materials = [self._material(material) for material in mesh.materials]
                _clamp_slots(exported)
                self.meshes[key] = len(self.scene.meshes)
                self.scene.meshes.append(exported)
        return self.meshes[key]

    def _material(self, material):
        if material is None:
            return data.NONE
        key = material.as_pointer()
        if key not in self.materials:
            self.materials[key] = len(self.scene.materials)
            self.scene.materials.append(export_material(material, self.textures, self.scene.warn))
        return self.materials[key]


def _clamp_slots(mesh):
    """Faces of a slot that was deleted take the last one, as Blender shows them."""
    if mesh.face_materials is not None:
        last = max(len(mesh.materials) - 1, 0)
        mesh.face_materials = mesh.face_materials.clip(max=last) if last else None
