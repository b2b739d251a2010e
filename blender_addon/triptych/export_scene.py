# SPDX-License-Identifier: GPL-3.0-or-later
"""A depsgraph to data.Scene: what renders, each mesh and material once, instances sharing them."""

from . import data, properties, settings
from .export_camera import export_camera
from .export_light import export_light
from .export_material import export_material
from .export_mesh import export_mesh
from .export_motion import Motion, may_bend
from .export_texture import Textures
from .export_world import export_world
from .generated import is_generated
from .transforms import rows


def export_scene(depsgraph, triangulate=False, require_camera=True, shutter=None):
    """The data.Scene of an evaluated depsgraph.

    triangulate: see export_mesh. shutter: an export_motion.Shutter, for motion blur. ExportError where there is no
    usable camera and one is required.
    """
    exporter = _Exporter(depsgraph, triangulate)
    scene = exporter.run(require_camera)
    if shutter is not None:
        exporter.add_motion(shutter)
    return scene


def film_size(render):
    """(width, height) in pixels of the whole picture, border or not."""
    percent = render.resolution_percentage
    return max(render.resolution_x * percent // 100, 1), max(render.resolution_y * percent // 100, 1)


_LAMPS_ALONE = "light groups are of lamps; what else gives light is in none"
_CAMERA = "camera"  # its key among the places of what is shown


class _Exporter:
    def __init__(self, depsgraph, triangulate):
        self.depsgraph = depsgraph
        self.triangulate = triangulate
        self.scene = data.Scene(name=depsgraph.scene.name)
        self.textures = Textures(self.scene)
        self.meshes = {}
        self.materials = {}
        self.places = {}  # as Motion takes them
        self.bending = {}
        self.camera = None
        self.groups = properties.light_groups(depsgraph.view_layer)

    def run(self, require_camera):
        source, result = self.depsgraph.scene, self.scene
        result.film = film_size(source.render)
        self._camera(source, require_camera)
        result.settings = settings.changed(source)
        result.world = export_world(source.world, self.textures, result.warn)
        for key, instance, shown in self._shown():
            if shown.type == "MESH":
                self._instance(key, instance, shown)
            elif shown.type == "LIGHT":
                group = self.groups.get(shown.lightgroup, 0)
                light = export_light(shown, instance.matrix_world.copy(), self.textures, result.warn, group)
                result.lights.append(light)
                self.places[key] = light, "world_from_light"
            elif shown.type in {"VOLUME", "CURVES", "POINTCLOUD", "GPENCIL", "GREASEPENCIL"}:
                result.warn(f"object '{shown.name}': {shown.type.lower()} objects are not supported; it is left out")
        self._warn_of_groups(source.world)
        return result

    def _warn_of_groups(self, world):
        if world is not None and world.lightgroup in self.groups and any(self.scene.world.radiance):
            self.scene.warn(f"world '{world.name}': {_LAMPS_ALONE}")
        for name, number in self.groups.items():
            if number > properties.LIGHT_GROUPS:
                self.scene.warn(f"light group '{name}' has no pass: there are {properties.LIGHT_GROUPS}")

    def _shown(self):
        """What the depsgraph shows: (a key that is the same at every time, instance, evaluated object)."""
        for instance in self.depsgraph.object_instances:
            shown = instance.object
            if not instance.show_self or is_generated(shown.original):
                continue
            if self.depsgraph.mode != "RENDER" and shown.original.hide_render:
                continue
            parent = instance.parent.original.as_pointer() if instance.parent else 0
            yield (shown.original.as_pointer(), parent, *instance.persistent_id), instance, shown

    def add_motion(self, shutter):
        """Goes through the shutter's times, and back."""
        motion = Motion(self.places, self.bending)
        try:
            for time in shutter.times:
                shutter.go_to(time)
                motion.begin_time()
                for key, instance, shown in self._shown():
                    motion.note(key, instance.matrix_world, shown.data if key in self.bending else None)
                if self.scene.cameras:
                    # The frame's own: a marker may bind another one to a time within the shutter.
                    motion.note(_CAMERA, self.camera.evaluated_get(self.depsgraph).matrix_world)
        finally:
            shutter.go_to(shutter.now)
        motion.finish(len(shutter.times), self.scene.warn)

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
        self.camera = camera.original
        self.places[_CAMERA] = self.scene.cameras[0], "world_from_camera"

    def _instance(self, key, instance, shown):
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
        if shown.lightgroup in self.groups:
            shown_materials = [*self.scene.meshes[mesh].materials, *result.materials]
            if any(k != data.NONE and any(self.scene.materials[k].emission.value) for k in shown_materials):
                self.scene.warn(f"object '{shown.name}': {_LAMPS_ALONE}")
        self.scene.instances.append(result)
        self.places[key] = result, "world_from_object"
        if may_bend(shown):
            self.bending[key] = self.scene.meshes[mesh]

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
