"""Pictures in bands of the spectrum, and what an observer sees of them by the light of an illuminant."""

from __future__ import annotations

from typing import Any, NamedTuple, Union

import numpy as np

from . import _hairline as core
from ._arrays import ArrayLike, Floats, floats
from ._errors import argument_error
from ._table import Path

_STEP_NM = 0.5
"""Of integrals over a band."""

_A_K = 2848.0
_C2_NM_K = 1.435e7
"""Temperature and second radiation constant that CIE 15 defines illuminant A by."""


def _table(key: str, rows: ArrayLike, columns: int, right: str) -> Floats:
    """Rows of a wavelength, rising, and values of at least 0, of which some are above."""
    table = floats(key, rows, None, columns)
    if not (len(table) and np.isfinite(table).all() and (np.diff(table[:, 0]) > 0).all() and (table[:, 1:] >= 0).all() and table[:, 1:].any()):
        raise argument_error(key, f"found {len(table)} rows that are none of these", right)
    return table


def _illuminant(illuminant: Union[str, ArrayLike], nm: Floats, cie: Floats) -> Floats:
    right = 'must be "D65", "A", "E", or rows of a rising wavelength in nm and a power'
    if not isinstance(illuminant, str):
        rows = _table("illuminant", illuminant, 2, right)
        return np.interp(nm, rows[:, 0], rows[:, 1], left=0.0, right=0.0)
    if illuminant == "D65":
        return np.interp(nm, cie[:, 0], cie[:, 4])
    if illuminant == "A":
        return nm**-5.0 / np.expm1(_C2_NM_K / (_A_K * nm)) * 1e15
    if illuminant == "E":
        return np.ones_like(nm)
    raise argument_error("illuminant", f'found "{illuminant}"', right)


def _observer(observer: Union[str, ArrayLike], nm: Floats, cie: Floats) -> Floats:
    right = 'must be "1931", or rows of a rising wavelength in nm and the three functions of an observer'
    if isinstance(observer, str):
        if observer != "1931":
            raise argument_error("observer", f'found "{observer}"', right)
        rows = cie[:, :4]
    else:
        rows = _table("observer", observer, 4, right)
    return np.stack([np.interp(nm, rows[:, 0], rows[:, i], left=0.0, right=0.0) for i in (1, 2, 3)], axis=-1)


class Bands(NamedTuple):
    """A picture in bands of the spectrum: float32, height x width x bands. Values are means over a band of what white light of radiance 1 would be there:
    times a lamp's spectrum, over that of its radiance, they are spectral radiances."""

    bands_nm: tuple[tuple[float, float], ...]
    base: Any
    """Light off the base."""
    scratches: Any
    """Light off the scratches."""

    @property
    def beauty(self) -> Any:
        """All light."""
        return self.base + self.scratches

    def rgb(self, illuminant: Union[str, ArrayLike] = "D65", observer: Union[str, ArrayLike] = "1931") -> Floats:
        """What an observer sees of :attr:`beauty` where all lamps have the spectrum of an illuminant: linear Rec.709, height x width x 3. White
        surfaces show the illuminant's colour, with the luminance that they have in the picture in colour. Where there is no band it is dark.

        :param illuminant: ``"D65"``, ``"A"``, ``"E"`` (the same at all wavelengths), or rows of a wavelength in nm and a power, n x 2.
        :param observer: ``"1931"``, or rows of a wavelength in nm and the observer's three functions, n x 4.
        """
        rows, matrix = core.cie()
        cie = rows.reshape(-1, 5)

        def seen(low: float, high: float) -> Floats:
            steps = max(1, round((high - low) / _STEP_NM))
            nm = low + (np.arange(steps) + 0.5) * (high - low) / steps
            of_light = _illuminant(illuminant, nm, cie)[:, None] * _observer(observer, nm, cie)
            made: Floats = of_light.sum(axis=0) * (high - low) / steps
            return made

        white = seen(float(cie[0, 0]), float(cie[-1, 0]))[1]
        if not white > 0:
            raise argument_error("illuminant", "found no light that the observer sees", "must have a power from 380 to 780 nm")
        weights = np.array([seen(*band) for band in self.bands_nm]) / white
        made: Floats = self.beauty.astype(np.float64) @ weights @ matrix.reshape(3, 3).T
        return made

    def save(self, path: Path) -> None:
        """Writes an .exr of spectral channels (``S0.405,00nm``): the whole file or none."""
        core.write_bands(path, list(self.bands_nm), self.base, self.scratches)
