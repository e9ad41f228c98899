"""The data model is that of scene files, and says what they say."""

import copy
import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import hairline
from conftest import lines_on_plate, plate_table


def test_a_scene_goes_through_a_dict_and_a_file_and_stays_the_same(tmp_path, scene):
    assert hairline.Scene.from_dict(scene.to_dict()).to_dict() == scene.to_dict()
    scene.save(tmp_path / "plate.toml")
    assert hairline.load(tmp_path / "plate.toml").to_dict() == scene.to_dict()
    assert [path.name for path in tmp_path.iterdir()] == ["plate.toml"]


def test_every_scene_of_the_repository_goes_through_its_own_text(repository, tmp_path):
    paths = sorted((repository / "scenes").glob("*.toml"))
    assert len(paths) >= 10
    for path in paths:
        scene = hairline.load(path)
        (tmp_path / "again.toml").write_text(scene.to_toml())
        assert hairline.load(tmp_path / "again.toml").to_dict() == scene.to_dict(), path.name


def test_attributes_are_the_keys_and_defaults_are_filled_in(scene):
    assert scene.camera.position_m == (0.0, -0.22, 0.30)
    assert scene.camera.fov_y_deg == 30.0
    assert scene.lights[0].radius_m == 0.02
    assert scene.lights[0].hidden is False
    assert scene.lights[0].temperature_k is None
    assert isinstance(scene.lights[0], hairline.SphereLight)
    assert scene.settings.size_px == (48, 32)
    assert scene.objects.named("plate").material == "steel"


def test_what_is_left_out_means_what_the_attribute_says(scene):
    """Keys that go without saying are not written; what reading them gives must be what they are."""
    tables = [
        hairline.Studio(),
        hairline.Ground(),
        *scene.lights,
        *scene.scratches,
        hairline.DiskLight(center_m=(0, 0, 1), target_m=(0, 0, 0), radius_m=0.1),
        hairline.RectangleLight(center_m=(0, 0, 1), target_m=(0, 0, 0), width_m=0.1, height_m=0.1),
        hairline.SunLight(direction=(0, 1, -1)),
    ]
    for table in tables:
        for key, value in type(table)._absent.items():
            if key in table.to_dict():
                continue
            again = copy.deepcopy(table)
            setattr(again, key, value)
            assert again == table, key
            assert getattr(again, key) == value


def test_a_studio_is_there_where_a_file_has_one(table):
    lit = hairline.Scene.from_dict(table)
    assert lit.studio is None and lit.ground is None
    lit.studio, lit.ground = hairline.Studio(intensity=0.5), hairline.Ground(height_m=-0.01)
    again = hairline.Scene.from_dict(lit.to_dict())
    assert (again.studio, again.ground) == (lit.studio, lit.ground)
    alone = hairline.Scene.from_dict({**table, "light": []})
    assert (alone.studio, alone.ground) == (hairline.Studio(), hairline.Ground())
    dark = hairline.Scene.from_dict({**table, "light": [], "studio": {"hidden": True}})
    assert dark.studio == hairline.Studio(hidden=True) and dark.ground is None
    for scene, is_lit in ((alone, True), (dark, False), (pickle.loads(pickle.dumps(dark)), False)):
        assert (scene.render(size=(16, 12), backend="cpu", samples=1, shadows=False).beauty.max() > 0) == is_lit


def test_a_lens_sees_by_the_shape_of_the_picture(scene):
    scene.settings.size_px = (40, 40)
    scene.camera.focal_length_mm = 50
    assert scene.camera.fov_y_deg is None and scene.camera.sensor_width_mm == 36
    angle = np.degrees(2 * np.arctan(0.5 * 36 / 50))
    assert hairline.Scene.from_dict(scene.to_dict()).camera.fov_y_deg == pytest.approx(angle)
    by_lens = scene.render(size=(24, 12), backend="cpu", samples=1, shadows=False)
    scene.camera.fov_y_deg = angle
    assert scene.camera.focal_length_mm is None
    by_angle = scene.render(size=(24, 12), backend="cpu", samples=1, shadows=False)
    np.testing.assert_allclose(by_lens.beauty, by_angle.beauty, rtol=1e-4)


def test_an_f_stop_is_an_opening(scene):
    scene.camera.update(focal_length_mm=50, f_stop=2)
    assert scene.camera.aperture_mm is None
    assert hairline.Scene.from_dict(scene.to_dict()).camera.aperture_mm == 25
    scene.camera.aperture_mm = 10
    assert scene.camera.f_stop is None
    with pytest.raises(hairline.SceneError, match="camera.f_stop: found no `focal_length_mm`"):
        scene.camera.update(f_stop=2, fov_y_deg=30)


def test_a_change_is_checked_at_once_and_a_wrong_one_changes_nothing(scene):
    with pytest.raises(hairline.SceneError) as caught:
        scene.camera.fov_y_deg = 200
    assert str(caught.value) == "camera.fov_y_deg: found 200; must be from 0.001 to 179"
    assert caught.value.key == "camera.fov_y_deg"
    assert caught.value.file is None and caught.value.line is None
    assert scene.camera.fov_y_deg == 30.0


