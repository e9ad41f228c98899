"""The code in the documents runs."""

import ast
import inspect
import re
import shutil
from pathlib import Path

import pytest

import hairline
from conftest import ROOT

CODE = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("document", ["README.md", "docs/python.md"])
def test_code_in_documents_runs(document, tmp_path, monkeypatch):
    text = (ROOT / document).read_text(encoding="utf-8")
    blocks = CODE.findall(text)
    assert blocks, document
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")
    plate = tmp_path / "scenes/plate.toml"
    few = plate.read_text(encoding="utf-8").replace("count = 10000", "count = 300")
    assert few.count("count = 300\n") == 1
    plate.write_text(few, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    # Smaller than a reader would have them: what they show is tested elsewhere.
    code = "\n".join(blocks).replace("(640, 360)", "(64, 36)").replace("(320, 180)", "(32, 18)")
    exec(compile(code, document, "exec"), {"__name__": "__main__"})
    assert (tmp_path / "plate.png").read_bytes().startswith(b"\x89PNG")


def test_help_tells_what_the_stubs_tell():
    stubs = ast.parse(Path(hairline.__file__).with_name("_hairline.pyi").read_text(encoding="utf-8"))
    [image] = [node for node in stubs.body if isinstance(node, ast.ClassDef) and node.name == "Image"]
    told = {node.name: ast.get_docstring(node) for node in image.body if isinstance(node, ast.FunctionDef) and ast.get_docstring(node)}
    assert {"beauty", "depth_m", "samples", "save"} <= set(told)
    for name, text in told.items():
        assert inspect.getdoc(getattr(hairline.Image, name)) == text
    assert inspect.getdoc(hairline.Image) == ast.get_docstring(image)


def test_help_tells_every_key_with_its_unit():
    for kind in (hairline.Camera, hairline.SphereLight, hairline.Scratches, hairline.Studio):
        signature = inspect.signature(kind)
        assert set(signature.parameters) == kind._keys - set(kind._fixed)
        for key in kind._keys:
            assert f"\n\n{key}\n    " in kind.__doc__, key
    assert "radius_m\n    Its radius. Unit: m." in hairline.SphereLight.__doc__
    needed = [key for key, it in inspect.signature(hairline.SphereLight).parameters.items() if it.default is it.empty]
    assert needed == ["center_m", "radius_m"]
