# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras: of a scene, and of a viewport."""

import math

from .frames import tidy, unit_axes
from .notes import Refused


class View:
    """A camera with its picture: the width of a pixel at unit depth, and the pixel that the lens axis goes through."""

    def __init__(self, matrix, size_px, tan_per_px, middle_px):
        self.matrix, self.size_px, self.tan_per_px, self.middle_px = matrix, size_px, tan_per_px, middle_px
        self.focus = {}

    def part(self, x, y, width, height):
        """The view of a part of the picture. x and y count from the lower left corner."""
        middle = self.middle_px[0] - x, self.middle_px[1] - y
        part = View(self.matrix, (width, height), self.tan_per_px, middle)
        part.focus = self.focus
        return part

    def table(self):
        """The table `[camera]`."""
        width, height = self.size_px
        position, _, up, back = unit_axes(self.matrix)
        shift = (0.5 * width - self.middle_px[0]) / height, (0.5 * height - self.middle_px[1]) / height
        table = {
            "position_m": [float(x) for x in position],
            "target_m": [float(x) for x in position - back],
            "up": [float(x) for x in up],
            "fov_y_deg": math.degrees(2 * math.atan(0.5 * height * self.tan_per_px)),
            "world_up": "z",
            **self.focus,
        }
        if any(abs(part) > 1e-9 for part in shift):
            table["shift"] = list(shift)
        return table


def of_scene(scene, depsgraph, notes):
    """The view of the scene's camera, of the whole picture."""
    render = scene.render
    if scene.camera is None:
        raise Refused(f'scene "{scene.name}": found no camera; add one, and make it the active one of the scene')
    camera_object = scene.camera.evaluated_get(depsgraph)
    camera = camera_object.data
    subject = f'camera "{camera_object.name}"'
    if camera_object.type != "CAMERA" or camera.type != "PERSP":
        found = camera_object.type if camera_object.type != "CAMERA" else camera.type
        raise Refused(f"{subject}: found the type {found}; Hairline sees by perspective cameras alone: set it to Perspective")
    if abs(render.pixel_aspect_x / render.pixel_aspect_y - 1) > 1e-6:
        notes.add(f'scene "{scene.name}"', "its pixels are not square", "they are taken for square")
    size_px = picture_size_px(render)
    view = _perspective(camera, camera_object.matrix_world, size_px)
    if camera.dof.use_dof:
        view.focus = _focus(camera_object, subject, notes)
    return view


def picture_size_px(render):
    return tuple(max(n * render.resolution_percentage // 100, 1) for n in (render.resolution_x, render.resolution_y))


def _perspective(camera, matrix, size_px):
    width, height = size_px
    is_wide = camera.sensor_fit == "HORIZONTAL" or camera.sensor_fit == "AUTO" and width >= height
    # Blender fits the sensor to this side of the picture, and measures shifts in it.
    fitted_px = width if is_wide else height
    sensor_mm = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    middle_px = 0.5 * width - camera.shift_x * fitted_px, 0.5 * height - camera.shift_y * fitted_px
    return View(matrix, size_px, sensor_mm / camera.lens / fitted_px, middle_px)


def _focus(camera_object, subject, notes):
    camera = camera_object.data
    dof = camera.dof
    distance_m = dof.focus_distance
    if dof.focus_object:
        position, _, _, back = unit_axes(camera_object.matrix_world)
        distance_m = (position - dof.focus_object.matrix_world.translation).dot(back)
    if dof.aperture_blades or dof.aperture_rotation or abs(dof.aperture_ratio - 1) > 1e-6:
        notes.add(subject, "the shape of its opening is not carried over", "it is round")
    return {
        "aperture_mm": tidy(camera.lens / max(dof.aperture_fstop, 1e-3)),
        "focus_distance_m": max(tidy(distance_m), 1e-5),
    }


def of_viewport(region, region_3d):
    """The view of a viewport, by its own lens or through the scene's camera."""
    if not region_3d.is_perspective:
        raise Refused("viewport: found an orthographic view; Hairline sees in perspective: press 5 on the number pad")
    width, height = region.width, region.height
    # The matrix from view to clip space: its scale is two over the tangent of the whole height, its third column the shift.
    window = region_3d.window_matrix
    middle_px = 0.5 * width * (1 - window[0][2]), 0.5 * height * (1 - window[1][2])
    return View(region_3d.view_matrix.inverted(), (width, height), 2 / (window[1][1] * height), middle_px)
