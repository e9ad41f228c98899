"""Pictures of derivatives."""

import numpy as np
import pytest

import hairline
from hairline._changes import changed
from hairline._changes import found as at
from hairline._host import Host

WITHIN = 1e-5


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.fixture
def worn(scene):
    scene.scratches[0].update(count=3000, width_um={"mean": 3.0, "spread": 0.2}, depth_nm={"mean": 150.0, "spread": 0.2})
    return scene


def light(scene):
    """Light of the base and of the scratches."""
    return np.stack(scene.build().light(None, 1.0, Host(False)))


def moved(scene, way, by):
    table = scene.to_dict()
    return hairline.Scene.from_dict(changed(table, {way: at(table, way) + by}))


def richardson(picture, step):
    """The derivative at 0 of a function, by differences of three steps whose errors of second and fourth order cancel."""
    each = [(picture(h) - picture(-h)) / (2 * h) for h in (step, 2 * step, 4 * step)]
    second = [(4 * each[i] - each[i + 1]) / 3 for i in (0, 1)]
    return (16 * second[0] - second[1]) / 15


def test_light_with_all_digits_is_that_of_pictures(worn):
    base, scratches = worn.build().light(None, 1.0, Host(False))
    image = worn.render(backend="cpu", shadows=False, samples=1)
    # The tables of pictures are linear between depths.
    assert rms(base - image.base) < 1e-4 * rms(image.base)
    assert rms(scratches - image.scratches) < 2e-3 * rms(image.scratches)


def test_light_is_linear_in_its_radiance(worn):
    by = worn.gradients(["light[0].radiance"])["light[0].radiance"]
    base, scratches = worn.build().light(None, 1.0, Host(False))
    assert rms(by.base - base / 40) < 1e-9 * rms(base / 40)
    assert rms(by.scratches - scratches / 40) < 1e-9 * rms(scratches / 40)


@pytest.mark.parametrize(
    # Of the base and of the scratches: see `gradients`.
    "way, steps",
    [
        ("light[0].radius_m", (2.2e-5, 2.2e-4)),
        ("light[0].center_m[0]", (4.1e-5, 4.1e-4)),
        ("light[0].center_m[2]", (4.1e-5, 4.1e-4)),
        ("material[0].roughness", (2e-5, 2e-5)),
        ("scratches[0].width_um.mean", (0.012, 0.012)),
        ("scratches[0].depth_nm.mean", (1.7, 1.7)),
    ],
)
def test_derivatives_are_limits_of_differences(worn, way, steps):
    by = worn.gradients([way])[way]
    for i, layer in enumerate(("base", "scratches")):
        found, right = by[i], richardson(lambda by: light(moved(worn, way, by)), steps[i])[i]
        if way == "material[0].roughness" and layer == "scratches":
            # Scratches know nothing of it.
            assert rms(found) == rms(right) == 0
            continue
        error = rms(found - right) / rms(right)
        print(f"{way}, {layer}: {error:.1e}")
        assert error < WITHIN
        # One that is off by a hundredth of a percent is told apart.
        assert rms(1.0001 * found - right) > WITHIN * rms(right)


def test_by_a_density_the_derivative_is_that_of_the_mean_picture(worn):
    """The mean of what scratches send is in proportion to their number, where they are too few to weaken one another."""
    table = worn.to_dict()
    few = hairline.Scene.from_dict(changed(table, {"scratches[0].count": 200}))
    by = few.gradients(["scratches[0].count"])["scratches[0].count"]
    base, scratches = few.build().light(None, 1.0, Host(False))
    assert rms(200 * by.scratches - scratches) < 1e-2 * rms(scratches)

    def of_seeds(count, seeds):
        scenes = (changed(table, {"scratches[0].count": count, "scratches[0].seed": seed}) for seed in seeds)
        return [light(hairline.Scene.from_dict(one)).sum(axis=0).mean() for one in scenes]

    # By another density scratches are other ones, and only means over many of them tell: here over the picture and over seeds.
    seeds = range(1, 9)
    counts = (2000, 4000)
    right = (np.mean(of_seeds(counts[1], seeds)) - np.mean(of_seeds(counts[0], seeds))) / (counts[1] - counts[0])
    slopes = []
    for seed in seeds:
        one = hairline.Scene.from_dict(changed(table, {"scratches[0].count": 3000, "scratches[0].seed": seed}))
        slopes.append(one.gradients(["scratches[0].count"])["scratches[0].count"].beauty.mean())
    print(f"by the count: {np.mean(slopes):.4e}, of means {right:.4e}")
    assert abs(np.mean(slopes) / right - 1) < 0.1


@pytest.mark.parametrize(
    "way, message",
    [
        ("light[3].radiance", "light[3].radiance: found no such key in the scene"),
        ("light[0].center_m", "light[0].center_m: found"),
        ("light[0]radiance", "found no way to a key"),
        ("scratches[0].seed", "scratches[0].seed: found what other scratches are drawn by"),
        ("scratches[0].width_um.spread", "found what other scratches are drawn by"),
        ("material[0].metal", "must lead to a number"),
    ],
)
def test_wrong_ways_are_told(worn, way, message):
    worn.scratches[0].seed = 3
    with pytest.raises(hairline.SceneError) as raised:
        worn.gradients([way])
    assert message in str(raised.value)
    with pytest.raises(hairline.SceneError, match="relative_step: found 1"):
        worn.gradients([], relative_step=1)
