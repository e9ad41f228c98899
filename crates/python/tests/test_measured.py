"""Measured surfaces: what is found in maps whose scratches are known, and what is said of maps that are none."""

import struct
import zlib

import numpy as np
import pytest

import hairline
from surfaces import KNOWN, engraved

pytest.importorskip("skimage", reason="measured surfaces need scikit-image")
from hairline import bsdf, measured, optics  # noqa: E402

STEP_UM = 0.5


@pytest.fixture(scope="module")
def plate():
    """A map of 200 x 200 um, tilted and bowed by far more than its scratches are deep."""
    heights = engraved((400, 400), STEP_UM, KNOWN, noise_nm=1.5)
    x = np.linspace(-1, 1, 400)
    return measured.HeightMap(heights + 1e-6 * (x + 0.3 * x[:, None] + 0.4 * x**2), 1e-6 * STEP_UM)


@pytest.fixture(scope="module")
def found(plate):
    return plate.levelled(2).scratches()


FINE_UM = 0.25


def one_groove():
    """A groove 2 um wide and 60 nm deep through a map of 160 x 160 um, its walls between points of the grid."""
    return measured.HeightMap(engraved((640, 640), FINE_UM, [(-90, 0, 90, 0, 2.0, 60.0)]), 1e-6 * FINE_UM)


def seen(groove):
    """What of a groove lies on the map of 200 x 200 um."""
    a, b = np.array(groove[:2]), np.array(groove[2:4])
    ts = np.linspace(0, 1, 20001)
    on = [t for t in ts if np.abs(a + t * (b - a)).max() <= 100]
    return np.array([a + on[0] * (b - a), a + on[-1] * (b - a)])


def test_known_scratches_are_found(found):
    assert len(found) == len(KNOWN)
    for groove in KNOWN:
        ends = seen(groove)
        off = [min(np.hypot(*(1e6 * one.ends_m[::way] - ends).T).max() for way in (1, -1)) for one in found]
        one = found[int(np.argmin(off))]
        assert min(off) < 2 * STEP_UM
        assert one.width_um == pytest.approx(groove[4], rel=0.1)
        assert one.depth_nm == pytest.approx(groove[5], rel=0.05)
        assert one.residual_nm < 2


def test_a_plane_has_no_scratches():
    noise = 1e-9 * np.random.default_rng(2).standard_normal((300, 300))
    assert len(measured.HeightMap(noise, 5e-7).scratches()) == 0


def test_a_level_is_not_pulled_by_scratches(plate):
    flat = 1e9 * plate.levelled(2).heights_m
    untouched = 1e9 * engraved((400, 400), STEP_UM, KNOWN) == 0
    x = np.linspace(-1, 1, 400)
    rest = np.polynomial.polynomial.polyfit(np.tile(x, (400, 1))[untouched], flat[untouched], 2)
    assert np.abs(rest).max() < 0.2  # of 1000 nm


def test_steps_may_differ_both_ways(found):
    heights = engraved((400, 400), STEP_UM, KNOWN, noise_nm=1.5)
    other = measured.HeightMap(heights[::2], (1e-6 * STEP_UM, 2e-6 * STEP_UM)).scratches()
    assert other.length_m.sum() == pytest.approx(found.length_m.sum(), rel=0.05)
    assert sorted(other.depth_nm) == pytest.approx(sorted(found.depth_nm), rel=0.06)


def test_a_list_is_what_scene_files_read(found, tmp_path, table):
    found.save_csv(tmp_path / "found.csv")
    lines = (tmp_path / "found.csv").read_text().splitlines()
    assert lines[0] == "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm" and len(lines) == 1 + len(found)
    table["scratches"] = [{"object": "plate", "pattern": "file", "file": str(tmp_path / "found.csv")}]
    table["object"] = [{"name": "plate", "shape": {"plane": {"size_m": [0.001, 0.001]}}, "material": "steel"}]
    scene = hairline.Scene.from_dict(table)
    assert scene.build().scratch_counts() == [len(found)]
    scene.scratches[0] = found.listed("plate")
    assert scene.build().scratch_counts() == [len(found)]


