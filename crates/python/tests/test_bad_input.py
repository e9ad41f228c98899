"""What is wrong is told clearly: where, what was found, what would be right."""

import decimal

import numpy as np
import pytest

import hairline
from conftest import lines_on_plate, plate_table

ENDS = lines_on_plate(5)
NAN_ENDS = ENDS.copy()
NAN_ENDS[3, 1, 2] = np.nan


class Foreign:
    """As a tensor of another library: it has numbers, and is none of numpy's."""

    def tolist(self):
        return [0.0, 0.0, 1.0]


def changed(section, index, **keys):
    table = plate_table()
    target = table[section] if index is None else table[section][index]
    target.update(keys)
    return table


@pytest.mark.parametrize(
    "table, message",
    [
        (changed("light", 0, radius_m="0.02"), 'light[0].radius_m: found the text "0.02"; must be a number (metres)'),
        (changed("light", 0, radius_m=float("nan")), "light[0].radius_m: found NaN; must be finite"),
        (changed("light", 0, radius_m=True), "light[0].radius_m: found `true`; must be a number (metres)"),
        (changed("light", 0, radius_m=None), "light[0]: `radius_m` is missing; `light[0]` needs it"),
        (changed("light", 0, center_m=[0.0, 1.0]), "light[0].center_m: found an array of 2; must be an array of 3 numbers"),
        (changed("light", 0, center_m=np.zeros((2, 3))), "light[0].center_m: found an array of 2; must be an array of 3"),
        (changed("light", 0, center_m=np.array(["a", "b", "c"])), 'light[0].center_m[0]: found the text "a"'),
        (changed("light", 0, center_m=Foreign()), "light[0].center_m: found an object of type"),
        (changed("light", 0, radius_m=decimal.Decimal("0.1")), "light[0].radius_m: found an object of type decimal.Decimal"),
        (changed("light", 0, radius_m=1j), "light[0].radius_m: found an object of type complex"),
        (changed("light", 0, radiance=-1), "light[0].radiance: found -1; must be 0 or greater"),
        (changed("light", 0, kind="spher"), 'light[0].kind: found the text "spher"; did you mean `sphere`?'),
        (changed("scratches", 0, seed=2**64), "scratches[0].seed: found the whole number 18446744073709551616"),
        (changed("scratches", 0, count=2.5), "scratches[0].count: found the number 2.5; must be a whole number"),
        (changed("camera", None, position_m=[0, 0, [1]]), "camera.position_m[2]: found an array of 1; must be a number"),
        (changed("object", 0, shape={"disc": {"radius_m": 1}}), "object[0].shape.disc: unknown key; did you mean `disk`?"),
        (changed("object", 0, material="stele"), 'object[0].material: found no material called "stele"; did you mean "steel"?'),
        ({"camera": {}}, "camera: `position_m` is missing"),
        ({**plate_table(), "lights": []}, "lights: unknown key; did you mean `light`?"),
        ({**plate_table(), 7: []}, "found a key of type int"),
        ({**plate_table(), "light": {"kind": "sphere"}}, "light: found a table; must be written `[[light]]`"),
    ],
)
def test_wrong_scenes(table, message):
    with pytest.raises(hairline.SceneError) as caught:
        hairline.Scene.from_dict(table)
    assert message in str(caught.value)


def test_a_table_that_holds_itself_is_refused():
    table = plate_table()
    table["camera"]["position_m"] = [table["camera"]]
    with pytest.raises(hairline.SceneError, match="found tables without end"):
        hairline.Scene.from_dict(table)


@pytest.mark.parametrize("table", [None, [], "scene", 3])
def test_what_is_no_table_is_no_scene(table):
    with pytest.raises(hairline.SceneError, match="must be a dict"):
        hairline.Scene.from_dict(table)


