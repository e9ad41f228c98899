"""The physics over arrays."""

import numpy as np
import pytest

import hairline
from hairline import optics


def test_the_phase_step_is_its_equation():
    depth, wavelength = np.linspace(0, 500, 11)[:, None], np.linspace(400, 700, 7)
    expected = 4 * np.sin(2 * np.pi * depth / wavelength) ** 2
    found = optics.phase_step_energy(depth, wavelength)
    assert found.shape == (11, 7)
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_numbers_are_arrays_of_no_dimension():
    assert optics.phase_step_energy(125.0, 500.0).shape == ()
    assert optics.phase_step_energy(125, 500) == pytest.approx(4.0)
    assert optics.metal_rgb("gold").shape == (3,)
    assert optics.phase_step_energy([], 500).shape == (0,)


def test_a_dielectric_reflects_what_it_does_at_normal_incidence():
    assert optics.fresnel_dielectric(1.0, 1.5) == pytest.approx(0.04)
    assert optics.fresnel_dielectric(0.0, 1.5) == 1.0


def test_a_metals_colour_is_that_of_its_spectrum():
    light = optics.spectrum()
    assert light.weight.shape == (81, 3)
    np.testing.assert_allclose(light.weight.sum(axis=0), 1)
    for metal in optics.metals():
        spectral = optics.fresnel_metal(metal, 1.0, light.wavelength_nm)
        np.testing.assert_allclose(optics.rgb_from_spectrum(spectral), optics.metal_rgb(metal), rtol=1e-12)


def test_the_table_is_the_sum_of_the_spectrum():
    """Radiance by the table against the sum over wavelengths, weighed by the metal."""
    light = optics.spectrum()
    width, depth, low, high = 4.0, 160.0, 0.1, 0.4
    spectral = optics.scratch_spectrum(width, depth, low, high, light.wavelength_nm)
    reflectance = optics.fresnel_metal("gold", 1.0, light.wavelength_nm)
    expected = optics.rgb_from_spectrum(spectral * reflectance) / optics.metal_rgb("gold")
    found = optics.scratch_radiance("gold", width, depth, low, high)
    # Columns of the table hold a slope, and rows are linear in depth.
    np.testing.assert_allclose(found, expected, atol=2e-3 * np.abs(expected).max())


def test_all_of_a_groove_is_between_the_ends_of_its_table():
    depth = np.array([50.0, 150.0, 300.0])
    whole = optics.scratch_radiance("steel", 3.0, depth, -np.inf, np.inf)
    np.testing.assert_allclose(whole, optics.scratch_mean_energy("steel", depth), rtol=1e-3)


def test_a_lone_groove_takes_its_energy():
    energy = optics.scratch_mean_energy("steel", 150.0)
    taken = optics.mask(0.03, energy, share_by_line=0.03 * 0.03)
    np.testing.assert_allclose(taken, 0.03 * energy, rtol=1e-9)
    assert optics.depth_coherence([100.0, 100.0]) == pytest.approx(1.0)
    assert optics.depth_coherence(np.arange(2750.0)) == pytest.approx(0.5, abs=0.02)


def test_a_window_share_is_the_full_fields_overlap():
    """A groove along the point: what it covers of the window, by both."""
    overlap = optics.window_overlap_um2(0.0, -np.inf, np.inf, 20.0)
    assert optics.window_share(2.0, overlap, 20.0) == pytest.approx(2.0 / (np.sqrt(np.pi) * 20.0), rel=1e-3)


def test_no_groove_is_a_mirror():
    angle = np.linspace(-0.02, 0.02, 401)
    x, y = np.meshgrid(angle, angle)
    parts = optics.coherent_response(np.zeros((0, 6)), x, y, 550.0)
    assert (parts[..., 1:] == 0).all()
    assert parts[..., 0].sum() * (angle[1] - angle[0]) ** 2 == pytest.approx(1.0, rel=1e-3)


def test_a_groove_scatters_its_share():
    groove = [[0.0, 0.0, -np.inf, np.inf, 3.0, 137.5]]
    x, y = np.meshgrid(np.linspace(-0.03, 0.03, 61), np.linspace(-1, 1, 4001))
    scattered = optics.coherent_response(groove, x, y, 550.0)[..., 2].sum() * 0.001 * 0.0005
    share = optics.window_share(3.0, optics.window_overlap_um2(0, -np.inf, np.inf, 20.0), 20.0)
    # sinc^2 beyond the sine of 1 is cut: a few percent.
    assert scattered == pytest.approx(4 * share, rel=0.08)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: optics.phase_step_energy("deep", 500), "depth_nm: found texts"),
        (lambda: optics.phase_step_energy(np.nan, 500), "depth_nm: found NaN"),
        (lambda: optics.phase_step_energy([5, -5], 500), "depth_nm: found -5; must be from 0 to 1e+09"),
        (lambda: optics.phase_step_energy(5, 0), "wavelength_nm: found 0; must be above 0"),
        (lambda: optics.fresnel_metal("gold", 1, 900), "wavelength_nm: found 900; must be from 380 to 780"),
        (lambda: optics.fresnel_metal("gold", 2, 500), "cos_theta: found 2; must be from 0 to 1"),
        (lambda: optics.scratch_mean_energy("gold", 2500), "depth_nm: found 2500; must be from 0 to 2000"),
        (lambda: optics.phase_step_energy(np.ones(3), np.ones(4)), "found shapes that do not fit one another"),
        (lambda: optics.metal_rgb("unobtainium"), 'metal: found "unobtainium"; must be one of "iron"'),
        (lambda: optics.rgb_from_spectrum(np.ones(80)), "values: found an array of shape (80,); must end in 81"),
        (lambda: optics.mask(0.1, [1.0, 2.0]), "mean_energy: found an array of shape (2,)"),
        (lambda: optics.coherent_response([[1, 2, 3]], 0, 0, 550), "grooves: found an array of shape (1, 3)"),
        (lambda: optics.depth_coherence(object()), "depth_nm: found an object of type builtins.object"),
    ],
)
def test_wrong_arguments(call, message):
    with pytest.raises(hairline.SceneError) as caught:
        call()
    assert message in str(caught.value)
