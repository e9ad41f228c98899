# SPDX-License-Identifier: GPL-3.0-or-later
"""Things stand where they stand in Cycles: instances, mirrored scales, parents, modifiers."""

import math

import addon_under_test as addon
import bpy
import pytest
import stage
from mathutils import Matrix

GREY = {"base_color": (0.6, 0.5, 0.4), "roughness": 0.6}


def wedge(name="wedge"):
    """Something that is like none of its mirror images, flat shaded."""
    mesh = bpy.data.meshes.new(name)
    points = [(-0.4, -0.3, 0), (0.5, -0.3, 0), (0.5, 0.4, 0), (-0.4, 0.4, 0), (-0.4, -0.3, 0.8), (-0.1, 0.4, 0.3)]
    mesh.from_pydata(points, [], [(3, 2, 1, 0), (0, 1, 4), (1, 2, 5), (1, 5, 4), (2, 3, 5), (3, 0, 4, 5)])
    mesh.validate()
    mesh.materials.append(stage.material(name, **GREY))
    return stage.link(name, mesh)


def collection_instances():
    inner = bpy.data.collections.new("inner")
    made = wedge()
    bpy.context.scene.collection.objects.unlink(made)
    inner.objects.link(made)
    for i in range(3):
        empty = stage.link(f"place {i}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", inner
        empty.location, empty.rotation_euler = (i - 1.0, 0.3 * i, 0.2 * i), (0.2 * i, 0.1, 0.5 * i)


def mirrored():
    made = wedge()
    made.scale, made.rotation_euler = (-1.0, 1.4, 0.8), (0.2, 0.3, 0.7)
    made.data.polygons.foreach_set("use_smooth", [True] * len(made.data.polygons))


def parents():
    parent = stage.link("parent", None)
    parent.rotation_euler, parent.scale, parent.location = (0.3, 0.1, 0.6), (1.5, 0.6, 1.0), (0.2, 0.1, 0.3)
    child = wedge()
    # Turned under a parent of uneven scale: sheared.
    child.parent, child.rotation_euler = parent, (0.4, 0.5, 0.2)


def modifiers():
    made = wedge()
    for kind, settings in (
        ("SUBSURF", {"levels": 1, "render_levels": 3}),
        ("ARRAY", {"count": 2, "relative_offset_displace": (1.1, 0.2, 0)}),
    ):
        made.modifiers.new(kind, kind).__class__
        for key, value in settings.items():
            setattr(made.modifiers[-1], key, value)
    made.scale = (0.7, 0.7, 0.9)
    made.location.x = -0.5


def sharp_edges():
    made = stage.ball(segments=12, made_of=stage.material("ball", **GREY))
    attribute = made.data.attributes.new("sharp_face", "BOOLEAN", "FACE")
    attribute.data.foreach_set("value", [i % 3 == 0 for i in range(len(made.data.polygons))])


def text():
    curve = bpy.data.curves.new("text", "FONT")
    curve.body, curve.extrude, curve.bevel_depth = "Hair", 0.1, 0.02
    curve.materials.append(stage.material("text", **GREY))
    made = stage.link("text", curve)
    made.location, made.rotation_euler = (-0.8, 0, 0.2), (math.radians(70), 0, 0)


def geometry_nodes():
    """A cube that is no object of its own, on the corners of a triangle."""
    mesh = bpy.data.meshes.new("points")
    mesh.from_pydata([(-0.9, 0, 0.4), (0.9, 0.2, 0.3), (0, 0.9, 0.7)], [], [(0, 1, 2)])
    made = stage.link("points", mesh)
    group = bpy.data.node_groups.new("group", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes, links = group.nodes, group.links
    begin, end, cube = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput"), nodes.new("GeometryNodeMeshCube")
    put, material = nodes.new("GeometryNodeInstanceOnPoints"), nodes.new("GeometryNodeSetMaterial")
    cube.inputs["Size"].default_value = (0.5, 0.3, 0.4)
    material.inputs["Material"].default_value = stage.material("cube", **GREY)
    links.new(cube.outputs[0], material.inputs["Geometry"])
    links.new(begin.outputs[0], put.inputs["Points"])
    links.new(material.outputs[0], put.inputs["Instance"])
    links.new(put.outputs[0], end.inputs[0])
    put.inputs["Rotation"].default_value = (0.3, 0.2, 0.5)
    made.modifiers.new("nodes", "NODES").node_group = group


@pytest.mark.parametrize("things", [geometry_nodes, collection_instances, mirrored, parents, modifiers, sharp_edges, text])
def test_pictures_are_those_of_cycles(things):
    stage.empty()
    stage.plane(made_of=stage.material("floor", base_color=(0.3, 0.3, 0.3), roughness=0.9))
    stage.light("SUN", 3.0, angle=0.1)
    stage.world(bpy.context.scene, (0.2, 0.2, 0.25))
    stage.camera()
    things()
    mean, rms = stage.apart(*stage.both())
    print(f"{things.__name__}: mean {100 * mean:+.2f} % rms {100 * rms:.1f} %")
    assert abs(mean) < 0.01 and rms < 0.08


def smooth_sides():
    """A cylinder whose caps are flat, without sharp edges."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=16, radius=0.6, depth=1.2, location=(0, 0, 0.6))
    made = bpy.context.object
    made.data.polygons.foreach_set("use_smooth", [len(p.vertices) == 4 for p in made.data.polygons])
    made.data.materials.append(stage.material("can", **GREY))
    return made


def test_smooth_sides_of_flat_caps_are_those_of_cycles_with_sharp_edges():
    """Without sharp edges Cycles takes the normals of vertices, bent by the caps. The viewport does not, nor does Hairline, which says so."""
    stage.empty()
    stage.light("SUN", 3.0, frm=(1.5, -3.0, 1.5), angle=0.1)
    stage.camera()
    mesh = smooth_sides().data
    ours = stage.picture("HAIRLINE")[..., :3]
    line = 'object "Cylinder": Cycles bends the shading of its smooth faces'
    assert line in "\n".join(addon.notes.last(bpy.context.scene))
    mean, rms = stage.apart(ours, stage.picture("CYCLES", 64)[..., :3])
    assert rms > 0.3
    caps = {key for p in mesh.polygons if len(p.vertices) > 4 for key in p.edge_keys}
    mesh.edges.foreach_set("use_edge_sharp", [tuple(sorted(edge.vertices)) in caps for edge in mesh.edges])
    mean, rms = stage.apart(*stage.both(64))
    assert line not in "\n".join(addon.notes.last(bpy.context.scene))
    assert abs(mean) < 0.01 and rms < 0.08


def test_a_mirror_image_is_seen():
    stage.empty()
    stage.plane(made_of=stage.material("floor", base_color=(0.3, 0.3, 0.3), roughness=0.9))
    stage.light("SUN", 3.0, angle=0.1)
    stage.camera()
    mirrored()
    ours = stage.picture("HAIRLINE")[..., :3]
    bpy.data.objects["wedge"].matrix_world = bpy.data.objects["wedge"].matrix_world @ Matrix.Scale(-1, 4, (1, 0, 0))
    assert stage.apart(ours, stage.picture("CYCLES")[..., :3])[1] > 0.16
