"""Files that are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Union


def write_whole(path: Union[str, "os.PathLike[str]"], contents: bytes) -> None:
    """Writes a file beside its place, then moves it there. Where that fails, nothing is left of it, and what was there stays."""
    target = Path(path)
    temporary = target.with_name(f".{target.name}.part")
    try:
        temporary.write_bytes(contents)
        os.replace(temporary, target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
