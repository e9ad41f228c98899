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
    with pytest.raises(hairline.SceneError, match="path: found .*; must end in .glb"):
        scene.export(tmp_path / "worn.gltf")


def test_a_wrong_extension_is_told_and_the_model_is_plain(tmp_path, scene):
    path = tmp_path / "worn.glb"
    scene.export(path)
    # As long as it was, so that nothing else has to change.
    path.write_bytes(path.read_bytes().replace(b'"version":1', b'"version":7', 1))
    plain = hairline.load(path)
    assert list(plain.scratches) == []
    assert any("HAIRLINE_scratches.version: found version 7" in note for note in plain.notes)
