"""The code in the documents runs."""

import ast
import importlib
import inspect
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

import hairline
from conftest import ROOT
from surfaces import engraved

BLOCK = re.compile(r"(?:<!-- not run: (.+?) -->\n+)?^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)
BLOCKS = [
    pytest.param(*block.groups(), id=f"{path.relative_to(ROOT).as_posix()}:{block.start()}")
    for pattern in ("*.md", "docs/**/*.md", "crates/*/*.md", "packages/*/*.md")
    for path in sorted(ROOT.glob(pattern))
    for block in BLOCK.finditer(path.read_text(encoding="utf-8"))
]
# Smaller than a reader would have them: what they show is tested elsewhere.
SMALL = {
    "(64, 36)": "(16, 9)",
    "(640, 360)": "(32, 18)",
    "(320, 180)": "(32, 18)",
    "(256, 256)": "(32, 32)",
    "count=500": "count=1",
    '"plate.sur"': '"plate.npy", spacing_m=9e-7',
    # Millions.
    'scene.scratches.extend(found.layers("plate"))': 'found.layers("plate")',
}
# What readers have before a block.
BEFORE = """import numpy as np
import hairline
scene = hairline.load("scenes/plate.toml")
image = scene.render(size=(32, 18), shadows=False)
"""


@pytest.mark.parametrize("not_run, block", BLOCKS)
def test_code_in_documents_runs(not_run, block, tmp_path, monkeypatch):
    # Nothing that every machine has is a reason.
    assert bool(not_run) == bool(re.search(r"^import (?!hairline|numpy)|://", block, re.MULTILINE)), not_run
    if not_run:
        return names_exist(block)
    if "measured" in block:
        pytest.importorskip("skimage")
        np.save(tmp_path / "plate.npy", engraved((200, 200), 0.9, [(-70, -60, 65, 70, 3, 120), (-70, 75, 60, -70, 4, 60)], noise_nm=0.3))
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")
    plate = tmp_path / "scenes/plate.toml"
    few = plate.read_text(encoding="utf-8").replace("count = 10000", "count = 300")
    assert few.count("count = 300\n") == 1
    plate.write_text(few, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    for large, small in SMALL.items():
        block = block.replace(large, small)
    exec(compile(BEFORE + block, "document", "exec"), {"__name__": "__main__"})


def names_exist(block):
    """Whether what code that is not run calls is there and takes what it gets."""
    known = {}
    for node in ast.walk(ast.parse(block)):
        if isinstance(node, (ast.Import, ast.ImportFrom)) and "hairline" in ast.unparse(node):
            try:
                exec(ast.unparse(node), known)
            except ImportError:
                return
    for node in ast.walk(ast.parse(block)):
        if isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[0] in known:
            function = eval(ast.unparse(node.func), known)
            inspect.signature(function).bind(*node.args, **{word.arg: word.value for word in node.keywords})


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
