# SPDX-License-Identifier: GPL-3.0-or-later
"""Scratches and gratings: stored, animated, exported, imported."""

import os

import bpy
import hairline
import numpy as np
import OpenEXR
import pytest
import stage

STEEL = {"base_color": (0.6, 0.6, 0.62), "metallic": 1.0, "roughness": 0.2}


def plate():
    """A round plate of 20 cm under a small lamp whose mirror image lies on it."""
    scene = stage.empty((160, 120))
    bpy.ops.mesh.primitive_circle_add(vertices=64, radius=0.1, fill_type="NGON")
    made = bpy.context.object
    made.name = "plate"
    made.data.materials.append(stage.material("steel", **STEEL))
    stage.camera(frm=(0, -0.35, 0.25), at=(0, 0, 0), lens=60)
    stage.light("POINT", 3.0, frm=(0.02, 0.3, 0.25), at=(0, 0, 0), shadow_soft_size=0.005)
    scene.hairline.shadows = False
    return made


def add(item, kind="scratches", preset="Turned pan", owner="object"):
    bpy.context.view_layer.objects.active = item
    operator = bpy.ops.hairline.add_layer if kind == "scratches" else bpy.ops.hairline.add_grating
    assert operator(owner=owner, preset=preset) == {"FINISHED"}
    surface = item.hairline if owner == "object" else item.active_material.hairline
    return (surface.scratches if kind == "scratches" else surface.gratings)[-1]


def layer_of(name):
    """A layer of the picture, rows from the top."""
    render = bpy.context.scene.render
    settings = render.image_settings
    render.engine = "HAIRLINE"
    # Since Blender 5.0 the type of the medium comes first.
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format = "OPEN_EXR_MULTILAYER"
    settings.color_depth = "32"
    path = os.path.join(stage.FOLDER, "layers.exr")
    render.filepath = path
    bpy.ops.render.render(write_still=True)
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    return multilayer(path)[name]


def multilayer(path):
    """The channels of Blender's EXR, by the name of the pass."""
    found = {}
    # Blender 4.5 writes all passes into one part, 5.0 each into its own.
    for part in OpenEXR.File(path, separate_channels=True).parts:
        for name, channel in part.channels.items():
            _, of_pass, letter = name.split(".")
            found.setdefault(of_pass, {})[letter] = channel.pixels
    return {name: np.dstack([of[letter] for letter in sorted(of, key="RGBAXYZ".index)]) for name, of in found.items()}


def exported(name="scene"):
    folder = os.path.join(stage.FOLDER, name)
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "scene.toml")
    assert bpy.ops.hairline.export(filepath=path) == {"FINISHED"}
    return path


def test_scratches_are_those_of_the_scene_file():
    item = plate()
    add(item)
    add(item, preset="Random wear", owner="material")
    add(item, "grating", "Turned steel")
    # Turned, moved and scaled: scratches go with the object.
    item.rotation_euler, item.scale, item.location = (0.1, -0.05, 0.4), (1.1, 0.9, 1.0), (0.01, 0.0, 0.005)
    ours = layer_of("Hairline Scratches")
    path = exported()
    theirs = hairline.load(path).render(shadows=False).scratches
    assert theirs.mean() > 1e-4
    assert stage.apart(ours, theirs)[1] < 1e-3


def test_another_seed_is_seen():
    item = plate()
    layer = add(item)
    path = exported()
    layer.seed += 1
    assert stage.apart(layer_of("Hairline Scratches"), hairline.load(path).render(shadows=False).scratches)[1] > 0.05


