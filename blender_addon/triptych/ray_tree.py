# SPDX-License-Identifier: GPL-3.0-or-later
"""The ray tree of a pixel: traced by the library, drawn as curves in the scene, and put into the panel's list.

Curves, their collection and materials carry the custom property MARK, and only what carries it is ever replaced or
removed.
"""

from dataclasses import dataclass
from math import dist, floor

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d

from . import abi, core, data
from .as_rendered import export_to_render, no_render_runs
from .engine import window
from .export_scene import film_size

NAME = "Ray Tree"
MARK = "triptych_ray_tree"
MOST_RAYS = 10000
# By kind: yellow, vermillion and sky blue, which the colour-blind tell apart (Okabe and Ito, "Color Universal Design",
# 2008), linear and as bright as they get, since solid shading darkens them.
COLORS = {"primary": (1.0, 0.88, 0.06), "reflection": (1.0, 0.17, 0.0), "transmission": (0.11, 0.56, 1.0)}
_THICKNESS = 0.001  # a curve's radius; of the tree's size
_STUB = 0.05  # the length of a ray that is not traced; of the tree's size
_CHOSEN = 2.5  # how much thicker the ray is that is chosen in the list


@dataclass
class Tree:
    """The rays of a pixel in the order of the list: each, then the branches of its reflection and transmission."""

    rays: list  # of core.Ray
    levels: list  # how deep each is; 0: the primary ray
    objects: list  # name of the object at which each ends, or ""
    size: float  # metres: of the scene or of what the rays cross, whichever is smaller


# -------------------------------------------------------------------------------------------------------------- tracing


def trace(scene, view_layer, pixel):
    """(Tree, warnings) of a pixel of the picture of a bpy.types.Scene; pixel: (x, y) from the top left."""
    abi.library()
    width, height = film_size(scene.render)
    x, y = pixel
    if not (0 <= x < width and 0 <= y < height):
        raise data.ExportError(f"pixel ({x}, {y}) lies outside the picture of {width} × {height} pixels")
    source = export_to_render(scene, view_layer)
    with core.Scene() as core_scene:
        ids = core_scene.fill(source)
        core_scene.commit(int(source.settings.get("threads", 0)))
        with core.Render(core_scene, "ray_tracing") as job:
            job.set_film(width, height)
            for name, value in source.settings.items():
                job.set(name, value)
            rays = job.trace_tree(x, height - 1 - y, MOST_RAYS)
        names = {number: instance.name for number, instance in zip(ids, source.instances, strict=True)}
        info = core_scene.info()
        bounds = dist(info.bounds_min, info.bounds_max) if info.face_count else 0
        return _arranged(rays, names, bounds), source.warnings + core_scene.warnings()


def _arranged(rays, names, bounds):
    """The Tree of rays as the library gives them."""
    children = [[] for _ in rays]
    for place, ray in enumerate(rays[1:], 1):
        children[ray.parent].append(place)
    order, levels, left = [], [], [(0, 0)]
    while left:
        place, level = left.pop()
        order.append(rays[place])
        levels.append(level)
        left.extend((child, level + 1) for child in reversed(children[place]))
    met = [ray.origin for ray in rays] + [end_of(ray, 0) for ray in rays]
    crossed = dist(np.min(met, axis=0), np.max(met, axis=0))
    size = min((length for length in (bounds, crossed) if length > 0), default=1.0)
    return Tree(order, levels, [names.get(ray.instance, "") for ray in order], size)


def end_of(ray, size):
    """Where a ray is drawn to: what it meets; where it meets nothing, a length on."""
    if ray.end == "surface":
        return ray.position
    length = {"light": ray.distance, "background": size}.get(ray.end, _STUB * size)
    return tuple(np.add(ray.origin, np.multiply(ray.direction, length)))


# --------------------------------------------------------------------------------------------------------------- curves


def _marked(items):
    return [item for item in items if item.get(MARK) and not item.library]


def clear(manager):
    """Removes the curves, and all else that draw() made, and empties the list. What the user has put in stays."""
    for made in _marked(bpy.data.objects):
        bpy.data.objects.remove(made)
    for collection in _marked(bpy.data.collections):
        if collection.objects or collection.children:
            del collection[MARK]
        else:
            bpy.data.collections.remove(collection)
    for owner in (bpy.data.curves, bpy.data.materials):
        for made in _marked(owner):
            if not made.users:
                owner.remove(made)
    manager.triptych_ray_tree.rays.clear()


def is_shown(manager):
    """Whether there is something to clear."""
    return bool(manager.triptych_ray_tree.rays or _marked(bpy.data.collections))


