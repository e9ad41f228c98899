"""How far one picture is from another."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Union

from . import _hairline as core
from ._errors import argument_error
from ._hairline import Image

Picture = Union[Image, str, "os.PathLike[str]"]


class Comparison(Mapping[str, Mapping[str, Any]]):
    """The figures of each layer that both pictures have: ``comparison["beauty"]["relative_rms"]``.

    The figures: ``rms``, ``relative_rms``, ``relmse``, ``max``, ``flip``, ``flip95``, ``psnr``, ``mean``, ``reference_mean`` and
    ``not_finite``; where one of the pictures tells its noise also ``rms_beyond_noise``, ``relative_rms_beyond_noise``, ``z2`` and
    ``verdict``.
    """

    problems: list[str]
    """What could not be compared, or was left out."""

    def __init__(self, layers: dict[str, dict[str, Any]], problems: list[str]) -> None:
        self._layers, self.problems = layers, problems

    def __getitem__(self, layer: str) -> Mapping[str, Any]:
        return self._layers[layer]

    def __iter__(self) -> Any:
        return iter(self._layers)

    def __len__(self) -> int:
        return len(self._layers)

    def __repr__(self) -> str:
        lines = []
        for layer, figures in self._layers.items():
            shown = (f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in figures.items())
            lines.append(f"{layer}: {', '.join(shown)}")
        return "\n".join(lines + self.problems)


def compare(a: Picture, b: Picture, *, exposure_ev: float = 0.0, tone_map: str = "neutral") -> Comparison:
    """Compares a picture with a reference, as ``hairline compare`` does.

    :param a: an image, or the path of an .exr or a .png.
    :param b: the reference, likewise.
    :param exposure_ev: stops at which FLIP and PSNR see an .exr or an image.
    :param tone_map: the curve by which they see it.
    """
    for key, picture in (("a", a), ("b", b)):
        if not isinstance(picture, (Image, str, os.PathLike)):
            found = f"found an object of type {type(picture).__module__}.{type(picture).__qualname__}"
            raise argument_error(key, found, "must be a hairline.Image or a path")
    return Comparison(*core.compare(a, b, exposure_ev, tone_map))
