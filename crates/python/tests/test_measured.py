"""Height maps, and the scratches in them."""

import math

import numpy as np
import pytest

import hairline
from hairline import measured, optics
from hairline.bsdf import Scratched

pytest.importorskip("skimage", reason="scikit-image is not installed: pip install scikit-image")

PIXEL = 0.25


def made(grooves, size=(900, 700), noise_nm=4.0, tilt=(0.0, 0.0), seed=1):
    """A map with rectangular grooves: x and y of both ends in um from the upper left corner, width in um, depth in nm."""
    y, x = (np.mgrid[: size[1], : size[0]] + 0.5) * PIXEL
    height = np.zeros(x.shape)
    for x0, y0, x1, y1, width, depth in grooves:
        length = math.hypot(x1 - x0, y1 - y0)
        tx, ty = (x1 - x0) / length, (y1 - y0) / length
        along = (x - x0) * tx + (y - y0) * ty
        across = (x - x0) * ty - (y - y0) * tx
        # The rim is a pixel wide, as instruments have it.
        inside = np.clip((width / 2 - np.abs(across)) / PIXEL + 0.5, 0, 1) * ((along >= 0) & (along <= length))
        height = np.minimum(height, -depth * inside)
    return height + np.random.default_rng(seed).normal(0, noise_nm, x.shape) + tilt[0] * x + tilt[1] * y


GROOVES = [
    (20, 30, 180, 60, 2.0, 150.0),
    (40, 150, 200, 20, 3.0, 220.0),
    (30, 90, 120, 140, 1.5, 120.0),
    (150, 100, 215, 160, 4.0, 300.0),
]


def test_the_scratches_are_those_that_were_cut():
    height = measured.HeightMap(made(GROOVES, tilt=(1.5, -0.8)), PIXEL).levelled()
    found = height.scratches()
    assert len(found) == len(GROOVES), found.ends_um
    for x0, y0, x1, y1, width, depth in GROOVES:
        ends = np.array([[x0, y0], [x1, y1]])
        off = [min(np.abs(one - ends).max(), np.abs(one[::-1] - ends).max()) for one in found.ends_um]
        at = int(np.argmin(off))
        assert off[at] < 3.0, (ends, found.ends_um[at])
        assert found.width_um[at] == pytest.approx(width, abs=0.2)
        assert found.depth_nm[at] == pytest.approx(depth, rel=0.05)


def test_a_plain_map_has_none():
    height = measured.HeightMap(made([], tilt=(1.0, 1.0)), PIXEL).levelled()
    assert np.abs(height.height_nm).max() < 30
    found = height.scratches()
    assert len(found) == 0
    with pytest.raises(hairline.WorkError, match="no scratches were found"):
        found.layer("plate")


def test_waviness_goes_and_grooves_stay():
    y, x = (np.mgrid[:700, :900] + 0.5) * PIXEL
    wavy = made(GROOVES) + 200 * np.sin(2 * np.pi * x / 180)
    level = measured.HeightMap(wavy, PIXEL).levelled(waviness_um=60)
    assert np.std(level.height_nm) < 0.5 * np.std(wavy)
    assert len(level.scratches()) >= 3


def test_a_layer_repeats_the_statistics(scene):
    random = np.random.default_rng(3)
    grooves = []
    for _ in range(14):
        x0, y0 = random.uniform(15, 150), random.uniform(15, 160)
        turn, length = random.normal(0.3, 0.05), random.uniform(40, 60)
        grooves.append((x0, y0, x0 + length * math.cos(turn), y0 - length * math.sin(turn), 2.0, 180.0))
    found = measured.HeightMap(made(grooves), PIXEL).levelled().scratches()
    assert len(found) == pytest.approx(14, abs=3)
    layer = found.layer("plate", seed=5)
    assert layer.pattern == "parallel"
    assert math.atan2(layer.direction[1], layer.direction[0]) == pytest.approx(0.3, abs=0.05)
    assert layer.to_dict()["depth_nm"]["mean"] == pytest.approx(180, rel=0.05)
    assert layer.density_per_m2 == pytest.approx(len(found) / (225e-6 * 175e-6))
    scene.scratches = [found.laid("plate"), layer]
    counts = scene.build().scratch_counts()
    assert counts[0] > len(found)
    mean = found.mean()
    assert mean.share == pytest.approx(14 * 50 * 2.0 / (225 * 175), rel=0.25)


def directions(angles, azimuth):
    return np.stack([np.sin(angles) * math.cos(azimuth), np.sin(angles) * math.sin(azimuth), np.cos(angles)], axis=-1)


def test_the_maps_own_light_is_that_of_its_groove():
    """The Fourier transform of a map with one groove, against the whole field of that groove, and against the model's scratch."""
    middle = (112.5, 87.5)
    width, depth, nm, sigma = 2.0, 140.0, 550.0, 12.0
    # Along x, 3 um above the middle.
    groove = (0, middle[1] - 3, 225, middle[1] - 3, width, depth)
    height = measured.HeightMap(made([groove], noise_nm=0), PIXEL)
    wo = np.array([0.0, 0.0, 1.0])
    wi = directions(np.linspace(0.03, 0.5, 25), math.pi / 2)
    found = height.brdf(wi, wo, wavelength_nm=nm, coherence_um=sigma)
    xi = wi + wo
    field = optics.coherent_response([[0.0, 3.0, -100.0, 100.0, width, depth]], xi[:, 0], xi[:, 1], nm, sigma, xi[:, 2])
    right = field.sum(axis=1) * wi[:, 2]
    # The rim of a pixel is no step: a few percent where sinc has its zeros, little in the mean.
    assert np.sqrt(np.mean((found - right) ** 2) / np.mean(right**2)) < 0.05
    shallow = height.brdf(wi, wo, wavelength_nm=600.0, coherence_um=sigma)
    assert np.sqrt(np.mean((shallow - right) ** 2) / np.mean(right**2)) > 0.1


