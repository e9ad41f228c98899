"""Pictures in bands of the spectrum."""

import numpy as np
import pytest

import hairline
from hairline import optics

ALL = [(nm, nm + 5.0) for nm in range(380, 780, 5)]


def lit(scene, metal="gold"):
    scene.materials[0].metal = metal
    scene.scratches[0].count = 2000
    return scene


def test_bands_by_the_eyes_curves_are_the_colours(scene):
    """The eye's weights are tabulated where bands meet, and linear between."""
    lit(scene)
    bands = scene.render_bands(ALL, shadows=False, samples=1)
    colours = scene.render(backend="cpu", shadows=False, samples=1)
    weights = optics.spectrum().weight
    assert weights.shape == (81, 3)
    of_band = 0.5 * (weights[1:] + weights[:-1])
    of_band[0] += 0.5 * weights[0]
    of_band[-1] += 0.5 * weights[-1]
    for layer in ("base", "scratches"):
        found = getattr(bands, layer).astype(float) @ of_band
        right = getattr(colours, layer).astype(float)
        error = np.sqrt(np.mean((found - right) ** 2) / np.mean(right**2))
        print(f"{layer}: {error:.2e}")
        assert error < 0.01
        # Bands in another order have other colours.
        wrong = getattr(bands, layer).astype(float) @ of_band[::-1]
        assert np.sqrt(np.mean((wrong - right) ** 2) / np.mean(right**2)) > 0.1


def test_lamps_by_temperature_are_black_bodies(scene):
    """On a mirror, where light keeps its spectrum: of a colour times a metal's the picture in colour knows no more than three numbers."""
    scene.scratches = []
    scene.materials[0].update(kind="mirror", metal=None)
    scene.lights[0].temperature_k = 2700
    bands = scene.render_bands(ALL, size=(24, 16), shadows=False, samples=1)
    colours = scene.render(size=(24, 16), backend="cpu", shadows=False, samples=1).beauty
    np.testing.assert_allclose(bands.rgb(), colours, rtol=5e-3, atol=1e-3 * colours.max())
    # It is no grey one.
    scene.lights[0].temperature_k = None
    white = scene.render_bands(ALL, size=(24, 16), shadows=False, samples=1).rgb()
    assert np.sqrt(np.mean((white - colours) ** 2) / np.mean(colours**2)) > 0.3
    # One whose colour is another than the body's has no spectrum.
    scene.lights[0].update(temperature_k=2700, color=(1.0, 0.5, 0.2))
    with pytest.raises(hairline.SceneError, match="the radiance of light 0"):
        scene.render_bands([(400, 410)])


def test_illuminants_have_their_white_on_a_mirror(scene):
    scene.scratches = []
    scene.materials[0].update(kind="mirror", metal=None)
    bands = scene.render_bands(ALL, size=(12, 8), shadows=False, samples=1)
    colours = scene.render(size=(12, 8), backend="cpu", shadows=False, samples=1).beauty
    np.testing.assert_allclose(bands.rgb(), colours, rtol=2e-3, atol=1e-6 * colours.max())
    xyz_from_rgb = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])
    brightest = np.unravel_index(np.argmax(colours[..., 1]), colours.shape[:2])
    every = np.arange(380.0, 781.0, 5.0)
    own = np.stack([every, 100 * np.ones_like(every)], axis=1)
    # CIE 15: chromaticities of the illuminants.
    for illuminant, x, y in [("D65", 0.3127, 0.3290), ("A", 0.4476, 0.4074), ("E", 1 / 3, 1 / 3), (own, 1 / 3, 1 / 3)]:
        xyz = xyz_from_rgb @ bands.rgb(illuminant)[brightest]
        assert xyz[:2] / xyz.sum() == pytest.approx([x, y], abs=1e-3)
        assert xyz[1] == pytest.approx(colours[brightest][1], rel=3e-3)
    # Another observer: one that sees green alone, as all three.
    green = np.stack([every, *[(abs(every - 550) < 20) * 1.0] * 3], axis=1)
    assert bands.rgb("E", green)[brightest] @ [0.2126, 0.7152, 0.0722] == pytest.approx(colours[brightest][1], rel=3e-3)
    for wrong in ("D50", np.ones((3, 3)), [[500, 1], [400, 1]], [[100, 1], [200, 1]]):
        with pytest.raises(hairline.SceneError, match="illuminant"):
            bands.rgb(wrong)
    with pytest.raises(hairline.SceneError, match="observer"):
        bands.rgb(observer="1964")


