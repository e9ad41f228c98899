"""Labels of pictures, and data sets of them."""

import json
import math
import subprocess

import numpy as np
import pytest

import hairline
from hairline import inspect

GOUGE = inspect.Defect("gouge", "plate", count=(1, 3), length_m=(0.02, 0.05), width_um=30.0, depth_nm=(800, 1500))


def in_picture(scene, size, points):
    """Places of points in the picture, pixels, by the keys of the camera alone."""
    camera = scene.camera
    eye, target = np.array(camera.position_m), np.array(camera.target_m)
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    way = points - eye
    scale = size[1] / 2 / math.tan(math.radians(camera.fov_y_deg) / 2) / (way @ forward)
    return np.stack([size[0] / 2 + way @ right * scale, size[1] / 2 - way @ up * scale], axis=-1)


def test_labels_are_where_the_laid_scratches_are(scene):
    """Each scratch's pixels are those that points of its line fall into, as the list of what was laid says."""
    size = (96, 64)
    labels = scene.labels(size=size)
    laid = scene.build(size=size).laid("plate")
    share = np.linspace(0, 1, 4000)[:, None]
    missed = added = 0
    sees = labels.object.reshape(-1) >= 0
    for own in range(0, 300, 7):
        found = set(labels.touched[labels.touched[:, 1] == own, 0].tolist())
        right = {}
        for piece in np.flatnonzero(laid["scratch"] == own):
            points = laid["start_m"][piece] * (1 - share) + laid["end_m"][piece] * share
            at = np.floor(in_picture(scene, size, points)).astype(int)
            inside = (at >= 0).all(axis=1) & (at < size).all(axis=1)
            for x, y in at[inside].tolist():
                right[y * size[0] + x] = right.get(y * size[0] + x, 0) + 1
        # Corners of pixels that are cut by less than a few points may fall either way.
        # At the rim the middles of pixels see nothing.
        missed += sum(count > 4 and pixel not in found and sees[pixel] for pixel, count in right.items())
        added += len(found - set(right))
    assert len(labels.touched) > 1000 and missed == 0 and added <= 5, (missed, added)


def test_the_strongest_come_first(scene):
    image = scene.render(size=(48, 32), labels=True, backend="cpu", samples=1, shadows=False)
    labels = image.labels
    assert labels.size == image.size == (48, 32)
    assert labels.scratch.shape == labels.coverage.shape == labels.direction_rad.shape == (32, 48, labels.RANKS)
    assert (np.diff(labels.coverage, axis=2) <= 0).all() and (labels.coverage >= 0).all()
    np.testing.assert_array_equal(labels.scratch < 0, labels.coverage == 0)
    np.testing.assert_array_equal(labels.object >= 0, image.depth_m > 0)
    assert (np.abs(labels.direction_rad) <= math.pi / 2 + 1e-6).all()
    assert labels.objects == ["plate"] and len(labels.scratch_width_um) == 300
    # Light of scratches is where they cover most.
    light, cover = image.scratches.sum(axis=2), labels.coverage.sum(axis=2)
    assert light[cover > np.quantile(cover, 0.9)].mean() > light[cover <= np.median(cover)].mean()
    assert scene.render(size=(8, 8), backend="cpu").labels is None


def test_directions_are_those_in_the_picture(scene):
    scene.scratches[0].update(pattern="parallel", curvature_per_m=None, direction=(1, 1, 0), count=50)
    labels = scene.labels(size=(48, 32))
    ends = in_picture(scene, (48, 32), np.array([[0, 0, 0], [1e-3, 1e-3, 0]]))
    dx, dy = ends[1] - ends[0]
    strong = labels.coverage[..., 0] > 0.01
    assert labels.direction_rad[..., 0][strong] == pytest.approx(math.atan2(-dy, dx), abs=0.15)


def murmur3(text):
    """MurmurHash3 of 32 bits, seed 0."""
    data, hash_, most = text.encode(), 0, 0xFFFFFFFF
    for i in range(0, len(data) - len(data) % 4, 4):
        k = int.from_bytes(data[i : i + 4], "little") * 0xCC9E2D51 & most
        hash_ ^= (k << 15 | k >> 17) * 0x1B873593 & most
        hash_ = ((hash_ << 13 | hash_ >> 19) & most) * 5 + 0xE6546B64 & most
    if len(data) % 4:
        k = int.from_bytes(data[-(len(data) % 4) :], "little") * 0xCC9E2D51 & most
        hash_ ^= ((k << 15 | k >> 17) & most) * 0x1B873593 & most
    hash_ ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        hash_ = (hash_ ^ hash_ >> shift) * factor & most
    return hash_