def test_what_was_found_has_the_light_of_the_map():
    """The judge: light of the scratches as they were found, by the model, against the map's own, under a window on one of them."""
    height = measured.HeightMap(made(GROOVES, noise_nm=1.0), PIXEL).levelled()
    found = height.scratches()
    middle, sigma, nm = (100.0, 45.0), 10.0, 550.0
    rows = []
    for (a, b), width, depth in zip(found.ends_um, found.width_um, found.depth_nm):
        along = (b - a) * (1, -1) / np.linalg.norm(b - a)
        start, end = (a - middle) * (1, -1), (b - middle) * (1, -1)
        rows.append([math.atan2(along[1], along[0]), along[0] * start[1] - along[1] * start[0], start @ along, end @ along, width, depth])
    material = Scratched([[550, 1.0, 100.0]], scratches=rows, coherence_um=sigma)
    angle = min(rows, key=lambda row: abs(row[1]))[0]
    # Across it, where its light goes: evenly, so that its lobes count as they are.
    q = np.linspace(0.1, 0.5, 60)
    xi = np.stack([-q * math.sin(angle), q * math.cos(angle)], axis=1)
    wi, wo = np.concatenate([xi, np.sqrt(1 - q * q)[:, None]], axis=1), np.array([0.0, 0.0, 1.0])
    right = height.brdf(wi, wo, wavelength_nm=nm, coherence_um=sigma, center_um=middle)
    model = material.eval(wi, wo, wavelength_nm=nm, part="scratches")
    assert model.sum() == pytest.approx(right.sum(), rel=0.1)
    assert np.sqrt(np.mean((model - right) ** 2) / np.mean(right**2)) < 0.15


def test_files_are_read(tmp_path):
    height = made(GROOVES[:1], size=(64, 48))
    np.save(tmp_path / "map.npy", height)
    assert np.array_equal(measured.read(tmp_path / "map.npy", pixel_um=PIXEL).height_nm, height)
    from PIL import Image

    steps = np.round(height + 500).astype(np.uint16)
    Image.fromarray(steps).save(tmp_path / "map.png")
    np.testing.assert_allclose(measured.read(tmp_path / "map.png", pixel_um=PIXEL, nm_per_step=0.5).height_nm, steps * 0.5)
    shown = measured.HeightMap(height, PIXEL)
    assert shown._repr_png_().startswith(b"\x89PNG") and "64 x 48 pixels" in repr(shown)


@pytest.mark.parametrize("ending", ["x3p", "sur", "plu", "al3d"])
def test_files_of_instruments_that_are_cut_short_are_told(tmp_path, ending):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed: pip install SurfaceTopography")
    path = tmp_path / f"map.{ending}"
    path.write_bytes(b"PK\x03\x04" + bytes(40))
    with pytest.raises(hairline.WorkError, match="cannot be read as a height map"):
        measured.read(path)


def test_a_gap_takes_the_nearest_height():
    height = made(GROOVES[:1], size=(64, 48), noise_nm=0)
    height[10:14, 20:24] = np.nan
    assert np.isfinite(measured.HeightMap(height, PIXEL).height_nm).all()


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: measured.HeightMap(np.zeros((0, 0)), 1.0), "height_nm: found 0 x 0 pixels; must have from 16 to 8192 to a side"),
        (lambda: measured.HeightMap(np.zeros((20, 20_000)), 1.0), "height_nm: found 20000 x 20 pixels; must have from 16 to 8192"),
        (lambda: measured.HeightMap(np.zeros(20), 1.0), "height_nm: found an array of shape (20,); must be rows by columns"),
        (lambda: measured.HeightMap(np.full((20, 20), np.nan), 1.0), "height_nm: found no height in 100 % of the pixels"),
        (lambda: measured.HeightMap(np.zeros((20, 20)), 0), "pixel_um: found 0; must be a number from 0.0001 to 10000"),
        (lambda: measured.HeightMap(np.zeros((20, 20)), 1.0).brdf([0, 0, 1], [0, 0, 1], wavelength_nm=550), "must fit into the map"),
        (lambda: measured.HeightMap(np.zeros((400, 400)), 0.5).brdf([0, 0, 1], [0, 0, 1], wavelength_nm=550), "at most half a wavelength"),
        (lambda: measured.HeightMap(np.zeros((20, 20)), (1.0, 2.0)).scratches(), "must be square pixels"),
        (lambda: measured.read("map.npy"), "pixel_um: found none; .npy does not tell it"),
        (lambda: measured.read("map.png", pixel_um=1), "nm_per_step: found None; a .png has steps"),
        (lambda: measured.read("map.x3p", pixel_um=1), ".x3p tells both itself: leave them out"),
    ],
)
def test_wrong_maps_are_told(call, message):
    with pytest.raises(hairline.SceneError) as raised:
        call()
    assert message in str(raised.value)


def test_files_that_are_cut_short_are_told(tmp_path):
    np.save(tmp_path / "map.npy", np.zeros((64, 64)))
    contents = (tmp_path / "map.npy").read_bytes()
    (tmp_path / "map.npy").write_bytes(contents[:200])
    for name, keys in (("map.npy", {"pixel_um": 1.0}), ("missing.x3p", {})):
        with pytest.raises(hairline.WorkError, match="cannot be read"):
            measured.read(tmp_path / name, **keys)
