# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of a chessboard lie where Cycles has them."""

import math

import bpy
import numpy as np
import pytest
import stage
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

# Of squares along an edge of the board, and its half edge in metres.
_SQUARES, _HALF_M = 8, 1.0


def board():
    """Squares of two materials, in the plane z = 0, lit evenly."""
    mesh = bpy.data.meshes.new("board")
    ticks = np.linspace(-_HALF_M, _HALF_M, _SQUARES + 1)
    points = [(x, y, 0) for y in ticks for x in ticks]
    row = _SQUARES + 1
    faces = [(i + j * row, i + 1 + j * row, i + 1 + (j + 1) * row, i + (j + 1) * row) for j in range(_SQUARES) for i in range(_SQUARES)]
    mesh.from_pydata(points, [], faces)
    for value in (0.02, 0.8):
        mesh.materials.append(stage.material(f"grey {value}", base_color=(value,) * 3, roughness=1.0, specular_ior_level=0.0))
    mesh.polygons.foreach_set("material_index", [(i + j) % 2 for j in range(_SQUARES) for i in range(_SQUARES)])
    stage.link("board", mesh)


def corners_px(scene):
    """Of the inner corners those in the picture, and not at its border."""
    width, height = scene.render.resolution_x, scene.render.resolution_y
    ticks = np.linspace(-_HALF_M, _HALF_M, _SQUARES + 1)[1:-1]
    found = []
    bpy.context.view_layer.update()
    for x in ticks:
        for y in ticks:
            at = world_to_camera_view(scene, scene.camera, Vector((x, y, 0)))
            px = np.array([at.x * width, (1 - at.y) * height])
            if at.z > 0 and (px > 6).all() and (px < np.array([width, height]) - 6).all():
                found.append(px)
    return found


def offsets_px(a, b, corners, half=4):
    """By how much a is moved against b about each corner: Lucas and Kanade's registration, repeated."""
    a, b = a[..., :3].mean(axis=2).astype(float), b[..., :3].mean(axis=2).astype(float)
    found = []
    for corner in corners:
        x, y = (int(v) for v in corner)
        cut = slice(y - half, y + half + 1), slice(x - half, x + half + 1)
        window = a[cut]
        gy, gx = np.gradient(0.5 * (a + b))
        gy, gx = gy[cut].ravel(), gx[cut].ravel()
        move, *_ = np.linalg.lstsq(np.stack([gx, gy], 1), (b[cut] - window).ravel(), rcond=None)
        found.append(move)
    return np.array(found)


def setting(**changes):
    scene = stage.empty(changes.pop("size_px", (160, 120)))
    stage.world(scene, (1, 1, 1))
    board()
    camera = stage.camera(frm=(0.4, -1.6, 2.0), at=(0, 0, 0), lens=changes.pop("lens", 40.0))
    roll = changes.pop("roll", 0.0)
    camera.rotation_euler.rotate_axis("Z", roll)
    for key, value in changes.items():
        setattr(camera.data, key, value)
    return scene, camera


VIEWS = {
    "plain": {},
    "portrait": {"size_px": (100, 160)},
    "shifted": {"shift_x": 0.13, "shift_y": -0.07},
    "shifted portrait": {"size_px": (100, 160), "shift_x": -0.1, "shift_y": 0.15},
    "vertical sensor": {"sensor_fit": "VERTICAL", "sensor_height": 30.0, "shift_x": 0.05},
    "horizontal sensor of a portrait": {"sensor_fit": "HORIZONTAL", "size_px": (100, 160), "shift_y": 0.1},
    "rolled by a right angle": {"roll": math.radians(90)},
    "rolled": {"roll": math.radians(-35), "shift_x": 0.1},
    "wide": {"lens": 18.0},
}


