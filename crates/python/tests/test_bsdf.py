"""The reflection of a scratched metal by itself."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

import hairline
from hairline import optics
from hairline.bsdf import Grating, Layer, Scratched

LAYER = Layer(width_um=(2.0, 0.2), depth_nm=(160.0, 0.2), coverage=0.03)
ROW = Grating(pitch_um=1.6, width_um=0.6, depth_nm=110.0, coverage=0.5, direction_deg=30, angle_std_deg=1, theory="scalar")
FINE = Grating(pitch_um=0.74, width_um=0.3, depth_nm=60.0, coverage=0.5, direction_deg=30, angle_std_deg=1)
PLATE = {"ior": 1.58, "thickness_mm": 1.2, "color": (0.8, 0.8, 0.8)}
POINT = [[0.7, 3.0, -400.0, 90.0, 2.0, 150.0]]
MATERIALS = {
    "bare": Scratched("steel", roughness=0.3),
    "all ways": Scratched("steel", roughness=0.3, layers=[LAYER]),
    "one way": Scratched("gold", roughness=0.3, layers=[Layer(2.0, 150.0, 0.04, direction_deg=20, spread_deg=3)]),
    "round ones": Scratched("steel", roughness=0.3, layers=[Layer(2.0, 200.0, 0.04, profile="round")]),
    "listed one way": Scratched("gold", layers=[Layer(2.0, 150.0, 0.04, direction_deg=20, spread_deg=3, profile=(1, 0.7, 0, -0.3, 0))], roughness=0.3),
    "row": Scratched("steel", roughness=0.3, gratings=[ROW]),
    "row without orders": Scratched("steel", roughness=0.3, gratings=[Grating(10.0, 3.0, 200.0, coverage=0.3, jitter_um=20.0)]),
    "point": Scratched("steel", roughness=0.3, scratches=POINT),
    "together": Scratched("steel", roughness=0.3, layers=[LAYER], gratings=[ROW], scratches=POINT),
    "in a coat": Scratched("steel", roughness=0.3, layers=[LAYER], gratings=[ROW], scratches=POINT, clearcoat=1, clearcoat_roughness=0.2),
    "in half a coat": Scratched("gold", roughness=0.3, layers=[LAYER], clearcoat=0.5, clearcoat_roughness=0.2),
    "under a plate": Scratched("gold", roughness=0.3, layers=[LAYER], gratings=[ROW], cover=PLATE),
    "fine row": Scratched("gold", roughness=0.3, gratings=[FINE]),
    "fine row under a plate": Scratched("gold", roughness=0.3, gratings=[replace(FINE, jitter_um=0.05)], layers=[LAYER], cover=PLATE),
}


def bare_of(material):
    """The same metal, coat and plate without scratches and gratings."""
    return Scratched(
        material.metal,
        roughness=material.roughness,
        clearcoat=material.clearcoat,
        clearcoat_roughness=material.clearcoat_roughness,
        cover=material.cover,
    )


def direction(theta, phi=0.0):
    return np.stack(
        np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), axis=-1
    )


def in_bins(wi):
    """Bins of the disc of tangential components, even in the square of the radius and in the angle."""
    radius = np.minimum((wi[:, 0] ** 2 + wi[:, 1] ** 2) * 12, 11.999).astype(int)
    angle = np.minimum((np.arctan2(wi[:, 1], wi[:, 0]) / (2 * np.pi) + 0.5) * 24, 23.999).astype(int)
    return radius * 24 + angle


def chi_square(material, wo, wavelength_nm, pdf_of=lambda pdf: pdf):
    """Chi square of samples over what their density has in each bin, and its degrees of freedom; K. Pearson (1900)."""
    random = np.random.default_rng(3)
    count = 200_000
    drawn = material.sample(wo, random.random((count, 3)), wavelength_nm=wavelength_nm)
    kept = drawn.wi[drawn.pdf > 0]
    found = np.bincount(in_bins(kept), minlength=288).astype(float)
    # Quadrature of the density: a grid of the disc, finer than a band is wide, and about the mirror's direction, where the density rises without
    # bound, a grid of polar coordinates.
    steps, near = 1400, 0.05
    line = (2 * np.arange(steps) + 1) / steps - 1
    at = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    at = at[(np.sum(at**2, axis=1) < 1 - 1e-9) & (np.linalg.norm(at + wo[:2], axis=1) > near)]
    radius, angle = np.meshgrid((np.arange(300) + 0.5) * near / 300, (np.arange(600) + 0.5) * np.pi / 300)
    around = radius[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1) - wo[:2]
    weight = np.concatenate([np.full(len(at), 4 / steps**2), (radius * near / 300 * np.pi / 300).reshape(-1)])
    at = np.concatenate([at, around.reshape(-1, 2)])
    wi = np.concatenate([at, np.sqrt(1 - np.sum(at**2, axis=1))[:, None]], axis=1)
    pdf = pdf_of(material.pdf(wi, wo, wavelength_nm=wavelength_nm))
    expected = np.bincount(in_bins(wi), weights=pdf / wi[:, 2] * weight, minlength=288) * count
    # Samples below the horizon are a bin of their own.
    found, expected = np.append(found, count - len(kept)), np.append(expected, count - expected.sum())
    rest = expected < 40
    found = np.append(found[~rest], found[rest].sum())
    expected = np.append(expected[~rest], expected[rest].sum())
    # The expected numbers have an error of their own: less than two parts in a hundred of a bin of 40.
    variance = np.maximum(expected, 1) + (0.01 * expected) ** 2
    return float(np.sum((found - expected) ** 2 / variance)), len(found) - 1


@pytest.mark.parametrize("name", MATERIALS)
@pytest.mark.parametrize("wavelength_nm, theta", [(None, 0.9), (550.0, 0.1)])
def test_samples_have_the_density(name, wavelength_nm, theta):
    chi2, freedom = chi_square(MATERIALS[name], direction(theta, 0.4), wavelength_nm)
    # One in ten thousand by chance (the cube root of chi square is nearly normal: E. Wilson, M. Hilferty, 1931).
    bound = freedom * (1 - 2 / (9 * freedom) + 3.7 * math.sqrt(2 / (9 * freedom))) ** 3
    assert chi2 < bound, (chi2, bound)


def test_a_wrong_density_is_found():
    wo = direction(0.9, 0.4)
    chi2, freedom = chi_square(MATERIALS["all ways"], wo, None, lambda pdf: pdf * 1.1)
    assert chi2 > 3 * freedom


@pytest.mark.parametrize("name", MATERIALS)
def test_weights_of_samples_are_values_over_densities(name):
    material = MATERIALS[name]
    wo = direction(0.5, 1.0)
    drawn = material.sample(wo, np.random.default_rng(1).random((1000, 3)))
    kept = drawn.pdf > 0
    assert kept.mean() > 0.8
    np.testing.assert_allclose(np.linalg.norm(drawn.wi[kept], axis=1), 1, rtol=1e-9)
    np.testing.assert_allclose(material.eval(drawn.wi[kept], wo), drawn.value[kept])
    np.testing.assert_allclose(material.pdf(drawn.wi[kept], wo), drawn.pdf[kept])
    np.testing.assert_array_equal(drawn.value[~kept], 0)
    parts = [material.eval(drawn.wi[kept], wo, part=part) for part in ("base", "scratches")]
    np.testing.assert_allclose(parts[0] + parts[1], drawn.value[kept])


@pytest.mark.parametrize("name", MATERIALS)
def test_no_light_is_made_or_lost(name):
    random = np.random.default_rng(2)
    bare = bare_of(MATERIALS[name])
    for theta in (0.0, 0.7):
        wo = direction(theta)

        def albedo(material):
            drawn = material.sample(wo, random.random((300_000, 3)))
            kept = drawn.pdf > 0
            return np.sum(drawn.value[kept] / drawn.pdf[kept, None], axis=0) / 300_000

        if "fine" in name:
            # Fine grooves absorb; how much, says a test of the crate by their efficiencies.
            assert (albedo(MATERIALS[name]) < 1.005 * albedo(bare)).all()
            continue
        # 1 % and the noise of the samples.
        np.testing.assert_allclose(albedo(MATERIALS[name]), albedo(bare), rtol=0.02)


def test_one_scratch_is_the_equation():
    """Equations (4) to (6) of the model, written out."""
    nm, sigma, width, depth = 550.0, 20.0, 2.0, 150.0
    material = Scratched("steel", scratches=[[0.0, 5.0, -np.inf, np.inf, width, depth]])
    wi, wo = direction(0.30, 1.5), direction(0.1, -1.5)
    t, q = (wi + wo)[:2]
    s = 1e-3 * nm / (2 * math.sqrt(2) * math.pi * sigma)
    d2 = 4 * math.sin(2 * math.pi * depth * (wi[2] + wo[2]) / 2 / nm) ** 2
    share = width / (math.sqrt(math.pi) * sigma) * math.exp(-25 / sigma**2)
    across = width / (1e-3 * nm) * np.sinc(width * q / (1e-3 * nm)) ** 2
    along = math.exp(-0.5 * (t / s) ** 2) / (math.sqrt(2 * math.pi) * s)
    fresnel = optics.fresnel_metal("steel", wo[2], nm)
    # One scratch does not weaken itself.
    expected = fresnel * d2 * share * across * along * wi[2]
    assert material.eval(wi, wo, wavelength_nm=nm, part="scratches") == pytest.approx(float(expected), rel=1e-6)


def test_a_layer_is_the_mean_of_its_scratches():
    """One scratch after another at random places and angles, against the closed form."""
    random = np.random.default_rng(5)
    count = 300_000
    angle = random.uniform(0, np.pi, count)
    wi, wo = direction(0.12, 2.0), direction(0.05, 0.3)
    nm = 550.0
    t = (wi + wo)[0] * np.cos(angle) + (wi + wo)[1] * np.sin(angle)
    q = (wi + wo)[1] * np.cos(angle) - (wi + wo)[0] * np.sin(angle)
    s = float(optics.band_std(20.0, nm))
    d2 = float(optics.phase_step_energy(optics.oblique_depth_nm(150.0, wi[2], wo[2]), nm))
    each = d2 * 2 / 0.55 * np.sinc(2 * q / 0.55) ** 2 * np.exp(-0.5 * (t / s) ** 2) / (math.sqrt(2 * math.pi) * s)
    mean, noise = each.mean(), each.std() / math.sqrt(count)
    thin = 1e-6
    layer = Scratched("steel", layers=[Layer(2.0, 150.0, thin)])
    fresnel = float(optics.fresnel_metal("steel", wo[2], nm))
    found = layer.eval(wi, wo, wavelength_nm=nm, part="scratches") / (thin * fresnel * wi[2])
    assert abs(found - mean) < 4 * noise and noise < 0.02 * mean


def test_a_scene_becomes_its_mean(scene):
    scene.scratches[0].update(count=5000)
    material = Scratched.from_scene(scene, "plate")
    [layer] = material.layers
    assert layer.direction_deg is None
    laid = scene.build().laid("plate")
    length = np.linalg.norm(laid["end_m"] - laid["start_m"], axis=1)
    assert layer.share == pytest.approx(float(1e-6 * (laid["width_um"] * length).sum() / laid["area_m2"]))
    assert laid["area_m2"] == pytest.approx(math.pi * 0.08**2, rel=0.01)
    scene.scratches[0].update(pattern="parallel", curvature_per_m=None, direction=(1, 1, 0), jitter_deg=4)
    [layer] = Scratched.from_scene(scene, "plate").layers
    assert layer.direction_deg == pytest.approx(45, abs=1) and layer.spread_deg == pytest.approx(4, abs=0.5)


def test_arrays_are_broadcast():
    material = MATERIALS["all ways"]
    wi, wo = direction(np.linspace(0, 1, 5)[:, None]), direction(np.linspace(0, 1, 3))
    assert material.eval(wi, wo).shape == (5, 3, 3)
    assert material.eval(wi, wo, wavelength_nm=550).shape == (5, 3)
    assert material.eval(wi[0], wo[0], wavelength_nm=[500, 600]).shape == (2,)
    assert material.pdf(wi, wo).shape == (5, 3)
    assert material.eval(direction(2.0), wo).tolist() == [[0, 0, 0]] * 3
    again = pickle.loads(pickle.dumps(material))
    np.testing.assert_array_equal(again.eval(wi, wo), material.eval(wi, wo))


def test_the_share_of_a_layer_is_that_of_its_grooves():
    layer = Layer(density_per_m2=1e6, length_m=0.01, grooves=((0.5, 10, 200), (0.5, 5, 200)))
    # Half of the area by each: twice as many of 5 um as of 10 um.
    assert layer.share == pytest.approx(1e6 * 0.01 * (10 + 2 * 5) / 3 * 1e-6)


@pytest.mark.parametrize("profile, depth_share", [("v", lambda x: 1 - x), ("round", lambda x: 1 - x * x), ((1, -0.5), lambda x: 1 - 1.5 * x)])
def test_a_profile_sends_the_transform_of_its_phases(profile, depth_share):
    nm, width, depth = 550.0, 2.0, 240.0
    wi, wo = direction(0.30, 1.5), direction(0.1, -1.5)
    q = np.linalg.norm((wi + wo)[:2])
    x = (np.arange(20_000) + 0.5) / 20_000 - 0.5
    path = 4 * np.pi * depth * 0.5 * (wi[2] + wo[2]) / nm
    wave = np.exp(2e3j * np.pi / nm * width * q * x)

    def sent(depth_shares):
        return abs(np.mean((1 - np.exp(-1j * path * depth_shares)) * wave)) ** 2

    def of(profile):
        layer = Layer(width, depth, 1e-6, profile=profile)
        return Scratched("steel", layers=[layer]).eval(wi, wo, wavelength_nm=nm, part="scratches")

    right = sent(depth_share(2 * abs(x))) / sent(np.ones_like(x))
    assert of(profile) / of("rectangle") == pytest.approx(right, rel=3e-3)
    assert abs(right - 1) > 0.1


def test_another_footprint_is_that_of_a_new_material():
    wi, wo = direction(0.30, 1.5), direction(0.1, -1.5)
    material = Scratched("steel", layers=[LAYER], scratches=POINT)
    each = [material.eval(wi, wo, footprint) for footprint in (0.0, 40.0, 0.0)]
    np.testing.assert_array_equal(each[0], each[2])
    np.testing.assert_array_equal(each[1], Scratched("steel", layers=[LAYER], scratches=POINT).eval(wi, wo, 40.0))
    assert (each[0] != each[1]).any()


def test_layers_of_a_scene_have_its_profiles(scene):
    scene.scratches[0].profile = "round"
    material = Scratched.from_scene(scene, "plate")
    assert material.layers[0].profile == "round"
    assert pickle.loads(pickle.dumps(material)).layers == material.layers


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda m: m.eval([0, 0, 2], [0, 0, 1]), "wi: found (0, 0, 2) at 0; must be unit vectors"),
        (lambda m: m.eval([0, 0, 1], [0, 0, math.nan]), "wo: found (0, 0, NaN) at 0; must be unit vectors"),
        (lambda m: m.eval([0, 0], [0, 0, 1]), "wi: found an array of shape (2,); must end in 3 components"),
        (lambda m: m.eval(np.zeros((2, 3)), np.zeros((3, 3))), "wi, wo: found shapes that do not fit one another"),
        (lambda m: m.eval([0, 0, 1], [0, 0, 1], wavelength_nm=300), "wavelength_nm: found 300; must be from 380 to 780"),
        (lambda m: m.eval([0, 0, 1], [0, 0, 1], part="all of it"), 'part: found "all of it"; must be one of "all", "base"'),
        (lambda m: m.eval([0, 0, 1], [0, 0, 1], -1), "footprint_um: found -1"),
        (lambda m: m.sample([0, 0, 1], [0.1, 0.2, 1.0]), "u: found a number outside of [0, 1)"),
        (lambda m: Scratched("tin"), 'metal: found "tin"; must be one of'),
        (lambda m: Scratched(np.ones((80, 2))), "metal: found an array of shape 80 x 2; must be of shape n x 3"),
        (lambda m: Scratched([[400, math.nan, 1]]), "metal: found the n nan in row 0; must be above 0, up to 100"),
        (lambda m: Scratched([[500, 1, 1], [400, 1, 1]]), "metal: found the wavelength 400 in row 1 after 500; must rise"),
        (lambda m: Scratched(roughness=2), "roughness: found 2; must be a number from 0 to 1"),
        (lambda m: Scratched(gratings=[ROW, ROW, ROW]), "gratings: found coverages that add up to 1.5"),
        (lambda m: Scratched(layers=[ROW]), "layers[0]: found an object of type Grating; must be a hairline.bsdf.Layer"),
        (lambda m: Scratched(scratches=[[0, 0, 5, 1, 2, 100]]), "scratches: found a scratch that is none"),
        (lambda m: Layer(width_um=0.0, coverage=0.1), "width_um: found 0.0; must be a number from 0.05 to 100"),
        (lambda m: Scratched(layers=[Layer(coverage=0.1, profile="w")]), 'profile: found "w"; must be one of "rectangle"'),
        (lambda m: Scratched(layers=[Layer(coverage=0.1, profile=(0, 0))]), "profile: found [0.0, 0.0]; must be a name, or 2 to 64"),
        (lambda m: Layer(), "coverage: found coverage=None"),
        (lambda m: Layer(coverage=0.1, length_m=0.1), "coverage: found coverage=0.1"),
        (lambda m: Layer(coverage=0.1, spread_deg=10.0), "spread_deg: found 10 without direction_deg"),
        (lambda m: Layer(coverage=0.1, grooves=()), "grooves: found parts that add up to 0; must add up to 1"),
        (lambda m: Layer(coverage=0.1, grooves=((1, 0, 100),)), "grooves[0].width_um: found 0; must be a number from"),
        (lambda m: Layer(coverage=0.1, grooves=((1, 2, math.nan),)), "grooves[0].depth_nm: found nan"),
        (lambda m: Scratched(layers=[Layer(30.0, 100.0, 0.1)]), "width_um: found 30; must be 8 at most, 0.4 of coherence_um"),
        (lambda m: Scratched(scratches=[[0, 0, -math.inf, math.inf, 2, math.inf]]), "scratches: found NaN or an infinite number"),
        (lambda m: Scratched([[550, 1.0, 0.0]]), "metal: found n = 1 and k = 0 in all rows, which is air"),
        (lambda m: Scratched(clearcoat=1.5), "clearcoat: found 1.5; must be from 0 to 1"),
        (lambda m: Scratched(clearcoat=1, clearcoat_roughness=-1), "clearcoat_roughness: found -1; must be from 0 to 1"),
        (lambda m: Scratched(clearcoat_roughness=0.2), "clearcoat_roughness: found no `clearcoat` beside it"),
        (lambda m: Scratched(clearcoat=1, cover=PLATE), "cover: found a `clearcoat` beside it; leave one of them out"),
        (lambda m: Scratched(cover={"ior": 0.5}), "cover.ior: found 0.5; must be from 1 to 4"),
        (lambda m: Scratched(cover={"ior": math.nan}), "cover.ior: found NaN"),
        (lambda m: Scratched(cover={"index": 1.5}), "cover.index: unknown key"),
        (lambda m: Scratched(cover=1.58), "cover: found the number 1.58; must be a table"),
        (lambda m: Scratched(cover={"color": (1, 1, 0.5)}).pdf([0, 0, 1], [0, 0, 1], wavelength_nm=500), "wavelength_nm: found wavelengths for a cover of a colour"),
        (lambda m: replace(FINE, theory="vector"), "theory: found 'vector'; must be \"rigorous\" or \"scalar\""),
        (lambda m: Grating(1.6, 2.0, 100), "width_um: found 2.0; must be a number from 0.01 to 1.6"),
    ],
)
def test_wrong_input_is_told(call, message):
    with pytest.raises(hairline.SceneError) as raised:
        call(MATERIALS["bare"])
    assert message in str(raised.value)
