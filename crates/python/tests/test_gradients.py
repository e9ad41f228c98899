"""Pictures of derivatives."""

import numpy as np
import pytest

import hairline


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.fixture
def worn(scene):
    scene.scratches[0].update(count=2000, width_um={"mean": 3.0, "spread": 0.2}, depth_nm={"mean": 150.0, "spread": 0.2})
    return scene


def picture(scene):
    return scene.render(backend="cpu", shadows=False, samples=1).beauty.astype(float)


def test_light_is_linear_in_its_radiance(worn):
    by = worn.gradients(["light[0].radiance"])["light[0].radiance"]
    image = worn.render(backend="cpu", shadows=False, samples=1)
    for layer in ("base", "scratches"):
        right = getattr(image, layer).astype(float) / 40
        assert rms(getattr(by, layer) - right) < 1e-5 * rms(right)


# Of the second: against the difference of two pictures at a step that is right for it, since the fourth order of theirs is not used.
@pytest.mark.parametrize(
    "way, step, within",
    [
        ("light[0].radius_m", 2e-4, 3e-4),
        ("light[0].center_m[2]", 5e-4, 3e-4),
        ("material[0].roughness", 2e-3, 1e-3),
        ("scratches[0].width_um.mean", 0.05, 2e-3),
        ("scratches[0].depth_nm.mean", 8.0, 1e-2),
    ],
)
def test_derivatives_are_limits_of_differences(worn, way, step, within):
    found = worn.gradients([way])[way].beauty
    from hairline._changes import changed
    from hairline._changes import found as at

    table = worn.to_dict()
    value = at(table, way)
    either = [picture(hairline.Scene.from_dict(changed(table, {way: value + sign * step}))) for sign in (1, -1)]
    right = (either[0] - either[1]) / (2 * step)
    assert rms(found - right) < within * rms(right)
    # Another number's derivative is another picture.
    other = worn.gradients(["light[0].radiance"])["light[0].radiance"].beauty
    assert rms(found / rms(found) - other / rms(other)) > 0.05


@pytest.mark.parametrize(
    "way, message",
    [
        ("light[3].radiance", "light[3].radiance: found no such key in the scene"),
        ("light[0].center_m", "light[0].center_m: found"),
        ("light[0]radiance", "found no way to a key"),
        ("scratches[0].count", "scratches[0].count: found what other scratches are drawn by"),
        ("scratches[0].width_um.spread", "found what other scratches are drawn by"),
        ("material[0].metal", "must lead to a number"),
    ],
)
def test_wrong_ways_are_told(worn, way, message):
    with pytest.raises(hairline.SceneError) as raised:
        worn.gradients([way])
    assert message in str(raised.value)
    with pytest.raises(hairline.SceneError, match="relative_step: found 1"):
        worn.gradients([], relative_step=1)
