"""Packages that only measured surfaces need, imported at their first use."""

from __future__ import annotations

import importlib
from typing import Any

from .._errors import WorkError


def needed(module: str, package: str) -> Any:
    """A module of a package that may be missing."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise WorkError(f"measured surfaces need the package {package} ({error}): pip install 'hairline-render[measured]'") from None


def scipy(part: str) -> Any:
    """A part of SciPy, such as ``ndimage``."""
    return needed(f"scipy.{part}", "scipy")


def skimage(part: str) -> Any:
    """A part of scikit-image, such as ``filters``."""
    return needed(f"skimage.{part}", "scikit-image")
