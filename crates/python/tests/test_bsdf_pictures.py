"""The reflection by itself against pictures of plates at the same angles."""

import math

import numpy as np
import pytest

import hairline
from hairline.bsdf import Grating, Scratched

PLATE = {"ior": 1.58, "thickness_mm": 1.2, "color": [0.7, 0.8, 0.95]}
ROW = {"pitch_um": 1.6, "width_um": 0.6, "depth_nm": 110.0}
FINE = {"pitch_um": 0.74, "width_um": 0.3, "depth_nm": 60.0}
SIZE = (6, 4)
DISTANCE_M = 0.6


def direction(angle_deg, turn_deg):
    a, t = math.radians(angle_deg), math.radians(turn_deg)
    return np.array([math.sin(a) * math.cos(t), math.sin(a) * math.sin(t), math.cos(a)])


def plate(material, **tables):
    """A plate from afar, with a lamp beside its mirror direction and one that the first order of rows or the band of scratches meets."""
    lamp = {"kind": "sphere", "radius_m": 0.08, "radiance": 20.0}
    towards = (direction(26, 95), direction(22, 268))
    return hairline.Scene.from_dict(
        {
            "camera": {"position_m": (DISTANCE_M * direction(20, 270)).tolist(), "target_m": [0, 0, 0], "up": [0, 0, 1], "fov_y_deg": 1.5},
            "render": {"size_px": list(SIZE)},
            "material": [{"name": "plate", "kind": "metal", "roughness": 0.3, **material}],
            "object": [{"name": "plate", "shape": {"plane": {"size_m": [0.06, 0.06]}}, "material": "plate"}],
            "light": [{**lamp, "center_m": (DISTANCE_M * it).tolist()} for it in towards],
            **tables,
        }
    )


def row(grating, **keys):
    return [{"object": "plate", "pattern": "parallel", "direction": [1, 0, 0], "jitter_deg": 3.0, **grating, **keys}]


def seen(scene, material, part, count=4000):
    """The layer of each pixel: the integral over the lamps of what the reflection sends from each direction in them to the camera."""
    # Even over a cap: a spiral of Fibonacci's, another one in each pixel.
    even, random = np.arange(count), np.random.default_rng(1)
    camera = np.array(scene.camera.position_m)
    forward = -camera / np.linalg.norm(camera)
    right = np.cross(forward, [0, 0, 1]) / np.linalg.norm(np.cross(forward, [0, 0, 1]))
    up = np.cross(right, forward)
    half = math.tan(math.radians(scene.camera.fov_y_deg) / 2)
    made = np.zeros((SIZE[1], SIZE[0], 3))
    for y in range(SIZE[1]):
        for x in range(SIZE[0]):
            at = ((2 * x + 1 - SIZE[0]) / SIZE[1] * half, (SIZE[1] - 2 * y - 1) / SIZE[1] * half)
            ray = forward + at[0] * right + at[1] * up
            place = camera - ray * camera[2] / ray[2]
            wo = camera - place
            wo /= np.linalg.norm(wo)
            for lamp in scene.lights:
                way = np.array(lamp.center_m) - place
                away = np.linalg.norm(way)
                axis, least = way / away, math.sqrt(1 - (lamp.radius_m / away) ** 2)
                z = least + (1 - least) * (even + random.uniform()) / count
                phi = math.pi * (3 - math.sqrt(5)) * even + random.uniform(0, 2 * math.pi)
                side = np.cross(axis, [1, 0, 0])
                side /= np.linalg.norm(side)
                radius = np.sqrt(1 - z * z)[:, None]
                wi = z[:, None] * axis + radius * (np.cos(phi)[:, None] * side + np.sin(phi)[:, None] * np.cross(axis, side))
                wi /= np.linalg.norm(wi, axis=1)[:, None]
                made[y, x] += lamp.radiance * 2 * math.pi * (1 - least) * material.eval(wi, wo, part=part).mean(axis=0)
    return made


def off(found, right):
    """The difference of the means of a layer over the plate, of the brightest channel."""
    found, right = found.mean(axis=(0, 1)), right.mean(axis=(0, 1))
    return np.abs(found - right).max() / right.max()