def test_keys_that_only_fit_together_are_set_together(scene):
    material = scene.materials[0]
    material.update(metal=None, base_color=(0.9, 0.5, 0.2))
    assert material.metal is None and material.base_color == (0.9, 0.5, 0.2)


def test_what_is_read_back_cannot_be_changed_in_place(scene):
    with pytest.raises(TypeError):
        scene.camera.position_m[0] = 1.0


def test_an_array_is_a_vector(scene):
    scene.camera.position_m = np.array([0.0, -0.3, 0.2], dtype=np.float32).astype(np.float64)
    scene.camera.fov_y_deg = np.float64(25)
    assert scene.camera.fov_y_deg == 25.0
    assert scene.camera.position_m[1] == pytest.approx(-0.3)


def test_every_kind_of_light_is_made_and_appended(scene):
    lamps = [
        hairline.SphereLight(center_m=(0, 0.2, 0.3), radius_m=0.01, radiance=5),
        hairline.DiskLight(center_m=(0, 0.2, 0.3), target_m=(0, 0, 0), radius_m=0.01),
        hairline.RectangleLight(center_m=(0, 0.2, 0.3), target_m=(0, 0, 0), width_m=0.1, height_m=0.2),
        hairline.PolygonLight(vertices_m=np.array([[0, 0, 1], [0, 1, 1], [1, 0, 1.0]])),
        hairline.TubeLight(ends_m=[(0, 0, 1), (0, 1, 1)], radius_m=0.01),
        hairline.SunLight(direction=(0, 1, -1), angle_deg=2, irradiance=0.5),
    ]
    scene.lights.extend(lamps)
    again = hairline.Scene.from_dict(scene.to_dict())
    assert [type(light) for light in again.lights[1:]] == [type(lamp) for lamp in lamps]
    assert list(again.lights) == list(scene.lights)


def test_a_scene_can_be_written_in_python_alone():
    scene = hairline.Scene(
        camera=hairline.Camera(position_m=(0, -0.22, 0.3), target_m=(0, 0, 0), up=(0, 0, 1)),
        settings=hairline.Settings(size_px=(48, 32)),
        materials=[hairline.Material(name="steel", kind="metal", metal="steel", roughness=0.2)],
        objects=[hairline.Object(name="plate", shape={"disk": {"radius_m": 0.08}}, material="steel")],
        scratches=[hairline.Scratches(object="plate", pattern="random", count=300, width_um=4.0)],
        lights=[hairline.SphereLight(center_m=(0.06, 0.1, 0.25), radius_m=0.02, radiance=40)],
    )
    assert scene.to_dict() == hairline.Scene.from_dict(plate_table()).to_dict()


def test_errors_of_a_file_tell_file_line_and_key(tmp_path, scene):
    path = tmp_path / "plate.toml"
    text = scene.to_toml()
    path.write_text(text.replace("radius_m = 0.02", "radius_mm = 20.0"))
    with pytest.raises(hairline.SceneError) as caught:
        hairline.load(path)
    assert caught.value.file == str(path)
    assert "radius_mm" in path.read_text().splitlines()[caught.value.line - 1]
    assert caught.value.key == "light[0].radius_mm"
    assert caught.value.right == "did you mean `radius_m = 0.02`?"
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and again.line == caught.value.line

    path.write_text(text.replace('material = "steel"', 'material = "stele"'))
    with pytest.raises(hairline.SceneError, match=r'plate.toml:\d+: object\[0\].material: found no material called "stele"'):
        hairline.load(path)


def test_a_file_that_a_scene_names_and_is_not_there_is_told_with_its_line(tmp_path, scene):
    path = tmp_path / "plate.toml"
    text = scene.to_toml().replace("shape = { disk = { radius_m = 0.08 } }", 'mesh = "gone.glb"')
    assert "gone.glb" in text
    path.write_text(text)
    with pytest.raises(hairline.SceneError, match=r"plate.toml:\d+: object\[0\].mesh: \"gone.glb\""):
        hairline.load(path).build()


def test_scratches_from_arrays_are_those_of_a_file(tmp_path, scene):
    ends = lines_on_plate(200)
    rows = [",".join(map(repr, map(float, [*pair.ravel(), 3.5, 170.0]))) for pair in ends]
    header = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm"
    (tmp_path / "lines.csv").write_text("\n".join([header, *rows]))
    scene.folder = tmp_path
    scene.scratches = [hairline.Scratches(object="plate", pattern="file", file="lines.csv")]
    from_file = scene.render(backend="cpu")
    scene.scratches = [hairline.Scratches.from_arrays(object="plate", ends_m=ends, width_um=3.5, depth_nm=170.0)]
    from_arrays = scene.render(backend="cpu")
    assert from_file.scratches.max() > 0
    np.testing.assert_array_equal(from_file.beauty, from_arrays.beauty)