def test_layers_repeat_the_statistics():
    random = np.random.default_rng(5)
    grooves = []
    for y in np.linspace(-126, 126, 15):
        x, angle, length = random.uniform(-150, 150), random.normal(0.4, 0.06), random.uniform(60, 120)
        way = 0.5 * length * np.array([np.cos(angle), np.sin(angle)])
        grooves.append((x - way[0], y - way[1], x + way[0], y + way[1], random.uniform(2, 3), random.uniform(80, 120)))
    found = measured.HeightMap(engraved((400, 400), STEP_UM, grooves, noise_nm=1.0), 1e-6 * STEP_UM).scratches()
    table = found.layers("plate")[0].to_dict()
    # What these very scratches have on the map, of 200 x 200 um.
    ends = np.array([groove[:4] for groove in grooves]).reshape(-1, 2)
    density = (np.abs(ends) < 100).all(axis=1).sum() / 2 / 200e-6**2
    way = ends[1::2] - ends[::2]
    along = (np.arange(2000) + 0.5) / 2000
    points = ends[::2, None] + along[:, None] * way[:, None]
    lengths = (np.abs(points) < 100).all(axis=2).mean(axis=1) * np.hypot(*way.T)
    width, depth = (np.average([groove[n] for groove in grooves], weights=lengths) for n in (4, 5))
    assert table["pattern"] == "parallel"
    assert np.arctan2(*table["direction"][1::-1]) == pytest.approx(0.4, abs=0.06)
    assert table["jitter_deg"] == pytest.approx(3.4, rel=0.4)
    # What the border cuts to less than 10 um is not looked for, and of two that cross at a few degrees one may be missed.
    assert table["density_per_m2"] == pytest.approx(density, rel=0.25)
    assert table["density_per_m2"] * table["length_m"]["mean"] == pytest.approx(1e-6 * lengths.sum() / 200e-6**2, rel=0.2)
    assert table["width_um"]["mean"] == pytest.approx(width, rel=0.1)
    assert table["depth_nm"]["mean"] == pytest.approx(depth, rel=0.06)
    covered = 1e-6 * np.array([groove[4] for groove in grooves]) @ (1e-6 * lengths) / 200e-6**2
    mean = found.mean()
    assert mean.share == pytest.approx(covered, rel=0.2)
    assert mean.direction_deg == pytest.approx(np.degrees(0.4), abs=3.4)
    assert mean.spread_deg == pytest.approx(table["jitter_deg"])
    assert sum(part for part, _, _ in mean.grooves) == pytest.approx(1)
    assert sum(part * deep for part, _, deep in mean.grooves) == pytest.approx(depth, rel=0.06)


def test_the_mean_of_scratches_is_a_layer_of_the_bsdf(found):
    mean = found.mean()
    assert mean.direction_deg is None and mean.spread_deg == 0
    steel = bsdf.Scratched("steel", layers=[mean])
    # Each of them as a layer of its own.
    share = 1e-6 * found.width_um * found.length_m / np.prod(found.size_m)
    each = [bsdf.Layer(width_um=one.width_um, depth_nm=one.depth_nm, coverage=part) for one, part in zip(found, share)]
    up, aside = [0.0, 0.0, 1.0], [np.sin(0.1), 0.0, np.cos(0.1)]
    value = steel.eval(aside, up, part="scratches")
    assert value.shape == (3,) and (value > 0).all()
    assert value == pytest.approx(bsdf.Scratched("steel", layers=each).eval(aside, up, part="scratches"), rel=1e-3)


def test_scratches_that_reach_through_have_no_length_of_their_own():
    found = one_groove().scratches()
    with pytest.raises(hairline.SceneError, match="length_m: 0 ends of scratches lie within the map"):
        found.layers("plate")
    [layer] = found.layers("plate", length_m=0.01)
    # 160 um of it in 160 x 160 um.
    assert layer.density_per_m2 == pytest.approx(1 / (160e-6 * 0.01), rel=0.02)


def test_rows_are_found_as_they_are():
    step, pitch, angle = 0.25, 5.3, np.radians(25)
    middles = pitch * np.arange(-40, 41) + np.random.default_rng(3).normal(0, 0.3, 81)
    way = np.array([np.cos(angle), np.sin(angle)])
    side = np.array([-way[1], way[0]])
    grooves = [(*(m * side - 300 * way), *(m * side + 300 * way), 2.0, 80.0) for m in middles]
    rows = measured.HeightMap(engraved((400, 400), step, grooves, noise_nm=2.0), 1e-6 * step).rows()
    assert rows.pitch_um == pytest.approx(pitch, rel=0.01)
    assert rows.direction == pytest.approx(way, abs=0.01)
    assert rows.width_um == pytest.approx(2.0, rel=0.1)
    assert rows.depth_nm == pytest.approx(80, rel=0.05)
    assert rows.jitter_um == pytest.approx(0.3, rel=0.4)
    assert rows.grating("plate").pitch_um == pytest.approx(pitch, rel=0.01)


