# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene to begin with, made by script: `blender --python example.py` opens it; in the module `bpy`, `example.save(path)` writes it."""

import math

import bpy
from mathutils import Vector

# A tray turned about z: radius and height.
_PROFILE_M = [
    (0.0, 0.0),
    (0.068, 0.0),
    (0.075, 0.001),
    (0.085, 0.008),
    (0.09, 0.009),
    (0.0915, 0.0085),
    (0.0905, 0.0075),
    (0.085, 0.006),
    (0.076, -0.001),
    (0.0, -0.0015),
]
_AROUND = 192


def build():
    """A worn steel tray on a dark table, under a small lamp and a dim ceiling."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.engine = "HAIRLINE"
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    # The rim mirrors the lamp in lines thinner than a pixel.
    scene.hairline.samples = 32
    # Colours of scratches stay as they are, up to the highlights.
    scene.view_settings.view_transform = "Khronos PBR Neutral"
    scene.world = bpy.data.worlds.new("dark")
    scene.world.color = (0, 0, 0)
    if scene.world.node_tree:
        scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
    tray = _object("tray", _turned(), _material("steel", (0.6, 0.58, 0.55), 1.0, 0.07))
    tray.location.z = 0.0015
    tray.active_material.hairline.metal = "steel"
    _object("table", _square(1.0), _material("wood", (0.012, 0.01, 0.009), 0.0, 0.6))
    _look(_linked("camera", bpy.data.cameras.new("camera")), (0.0, -0.26, 0.2), (0, -0.005, 0))
    scene.camera = bpy.data.objects["camera"]
    scene.camera.data.lens, scene.camera.data.clip_start = 45, 0.01
    _lamp("key", "POINT", 1.1, (0.05, 0.2, 0.21), color=(1.0, 0.95, 0.88), shadow_soft_size=0.005)
    _lamp("ceiling", "AREA", 0.8, (0, 0.7, 0.75), color=(0.8, 0.9, 1.0), shape="RECTANGLE", size=2.0, size_y=1.2)
    bpy.context.view_layer.objects.active = tray
    for preset, count, width_um in (("Turned pan", 2500, 5.0), ("Random wear", 7000, 4.2)):
        bpy.ops.hairline.add_layer(owner="object", preset=preset)
        layer = tray.hairline.scratches[-1]
        layer.count, layer.width_um, layer.depth_nm, layer.depth_spread = count, width_um, 134, 0.1
    return scene


def save(path):
    build()
    bpy.ops.wm.save_as_mainfile(filepath=str(path))


def _linked(name, data):
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    return made


def _object(name, mesh, material):
    mesh.materials.append(material)
    return _linked(name, mesh)


def _turned():
    """The profile turned about z, smooth but for its rim."""
    mesh = bpy.data.meshes.new("tray")
    points, faces = [], []
    rings = [p for p in _PROFILE_M if p[0] > 0]
    for radius, height in rings:
        for i in range(_AROUND):
            angle = 2 * math.pi * i / _AROUND
            points.append((radius * math.cos(angle), radius * math.sin(angle), height))
    at = lambda ring, i: ring * _AROUND + i % _AROUND
    for ring in range(len(rings) - 1):
        faces += [(at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1)) for i in range(_AROUND)]
    for height, ring, is_top in ((_PROFILE_M[0][1], 0, True), (_PROFILE_M[-1][1], len(rings) - 1, False)):
        middle = len(points)
        points.append((0, 0, height))
        for i in range(_AROUND):
            faces.append((middle, at(ring, i), at(ring, i + 1)) if is_top else (middle, at(ring, i + 1), at(ring, i)))
    mesh.from_pydata(points, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    return mesh


def _square(size_m):
    mesh = bpy.data.meshes.new("table")
    s = size_m / 2
    mesh.from_pydata([(-s, -s, 0), (s, -s, 0), (s, s, 0), (-s, s, 0)], [], [(0, 1, 2, 3)])
    return mesh


def _material(name, base_color, metallic, roughness):
    made = bpy.data.materials.new(name)
    if not made.node_tree:
        made.use_nodes = True
    node = next(node for node in made.node_tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")
    node.inputs["Base Color"].default_value = (*base_color, 1)
    node.inputs["Metallic"].default_value, node.inputs["Roughness"].default_value = metallic, roughness
    return made


def _lamp(name, kind, power_w, at, **settings):
    data = bpy.data.lights.new(name, kind)
    data.energy = power_w
    for key, value in settings.items():
        setattr(data, key, value)
    made = _linked(name, data)
    _look(made, at, (0, 0, 0))
    return made


def _look(item, frm, at):
    item.location = frm
    item.rotation_euler = (Vector(at) - Vector(frm)).to_track_quat("-Z", "Y").to_euler()


if __name__ == "__main__":
    build()