def draw(scene, tree):
    """Draws the rays into the collection NAME: one curve object for each kind of ray, a spline for each ray."""
    collection = bpy.data.collections.new(NAME)
    collection[MARK] = True
    scene.collection.children.link(collection)
    for kind in COLORS:
        rays = [ray for ray in tree.rays if ray.kind == kind]
        if rays:
            collection.objects.link(_curves(kind, rays, tree.size))


def _curves(kind, rays, size):
    """An object that is seen in viewports, over what hides it, but not in renders, and that no click selects."""
    curve = bpy.data.curves.new(f"{kind.title()} Rays", "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution = "3D", _THICKNESS * size, 2
    curve.use_fill_caps = True
    for ray in rays:
        points = curve.splines.new("POLY").points
        points.add(1)
        points.foreach_set("co", [*ray.origin, 1, *end_of(ray, size), 1])
        if kind == "primary":
            points[0].radius = 0  # seen from the camera, the ray is a dot on its pixel
    curve.materials.append(_material(kind))
    made = bpy.data.objects.new(curve.name, curve)
    made.color = (*COLORS[kind], 1)
    made.hide_render = made.hide_select = made.show_in_front = True
    made[MARK] = curve[MARK] = kind
    return made


def thicken(rays, chosen):
    """Makes the curve of one of the rays of the list thicker than the others."""
    for made in _marked(bpy.data.objects):
        mine = [ray for ray in rays if ray.kind == made[MARK]]
        for ray, spline in zip(mine, made.data.splines, strict=False):
            spline.points[1].radius = _CHOSEN if ray == chosen else 1
            if ray.kind != "primary":
                spline.points[0].radius = spline.points[1].radius


def _material(kind):
    """A material that shines in the colour of a kind."""
    made = bpy.data.materials.new(f"{kind.title()} Rays")
    made[MARK] = kind
    made.diffuse_color = (*COLORS[kind], 1)
    made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    emission = nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = made.diffuse_color
    made.node_tree.links.new(emission.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


# ------------------------------------------------------------------------------------------------------------- the list

_ENDS = {"light": "light", "background": "background", "depth": "limit of depth", "weight": "least weight"}


def _fill(manager, tree, pixel):
    """Puts a tree into the list."""
    listed = manager.triptych_ray_tree
    listed.rays.clear()
    listed.pixel = pixel
    for ray, level, name in zip(tree.rays, tree.levels, tree.objects, strict=True):
        row = listed.rays.add()
        row.level, row.object = level, name
        for field in ("kind", "end", "material", "distance", "origin", "direction", "position", "normal"):
            setattr(row, field, getattr(ray, field))
        for field in ("weight", "local", "intensity"):
            setattr(row, field, getattr(ray, field))
        where = f"{name} ({ray.material})" if ray.end == "surface" else _ENDS[ray.end]
        row.name = f"{ray.kind.title()}: {where}"
    listed.active = 0


# ------------------------------------------------------------------------------------------------------------ the click


def pixel_at(context, x, y):
    """The pixel (from the top left) of the scene's picture at a place of the window. ExportError where none is."""

    def holds(region):
        return 0 <= x - region.x < region.width and 0 <= y - region.y < region.height

    area = next((area for area in context.screen.areas if holds(area)), None)
    if area is not None and area.type in _PLACES:
        regions = [region for region in area.regions if region.type in {"WINDOW", "UI", "HEADER"} and holds(region)]
        if all(region.type == "WINDOW" for region in regions):
            for region in regions:
                place = x - region.x + 0.5, y - region.y + 0.5  # its middle
                return _in_picture(context.scene, *_PLACES[area.type](context.scene, area.spaces.active, region, place))
    raise data.ExportError("click a pixel in an Image Editor or in a 3D Viewport that looks through the camera")


def _in_picture(scene, u, v):
    """The pixel at a place of the picture, (0, 0) at its bottom left and (1, 1) at its top right."""
    width, height = film_size(scene.render)
    x, y = floor(u * width), height - 1 - floor(v * height)
    if not (0 <= x < width and 0 <= y < height):
        raise data.ExportError("click inside the picture")
    return x, y


def _of_image(scene, space, region, place):
    """Where in the picture a place of an Image Editor is."""
    image, film = space.image, film_size(scene.render)
    if image is None:
        raise data.ExportError("the Image Editor shows no picture; render one first")
    u, v = region.view2d.region_to_view(*place)
    if image.type == "RENDER_RESULT":
        if scene.render.use_crop_to_border:
            left, bottom, width, height = window(scene.render, film)
            u, v = (left + u * width) / film[0], (bottom + v * height) / film[1]
    elif 0 in image.size or abs(image.size[0] / image.size[1] * film[1] / film[0] - 1) > 1 / min(image.size):
        raise data.ExportError(f"image '{image.name}' has not the shape of the scene's picture, {film[0]} × {film[1]}")
    return u, v


def _of_view(scene, space, region, place):
    """Where in the picture a place of a 3D Viewport is."""
    camera, view = scene.camera, region.data
    if view.view_perspective != "CAMERA" or (space.use_local_camera and space.camera != camera):
        raise data.ExportError("look through the camera to click a pixel: View > Cameras > Active Camera, numpad 0")
    corners = [camera.matrix_world.normalized() @ corner for corner in camera.data.view_frame(scene=scene)]
    right_top, left_bottom = (location_3d_to_region_2d(region, view, corners[k]) for k in (0, 2))
    return (np.subtract(place, left_bottom) / np.subtract(right_top, left_bottom)).tolist()


_PLACES = {"IMAGE_EDITOR": _of_image, "VIEW_3D": _of_view}


# ------------------------------------------------------------------------------------------------------------ operators


class TRIPTYCH_OT_ray_tree(bpy.types.Operator):
    bl_idname = "triptych.ray_tree"
    bl_label = "Ray Tree"
    bl_description = (
        "Click a pixel of a picture, or of a 3D Viewport that looks through the camera. "
        "The rays that ray tracing follows for it are drawn in the scene and listed in the sidebar"
    )
    bl_options = {"REGISTER", "UNDO"}

    pixel: bpy.props.IntVectorProperty(
        name="Pixel", description="In pixels from the top left of the picture", size=2, min=0, options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context):
        return no_render_runs(cls)

    def invoke(self, context, event):
        if self.properties.is_property_set("pixel"):
            return self.execute(context)
        camera = context.scene.camera
        if camera is None or camera.type != "CAMERA":
            self.report({"ERROR"}, f"scene '{context.scene.name}': there is no camera")
            return {"CANCELLED"}
        context.window.cursor_modal_set("CROSSHAIR")
        context.window_manager.modal_handler_add(self)
        self._tell(context, event)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "MOUSEMOVE":
            self._tell(context, event)
        elif event.type in {"ESC", "RIGHTMOUSE"}:
            self._end(context)
            return {"CANCELLED"}
        elif event.type == "LEFTMOUSE" and event.value == "PRESS":
            self._end(context)
            try:
                self.pixel = pixel_at(context, event.mouse_x, event.mouse_y)
            except data.ExportError as error:
                self.report({"ERROR"}, str(error))
                return {"CANCELLED"}
            return self.execute(context)
        elif event.type in _NAVIGATION:
            return {"PASS_THROUGH"}
        return {"RUNNING_MODAL"}

    def _tell(self, context, event):
        """Says in the status bar and in the header what a click does here."""
        try:
            x, y = pixel_at(context, event.mouse_x, event.mouse_y)
            text = f"Click to trace the rays of pixel ({x}, {y})"
        except data.ExportError as error:
            text = str(error)[0].upper() + str(error)[1:]
        text += "  |  Esc, right click: cancel"
        context.workspace.status_text_set(text)
        if context.area is not None:
            context.area.header_text_set(text)

    def _end(self, context):
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)
        if context.area is not None:
            context.area.header_text_set(None)

    def execute(self, context):
        manager = context.window_manager
        try:
            tree, warnings = trace(context.scene, context.view_layer.name, self.pixel)
        except (abi.LibraryMissing, abi.Error, data.ExportError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for line in warnings:
            self.report({"WARNING"}, line)
        clear(manager)
        draw(context.scene, tree)
        _fill(manager, tree, self.pixel)
        root, count = tree.rays[0].intensity, len(tree.rays)
        values = ", ".join(f"{number:.4g}" for number in root)
        self.report({"INFO"}, f"Pixel ({self.pixel[0]}, {self.pixel[1]}): {count} rays, intensity ({values})")
        return {"FINISHED"}


_NAVIGATION = {
    *("MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "NDOF_MOTION"),
    *("NUMPAD_0", "HOME"),
}


class TRIPTYCH_OT_ray_tree_clear(bpy.types.Operator):
    bl_idname = "triptych.ray_tree_clear"
    bl_label = "Clear Ray Tree"
    bl_description = "Remove the curves of the ray tree from the scene and empty the list"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return is_shown(context.window_manager)

    def execute(self, context):
        clear(context.window_manager)
        return {"FINISHED"}


def _draw(self, context):
    if context.engine == "TRIPTYCH":
        self.layout.operator(TRIPTYCH_OT_ray_tree.bl_idname)


_CLASSES = (TRIPTYCH_OT_ray_tree, TRIPTYCH_OT_ray_tree_clear)


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.TOPBAR_MT_render.append(_draw)


def unregister():
    bpy.types.TOPBAR_MT_render.remove(_draw)
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