COATED = {"metal": "gold", "clearcoat": 0.7, "clearcoat_roughness": 0.15}
COVERED = {"metal": "gold", "cover": PLATE}
CASES = {
    "row in a coat": (COATED, row(ROW, coverage=0.5), Grating(**ROW, coverage=0.5, angle_std_deg=3)),
    "fine row": ({"metal": "gold"}, row(FINE, coverage=0.5), Grating(**FINE, coverage=0.5, angle_std_deg=3)),
    "fine row under a plate": (COVERED, row(FINE, coverage=0.5), Grating(**FINE, coverage=0.5, angle_std_deg=3)),
    "scalar row under a plate": (COVERED, row(ROW, coverage=0.5, theory="scalar"), Grating(**ROW, coverage=0.5, angle_std_deg=3, theory="scalar")),
}
WRONG = {
    "row in a coat": {"clearcoat": 0.6},
    "fine row": {"gratings": [Grating(**FINE, coverage=0.5, angle_std_deg=3, theory="scalar")]},
    "fine row under a plate": {"cover": {**PLATE, "ior": 1.45}},
    "scalar row under a plate": {"cover": {**PLATE, "ior": 1.45}},
}


@pytest.mark.parametrize("name", CASES)
def test_gratings_are_those_of_the_reference(name):
    keys, gratings, grating = CASES[name]
    scene = plate(keys, grating=gratings)
    truth = scene.reference(size=SIZE, samples=4096, shadows=False)
    of = {"roughness": 0.3, "gratings": [grating], **{key: value for key, value in keys.items() if key != "metal"}}
    material = Scratched(keys["metal"], **of)
    wrong = Scratched(keys["metal"], **{**of, **WRONG[name]})
    differences = {}
    for part in ("base", "scratches"):
        right = getattr(truth, part)
        differences[part] = off(seen(scene, material, part), right), off(seen(scene, wrong, part), right)
    print(name, differences)
    assert all(of < 0.02 for of, _ in differences.values()), differences
    assert max(of for _, of in differences.values()) > 0.06, differences


@pytest.mark.parametrize("keys", [COATED, COVERED], ids=["in a coat", "under a plate"])
def test_scratches_are_the_mean_of_a_picture(keys):
    scratches = {"object": "plate", "pattern": "parallel", "direction": [1, 0, 0], "jitter_deg": 8.0, "count": 60_000}
    sizes = {"length_m": 4e-3, "width_um": 1.5, "depth_nm": 150.0}
    scene = plate(keys, scratches=[{**scratches, **sizes}])
    picture = scene.render(size=SIZE, backend="cpu", shadows=False)
    material = Scratched.from_scene(scene, "plate")
    assert (material.clearcoat, material.cover is None) == (keys.get("clearcoat"), "cover" not in keys)
    bare = Scratched("gold", roughness=0.3, layers=material.layers)
    differences = {}
    for part in ("base", "scratches"):
        right = getattr(picture, part)
        differences[part] = off(seen(scene, material, part), right), off(seen(scene, bare, part), right)
    print(differences)
    # The places of the scratches leave noise.
    assert differences["base"][0] < 0.02 and differences["scratches"][0] < 0.03, differences
    assert min(of for _, of in differences.values()) > 0.1, differences


@pytest.mark.parametrize("keys", [COATED, COVERED], ids=["in a coat", "under a plate"])
def test_scratches_by_position_have_the_same_layers_over_them(keys):
    """What Mitsuba is given of a scene, at a point without scratches."""
    scene = plate(keys, scratches=[{"object": "plate", "pattern": "random", "count": 1, "length_m": 1e-4, "seed": 3}])
    at = scene.build().bsdf("plate")
    wi, wo = np.array([direction(30, 80), direction(50, 10)]), np.array([direction(20, 270)] * 2)
    frames = np.tile(np.concatenate([[0.02, 0.02, 0], np.eye(3).ravel()]), 2)
    value, pdf = at.eval_pdf(frames, wi.ravel(), wo.ravel())
    material = Scratched(keys["metal"], roughness=0.3, **{key: of for key, of in keys.items() if key != "metal"})
    np.testing.assert_allclose(value.reshape(-1, 3), material.eval(wi, wo), rtol=1e-9)
    np.testing.assert_allclose(pdf, material.pdf(wi, wo), rtol=1e-9)
    assert not np.allclose(value.reshape(-1, 3), Scratched("gold", roughness=0.3).eval(wi, wo), rtol=0.01)