def test_layers_are_kept_in_the_blend_file():
    item = plate()
    add(item, preset="Spun disk")
    add(item, "grating", "DVD", "material")
    before = layer_of("Hairline Scratches")
    path = os.path.join(stage.FOLDER, "kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    plate()
    bpy.ops.wm.open_mainfile(filepath=path)
    item = bpy.data.objects["plate"]
    assert [layer.name for layer in item.hairline.scratches] == ["spun disk"]
    assert [grating.name for grating in item.active_material.hairline.gratings] == ["dvd"]
    assert np.array_equal(before, layer_of("Hairline Scratches"))
    copy = item.copy()
    assert copy.hairline.scratches[0].pattern == "spun"


def test_keyframes_move_depth_density_and_lamp():
    item = plate()
    layer = add(item)
    layer.depth_nm = 60
    layer.keyframe_insert("depth_nm", frame=1)
    layer.depth_nm = 180
    layer.keyframe_insert("depth_nm", frame=3)
    layer.count = 500
    layer.keyframe_insert("count", frame=1)
    layer.count = 2000
    layer.keyframe_insert("count", frame=3)
    scene = bpy.context.scene
    pictures = []
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        pictures.append(layer_of("Hairline Scratches"))
    means = [picture.mean() for picture in pictures]
    assert means[0] < means[1] < means[2]


def test_an_animation_writes_its_frames():
    item = plate()
    add(item)
    scene = bpy.context.scene
    scene.render.engine = "HAIRLINE"
    scene.frame_start, scene.frame_end = 1, 2
    scene.render.filepath = os.path.join(stage.FOLDER, "frame-")
    bpy.ops.render.render(animation=True)
    assert all(os.path.exists(os.path.join(stage.FOLDER, f"frame-000{i}.exr")) for i in (1, 2))


def test_import_lays_what_export_wrote():
    item = plate()
    layer = add(item, preset="Worn cutlery")
    layer.edges, layer.edge_width_m, layer.profile = 0.5, 0.01, "round"
    add(item, preset="Brushed steel", owner="material")
    add(item, "grating", "Engine turning").has_ring = True
    path = exported("again")
    before = hairline.load(path).to_dict()
    item.hairline.scratches.clear()
    item.hairline.gratings.clear()
    item.active_material.hairline.scratches.clear()
    assert bpy.ops.hairline.import_layers(filepath=path) == {"FINISHED"}
    after = hairline.load(exported("again")).to_dict()
    assert before["scratches"] == after["scratches"] and before["grating"] == after["grating"]


def test_wear_replaces_wear_and_leaves_other_layers():
    item = plate()
    add(item)
    for wear, names in (("Old", 4), ("Used", 2), ("New", 0)):
        bpy.ops.hairline.wear(owner="object", wear=wear)
        assert len(item.hairline.scratches) == names + 1
    assert item.hairline.scratches[0].name == "turned pan"


@pytest.mark.parametrize("kind", ["scratches", "grating"])
def test_every_preset_comes_through_the_properties_as_it_is(kind):
    from hairline import editing

    item = plate()
    for preset in editing.presets(kind):
        add(item, kind, preset.name)
    tables = getattr(hairline.load(exported("presets")), "scratches" if kind == "scratches" else "gratings")
    wanted = [
        made.to_dict() for p in editing.presets(kind) for made in editing.from_preset(kind, p.name, "plate", float(np.linalg.norm(item.dimensions)))
    ]
    for found, right in zip(tables, wanted, strict=True):
        found = found.to_dict()
        for key, value in right.items():
            flat = lambda v: np.hstack([np.ravel(x) for x in v.values()]) if isinstance(v, dict) else v
            if key != "seed":
                assert found[key] == value or np.allclose(flat(found[key]), flat(value), rtol=1e-5, atol=1e-9), (preset, key)


def test_masks_and_vertex_groups_keep_scratches_to_their_places():
    item = plate()
    layer = add(item, preset="Random wear")
    item.data.uv_layers.active.data.foreach_set(
        "uv", np.array([[0.5 + 5 * v.co.x, 0.5 + 5 * v.co.y] for v in (item.data.vertices[l.vertex_index] for l in item.data.loops)]).ravel()
    )
    whole = layer_of("Hairline Density")
    # The right half, by an image.
    values = np.zeros((64, 64, 3))
    values[:, 32:] = 1
    layer.mask = stage.image_of(values, "half", data=True)
    right = layer_of("Hairline Density")
    middle = whole.shape[1] // 2
    assert right[:, : middle - 6].sum() < 0.02 * right.sum() and right.sum() > 0.3 * whole.sum()
    # The left half, by weights; subdivided, since weights are those of vertices.
    layer.mask = None
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=40, y_subdivisions=40, size=0.2)
    grid = bpy.context.object
    item.hide_render = True
    grid.data.materials.append(item.data.materials[0])
    layer = add(grid, preset="Random wear")
    group = grid.vertex_groups.new(name="left")
    group.add([v.index for v in grid.data.vertices if v.co.x < 0], 1.0, "REPLACE")
    layer.vertex_group = "left"
    left = layer_of("Hairline Density")
    assert left[:, middle + 8 :].sum() < 0.03 * left.sum() and left.sum() > 0


_LINE_M = [(x, 0.0, 0.0) for x in (-0.06, -0.02, 0.02, 0.06)]


def curve():
    data = bpy.data.curves.new("stroke", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(3)
    for point, place in zip(spline.points, _LINE_M):
        point.co = (*place, 1)
    return stage.link("stroke", data)


def grease_pencil():
    pencils = bpy.data.grease_pencils_v3 if hasattr(bpy.data, "grease_pencils_v3") else bpy.data.grease_pencils
    data = pencils.new("stroke")
    drawing = data.layers.new("layer").frames.new(1).drawing
    drawing.add_strokes([len(_LINE_M)])
    for point, place in zip(drawing.strokes[0].points, _LINE_M):
        point.position = place
    return stage.link("stroke", data)


@pytest.mark.parametrize("make", [curve, grease_pencil])
def test_lines_become_strokes(make):
    item = plate()
    layer = add(item, preset="Random wear")
    layer.strokes, layer.pattern = make(), "drawn"
    layer.brush_radius_m, layer.brush_density_per_m, layer.length_m = 0.01, 8000, 0.01
    density = layer_of("Hairline Density").sum(axis=2)
    rows = np.flatnonzero(density.sum(axis=1) > 0.01 * density.sum(axis=1).max())
    # A band of a fifth of the plate's 20 cm.
    assert 3 < len(rows) < 0.35 * density.shape[0]


def test_linked_objects_keep_their_layers_and_overrides_change_them():
    add(plate(), preset="Spun disk")
    library, file = (os.path.join(stage.FOLDER, name) for name in ("library.blend", "user.blend"))
    bpy.ops.wm.save_as_mainfile(filepath=library)
    scene = stage.empty()
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.objects = ["plate"]
    linked = wanted.objects[0]
    scene.collection.objects.link(linked)
    assert linked.hairline.scratches[0].pattern == "spun"
    override = linked.override_create(remap_local_usages=True)
    override.hairline.scratches[0].depth_nm = 99
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    assert bpy.data.objects["plate", None].hairline.scratches[0].depth_nm == pytest.approx(99)
    assert bpy.data.objects["plate", "//library.blend"].hairline.scratches[0].depth_nm != pytest.approx(99)