@pytest.mark.parametrize("view", VIEWS)
def test_corners_are_where_cycles_has_them(view):
    scene, _ = setting(**VIEWS[view])
    # Eight samples place an edge to an eighth of a pixel.
    scene.hairline.samples = 64
    ours, theirs = stage.picture("HAIRLINE"), stage.picture("CYCLES", 128)
    corners = corners_px(scene)
    moves = offsets_px(ours, theirs, corners)
    off_px, mean_px = np.hypot(*moves.T), np.hypot(*moves.mean(axis=0))
    print(f"{view}: {len(corners)} corners, off by {off_px.max():.2f} px at most, in the mean by {mean_px:.3f} px")
    assert len(corners) > 12
    # Renderers filter edges differently, each corner by its place in its pixel; the mean is free of that.
    assert off_px.max() < 0.5 and mean_px < 0.05


def test_a_pixel_of_shift_is_found():
    scene, camera = setting(shift_x=0.1)
    theirs = stage.picture("CYCLES", 32)
    camera.data.shift_x += 1 / 160
    ours = stage.picture("HAIRLINE")
    assert np.hypot(*offsets_px(ours, theirs, corners_px(scene)).mean(axis=0)) > 0.5


def test_depth_of_field_blurs_as_in_cycles():
    scene, camera = setting()
    camera.data.dof.use_dof = True
    camera.data.dof.aperture_fstop, camera.data.dof.focus_distance = 0.4, 1.6
    ours, theirs = stage.both(128)
    assert abs(stage.apart(ours, theirs)[0]) < 0.02
    # Steep edges become soft ones: as soft as theirs.
    contrast = [np.abs(np.diff(p.mean(axis=2), axis=1)).mean() for p in (ours, theirs)]
    sharp = np.abs(np.diff((setattr(camera.data.dof, "use_dof", False), stage.picture("HAIRLINE"))[1][..., :3].mean(axis=2), axis=1)).mean()
    assert abs(contrast[0] / contrast[1] - 1) < 0.05 and contrast[1] < 0.9 * sharp


def test_a_border_is_a_part_of_the_picture():
    scene, _ = setting(shift_x=0.1)
    whole = stage.picture("HAIRLINE")
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.5, 1.0
    part = stage.picture("HAIRLINE")
    assert part.shape[:2] == (60, 80)
    mean, rms = stage.apart(part[..., :3], whole[:60, 40:120, :3])
    assert abs(mean) < 0.001 and rms < 0.03


# Shares of the picture from the left, right, low and high side; of 97 x 61 pixels few are whole.
BORDERS = [(0.25, 0.75, 0.5, 1.0), (0.1, 0.77, 0.23, 0.71), (0.7, 0.9, 0.3, 0.6), (1 / 3, 0.345, 0.0, 1.0)]


@pytest.mark.parametrize("border", BORDERS)
def test_a_border_has_the_pixels_that_blender_asks_for(border):
    scene, _ = setting(shift_x=0.1, size_px=(97, 61))
    whole = stage.picture("HAIRLINE")
    render = scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = border
    render.use_crop_to_border = True
    cropped, theirs = stage.picture("HAIRLINE"), stage.picture("CYCLES", 1)
    assert cropped.shape == theirs.shape
    # The border lies where the cut-off numbers say; what is outside of it is black.
    height, width = cropped.shape[:2]
    left, low = int(np.float32(border[0]) * np.float32(97)), int(np.float32(border[2]) * np.float32(61))
    inside = slice(61 - low - height, 61 - low), slice(left, left + width)
    assert stage.apart(cropped[..., :3], whole[inside][..., :3])[1] < 0.05
    render.use_crop_to_border = False
    placed = stage.picture("HAIRLINE")
    assert placed.shape == whole.shape and (placed[inside] == cropped).all()
    placed[inside] = 0
    assert (placed == 0).all()


def test_transparent_films_have_alpha():
    scene, _ = setting()
    scene.render.film_transparent = True
    ours, theirs = stage.picture("HAIRLINE"), stage.picture("CYCLES", 32)
    assert abs(ours[..., 3].mean() / theirs[..., 3].mean() - 1) < 0.01
    assert theirs[..., 3].min() == 0 and ours[..., 3].min() == 0
