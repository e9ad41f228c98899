"""Scratched metal as a BSDF of Mitsuba 3."""

import math
import subprocess
import sys

import numpy as np
import pytest

import hairline
from hairline.bsdf import Layer, Scratched

mi = pytest.importorskip("mitsuba", reason="Mitsuba 3 is not installed: pip install mitsuba")
if not any(variant.startswith("llvm") for variant in mi.variants()):
    pytest.skip("Mitsuba has no LLVM", allow_module_level=True)
# Mitsuba by itself ends the process on some processors with some versions of LLVM, as 15 with AVX-512.
ALONE = """
import mitsuba as mi
import numpy as np
mi.set_variant("llvm_ad_rgb")
film = {"type": "hdrfilm", "width": 4, "height": 4}
sensor = {"type": "perspective", "film": film}
scene = {"type": "scene", "integrator": {"type": "direct"}, "sensor": sensor, "ball": {"type": "sphere"}, "lamp": {"type": "constant"}}
np.array(mi.render(mi.load_dict(scene), spp=1))
"""
alone = subprocess.run([sys.executable, "-c", ALONE], capture_output=True, text=True)
if alone.returncode != 0:
    pytest.skip(f"Mitsuba cannot render a sphere here: {alone.stderr[:100]}", allow_module_level=True)
mi.set_variant("llvm_ad_rgb")

import drjit as dr  # noqa: E402

import hairline.mitsuba as plugin  # noqa: E402

SIZE = (48, 32)
LAMP = {"center_m": (0.05, 0.09, 0.11), "radius_m": 0.012, "radiance": 400.0}
EYE = (0.0, -0.06, 0.1)


def plate(count=1500, **keys):
    """A disk of 2 cm under a lamp."""
    return hairline.Scene.from_dict(
        {
            "camera": {"position_m": EYE, "target_m": (0, 0, 0), "up": (0, 0, 1), "fov_y_deg": 16.0},
            "render": {"size_px": SIZE},
            "material": [{"name": "steel", "kind": "metal", "metal": "steel", "roughness": 0.08}],
            "object": [{"name": "plate", "shape": {"disk": {"radius_m": 0.02}}, "material": "steel"}],
            "scratches": [
                {"object": "plate", "pattern": "random", "count": count, "length_m": 0.008, "width_um": 1.5, "depth_nm": 150.0, **keys}
            ],
            "light": [{"kind": "sphere", **LAMP}],
        }
    )


def mitsuba_plate(bsdf, samples):
    """The same in Mitsuba, its picture."""
    transform = mi.ScalarTransform4f()
    aspect = SIZE[0] / SIZE[1]
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 1, "hide_emitters": True},
            "sensor": {
                "type": "perspective",
                "fov": math.degrees(2 * math.atan(math.tan(math.radians(8.0)) * aspect)),
                "fov_axis": "x",
                "near_clip": 1e-3,
                "to_world": transform.look_at(origin=list(EYE), target=[0, 0, 0], up=[0, 0, 1]),
                "film": {"type": "hdrfilm", "width": SIZE[0], "height": SIZE[1], "rfilter": {"type": "box"}, "pixel_format": "rgb"},
                "sampler": {"type": "independent", "sample_count": samples},
            },
            "plate": {"type": "disk", "to_world": transform.scale([0.02, 0.02, 1]), "bsdf": bsdf},
            "lamp": {
                "type": "sphere",
                "center": list(LAMP["center_m"]),
                "radius": LAMP["radius_m"],
                "emitter": {"type": "area", "radiance": {"type": "rgb", "value": LAMP["radiance"]}},
            },
        }
    )
    with plugin.evaluated():
        return np.array(mi.render(scene, seed=1))