def test_files_of_labels_are_cryptomattes(scene, tmp_path):
    labels = scene.labels(size=(16, 12))
    labels.save(tmp_path / "labels.exr")
    contents = (tmp_path / "labels.exr").read_bytes()
    for channel in (b"CryptoScratch00.R\0", b"CryptoScratch02.A\0", b"CryptoObject00.G\0", b"label.width_um\0"):
        assert channel in contents
    key = f"{murmur3('CryptoScratch'):08x}"[:7].encode()
    for what, text in ((b"name", b"CryptoScratch"), (b"conversion", b"uint32_to_float32"), (b"hash", b"MurmurHash3_32")):
        assert b"cryptomatte/" + key + b"/" + what in contents and text in contents
    some = int(labels.scratch.max())
    bits = murmur3(f"plate/{some}")
    bits ^= (1 << 23) if (bits >> 23 & 255) in (0, 255) else 0
    assert f'"plate/{some}":"{bits:08x}"'.encode() in contents
    with pytest.raises(hairline.WorkError, match="png"):
        labels.save(tmp_path / "labels.png")


def filled(rings, shape):
    """The mask of polygons by the rule of even and odd, at the middles of pixels."""
    ys, xs = np.mgrid[: shape[0], : shape[1]] + 0.5
    inside = np.zeros(shape, bool)
    for ring in rings:
        corners = np.array(ring).reshape(-1, 2)
        for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0)):
            if x0 == x1:
                inside ^= (xs > x0) & (ys > min(y0, y1)) & (ys < max(y0, y1))
    return inside


def decoded(code):
    flat = np.repeat(np.arange(len(code["counts"])) % 2 == 1, code["counts"])
    return flat.reshape(code["size"], order="F")


def test_polygons_and_run_lengths_are_their_mask():
    random = np.random.default_rng(1)
    for mask in (random.random((9, 13)) < 0.5, np.ones((3, 4), bool), np.zeros((3, 4), bool), np.eye(5, dtype=bool)):
        np.testing.assert_array_equal(filled(inspect.polygons(mask), mask.shape), mask)
        code = inspect.run_lengths(mask)
        assert sum(code["counts"]) == mask.size
        np.testing.assert_array_equal(decoded(code), mask)
    assert inspect.polygons(np.ones((1, 2), bool)) == [[0.0, 0.0, 2.0, 0.0, 2.0, 1.0, 0.0, 1.0]]


def made(scene, folder, **keys):
    keys = {"count": 3, "size": (48, 32), "defects": [GOUGE], "backend": "cpu", "samples": 1, "shadows": False, **keys}
    return inspect.dataset(scene, folder, **keys)


def test_a_data_set_has_what_its_card_says(scene, tmp_path):
    folder = made(scene, tmp_path / "set", exr=True)
    coco = json.loads((folder / "annotations.json").read_text())
    manifest = json.loads((folder / "manifest.json").read_text())
    assert len(coco["images"]) == manifest["count"] == 3 and coco["annotations"]
    assert "| gouge | 1 |" in (folder / "README.md").read_text()
    ids = [one["id"] for one in coco["annotations"]]
    assert ids == list(range(1, len(ids) + 1))
    from PIL import Image

    for image in coco["images"]:
        assert Image.open(folder / image["file_name"]).size == (48, 32)
        semantic = np.asarray(Image.open(folder / "masks" / f"{image['id']:06d}.png"))
        together = np.zeros((32, 48), bool)
        for one in coco["annotations"]:
            if one["image_id"] == image["id"]:
                mask = decoded(one["rle"])
                np.testing.assert_array_equal(filled(one["segmentation"], mask.shape), mask)
                x, y, width, height = one["bbox"]
                assert mask.sum() == one["area"] == mask[y : y + height, x : x + width].sum()
                assert mask[y].any() and mask[y + height - 1].any() and 0.02 <= one["length_m"] * 1.01
                together |= mask
        np.testing.assert_array_equal(semantic == 1, together)
        assert hairline.read_image(folder / f"linear/{image['id']:06d}.exr").size == (48, 32)


def test_a_picture_depends_on_its_number_alone(scene, tmp_path):
    whole = made(scene, tmp_path / "whole")
    made(scene, tmp_path / "parts", count=1)
    first = tmp_path / "parts/images/000000.png"
    first.write_bytes(b"kept")
    parts = made(scene, tmp_path / "parts")
    assert first.read_bytes() == b"kept"
    for name in ("images/000002.png", "masks/000001.png", "labels/000001.json", "annotations.json"):
        assert (whole / name).read_bytes() == (parts / name).read_bytes(), name
    assert (whole / "images/000000.png").read_bytes() != (whole / "images/000001.png").read_bytes()
    other = made(scene, tmp_path / "other", seed=2)
    assert (whole / "images/000000.png").read_bytes() != (other / "images/000000.png").read_bytes()


