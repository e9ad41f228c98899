# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong is told by its name, and Blender lives on."""

import gc
import os
import sys
import time

import addon_under_test as addon
import bpy
import pytest
import stage


def refused():
    """The text of the error of a picture."""
    scene = bpy.context.scene
    scene.render.engine = "HAIRLINE"
    with pytest.raises(RuntimeError) as error:
        bpy.ops.render.render()
    return str(error.value)


def told():
    """What the last picture has not."""
    bpy.context.scene.render.engine = "HAIRLINE"
    bpy.ops.render.render()
    return "\n".join(addon.notes.last(bpy.context.scene))


def simple():
    stage.empty((48, 32))
    stage.plane(made_of=stage.material("floor"))
    stage.light("POINT", 100)
    stage.camera()


def test_no_mesh():
    stage.empty()
    stage.camera()
    assert 'scene "Scene": no object with a surface is shown to renders' in told()
    assert (stage.picture("HAIRLINE")[..., :3] == 0).all()


def test_no_camera():
    simple()
    bpy.context.scene.camera = None
    # Blender's own message.
    assert "no camera" in refused()


def test_an_orthographic_camera():
    simple()
    bpy.context.scene.camera.data.type = "ORTHO"
    assert 'camera "camera": found the type ORTHO' in refused()


def test_vertices_that_are_no_numbers():
    simple()
    bpy.data.objects["floor"].data.vertices[2].co.x = float("nan")
    message = refused()
    assert 'object "floor": found 1 of 4 vertices' in message
    # Blender lives on.
    bpy.data.objects["floor"].data.vertices[2].co.x = 3
    bpy.ops.render.render()


def test_nothing_is_raised_after_a_picture_that_failed(monkeypatch):
    simple()

    def mistake(*_):
        raise ValueError("made up")

    raised = []
    monkeypatch.setattr(sys, "unraisablehook", raised.append)
    monkeypatch.setattr(addon.rendering, "pixels", mistake)
    # Python keeps the last mistake with its engine: the second one lets the first go.
    for _ in range(2):
        assert "a mistake of its own: ValueError: made up" in refused()
        gc.collect()
    assert not raised, raised


def test_a_missing_image():
    simple()
    made = bpy.data.materials["floor"]
    node = made.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("wood", 4, 4)
    node.image.source, node.image.filepath = "FILE", "//gone.png"
    made.node_tree.links.new(node.outputs[0], stage.principled(made).inputs["Base Color"])
    line = told()
    assert 'material "floor": the file of the image "wood" is missing (//gone.png)' in line


def test_what_is_not_carried_over_is_told_by_name():
    simple()
    floor = bpy.data.materials["floor"]
    floor.node_tree.nodes["Principled BSDF"].inputs["Transmission Weight"].default_value = 0.5
    noise = floor.node_tree.nodes.new("ShaderNodeTexNoise")
    floor.node_tree.links.new(noise.outputs["Color"], stage.principled(floor).inputs["Base Color"])
    bpy.data.objects["lamp"].data.use_shadow = False
    bpy.data.objects["floor"].visible_glossy = False
    bpy.context.scene.render.use_motion_blur = True
    lines = told()
    for part in (
        'material "floor": transmission is not carried over',
        '"Base Color" by the node "Noise Texture"',
        'light "lamp": its shadows are switched off',
        'object "floor": it is hidden from glossy rays',
        "motion blur",
    ):
        assert part in lines, lines


def test_a_thing_too_far_off_is_named():
    simple()
    bpy.data.objects["floor"].location.x = 1e5
    message = refused()
    assert 'object "floor": found a coordinate of 1e+05 m' in message, message


def test_a_layer_that_cannot_be_is_named():
    simple()
    floor = bpy.data.objects["floor"]
    bpy.context.view_layer.objects.active = floor
    bpy.ops.hairline.add_layer(owner="object", preset="Turned pan")
    floor.hairline.scratches[0].axis = (0, 0, 0)
    message = refused()
    assert 'the layer "turned pan" of object "floor"' in message, message


def big(scratches):
    stage.empty((64, 48))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=708, y_subdivisions=708, size=2)
    grid = bpy.context.object
    grid.name = "big"
    grid.data.materials.append(stage.material("steel", metallic=1.0, roughness=0.2))
    bpy.ops.hairline.add_layer(owner="object", preset="Random wear")
    grid.hairline.scratches[0].count = scratches
    grid.hairline.scratches[0].length_m = 0.01
    stage.light("POINT", 100)
    stage.camera()


def test_a_million_triangles_with_a_million_scratches_announce_their_memory(capfd):
    big(1_000_000)
    bpy.context.scene.render.engine = "HAIRLINE"
    bpy.context.scene.hairline.shadows = False
    bpy.ops.render.render()
    said = capfd.readouterr().out
    assert "1,002,528 triangles" in said or "triangles" in said
    assert "1,000,000 scratches; about" in said and "GB of memory" in said


def test_more_scratches_than_memory_are_refused():
    big(2_000_000_000)
    message = refused()
    assert "big" in message or "memory" in message, message


def test_escape_ends_it_at_once(monkeypatch):
    simple()
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
    scene.hairline.samples = 512
    scene.render.engine = "HAIRLINE"
    start = time.monotonic()
    render = addon.rendering.render

    def stopped(made, table, settings, is_transparent, progress, is_stopped, *rest):
        # Headless there is no key to press: what the engine asks Blender is answered here.
        assert is_stopped() is False
        return render(made, table, settings, is_transparent, progress, lambda: time.monotonic() - start > 1.5, *rest)

    monkeypatch.setattr(addon.rendering, "render", stopped)
    bpy.ops.render.render()
    assert time.monotonic() - start < 6
    monkeypatch.undo()
    scene.render.resolution_x, scene.render.resolution_y = 48, 32
    scene.hairline.samples = 8
    assert stage.picture("HAIRLINE").shape == (32, 48, 4)


def test_a_million_triangles_are_exported_in_a_second():
    big(10)
    found = addon.notes.Notes()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    view = addon.camera.of_scene(bpy.context.scene, depsgraph, found)
    times = []
    for i in range(3):
        path = os.path.join(stage.FOLDER, f"export {i}")
        os.makedirs(path)
        # Of the processor: other programs may be at work.
        start = time.process_time()
        exported = addon.scene_export.export(bpy.context.scene, depsgraph, addon.folder.Folder(path, is_kept=False), view, found)
        times.append(time.process_time() - start)
    print(f"{exported.triangle_count} triangles in {min(times):.2f} s")
    assert exported.triangle_count > 1_000_000 and min(times) < 1.0