def blocks(picture, size=8):
    height, width, channels = picture.shape
    return picture.reshape(height // size, size, width // size, size, channels).mean(axis=(1, 3))


def test_the_plate_is_that_of_the_reference():
    """The very scratches by their positions, in blocks of pixels within the noise of both."""
    scene = plate()
    truth = scene.reference(samples=256, bounces=0)
    found, right = blocks(mitsuba_plate(plugin.bsdf(scene, "plate"), 128)), blocks(truth.beauty)
    inside = right.min(axis=2) > 0.02 * right.max()
    error = np.sqrt(np.mean((found[inside] / right[inside] - 1) ** 2))
    assert inside.sum() >= 6 and error < 0.12, error
    # Other scratches are another picture.
    other = blocks(mitsuba_plate(plugin.bsdf(plate(count=300), "plate"), 128))
    assert np.sqrt(np.mean((other[inside] / right[inside] - 1) ** 2)) > 2 * error


def test_the_mean_is_that_of_many_scratches():
    """A plate by its mean, against the closed form of its scratches: within what so few scratches differ from their mean."""
    scene = plate(count=20_000, width_um=2.0)
    mean = mitsuba_plate(plugin.bsdf(Scratched.from_scene(scene, "plate")), 256)
    right = blocks(scene.render(backend="cpu", shadows=False, samples=1).beauty)
    found = blocks(mean)
    inside = right.min(axis=2) > 0.02 * right.max()
    assert np.sqrt(np.mean((found[inside] / right[inside] - 1) ** 2)) < 0.2


def test_the_plugin_passes_mitsubas_own_test():
    """Chi square of its samples against its density, as Mitsuba has it for all of its BSDFs."""
    from mitsuba.chi2 import BSDFAdapter, ChiSquareTest, SphericalDomain

    material = plugin.bsdf(Scratched("steel", roughness=0.3, layers=[Layer(2.0, 150.0, 0.05)]))
    mi.register_bsdf("hairline_test", lambda props: material)
    with plugin.evaluated():
        sample, pdf = BSDFAdapter("hairline_test", "", wi=[0.5, 0.2, 0.8])
        test = ChiSquareTest(SphericalDomain(), sample, pdf, 3, sample_count=200_000, res=101, ires=16)
        assert test.run(), test.messages


@pytest.mark.parametrize("over", [{}, {"clearcoat": 0.8, "clearcoat_roughness": 0.1}, {"cover": {"ior": 1.5}}], ids=["bare", "coat", "cover"])
def test_scalar_variants_have_the_same_values(over):
    of = Scratched("steel", roughness=0.3, layers=[Layer(2.0, 150.0, 0.05)], **over)
    wi, wo = np.array([0.1, 0.2, 0.0]), np.array([-0.15, -0.1, 0.0])
    wi[2], wo[2] = np.sqrt(1 - wi @ wi), np.sqrt(1 - wo @ wo)
    right = of.eval(wo, wi)
    try:
        for variant in ("scalar_rgb", "llvm_ad_rgb"):
            mi.set_variant(variant)
            made = plugin.bsdf(of)
            si = dr.zeros(mi.SurfaceInteraction3f)
            si.wi = mi.Vector3f(wi.tolist())
            si.sh_frame = mi.Frame3f(mi.Normal3f(0, 0, 1))
            value, pdf = made.eval_pdf(mi.BSDFContext(), si, mi.Vector3f(wo.tolist()))
            np.testing.assert_allclose(np.array(value).ravel(), right, rtol=1e-4)
            assert float(np.array(pdf).ravel()[0]) == pytest.approx(float(of.pdf(wo, wi)), rel=1e-4)
    finally:
        mi.set_variant("llvm_ad_rgb")


def test_wrong_arguments_are_told():
    for call, message in (
        (lambda: plugin.bsdf(3), "of: found an object of type int"),
        (lambda: plugin.bsdf(plate(count=1)), "object: found None; must be the name of an object"),
        (lambda: plugin.bsdf(plate(count=1), "lid"), 'object: found "lid"; must be one of "plate"'),
        (lambda: plugin.bsdf(Scratched("steel"), "plate"), "object: found 'plate' beside a material"),
    ):
        with pytest.raises(hairline.SceneError) as raised:
            call()
        assert message in str(raised.value)