@pytest.mark.parametrize(
    "keys, message",
    [
        (dict(ends_m=ENDS[:, 0]), "ends_m: found an array of shape 5 x 3; must be of shape n x 2 x 3"),
        (dict(ends_m=NAN_ENDS), "ends_m[3][1][2]: found NaN; must be finite"),
        (dict(ends_m=ENDS.astype(str)), "ends_m: found texts; must be an array of numbers"),
        (dict(ends_m=[[0, 1], [2]]), "ends_m: found list"),
        (dict(ends_m=Foreign()), "ends_m: found an object of type"),
        (dict(ends_m=ENDS.astype(complex)), "ends_m: found values of type complex128"),
        (dict(width_um=np.ones(4)), "width_um: found 4 numbers for 5 scratches; must be one for each, or one for all"),
        (dict(width_um=[1, 2, 3, 4, np.nan]), "width_um[4]: found NaN; must be from 0.05 to 100"),
        (dict(width_um=500.0), "width_um: found 500; must be from 0.05 to 100"),
        (dict(depth_nm="deep"), "depth_nm: found texts"),
        (dict(depth_nm=-1), "depth_nm: found -1; must be from 0 to 2000"),
        (dict(depth_nm=None), "depth_nm: found an object of type builtins.NoneType"),
        (dict(ends_m=np.ma.masked_greater(ENDS, 0)), "ends_m: found masked values; must be an array of numbers, all of them known"),
        (dict(ends_m=ENDS[:, [0, 0]]), "ends_m[0]: found both ends at one point; must be two points"),
    ],
)
def test_wrong_arrays_of_scratches(keys, message):
    with pytest.raises(hairline.SceneError) as caught:
        hairline.Scratches.from_arrays(**{"object": "plate", "ends_m": ENDS, "width_um": 3.0, "depth_nm": 100.0, **keys})
    assert message in str(caught.value)


def test_scratches_off_the_surface_are_told_by_their_index(scene):
    ends = ENDS.copy()
    ends[2, 1, 2] = 0.5
    scene.scratches = [hairline.Scratches.from_arrays(object="plate", ends_m=ends, width_um=3, depth_nm=100)]
    with pytest.raises(hairline.SceneError, match=r"scratches\[0\].ends_m\[2\]\[1\]: found a point 50.0 cm off"):
        scene.render()


CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])


@pytest.mark.parametrize(
    "keys, message",
    [
        (dict(vertices_m=CORNERS[:, :2]), "vertices_m: found an array of shape 3 x 2; must be of shape n x 3"),
        (dict(vertices_m=CORNERS + np.inf), "vertices_m[0][0]: found inf; must be finite"),
        (dict(triangles=[[0, 1, 3]]), "triangles[0]: found vertex 3 of 3; must be below the number of vertices"),
        (dict(triangles=[[0, 1, -1]]), "triangles: found -1; must be from 0 to 2^32 - 1"),
        (dict(triangles=[[0.0, 1.0, 2.0]]), "triangles: found numbers of type float64; must be whole numbers"),
        (dict(triangles=np.zeros((0, 3), int)), "triangles: found none; must have a surface"),
        (dict(normals=CORNERS[:2]), "normals: found 2 rows for 3 vertices"),
        (dict(uvs=CORNERS), "uvs: found an array of shape 3 x 3; must be of shape n x 2"),
    ],
)
def test_wrong_arrays_of_a_mesh(keys, message):
    with pytest.raises(hairline.SceneError) as caught:
        mesh = {"vertices_m": CORNERS, "triangles": [[0, 1, 2]], "material": "steel", "name": "mesh"}
        hairline.Object.from_arrays(**{**mesh, **keys})
    assert message in str(caught.value)


def test_a_mesh_in_memory_has_no_keys_of_files(scene):
    mesh = hairline.Object.from_arrays(name="mesh", vertices_m=CORNERS, triangles=[[0, 1, 2]], material="steel")
    with pytest.raises(hairline.SceneError, match="object.fit_m: a mesh in memory has no such key"):
        mesh.fit_m = 0.1
    mesh.material = None
    scene.objects = [mesh]
    scene.scratches = []
    with pytest.raises(hairline.SceneError, match=r"object\[0\]: `material` is missing"):
        scene.render()


@pytest.mark.parametrize(
    "keys, message",
    [
        (dict(size=(0, 10)), "render.size_px"),
        (dict(size=(10, 10, 10)), "render.size_px: found an array of 3; must be an array of 2 numbers"),
        (dict(size=("a", 10)), 'render.size_px[0]: found the text "a"'),
        (dict(size=(20000, 10)), "render.size_px"),
        (dict(size=7), "render.size_px: found the whole number 7"),
        (dict(backend="cuda"), 'backend: found "cuda"; must be one of "auto", "gpu", "cpu"'),
        (dict(backend=None), "backend: found None; must be a text"),
        (dict(samples=0), "samples: found 0; must be a whole number from 1 to 1024"),
        (dict(samples="8"), "samples: found '8'; must be a whole number"),
        (dict(samples=8.0), "samples: found 8.0; must be a whole number"),
        (dict(samples=True), "samples: found True; must be a whole number"),
        (dict(shadows="on"), "shadows: found 'on'; must be True or False"),
        (dict(bounces=2, shadows=False), "bounces: found 2; add shadows=True"),
    ],
)
def test_wrong_arguments_of_a_render(scene, keys, message):
    with pytest.raises(hairline.SceneError) as caught:
        scene.render(**keys)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    "keys, message",
    [
        (dict(model="exact"), 'model: found "exact"; must be one of "separable", "full"'),
        (dict(time_s=0), "time_s: found 0; must be a number of seconds above 0"),
        (dict(time_s=float("nan")), "time_s: found nan"),
        (dict(time_s="60"), "time_s: found '60'; must be a number of seconds above 0"),
        (dict(samples=-1), "samples: found -1"),
        (dict(sample_seed=-1), "sample_seed: found -1"),
        (dict(resume=3), "resume: found int; must be a hairline.Image"),
    ],
)
def test_wrong_arguments_of_a_reference(scene, keys, message):
    with pytest.raises(hairline.SceneError) as caught:
        scene.reference(size=(8, 8), **keys)
    assert message in str(caught.value)


