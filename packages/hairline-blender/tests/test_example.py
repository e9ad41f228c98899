# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene to begin with."""

import os
import sys
from pathlib import Path

import addon_under_test as addon
import bpy
import stage

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import example


def test_the_example_is_a_blend_file_that_shows_its_scratches():
    path = os.path.join(stage.FOLDER, "example.blend")
    example.save(path)
    bpy.ops.wm.open_mainfile(filepath=path)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.hairline.samples = 160, 90, 8
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    worn = stage.picture("HAIRLINE")[..., :3]
    assert addon.notes.last(scene) == []
    for layer in bpy.data.objects["tray"].hairline.scratches:
        layer.hidden = True
    plain = stage.picture("HAIRLINE")[..., :3]
    assert (abs(worn - plain).max(axis=2) > 0.02).mean() > 0.1
