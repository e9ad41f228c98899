"""Ranges and presets for panels of other programs."""

import pytest

import hairline
from hairline import editing


def test_controls_lie_within_their_ends_and_fit_the_object():
    small, large = editing.controls(0.1), editing.controls(10.0)
    for control in small.values():
        (low, high), (least, most) = control.slider, control.hard
        assert least <= low < high <= most and control.tooltip.endswith(".")
    assert large["scratches.length_m"].slider[1] == pytest.approx(100 * small["scratches.length_m"].slider[1])
    assert small["scratches.width_um"].unit == "µm" and small["scratches.count"].is_whole and small["grating.pitch_um"].is_logarithmic


@pytest.mark.parametrize("kind", ["scratches", "grating", "wear"])
def test_presets_are_layers_that_can_be_built(kind, scene):
    for preset in editing.presets(kind):
        made = editing.from_preset(kind, preset.name, "plate", diagonal_m=0.2)
        assert len(made) == 1 or kind == "wear"
        (scene.gratings if kind == "grating" else scene.scratches).extend(made)
    scene.build()


def test_what_there_is_not_is_told():
    with pytest.raises(hairline.SceneError, match='kind: found "lights"; must be one of "scratches", "grating", "wear"'):
        editing.presets("lights")
    with pytest.raises(hairline.SceneError, match='name: found "Bent"; must be one of'):
        editing.from_preset("wear", "Bent", "plate", 0.2)


def test_a_built_scene_tells_its_memory(scene):
    few, _ = scene.build().memory_bytes()
    scene.scratches[0].count = 100_000
    many, there = scene.build().memory_bytes()
    assert many > few + 100_000 * 50 and (there is None or there > 0)


def test_a_shifted_camera_sees_what_lies_beside(scene):
    scene.camera.shift = (0.25, 0.0)
    moved = scene.render(size=(64, 64), samples=1, shadows=False, backend="cpu").depth_m
    scene.camera.shift = None
    plain = scene.render(size=(64, 64), samples=1, shadows=False, backend="cpu").depth_m
    assert abs(moved[:, :48] - plain[:, 16:]).max() < 1e-5 and abs(moved - plain).max() > 1e-3