def test_a_scene_takes_tables_of_its_own_alone(scene):
    with pytest.raises(hairline.SceneError, match="light: found an object of type builtins.dict; must be a hairline.Light"):
        scene.lights.append({"kind": "sphere"})
    with pytest.raises(hairline.SceneError, match="must be a hairline.Light"):
        scene.lights[0] = scene.materials[0]
    with pytest.raises(hairline.SceneError, match="must be a hairline.Camera"):
        scene.camera = (0, 0, 1)
    with pytest.raises(AttributeError, match="no attribute 'light'"):
        scene.light = []
    with pytest.raises(hairline.SceneError, match="camera.postion_m: unknown key; did you mean `position_m`?"):
        scene.camera.postion_m = (0, 0, 1)


def test_lists_of_tables_are_lists(scene):
    lamp = scene.lights[0]
    for wrong, found in ((lamp, "hairline._keys.SphereLight"), (None, "builtins.NoneType"), ({"light": lamp}, "builtins.dict")):
        with pytest.raises(hairline.SceneError, match=f"lights: found an object of type {found}; must be a list of hairline.Light"):
            scene.lights = wrong
    with pytest.raises(KeyError, match="no light is called 'key'; there are none"):
        scene.lights.named("key")


def test_a_lamp_stays_of_its_kind(scene):
    with pytest.raises(hairline.SceneError, match="light.kind: found 'disk'; a SphereLight has 'sphere' always"):
        hairline.SphereLight(kind="disk", center_m=(0, 0, 1), radius_m=0.1)
    with pytest.raises(hairline.SceneError, match="light.kind: found 'disk'"):
        scene.lights[0].update(kind="disk")
    with pytest.raises(TypeError, match="SphereLight takes its keys by their names"):
        hairline.SphereLight((0, 0, 1), 0.1)


def test_arrays_are_no_files():
    with pytest.raises(hairline.SceneError, match="object.mesh: found an object of type numpy.ndarray; .*Object.from_arrays"):
        hairline.Object(name="mesh", mesh=CORNERS, material="steel")


def test_a_lens_and_an_angle_are_not_given_together():
    camera = {"position_m": (0, 0, 1), "target_m": (0, 0, 0)}
    with pytest.raises(hairline.SceneError, match="camera.fov_y_deg: found 22.9 beside focal_length_mm; leave out one of them"):
        hairline.Camera(**camera, focal_length_mm=50, fov_y_deg=22.9)
    assert hairline.Camera(**camera, sensor_width_mm=24, fov_y_deg=20).fov_y_deg == 20
    with pytest.raises(hairline.SceneError, match="camera.sensor_width_mm: found 0; must be from 0.1 to 1000"):
        hairline.Camera(**camera, sensor_width_mm=0)


@pytest.mark.parametrize("exposure_ev, found", [("1", "found '1'"), (float("nan"), "found nan"), (100, "found 100"), (None, "found None")])
def test_stops_are_numbers(scene, tmp_path, exposure_ev, found):
    image = scene.render(size=(8, 8), backend="cpu", samples=1, shadows=False)
    right = "exposure_ev: " + found + "; must be a number of stops from -64 to 64"
    with pytest.raises(hairline.SceneError, match=right):
        hairline.compare(image, image, exposure_ev=exposure_ev)
    # None stands for the scene's own value there.
    if exposure_ev is not None:
        with pytest.raises(hairline.SceneError, match=right):
            image.save(tmp_path / "picture.png", exposure_ev=exposure_ev)


def test_a_progress_that_is_no_function_is_refused(scene):
    with pytest.raises(TypeError, match="progress: found 3"):
        scene.render(progress=3)


def test_what_is_no_picture_is_not_compared(scene):
    image = scene.render(size=(8, 8), backend="cpu")
    with pytest.raises(hairline.SceneError, match="b: found an object of type numpy.ndarray"):
        hairline.compare(image, image.beauty)
