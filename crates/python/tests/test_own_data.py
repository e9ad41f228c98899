"""Metals by n and k of one's own."""

import numpy as np
import pytest

import hairline
from hairline import optics
from hairline.bsdf import Layer, Scratched

NM = np.arange(380.0, 781.0, 10.0)


def rows_of(metal):
    """n and k whose reflectance at normal incidence is a metal's, of the extinction of an index of 1."""
    reflectance = optics.fresnel_metal(metal, 1.0, NM)
    return np.stack([NM, np.ones_like(NM), 2 * np.sqrt(reflectance / (1 - reflectance))], axis=1)


def test_a_metal_is_its_rows(scene):
    rows = rows_of("copper")
    scene.materials[0].update(metal=None, n_k=rows)
    again = hairline.Scene.from_dict(scene.to_dict())
    np.testing.assert_allclose(again.materials[0].n_k, rows)
    arguments = {"backend": "cpu", "shadows": False, "samples": 1}
    own = scene.render(**arguments)
    scene.materials[0].update(metal="copper", n_k=None)
    copper = scene.render(**arguments)
    scene.materials[0].metal = "steel"
    steel = scene.render(**arguments)

    def off(a, b, layer):
        a, b = getattr(a, layer), getattr(b, layer)
        return np.sqrt(np.sum((a - b) ** 2) / np.sum(b**2))

    # The same light straight on; at the angles of this picture nearly.
    assert off(own, copper, "base") < 0.05 and off(own, copper, "scratches") < 0.05
    assert off(steel, copper, "scratches") > 0.2


@pytest.mark.parametrize("backend", ["cpu", "gpu"])
def test_each_renderer_has_it(scene, backend):
    scene.materials[0].update(metal=None, n_k=rows_of("gold"))
    try:
        picture = scene.render(backend=backend, shadows=False, samples=1)
    except hairline.WorkError:
        pytest.skip("no driver")
    truth = scene.reference(samples=64)
    sums = [np.asarray(it.base).sum(axis=(0, 1)) for it in (picture, truth)]
    np.testing.assert_allclose(sums[0], sums[1], rtol=0.05)
    assert sums[0][0] > 1.3 * sums[0][2]


def test_scene_files_hold_it(scene, tmp_path):
    scene.materials[0].update(metal=None, n_k=[[400, 1.5, 1.9], [700, 0.2, 3.5]])
    scene.save(tmp_path / "own.toml")
    assert hairline.load(tmp_path / "own.toml").to_dict() == scene.to_dict()


def test_a_bsdf_takes_it(scene):
    rows = rows_of("brass")
    scene.materials[0].update(metal=None, n_k=rows)
    material = Scratched.from_scene(scene, "plate")
    direct = Scratched(rows, roughness=0.2, layers=[Layer(coverage=0.01)])
    wo = [0.0, 0.0, 1.0]
    ratio = material.eval(wo, wo, part="base") / direct.eval(wo, wo, part="base")
    assert (np.abs(ratio - 1) < 0.2).all()


@pytest.mark.parametrize(
    "rows, message",
    [
        ([], "material.n_k: found 0 rows; must have from 1 to 4096"),
        ([[500, 1.0]], "material.n_k[0]: found an array of 2; must be an array of 3 numbers"),
        ([[50, 1.0, 2.0]], "material.n_k[0][0]: found 50; must be a wavelength from 100 to 2000 (nm)"),
        ([[500, 1.0, 2.0], [500, 1.0, 2.0]], "material.n_k[1][0]: found 500; must be above 500, the wavelength before it"),
        ([[500, 0.0, 2.0]], "material.n_k[0][1]: found 0; must be above 0, up to 100"),
        ([[500, 1.0, -1.0]], "material.n_k[0][2]: found -1; must be from 0 to 100"),
        ([[500, float("nan"), 1.0]], "material.n_k[0][1]: found NaN; must be above 0, up to 100"),
    ],
)
def test_wrong_rows_are_told(scene, rows, message):
    with pytest.raises(hairline.SceneError) as raised:
        scene.materials[0].update(metal=None, n_k=rows)
    assert message in str(raised.value)


def test_a_metal_is_said_once(scene):
    with pytest.raises(hairline.SceneError, match="found both `metal` and `n_k`; must have exactly one of them"):
        scene.materials[0].n_k = [[500, 1.0, 2.0]]


RECORD = """# Johnson and Christy 1972
REFERENCES: "P. B. Johnson and R. W. Christy, 1972"
DATA:
  - type: tabulated nk
    data: |
        0.3974 1.47 1.952
        0.4959 1.04 1.833
        0.7045 0.13 4.103
"""


def test_records_of_refractiveindex_info_are_read(tmp_path):
    pytest.importorskip("yaml")
    path = tmp_path / "Au.yml"
    path.write_text(RECORD)
    np.testing.assert_allclose(optics.read_n_k(path), [[397.4, 1.47, 1.952], [495.9, 1.04, 1.833], [704.5, 0.13, 4.103]])
    path.write_text(
        "DATA:\n  - type: tabulated n\n    data: |\n      0.4 1.5\n      0.6 0.5\n  - type: tabulated k\n    data: |\n      0.4 2\n      0.6 4\n"
    )
    np.testing.assert_allclose(optics.read_n_k(path), [[400, 1.5, 2], [600, 0.5, 4]])


def test_tables_are_read(tmp_path):
    path = tmp_path / "au.csv"
    path.write_text("wl,n,k\n0.4,1.5,1.9\n0.7,0.2,3.5\n3.0,1,20\n")
    np.testing.assert_allclose(optics.read_n_k(path), [[400, 1.5, 1.9], [700, 0.2, 3.5]])
    path.write_text("k,wavelength_nm,n\n1.9,400,1.5\n")
    np.testing.assert_allclose(optics.read_n_k(path), [[400, 1.5, 1.9]])


@pytest.mark.parametrize(
    "name, text, message",
    [
        ("a.csv", "", "a.csv:1: found the header ''; must name wavelength_nm, n and k"),
        ("a.csv", "wl,n,k\n0.4,1.5\n", "a.csv:2: found '0.4,1.5'; must be 3 numbers"),
        ("a.csv", "wl,n,k\n0.4,one,2\n", "a.csv:2: found '0.4,one,2'; must be 3 numbers"),
        ("a.csv", "wl,n,k\n0.5,1,2\n0.4,1,2\n", "found the wavelength 400 in row 1 after 500; must rise"),
        ("a.csv", "wl,n,k\n", "found 0 rows; must have from 1 to 4096"),
        ("a.nk", "", "found the ending '.nk'; must be .yml or .csv"),
        ("a.yml", "DATA: [", "found no YAML"),
        ("a.yml", "REFERENCES: x", "found no DATA; must be a record of refractiveindex.info"),
        ("a.yml", "DATA:\n  - type: formula 2\n", 'found formula 2; must have "tabulated nk"'),
    ],
)
def test_wrong_files_are_told(tmp_path, name, text, message):
    if name.endswith("yml"):
        pytest.importorskip("yaml")
    (tmp_path / name).write_text(text)
    with pytest.raises(hairline.SceneError) as raised:
        optics.read_n_k(tmp_path / name)
    assert message in str(raised.value)
    with pytest.raises(hairline.WorkError):
        optics.read_n_k(tmp_path / "missing.csv")