def test_lines_at_random_are_no_row():
    middles = np.random.default_rng(4).uniform(-60, 60, 40)
    grooves = [(m, -60, m, 60, 1.5, 60.0) for m in middles]
    assert measured.HeightMap(engraved((400, 400), 0.25, grooves, noise_nm=2.0), 2.5e-7).rows() is None


def test_a_mirror_reflects_all_to_one_side():
    brdf = measured.HeightMap(np.zeros((400, 400)), 5e-7).brdf(550.0, coherence_um=15.0)
    assert brdf.values.sum() * brdf.cell == pytest.approx(1, abs=1e-5)
    assert brdf.sent(0.05, 0.3) < 1e-6
    gold = measured.HeightMap(np.zeros((400, 400)), 5e-7).brdf(650.0, "gold", coherence_um=15.0)
    assert gold.values.sum() * gold.cell == pytest.approx(float(optics.fresnel_metal("gold", 1.0, 650.0)), rel=1e-5)


def test_a_sine_sends_the_orders_of_bessel_functions():
    """A fact of its own: J_1(a)^2 of the light in each first order of a sinusoidal phase grating of amplitude a."""
    x = STEP_UM * np.arange(400)
    heights = 40e-9 * np.sin(2 * np.pi * x / 5) * np.ones((400, 1))
    sent = measured.HeightMap(heights, 1e-6 * STEP_UM).sent(500.0, 0.08, 0.12, coherence_um=15.0)
    phase = 4 * np.pi * 40 / 500
    angle = np.linspace(0, np.pi, 20001)
    bessel = np.mean(np.cos(angle - phase * np.sin(angle)))
    assert sent == pytest.approx(2 * bessel**2, rel=0.01)


def test_directions_are_those_of_the_map():
    """A slope that rises to the right and upwards by the same angle turns the mirror's direction to the left and down: wi + wo is along the normal."""
    rows, columns = np.mgrid[0:400, 0:400]
    slope = 0.02
    heights = 1e-6 * STEP_UM * slope * (columns + 2 * (399 - rows))
    brdf = measured.HeightMap(heights, 1e-6 * STEP_UM).brdf(500.0, coherence_um=15.0)
    at = np.unravel_index(brdf.values.argmax(), brdf.values.shape)
    # The phase k 2 h, less -k xi x: the maximum is at xi = 2 slope of either sign, the same for both axes.
    assert abs(brdf.xi_x[at[1]]) == pytest.approx(2 * slope, abs=0.005)
    assert abs(brdf.xi_y[at[0]]) == pytest.approx(4 * slope, abs=0.005)
    assert brdf.xi_x[at[1]] * brdf.xi_y[at[0]] > 0


def judged(heights, scratches, sines, wavelength_nm):
    options = {"coherence_um": 15.0}
    return scratches.sent(wavelength_nm, *sines, **options) / heights.sent(wavelength_nm, *sines, **options)


def test_heights_send_what_the_closed_form_says_of_their_scratches():
    heights = one_groove()
    assert judged(heights, heights.scratches(), (0.06, 0.25), [430.0, 550.0, 670.0]) == pytest.approx(1, abs=0.06)


# Far from the mirror's direction light comes from a groove's edges, and its width shows in where there is none: at 550 / 2000.
@pytest.mark.parametrize("wrong, sines", [({"depth_nm": 60 * 1.15}, (0.06, 0.25)), ({"width_um": 2.0 * 1.15}, (0.25, 0.3))])
def test_the_judge_sees_a_wrong_scratch(wrong, sines):
    heights = one_groove()
    found = heights.scratches()
    other = measured.Found(tuple(one._replace(**wrong) for one in found), found.size_m, 1e-6 * FINE_UM)
    assert abs(judged(heights, other, sines, 550.0) - 1) > 0.15


def test_a_map_is_shown(plate):
    shown = plate.levelled(2).shown()
    assert shown.dtype == np.uint8 and shown.shape == (400, 400) and shown.min() == 0 and shown.max() == 255
    pytest.importorskip("PIL")
    assert plate._repr_png_().startswith(b"\x89PNG")
    assert repr(plate).startswith("HeightMap(400 x 400 heights, 200 x 200 um")


def png(codes):
    """A PNG of 16 bits of grey, by its specification."""
    rows, columns = codes.shape
    lines = b"".join(b"\0" + line.astype(">u2").tobytes() for line in codes)
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 16, 0, 0, 0, 0)), (b"IDAT", zlib.compress(lines)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in chunks
    )


