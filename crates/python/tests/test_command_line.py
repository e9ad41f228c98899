"""The command line and Python are one program: the same bits, and the same words."""

import os
import subprocess
from pathlib import Path

import pytest

import hairline
from conftest import ROOT

PROGRAM = os.environ.get("HAIRLINE_PROGRAM", "")
# `cargo xtask wheel --all-scenes` renders all, with the samples that they have by default.
ALL = bool(os.environ.get("HAIRLINE_ALL_SCENES"))
QUICK = ("closeup", "mirror")
# Else those that are built in seconds: with a mesh, strokes, gratings, and shadows of lamps. What other scenes hold is read by the same code.
FEW = (*QUICK, "brushed", "drawn", "plate", "record")
SCENES = [path for path in sorted((ROOT / "scenes").glob("*.toml")) if ALL or path.stem in FEW]

pytestmark = pytest.mark.skipif(not Path(PROGRAM).is_file(), reason="HAIRLINE_PROGRAM names no program")


def run(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def check_same(a, b):
    """Each value of each layer, and what the files remember. Not their bytes: attributes of an EXR have no order."""
    a, b = hairline.read_image(a), hairline.read_image(b)
    assert a.notes == b.notes
    for layer in ("base", "scratches", "density", "normal", "depth_m", "samples"):
        first, second = getattr(a, layer), getattr(b, layer)
        assert (first is None) == (second is None), layer
        assert first is None or first.tobytes() == second.tobytes(), layer
    if a.samples is not None:
        assert a.variance("beauty").tobytes() == b.variance("beauty").tobytes()


@pytest.mark.parametrize("scene", SCENES, ids=lambda path: path.stem)
def test_pictures_are_the_same_to_the_bit(scene, tmp_path):
    samples = {} if ALL or scene.stem in QUICK else {"samples": 2}
    flags = ["--size", "64x40", "--backend", "cpu", *(f"--{flag}={value}" for flag, value in samples.items())]
    code, _, err = run("render", scene, "-o", tmp_path / "program.exr", *flags)
    assert code == 0, err
    hairline.load(scene).render(size=(64, 40), backend="cpu", **samples).save(tmp_path / "python.exr")
    check_same(tmp_path / "python.exr", tmp_path / "program.exr")


def test_displayed_pictures_are_the_same_to_the_byte(tmp_path):
    scene = ROOT / "scenes/closeup.toml"
    assert run("render", scene, "-o", tmp_path / "program.png", "--size", "64x40", "--backend", "cpu")[0] == 0
    png = hairline.load(scene).render(size=(64, 40), backend="cpu").png()
    assert png == (tmp_path / "program.png").read_bytes()


def test_shadows_and_bounces_are_the_same(tmp_path):
    scene = ROOT / "scenes/mirror.toml"
    flags = ["--size", "48x30", "--backend", "cpu", "--shadows", "on", "--bounces", "1", "--samples", "2"]
    assert run("render", scene, "-o", tmp_path / "program.exr", *flags)[0] == 0
    image = hairline.load(scene).render(size=(48, 30), backend="cpu", shadows=True, bounces=1, samples=2)
    image.save(tmp_path / "python.exr")
    check_same(tmp_path / "python.exr", tmp_path / "program.exr")


@pytest.mark.parametrize("model", ["separable", "full"])
def test_references_are_the_same_and_go_on_from_each_other(model, tmp_path):
    scene = ROOT / "scenes/plate.toml"
    flags = ["--size", "16x10", "--model", model]
    path = tmp_path / "program.exr"
    assert run("reference", scene, "-o", path, "--spp", "64", *flags)[0] == 0
    image = hairline.load(scene).reference(size=(16, 10), model=model, samples=64)
    image.save(tmp_path / "python.exr")
    check_same(tmp_path / "python.exr", path)
    resumed = hairline.read_image(path)
    more = hairline.load(scene).reference(size=(16, 10), model=model, samples=128, resume=resumed)
    more.save(tmp_path / "python.exr")
    code, _, err = run("reference", scene, "-o", path, "--spp", "128", "--resume", *flags)
    assert code == 0, err
    check_same(tmp_path / "python.exr", path)


def test_errors_are_the_same_words(tmp_path):
    text = (ROOT / "scenes/plate.toml").read_text()
    wrong = {
        "radius_m = 0.08": "radius_mm = 80",
        'metal = "steel"': 'metal = "stele"',
        "roughness = 0.06": "roughness = 7",
        'object = "plate"': 'object = "plates"',
        "count = 10000": "count = -1",
        "[camera]": "[camera",
    }
    for before, after in wrong.items():
        assert before in text
        path = tmp_path / "wrong.toml"
        path.write_text(text.replace(before, after, 1))
        code, _, err = run("render", path, "-o", tmp_path / "a.png")
        with pytest.raises(hairline.SceneError) as caught:
            hairline.load(path)
        assert code == 2
        assert err.strip() == f"error: {caught.value}"