def test_a_metal_reflects_as_fresnel_says_at_the_middle_of_each_band(scene):
    scene.scratches = []
    bands = [(400, 410), (500, 510), (600, 610), (700, 710)]
    mirror = hairline.Scene.from_dict(scene.to_dict())
    mirror.materials[0].update(kind="mirror", metal=None)
    scene.materials[0].update(metal="copper", roughness=0.2)
    mirror.materials[0].roughness = 0.2
    metal, white = (it.render_bands(bands, shadows=False, samples=1).base for it in (scene, mirror))
    brightest = np.unravel_index(np.argmax(white[..., 0]), white.shape[:2])
    # The highlight of a lamp that is seen at some 40 degrees from the normal, of which copper's reflectance knows next to nothing.
    found = metal[brightest] / white[brightest]
    right = [float(optics.fresnel_metal("copper", 0.8, 0.5 * (low + high))) for low, high in bands]
    print(f"found {found}, Fresnel {right}")
    assert found == pytest.approx(right, rel=0.01)
    assert found[0] < 0.7 * found[3]


def test_the_reference_agrees_in_bands_as_it_does_in_colour(scene):
    """Few pixels have few places of a highlight, and closed forms look at the middles of pixels: so each is compared with its own picture in colour."""
    lit(scene, "silver")
    bands = [(440, 460), (640, 660)]
    few = {"size": (12, 8), "shadows": False}
    closed = scene.render_bands(bands, samples=64, **few).beauty.sum(axis=(0, 1))
    sampled = scene.reference_bands(bands, samples=4096, **few).beauty.sum(axis=(0, 1))
    colours = [it.beauty.sum(axis=(0, 1))[1] for it in (scene.render(backend="cpu", samples=64, **few), scene.reference(samples=4096, **few))]
    ratio = sampled / closed / (colours[1] / colours[0])
    print(f"reference over closed form, in bands over in colour: {ratio}")
    assert ratio == pytest.approx([1, 1], abs=0.01)


def test_files_have_spectral_channels(scene, tmp_path):
    bands = scene.render_bands([(400, 410), (411, 413.5)], size=(16, 8), shadows=False, samples=1)
    bands.save(tmp_path / "bands.exr")
    data = (tmp_path / "bands.exr").read_bytes()
    for name in (b"S0.405,00nm", b"base.S0.412,25nm", b"scratches.S0.405,00nm", b"400:410 411:413.5"):
        assert name in data
    with pytest.raises(hairline.WorkError, match="need an .exr"):
        bands.save(tmp_path / "bands.png")


@pytest.mark.parametrize(
    "change, message",
    [
        (lambda scene: setattr(scene.lights[0], "color", (1.0, 0.5, 0.2)), "the radiance of light 0"),
        (lambda scene: scene.materials[0].update(kind="metal", metal=None, base_color=(0.9, 0.5, 0.2)), "the colour of material \"steel\""),
    ],
)
def test_what_has_no_spectrum_is_refused(scene, change, message):
    change(scene)
    with pytest.raises(hairline.SceneError) as raised:
        scene.render_bands([(400, 410)])
    assert message in str(raised.value) and "has no spectrum" in str(raised.value)


@pytest.mark.parametrize("bands", [[], [(410, 400)], [(300, 400)], [(700, 790)], [(500, 500.5)]])
def test_bands_that_are_none_are_refused(scene, bands):
    with pytest.raises(hairline.SceneError):
        scene.render_bands(bands)