def test_a_mesh_from_arrays_is_rendered(scene):
    table = scene.to_dict()
    table["object"] = []
    plane = hairline.Object(name="plate", shape={"plane": {"size_m": [0.1, 0.1]}}, material="steel")
    scene.objects = [plane]
    shape = scene.render(backend="cpu", samples=1)
    corner = 0.05 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    scene.objects = [
        hairline.Object.from_arrays(
            name="plate", vertices_m=corner, triangles=[[0, 1, 2], [0, 2, 3]], material="steel"
        )
    ]
    scene.scratches = []
    mesh = scene.render(backend="cpu", samples=1)
    np.testing.assert_array_equal(mesh.depth_m, shape.depth_m)
    np.testing.assert_allclose(mesh.normal, shape.normal, atol=1e-6)


def test_arrays_in_memory_are_not_saved_without_a_word(scene):
    scene.scratches.append(
        hairline.Scratches.from_arrays(object="plate", ends_m=lines_on_plate(3), width_um=3, depth_nm=100)
    )
    with pytest.raises(hairline.SceneError, match=r"scratches\[1\].file: found an array in memory"):
        scene.to_toml()


def test_scenes_are_copied_and_pickled(scene):
    scene.scratches.append(
        hairline.Scratches.from_arrays(object="plate", ends_m=lines_on_plate(30), width_um=3, depth_nm=100)
    )
    image = scene.render(backend="cpu", samples=1)
    for again in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        np.testing.assert_array_equal(again.render(backend="cpu", samples=1).beauty, image.beauty)
        again.camera.fov_y_deg = 20
        assert scene.camera.fov_y_deg == 30


def test_scenes_are_equal_that_say_the_same(scene, tmp_path):
    same = hairline.Scene.from_dict(scene.to_dict())
    assert same == scene
    # Lists, tuples and arrays; a default that is written out.
    same.camera.position_m = np.array([0.0, -0.22, 0.30])
    same.camera.fov_y_deg = 30
    assert same == scene and not same != scene
    for seed in (1, 2):
        ends_m = lines_on_plate(20, seed)
        scene.scratches.append(hairline.Scratches.from_arrays(object="plate", ends_m=ends_m, width_um=3, depth_nm=100))
    same.scratches.extend(copy.deepcopy(list(scene.scratches)[1:]))
    assert same == scene
    same.scratches[-1] = same.scratches[-2]
    assert same != scene
    elsewhere = copy.deepcopy(scene)
    elsewhere.folder = tmp_path
    assert elsewhere != scene and scene != scene.to_dict()


def test_files_are_found_after_the_program_has_gone_to_another_folder(tmp_path, monkeypatch):
    table = plate_table()
    table["scratches"] = [{"object": "plate", "pattern": "file", "file": "s.csv"}]
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "s.csv").write_text("x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n-0.01,0,0,0.01,0,0,2,150\n")
    monkeypatch.chdir(tmp_path)
    hairline.Scene.from_dict(table, "a").save("a/scene.toml")
    scenes = [hairline.load("a/scene.toml"), hairline.Scene.from_dict(table, "a")]
    monkeypatch.chdir("/")
    for scene in scenes:
        assert scene.build().scratch_counts() == [1]
        assert copy.deepcopy(scene).build().scratch_counts() == [1]


def test_work_after_a_fork_is_refused_and_does_not_wait_for_ever():
    """In a process of its own: the one of the tests goes on."""
    code = """
import os, hairline
from conftest import plate_table
scene = hairline.Scene.from_dict(plate_table())
scene.render(size=(8, 8), backend="cpu")
child = os.fork()
if child == 0:
    try:
        scene.render(size=(8, 8), backend="cpu")
    except hairline.WorkError as error:
        os._exit(7 if "forked" in str(error) and "spawn" in str(error) else 8)
    os._exit(9)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
"""
    run = subprocess.run([sys.executable, "-c", code], cwd=Path(__file__).parent, timeout=60, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


def test_nothing_is_said_of_a_display(tmp_path):
    environment = {name: value for name, value in os.environ.items() if name != "XDG_RUNTIME_DIR"}
    code = "import hairline, conftest; hairline.Scene.from_dict(conftest.plate_table()).render(size=(8, 8))"
    run = subprocess.run([sys.executable, "-c", code], cwd=Path(__file__).parent, env=environment, capture_output=True, text=True)
    assert run.returncode == 0 and "XDG_RUNTIME_DIR" not in run.stderr, run.stderr


def test_bounds_are_the_box_around_the_objects(scene):
    least, most = scene.bounds
    assert least == pytest.approx((-0.08, -0.08, 0), abs=1e-6) and most == pytest.approx((0.08, 0.08, 0), abs=1e-6)


def test_notebooks_show_scenes(scene):
    assert scene.thumbnail().size == (240, 160)
    assert scene._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(hairline.SceneError, match="width: found 3; must be a whole number from 16 to 1024"):
        scene.thumbnail(3)


def test_threads_are_set_before_any_work():
    code = "import hairline; hairline.set_threads(3); print(hairline.threads())"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.split() == ["3"]
    assert hairline.threads() >= 1
    with pytest.raises(hairline.SceneError, match="at work already; must be set before any other work"):
        hairline.set_threads(2)
    with pytest.raises(hairline.SceneError, match="threads: found 0; must be a whole number from 1 to 1024"):
        hairline.set_threads(0)
