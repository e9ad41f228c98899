# SPDX-License-Identifier: GPL-3.0-or-later
"""Principled materials against Cycles: constants, images, maps, transforms."""

import math

import bpy
import numpy as np
import pytest
import stage


def checks(low=(0.05, 0.1, 0.4), high=(0.8, 0.5, 0.1), squares=4, size=64):
    """A chessboard with one corner marked, so that no turn and no mirror image is like it."""
    v, u = np.mgrid[0:size, 0:size] * squares // size
    values = np.where(((u + v) % 2)[..., None] == 0, np.array(low), np.array(high))
    values[: size // squares, : size // squares] = (0.9, 0.9, 0.9)
    return values


def with_image(made, socket, values, data=False, uv=None, channel="Color", **mapping):
    """An image before a socket, by a Mapping node where one is asked for."""
    nodes, links = made.node_tree.nodes, made.node_tree.links
    node = nodes.new("ShaderNodeTexImage")
    node.image = stage.image_of(values, f"{socket} image", data)
    links.new(node.outputs[channel], stage.principled(made).inputs[socket])
    if mapping:
        place, map_node = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMapping")
        links.new(place.outputs["UV"], map_node.inputs["Vector"])
        links.new(map_node.outputs[0], node.inputs["Vector"])
        for key, value in mapping.items():
            map_node.inputs[key].default_value = value
    if uv:
        map_node = nodes.new("ShaderNodeUVMap")
        map_node.uv_map = uv
        links.new(map_node.outputs[0], node.inputs["Vector"])
    return node


def textured(**mapping):
    made = stage.material("textured", roughness=0.8)
    with_image(made, "Base Color", checks(), **mapping)
    return made


def rough_and_metal():
    made = stage.material("patched", base_color=(0.8, 0.7, 0.6))
    with_image(made, "Roughness", checks((0.2,) * 3, (0.7,) * 3), data=True)
    with_image(made, "Metallic", checks((0.0,) * 3, (1.0,) * 3, 2), data=True)
    return made


def bumpy():
    made = stage.material("bumpy", base_color=(0.5, 0.5, 0.5), roughness=0.5)
    nodes, links = made.node_tree.nodes, made.node_tree.links
    x = np.linspace(0, 6 * math.pi, 128)
    slope = 0.4 * np.sin(x)[None, :, None] * np.array([1.0, 0.3, 0]) * np.ones((128, 1, 1))
    normals = np.dstack([slope[..., 0], slope[..., 1], np.ones((128, 128))])
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    image, normal = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeNormalMap")
    image.image = stage.image_of(0.5 + 0.5 * normals, "normals", data=True)
    links.new(image.outputs["Color"], normal.inputs["Color"])
    links.new(normal.outputs[0], stage.principled(made).inputs["Normal"])
    return made


def see_through():
    made = stage.material("leaf", base_color=(0.2, 0.6, 0.2), roughness=0.8)
    with_image(made, "Alpha", checks((0.0,) * 3, (1.0,) * 3), data=True)
    return made


def stretched(direction=0.0):
    made = stage.material("brushed", base_color=(0.8, 0.8, 0.8), metallic=1.0, roughness=0.4, anisotropic=0.7, anisotropic_rotation=direction)
    nodes, links = made.node_tree.nodes, made.node_tree.links
    tangent = nodes.new("ShaderNodeTangent")
    tangent.direction_type = "UV_MAP"
    links.new(tangent.outputs[0], stage.principled(made).inputs["Tangent"])
    return made


# Each with how far its mean may be off, and why it is not less.
MATERIALS = {
    "image": (textured, 0.01),
    "moved, turned and scaled image": (lambda: textured(Location=(0.3, 0.2, 0), Rotation=(0, 0, 0.6), Scale=(2.0, 1.5, 1)), 0.01),
    "roughness and metal by images": (rough_and_metal, 0.02),
    "normal map": (bumpy, 0.02),
    "alpha": (see_through, 0.02),
    "half alpha": (lambda: stage.material("glassy", base_color=(0.8, 0.2, 0.2), roughness=0.6, alpha=0.5), 0.02),
    "coat": (lambda: stage.material("coated", base_color=(0.6, 0.1, 0.1), roughness=0.6, coat_weight=1.0, coat_roughness=0.15), 0.02),
    # At 60 degrees Fresnel's equations reflect 16 % more of an index of 2 than Schlick's curve. The body is dark, so this would be seen.
    "refractive index 2": (lambda: stage.material("dense", base_color=(0.1, 0.1, 0.1), roughness=0.3, ior=2.0), 0.05),
    "specular level 1": (lambda: stage.material("shiny", base_color=(0.1, 0.1, 0.1), roughness=0.3, specular_ior_level=1.0), 0.05),
    "specular level 0": (lambda: stage.material("dull", base_color=(0.5, 0.5, 0.5), roughness=0.3, specular_ior_level=0.0), 0.02),
    "tint": (lambda: stage.material("tinted", base_color=(0.05, 0.05, 0.05), roughness=0.3, ior=2.0, specular_tint=(1.0, 0.3, 0.1)), 0.06),
    "glow": (lambda: stage.material("glow", base_color=(0.1, 0.1, 0.1), emission_color=(0.2, 0.5, 1.0), emission_strength=0.7), 0.02),
    "anisotropic": (stretched, 0.03),
    "anisotropic, turned": (lambda: stretched(0.25), 0.03),
}


def setting(made):
    stage.empty()
    stage.plane(made_of=made, size=2.4)
    stage.camera(frm=(0.3, -3.0, 2.6), at=(0, 0, 0))
    stage.light("AREA", 120, frm=(0.8, 1.5, 2.5), size=1.0)
    stage.world(bpy.context.scene, (0.3, 0.3, 0.35))


@pytest.mark.parametrize("name", MATERIALS)
def test_means_are_those_of_cycles(name):
    make, most = MATERIALS[name]
    stage.empty()
    setting(None)
    bpy.data.objects["floor"].data.materials[0] = make()
    mean, rms = stage.apart(*stage.both())
    print(f"{name}: mean {100 * mean:+.2f} % rms {100 * rms:.1f} %")
    assert abs(mean) < most and rms < 0.15


def test_an_image_turned_the_other_way_is_seen():
    setting(None)
    bpy.data.objects["floor"].data.materials[0] = textured(Rotation=(0, 0, 0.3))
    ours = stage.picture("HAIRLINE")[..., :3]
    bpy.data.objects["floor"].data.materials[0] = textured(Rotation=(0, 0, -0.3))
    assert stage.apart(ours, stage.picture("CYCLES")[..., :3])[1] > 0.2


def test_the_second_uv_map_is_found_by_its_name():
    setting(None)
    floor = bpy.data.objects["floor"]
    floor.data.uv_layers.new(name="other").data.foreach_set("uv", [0, 0, 0, 2, 2, 2, 2, 0])
    floor.data.materials[0] = textured(uv="other")
    mean, rms = stage.apart(*stage.both())
    assert abs(mean) < 0.01 and rms < 0.1


def test_materials_by_slots_and_measured_metals():
    setting(None)
    ball = stage.ball(made_of=stage.material("a", base_color=(0.9, 0.1, 0.1)))
    ball.data.materials.append(stage.material("b", base_color=(0.1, 0.1, 0.9), metallic=1.0))
    ball.data.polygons.foreach_set("material_index", [i % 2 for i in range(len(ball.data.polygons))])
    bpy.data.objects["floor"].data.materials[0] = stage.material("floor")
    before = stage.picture("HAIRLINE")[..., :3]
    assert abs(stage.apart(before, stage.picture("CYCLES")[..., :3])[0]) < 0.02
    bpy.data.materials["b"].hairline.metal = "gold"
    gold = stage.picture("HAIRLINE")[..., :3]
    more = (gold - before).mean(axis=(0, 1))
    assert more[0] > 0 > more[2]
