"""Pictures: layers, files, comparisons, interrupts."""

import io
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest

import hairline


@pytest.fixture
def image(scene):
    return scene.render(backend="cpu")


def test_layers_are_arrays_of_the_pictures_own_memory(image):
    for layer in ("beauty", "base", "scratches", "density", "normal"):
        array = getattr(image, layer)
        assert array.dtype == np.float32 and array.shape == (32, 48, 3), layer
        assert not array.flags.writeable
        assert np.shares_memory(array, getattr(image, layer)), layer
    assert image.depth_m.shape == (32, 48)
    np.testing.assert_array_equal(image.beauty, image.base + image.scratches)
    assert image.scratches.max() > 0 and image.size == (48, 32) and image.is_complete


def test_an_array_outlives_its_picture(scene):
    base = scene.render(backend="cpu").base
    assert np.isfinite(base).all() and base.max() > 0


def test_files_hold_the_picture(tmp_path, image):
    image.save(tmp_path / "a.exr")
    again = hairline.read_image(tmp_path / "a.exr")
    for layer in ("beauty", "base", "scratches", "density", "normal", "depth_m"):
        np.testing.assert_array_equal(getattr(again, layer), getattr(image, layer))
    image.save(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == image.png() == image._repr_png_()


def test_a_transparent_picture_has_alpha(tmp_path, scene, image):
    assert image.alpha is None
    alone = scene.render(backend="cpu", transparent=True)
    assert alone.alpha.dtype == np.float32 and alone.alpha.shape == (32, 48)
    np.testing.assert_array_equal(alone.alpha > 0, alone.depth_m > 0)
    alone.save(tmp_path / "a.exr")
    for again in (hairline.read_image(tmp_path / "a.exr"), pickle.loads(pickle.dumps(alone))):
        np.testing.assert_array_equal(again.alpha, alone.alpha)
        np.testing.assert_array_equal(again.normal, alone.normal)
    assert alone.codes().shape == (32, 48, 4) and image.codes().shape == (32, 48, 3)
    np.testing.assert_array_equal(alone.codes()[..., 3], np.round(alone.alpha * 255))
    with pytest.raises(hairline.SceneError, match="transparent"):
        scene.render(transparent=1)


def test_a_name_that_is_no_picture_is_refused(tmp_path, image):
    with pytest.raises(hairline.WorkError, match="end it in .png or .exr"):
        image.save(tmp_path / "a.jpg")
    with pytest.raises(hairline.WorkError, match="there is no folder"):
        image.save(tmp_path / "nowhere" / "a.png")
    with pytest.raises(hairline.WorkError, match="cannot read"):
        hairline.read_image(tmp_path / "gone.exr")


def test_pillow_shows_what_a_png_holds(image):
    pillow = pytest.importorskip("PIL.Image")
    decoded = np.asarray(pillow.open(io.BytesIO(image.png())))
    np.testing.assert_array_equal(decoded, np.asarray(image.to_pil()))
    brighter = np.asarray(image.to_pil(exposure_ev=2.0)).astype(int)
    assert brighter.sum() > decoded.astype(int).sum()


def test_without_pillow_it_is_asked_for(image, monkeypatch):
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    monkeypatch.setitem(sys.modules, "PIL", None)
    with pytest.raises(ImportError, match=r"to_pil needs Pillow: pip install 'hairline-render\[pil\]'"):
        image.to_pil()


def test_equal_pictures_do_not_differ_and_others_do(image, scene, tmp_path):
    same = hairline.compare(image, image)
    assert same["beauty"]["rms"] == 0 and same["beauty"]["psnr"] == np.inf and not same.problems
    scene.lights[0].radiance = 80
    brighter = scene.render(backend="cpu")
    assert hairline.compare(brighter, image)["beauty"]["relative_rms"] == pytest.approx(1.0, abs=1e-3)
    image.save(tmp_path / "a.exr")
    assert hairline.compare(tmp_path / "a.exr", image)["scratches"]["rms"] == 0
    with pytest.raises(hairline.SceneError, match="sizes differ"):
        hairline.compare(image, scene.render(size=(24, 16), backend="cpu"))


def test_a_reference_knows_its_noise_and_goes_on(scene):
    half = scene.reference(size=(24, 16), samples=128)
    assert (half.samples == 128).all() and half.variance("beauty").max() > 0
    whole = scene.reference(size=(24, 16), samples=256)
    gone_on = scene.reference(size=(24, 16), samples=256, resume=half)
    np.testing.assert_array_equal(gone_on.beauty, whole.beauty)
    assert (half.samples == 128).all(), "what was gone on from stays"
    closed = scene.render(size=(24, 16), backend="cpu")
    assert "verdict" in hairline.compare(closed, whole)["beauty"]
    with pytest.raises(hairline.SceneError, match="its seed of the samples is 0 and not 7"):
        scene.reference(size=(24, 16), samples=256, resume=half, sample_seed=7)
    with pytest.raises(hairline.SceneError, match="it is not a reference"):
        scene.reference(size=(24, 16), samples=256, resume=closed)


def test_a_reference_is_of_the_scene_as_it_is_now(scene):
    """What is kept of the one before goes with what changed."""
    scene.reference(size=(24, 16), samples=64)
    scene.lights[0].radiance = 80
    scene.scratches[0].depth_nm = 90
    scene.materials[0].metal = "gold"
    scene.gratings.append(hairline.Grating(object="plate", pattern="parallel", pitch_um=1.6))
    again = hairline.Scene.from_dict(scene.to_dict()).reference(size=(24, 16), samples=64)
    for _ in range(2):
        np.testing.assert_array_equal(scene.reference(size=(24, 16), samples=64).beauty, again.beauty)


def test_time_is_a_limit(scene):
    start = time.monotonic()
    image = scene.reference(size=(48, 32), time_s=0.2)
    assert time.monotonic() - start < 10
    assert scene.reference(size=(8, 8), samples=64, time_s=1e30).is_complete
    assert not image.is_complete and image.samples.max() > 0


def test_progress_is_told(scene, capfd):
    told = []
    scene.render(size=(160, 120), samples=16, backend="cpu", progress=lambda what, share: told.append((what, share)))
    assert told and all(0 <= share <= 1 for _, share in told)
    scene.render(backend="cpu", progress=True)
    out = capfd.readouterr()
    assert out.out == ""
    scene.render(backend="cpu")
    assert capfd.readouterr().err == "", "silent unless asked"


def test_what_a_progress_function_raises_ends_the_work(scene):
    def fail(what, share):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        scene.reference(size=(480, 320), samples=1 << 20, progress=fail)


def interrupt_soon(after_s):
    # A shell's background job starts with SIGINT ignored, and Python then installs no handler.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(after_s, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    return timer


def interrupting():
    """A progress function that presses Ctrl-C once three hundredths of the picture are there, however long that takes."""
    timers = []

    def told(what, share):
        if what == "rendering" and share > 0.03 and not timers:
            timers.append(interrupt_soon(0.05))

    return told


def test_ctrl_c_ends_a_reference_and_returns_what_there_is(scene):
    scene.build()
    interrupt_soon(1.5)
    start = time.monotonic()
    with pytest.warns(hairline.InterruptedWarning):
        image = scene.reference(size=(48, 32), samples=1 << 24)
    assert time.monotonic() - start < 30
    assert not image.is_complete and image.samples.max() > 0


def test_ctrl_c_ends_a_picture(scene):
    # Takes many seconds: 64 batches of 16 shadow rays for each pixel, the first of which is there when Ctrl-C is pressed.
    with pytest.warns(hairline.InterruptedWarning):
        image = scene.render(size=(400, 300), samples=1024, shadows=True, backend="cpu", progress=interrupting())
    assert not image.is_complete
    assert (image.depth_m > 0).any() and 0 < image.samples.max() < 1024


def test_ctrl_c_ends_a_picture_without_shadows(scene):
    with pytest.warns(hairline.InterruptedWarning):
        image = scene.render(size=(4000, 3000), samples=1024, shadows=False, backend="cpu", progress=interrupting())
    assert not image.is_complete
    done = image.depth_m > 0
    assert done.any() and not done[-1].all()


def test_other_threads_run_meanwhile(scene):
    """The interpreter's lock is free while a picture is sampled."""
    steps = []

    def count():
        while not stop.is_set():
            steps.append(time.monotonic())
            time.sleep(0.01)

    stop = threading.Event()
    counter = threading.Thread(target=count)
    counter.start()
    begin = time.monotonic()
    scene.reference(size=(96, 64), time_s=1.0)
    end = time.monotonic()
    stop.set()
    counter.join()
    during = [at for at in steps if begin < at < end]
    assert len(during) > 20


def test_import_needs_no_display_and_of_other_packages_numpy_alone():
    script = "import sys; before = set(sys.modules); import hairline; print(*{name.split('.')[0] for name in set(sys.modules) - before})"
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, check=True, text=True)
    assert {name for name in done.stdout.split() if name not in sys.stdlib_module_names} == {"hairline", "numpy"}


def test_nothing_is_warned_of_a_whole_picture(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.render(backend="cpu")
        scene.reference(size=(24, 16), samples=32)