def test_the_cluster_makes_the_same(scene, tmp_path):
    cluster = pytest.importorskip("hairline.cluster")
    one = made(scene, tmp_path / "one", count=2)
    with cluster.local(1) as client:
        other = made(scene, tmp_path / "other", count=2, client=client)
    for name in ("images/000001.png", "annotations.json", "manifest.json", "README.md"):
        assert (one / name).read_bytes() == (other / name).read_bytes(), name


@pytest.mark.parametrize(
    "keys, message",
    [
        ({"count": 0}, "count: found 0; must be a whole number from 1 to 100000"),
        ({"seed": -1}, "seed: found -1"),
        ({"defects": ["gouge"]}, "defects[0]: found an object of type str; must be a hairline.inspect.Defect"),
        ({"defects": [GOUGE, GOUGE]}, "defects: found ['gouge', 'gouge']; must be at most 255, of different names"),
        ({"defects": [inspect.Defect("gouge", "lid")]}, 'found "lid"'),
        ({"variation": 3}, "variation: found 3"),
    ],
)
def test_wrong_arguments_are_told_before_the_work(scene, tmp_path, keys, message):
    with pytest.raises(hairline.SceneError) as raised:
        made(scene, tmp_path / "set", **keys)
    assert message in str(raised.value)
    assert not (tmp_path / "set").exists()


def test_wrong_defects_and_variations_are_told():
    for call, message in (
        (lambda: inspect.Defect("", "plate"), "defect.name: found ''; must be a text"),
        (lambda: inspect.Defect("a", "plate", count=(3, 1)), "defect.count: found (3, 1)"),
        (lambda: inspect.Defect("a", "plate", width_um=200), "defect.width_um: found 200; must be a number or two"),
        (lambda: inspect.Defect("a", "plate", depth_nm=math.nan), "defect.depth_nm: found nan"),
        (lambda: inspect.Defect("a", "plate", profile="w"), 'defect.profile: found the text "w"; must be one of `rectangle`'),
        (lambda: inspect.Defect("a", "plate", profile=(0, 0)), "defect.profile: found"),
        (lambda: inspect.Variation(camera_turn_deg=400), "variation.camera_turn_deg: found 400"),
        (lambda: inspect.Variation(wear=(2, 1)), "variation.wear: found (2, 1)"),
    ):
        with pytest.raises(hairline.SceneError) as raised:
            call()
        assert message in str(raised.value)


def test_defects_have_their_profile(scene):
    gouge = inspect.Defect("gouge", "plate", count=2, profile=(1.0, 0.5, -0.2))
    changed, told = inspect.drawn(scene, 1, defects=[gouge])
    assert [changed.scratches[one["layer"]].profile for one in told["defects"]] == [gouge.profile] * 2


def test_rectangles_turn_with_the_other_lights():
    before = {"center_m": [0.3, 0.5, 0.2], "target_m": [0.0, 0.0, 0.0], "rotation_deg": 20.0}
    for turn in (0.4, 1.7, -2.5):
        around = inspect._turn(turn, np.array([0.0, 0.0, 1.0]))
        after = {key: (around @ np.array(before[key])).tolist() for key in ("center_m", "target_m")}
        angle = math.radians(inspect._rotation_deg(before, after, around))

        def width_of(light, angle):
            x, y = inspect._plane(light)
            return math.cos(angle) * x + math.sin(angle) * y

        np.testing.assert_allclose(width_of(after, angle), around @ width_of(before, math.radians(20.0)), atol=1e-12)


def test_another_scene_is_not_mixed_in(scene, tmp_path):
    made(scene, tmp_path / "set", count=1)
    scene.materials[0].roughness = 0.3
    with pytest.raises(hairline.SceneError, match="found a data set with another scene"):
        made(scene, tmp_path / "set", count=2)


def test_the_command_line_writes_the_same_labels(scene, tmp_path):
    import os

    program = os.environ.get("HAIRLINE_PROGRAM")
    if program is None:
        pytest.skip("HAIRLINE_PROGRAM names no program")
    scene.save(tmp_path / "plate.toml")
    scene.labels().save(tmp_path / "python.exr")
    command = [program, "render", "plate.toml", "-o", "plate.png", "--labels", "labels.exr", "--backend", "cpu", "--samples", "1"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    written, by_python = ((tmp_path / name).read_bytes() for name in ("labels.exr", "python.exr"))
    # The attributes of a header come in any order; the pixels follow them.
    assert sorted(written) == sorted(by_python)
    pixels = len(written) // 2
    assert written[-pixels:] == by_python[-pixels:]
    command[command.index("labels.exr")] = "labels.png"
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2 and "labels need an .exr" in done.stderr
