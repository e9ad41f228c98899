"""A scene as one glTF file."""

import json
import struct

import numpy as np
import pytest

import hairline


def test_a_scene_comes_back_from_a_file_as_it_was(tmp_path, scene):
    path = tmp_path / "worn.glb"
    notes = scene.export(path)
    assert all(isinstance(note, str) for note in notes)
    again = hairline.load(path)
    assert again.to_dict() == scene.to_dict()
    assert np.array_equal(scene.render(samples=1).beauty, again.render(samples=1).beauty)


def test_what_a_file_holds_is_glTF(tmp_path, scene):
    path = tmp_path / "worn.glb"
    scene.export(path)
    smaller = path.stat().st_size
    scene.export(path, laid=True)
    assert path.stat().st_size > smaller
    data = path.read_bytes()
    assert data[:4] == b"glTF"
    (length,) = struct.unpack("<I", data[12:16])
    root = json.loads(data[20 : 20 + length])
    extension = root["extensions"]["HAIRLINE_scratches"]
    assert extension["version"] == 1
    assert "HAIRLINE_scratches" in root["extensionsUsed"]
    assert len(extension["scratches"]) == len(scene.scratches)


def test_other_names_and_inputs_are_refused(tmp_path, scene):
    with pytest.raises(hairline.SceneError, match="path: found .*; must end in .glb or .usdz"):
        scene.export(tmp_path / "worn.gltf")


def test_a_wrong_extension_is_told_and_the_model_is_plain(tmp_path, scene):
    path = tmp_path / "worn.glb"
    scene.export(path)
    # As long as it was, so that nothing else has to change.
    path.write_bytes(path.read_bytes().replace(b'"version":1', b'"version":7', 1))
    plain = hairline.load(path)
    assert list(plain.scratches) == []
    assert any("HAIRLINE_scratches.version: found version 7" in note for note in plain.notes)


def test_a_baked_model_is_plain(tmp_path, scene):
    path = tmp_path / "baked.glb"
    scene.export(path, bake=64)
    assert b"HAIRLINE" not in path.read_bytes()
    with pytest.raises(hairline.SceneError, match="bake: found 8; must be a whole number from 16 to 4096"):
        scene.export(path, bake=8)
    with pytest.raises(hairline.SceneError, match="laid: found scratches as they lie; must be off"):
        scene.export(path, bake=64, laid=True)


def errors_of_usd(path):
    """What the validators of Pixar's library find wrong in a package."""
    pytest.importorskip("pxr", reason="packages of USD are read by usd-core")
    from pxr import Usd, UsdValidation

    stage = Usd.Stage.Open(str(path))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) >= 20
    context = UsdValidation.ValidationContext(validators)
    return stage, [error.GetErrorAsString() for error in context.Validate(stage)]


@pytest.mark.parametrize("name, bake", [("plate.toml", None), ("plate.toml", 64), ("models/spoon.glb", None)])
def test_models_for_phones_are_valid(tmp_path, repository, name, bake):
    path = tmp_path / "model.usdz"
    notes = hairline.load(repository / "scenes" / name).export(path, bake=bake)
    assert ("scratches are not in the file" in notes) == (bake is None)
    stage, errors = errors_of_usd(path)
    assert errors == []
    from pxr import UsdGeom, UsdShade

    assert stage.GetDefaultPrim().GetName() == "Root"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == "Y"
    meshes = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    assert meshes
    for mesh in meshes:
        look, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
        surface, _, _ = look.ComputeSurfaceSource()
        assert surface.GetIdAttr().Get() == "UsdPreviewSurface"
        points = len(UsdGeom.Mesh(mesh).GetPointsAttr().Get())
        assert len(UsdGeom.Mesh(mesh).GetNormalsAttr().Get()) == points
        assert len(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").Get()) == points
