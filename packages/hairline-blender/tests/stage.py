# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of Blender for tests, and their pictures by Hairline and by Cycles."""

import math
import os
import tempfile

import bpy
import numpy as np
from mathutils import Vector

FOLDER = tempfile.mkdtemp(prefix="hairline-test-")


def empty(size_px=(128, 96)):
    """A scene with a black world and nothing in it."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = size_px
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    world(scene, (0, 0, 0))
    return scene


def world(scene, color, strength=1.0, image=None, turn_rad=0.0):
    scene.world = made = bpy.data.worlds.new("world")
    if not made.node_tree:
        made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    background = nodes.new("ShaderNodeBackground")
    links.new(background.outputs[0], nodes.new("ShaderNodeOutputWorld").inputs["Surface"])
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    if image:
        node, mapping, place = nodes.new("ShaderNodeTexEnvironment"), nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeTexCoord")
        node.image = image
        mapping.inputs["Rotation"].default_value[2] = turn_rad
        links.new(place.outputs["Generated"], mapping.inputs["Vector"])
        links.new(mapping.outputs[0], node.inputs["Vector"])
        links.new(node.outputs[0], background.inputs["Color"])
    return made


def link(name, data):
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    return made


def look(item, at, frm):
    item.location = frm
    item.rotation_euler = (Vector(at) - Vector(frm)).to_track_quat("-Z", "Y").to_euler()


def camera(frm=(0, -4, 2.5), at=(0, 0, 0.4), lens=50.0):
    data = bpy.data.cameras.new("camera")
    data.lens = lens
    made = link("camera", data)
    look(made, at, frm)
    bpy.context.scene.camera = made
    return made


def material(name="material", **sockets):
    """A Principled BSDF; `base_color=(r, g, b)`, `roughness=0.3` and so on."""
    made = bpy.data.materials.new(name)
    if not made.node_tree:
        made.use_nodes = True
    node = principled(made)
    for key, value in sockets.items():
        socket = node.inputs[{"ior": "IOR"}.get(key, key.replace("_", " ").title().replace("Ior", "IOR"))]
        socket.default_value = (*value, 1) if isinstance(value, tuple) else value
    return made


def principled(made):
    return next(node for node in made.node_tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")


def plane(size=6.0, made_of=None, name="floor"):
    mesh = bpy.data.meshes.new(name)
    s = size / 2
    mesh.from_pydata([(-s, -s, 0), (s, -s, 0), (s, s, 0), (-s, s, 0)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
    mesh.materials.append(made_of)
    return link(name, mesh)


def ball(radius=0.6, at=(0, 0, 0.6), made_of=None, name="ball", segments=96):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=segments // 2, radius=radius, location=at)
    made = bpy.context.object
    made.name = name
    made.data.polygons.foreach_set("use_smooth", [True] * len(made.data.polygons))
    made.data.materials.append(made_of)
    return made


def light(kind, energy, frm=(1.5, -1.5, 3.0), at=(0, 0, 0), **settings):
    data = bpy.data.lights.new("lamp", kind)
    data.energy = energy
    for key, value in settings.items():
        setattr(data, key, value)
    made = link("lamp", data)
    look(made, at, frm)
    return made


def image_of(values, name="image", data=False):
    """An image of height x width x 3 linear numbers, rows from the top; packed."""
    height, width = values.shape[:2]
    made = bpy.data.images.new(name, width, height, float_buffer=True, is_data=data)
    whole = np.ones((height, width, 4), np.float32)
    whole[..., :3] = values[::-1]
    made.pixels.foreach_set(whole.ravel())
    made.pack()
    return made


def picture(engine, samples=256, name=None, write=True):
    """Linear, rows from the top, height x width x 4."""
    scene = bpy.context.scene
    scene.render.engine = engine
    if engine == "CYCLES":
        own = scene.cycles
        own.device, own.samples, own.use_adaptive_sampling, own.use_denoising = "CPU", samples, False, False
        # What a picture of one bounce has.
        own.max_bounces = own.diffuse_bounces = own.glossy_bounces = 1
        own.transparent_max_bounces = 8
        own.sample_clamp_indirect, own.blur_glossy, own.light_sampling_threshold = 0, 0, 0
        own.pixel_filter_type, own.filter_width = "GAUSSIAN", 2.0
    path = os.path.join(FOLDER, f"{name or engine}.exr")
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return read(path)


def read(path):
    image = bpy.data.images.load(path)
    width, height = image.size
    values = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values.reshape(height, width, 4)[::-1]


def both(samples=256):
    # With the default of 8 samples, reflections of reflections on rough metal are 2.5 % too dark.
    bpy.context.scene.hairline.samples = 64
    return picture("HAIRLINE")[..., :3], picture("CYCLES", samples)[..., :3]


def apart(a, b):
    """By how much the mean of a is off that of b, and the rms difference over the mean."""
    a, b = a.astype(float), b.astype(float)
    mean = b.mean()
    return a.mean() / mean - 1, math.sqrt(((a - b) ** 2).mean()) / mean
