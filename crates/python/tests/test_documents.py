"""The code in the documents runs."""

import re
import shutil

import pytest

from conftest import ROOT

CODE = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("document", ["README.md", "docs/python.md"])
def test_code_in_documents_runs(document, tmp_path, monkeypatch):
    text = (ROOT / document).read_text(encoding="utf-8")
    blocks = CODE.findall(text)
    assert blocks, document
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")
    monkeypatch.chdir(tmp_path)
    # Smaller than a reader would have them: what they show is tested elsewhere.
    code = "\n".join(blocks).replace("(640, 360)", "(64, 36)").replace("(320, 180)", "(32, 18)")
    exec(compile(code, document, "exec"), {"__name__": "__main__"})
    assert (tmp_path / "plate.png").read_bytes().startswith(b"\x89PNG")