def test_files_are_read(tmp_path):
    codes = (1000 * np.arange(20)[:, None] + np.arange(30)).astype(np.uint16)
    np.save(tmp_path / "a.npy", 1e-9 * codes)
    map_of_array = measured.read(tmp_path / "a.npy", spacing_m=1e-6)
    assert map_of_array.heights_m == pytest.approx(1e-9 * codes) and map_of_array.spacing_m == (1e-6, 1e-6)
    pytest.importorskip("PIL")
    (tmp_path / "a.png").write_bytes(png(codes))
    of_picture = measured.read(tmp_path / "a.png", spacing_m=(1e-6, 2e-6), range_m=65535e-9)
    assert of_picture.heights_m == pytest.approx(1e-9 * codes) and of_picture.spacing_m == (1e-6, 2e-6)


def test_an_x3p_of_another_program_is_read(tmp_path):
    """Written by SurfaceTopography, whose arrays run along x first and y upwards."""
    topography = pytest.importorskip("SurfaceTopography", reason="files of instruments need SurfaceTopography")
    heights = engraved((40, 60), STEP_UM, [(-20, 0, 20, 8, 3, 90)])
    made = topography.Topography(heights[::-1].T, (30e-6, 20e-6), unit="m")
    if not hasattr(made, "to_x3p"):
        pytest.skip("this SurfaceTopography writes no .x3p")
    made.to_x3p(str(tmp_path / "a.x3p"))
    read = measured.read(tmp_path / "a.x3p")
    assert read.heights_m == pytest.approx(heights, abs=1e-12)
    assert read.spacing_m == pytest.approx((0.5e-6, 0.5e-6))


@pytest.mark.parametrize(
    "heights, spacing_m, message",
    [
        (np.zeros(100), 1e-6, "heights_m: found an array of shape 100; must be of shape rows x columns"),
        (np.zeros((20, 20, 3)), 1e-6, "heights_m: found an array of shape 20 x 20 x 3; must be of shape rows x columns"),
        (np.zeros((0, 0)), 1e-6, "heights_m: found 0 x 0 heights; must be from 16 to 10000 heights a side"),
        (np.zeros((20, 15)), 1e-6, "heights_m: found 15 x 20 heights; must be from 16 to 10000 heights a side"),
        (np.broadcast_to(0.0, (20000, 20000)), 1e-6, "heights_m: found 20000 x 20000 heights; must be from 16 to 10000"),
        (np.full((20, 20), np.nan), 1e-6, "heights_m: 400 of 400 heights are unknown (NaN); must be known"),
        (np.where(np.eye(20) > 0, np.nan, 0), 1e-6, "heights_m: 20 of 400 heights are unknown (NaN); fill=True gives them"),
        (np.ma.masked_equal(np.eye(20), 1), 1e-6, "heights_m: 20 of 400 heights are unknown (NaN); fill=True gives them"),
        (np.where(np.eye(20) > 0, np.inf, 0), 1e-6, "heights_m: found an infinite height; must be finite"),
        (np.full((20, 20), "a"), 1e-6, "heights_m: found texts; must be an array of numbers"),
        (np.zeros((20, 20)), 0, "spacing_m: found 0; must be one number or two, from 1e-10 to 0.001 metres"),
        (np.zeros((20, 20)), (1e-6, np.nan), "spacing_m: found (1e-06, nan); must be one number or two"),
        (np.zeros((20, 20)), (1e-6, 1e-6, 1e-6), "must be one number or two"),
    ],
)
def test_wrong_maps(heights, spacing_m, message):
    with pytest.raises(hairline.SceneError) as caught:
        measured.HeightMap(heights, spacing_m)
    assert message in str(caught.value)


