# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of docs/blender.md, of the scene of `example.py`."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import example


def make(folder):
    """Writes them; 0 for no error."""
    scene = example.build()
    scene.render.resolution_x, scene.render.resolution_y = 640, 360
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGB"
    scene.render.image_settings.compression = 100
    _write(scene, folder / "blender.png")
    for layer in bpy.data.objects["tray"].hairline.scratches:
        layer.hidden = True
    bpy.data.materials["steel"].hairline.metal = "NONE"
    scene.render.resolution_x, scene.render.resolution_y = 320, 180
    _write(scene, folder / "blender-plain.png")
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 256, False
    _write(scene, folder / "blender-cycles.png")
    return 0


def _write(scene, path):
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")
