# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's cameras to data.Camera."""

from math import atan

from . import data
from .transforms import rows


def export_camera(camera_object, scene):
    """The data.Camera of an evaluated object. ExportError where it is no camera, or of a kind that is not there."""
    if camera_object.type != "CAMERA":
        raise data.ExportError(f"camera '{camera_object.name}': a {camera_object.type.lower()} object is no camera")
    camera = camera_object.data
    if camera.type not in {"PERSP", "ORTHO"}:
        raise data.ExportError(
            f"camera '{camera_object.name}': the type {camera.type} is not supported; use perspective or orthographic"
        )
    sensor = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    result = data.Camera(
        name=camera_object.name,
        type="perspective" if camera.type == "PERSP" else "orthographic",
        world_from_camera=rows(camera_object.matrix_world),
        fit=camera.sensor_fit.lower(),
        field_of_view=2 * atan(sensor / (2 * camera.lens)),
        width=camera.ortho_scale,
        shift=(camera.shift_x, camera.shift_y),
        clip_start=camera.clip_start,
        clip_end=camera.clip_end,
        pixel_aspect=scene.render.pixel_aspect_x / scene.render.pixel_aspect_y,
    )
    dof = camera.dof
    if dof.use_dof:
        result.focus_distance = max(_focus_distance(camera_object), 1e-4)
        # An orthographic camera has no focal length; Blender's engines take one metre.
        focal_length = camera.lens * 1e-3 if camera.type == "PERSP" else 1.0
        result.aperture_radius = focal_length / (2 * max(dof.aperture_fstop, 1e-5))
        result.blade_count = dof.aperture_blades if dof.aperture_blades >= 3 else 0
        result.blade_rotation = dof.aperture_rotation
    return result


def _focus_distance(camera_object):
    """Metres along the camera's −Z."""
    dof = camera_object.data.dof
    target = dof.focus_object
    if target is None:
        return dof.focus_distance
    place = target.matrix_world.translation
    bone = dof.focus_subtarget and target.pose and target.pose.bones.get(dof.focus_subtarget)
    if bone:
        place = target.matrix_world @ bone.matrix.translation
    world = camera_object.matrix_world
    return abs((place - world.translation).dot(world.col[2].to_3d().normalized()))