def test_unknown_heights_are_filled_when_asked():
    heights = np.tile(np.arange(20.0), (20, 1)) * 1e-9
    heights[5, 7] = np.nan
    filled = measured.HeightMap(heights, 1e-6, fill=True).heights_m
    assert abs(filled[5, 7] - 7e-9) <= 1.01e-9


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda m: m.levelled(7), "degree: found 7; must be a whole number from 0 to 6"),
        (lambda m: m.shown((3, 3)), "range_nm: found (3, 3); must be two heights, the second greater"),
        (lambda m: m.scratches(widths_um=(3, 2)), "widths_um: found (3, 2); must be two widths"),
        (lambda m: m.scratches(least_length_um=0), "least_length_um: found 0; must be from"),
        (lambda m: m.scratches(least_depth_nm=-1), "least_depth_nm: found -1; must be above 0"),
        (lambda m: m.rows(least_share=0), "least_share: found 0; must be above 0, up to 1"),
        (lambda m: m.cropped(0, 0, 10, 500), "cropped: 10 x 500 at (0, 0) of 64 x 64; must lie within"),
        (lambda m: m.brdf(550.0), "coherence_um: found 20 for a map of 64 x 64 um; must be 7.75 at most, an eighth of the map"),
        (lambda m: m.brdf(550.0, coherence_um=1.0), "coherence_um: found 1; must be 2 at least, two points of the grid"),
        (lambda m: m.brdf(-1.0, coherence_um=5.0), "wavelength_nm: found -1.0; must be a number from 10 to"),
        (lambda m: m.sent(550.0, 0.1, 0.5, coherence_um=5.0), "sine_low, sine_high: found 0.1 and 0.5; must rise, from 0 to 0.2"),
        (lambda m: m.scratches().layers("plate"), "scratches: found none in the map"),
        (lambda m: m.scratches().mean(), "scratches: found none in the map"),
    ],
)
def test_wrong_arguments(call, message):
    with pytest.raises(hairline.SceneError) as caught:
        call(measured.HeightMap(np.zeros((64, 64)), 1e-6))
    assert message in str(caught.value)


WHOLE = png(np.zeros((20, 20), np.uint16))


@pytest.mark.parametrize(
    "name, content, options, message",
    [
        ("a.jpg", b"x", {}, "found the ending '.jpg'; height maps have one of .npy .png"),
        ("a", b"x", {}, "found no ending; height maps have one of"),
        ("a.npy", b"", {"spacing_m": 1e-6}, "found an empty file; must be a height map"),
        ("a.npy", b"\x93NUMPY\x01\x00", {"spacing_m": 1e-6}, "cannot be read as .npy"),
        ("a.npy", b"x" * 100, {"spacing_m": 1e-6}, "cannot be read as .npy"),
        ("a.npy", b"x", {}, "spacing_m is missing"),
        ("a.npy", b"x", {"spacing_m": 1e-6, "range_m": 1e-6}, "range_m was given; it belongs to .png"),
        ("a.png", WHOLE, {"spacing_m": 1e-6}, "range_m is missing; must say how many metres white is above black"),
        ("a.png", WHOLE[:50], {"spacing_m": 1e-6, "range_m": 1e-6}, "cannot be read as .png"),
        ("a.png", b"GIF89a", {"spacing_m": 1e-6, "range_m": 1e-6}, "cannot be read as .png"),
        ("a.png", png(np.zeros((4, 4))), {"spacing_m": 1e-6, "range_m": 1e-6}, "heights_m: found 4 x 4 heights; must be from 16"),
        ("a.sur", b"x" * 600, {}, "cannot be read as .sur"),
        ("a.plu", b"x" * 40, {}, "cannot be read as .plu"),
        ("a.x3p", b"PK\x03\x04" + b"\0" * 50, {}, "cannot be read as .x3p"),
        ("a.al3d", b"AliconaImaging\0", {}, "cannot be read as .al3d"),
        ("a.sur", b"x", {"spacing_m": 1e-6}, "spacing_m was given; the file has its own sizes"),
    ],
)
def test_wrong_files(tmp_path, name, content, options, message):
    if name.endswith((".sur", ".plu", ".x3p", ".al3d")) and len(content) > 1:
        pytest.importorskip("SurfaceTopography", reason="files of instruments need SurfaceTopography")
    if "range_m" in options and name.endswith(".png"):
        pytest.importorskip("PIL")
    (tmp_path / name).write_bytes(content)
    with pytest.raises(hairline.SceneError) as caught:
        measured.read(tmp_path / name, **options)
    assert message in str(caught.value)
    assert caught.value.file == str(tmp_path / name)


def test_a_large_file_is_refused_before_it_is_read(tmp_path):
    array = np.lib.format.open_memmap(tmp_path / "a.npy", mode="w+", dtype=np.float32, shape=(20000, 20000))
    del array
    with pytest.raises(hairline.SceneError, match="a.npy: heights_m: found 20000 x 20000 heights"):
        measured.read(tmp_path / "a.npy", spacing_m=1e-6)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(hairline.WorkError, match="a.npy: cannot be read: No such file"):
        measured.read(tmp_path / "a.npy", spacing_m=1e-6)


def test_a_missing_package_is_named(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "skimage.filters", None)
    with pytest.raises(hairline.WorkError, match=r"need the package scikit-image .*pip install 'hairline-render\[measured\]'"):
        measured.HeightMap(np.zeros((64, 64)), 1e-6).scratches()
