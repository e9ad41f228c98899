"""The light that heights send, by Fourier transform of the phase that they give: no model of scratches is in it.

A height h turns the phase of what it reflects by k h (cos i + cos o). The scattered field is the Fourier transform of that phasor under the
coherence window (Beckmann and Spizzichino, The Scattering of Electromagnetic Waves from Rough Surfaces, 1963; with both cosines in the phase as
in Krywonos, Harvey and Choi, JOSA A 28, 1121, 2011). The mean of its square over windows that lie all over the map (Welch, IEEE Trans. Audio
Electroacoust. 15, 70, 1967) is the BRDF, with the scale of equation (1) of docs/model.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional

import numpy as np
import numpy.typing as npt

from .. import optics
from .._arrays import ArrayLike, Floats, _numbers
from .._errors import argument_error
from ._grid import Grid
from ._packages import scipy

# A window ends where its amplitude is exp(-8).
_REACH = 4.0


class Brdf:
    """A BRDF with the cosine inside, over the tangential part of wi + wo."""

    def __init__(self, wavelength_nm: float, xi_x: Floats, xi_y: Floats, values: Floats) -> None:
        self.wavelength_nm = wavelength_nm
        self.xi_x = xi_x
        """Along x, rising, evenly spaced; shape (n,)."""
        self.xi_y = xi_y
        """Along y; shape (m,)."""
        self.values = values
        """Shape (m, n)."""

    def __repr__(self) -> str:
        return f"Brdf({self.wavelength_nm:g} nm, xi_x to {self.xi_x[-1]:.3g}, xi_y to {self.xi_y[-1]:.3g}, {len(self.xi_x)} x {len(self.xi_y)})"

    @property
    def cell(self) -> float:
        """The area of a cell of the grid."""
        return float((self.xi_x[1] - self.xi_x[0]) * (self.xi_y[1] - self.xi_y[0]))

    def sent(self, sine_low: float, sine_high: float) -> float:
        """The integral between two distances from the mirror's direction: the share of the light that goes there."""
        most = min(-self.xi_x[0], -self.xi_y[0])
        if not 0 <= sine_low < sine_high <= most:
            found = f"found {sine_low!r} and {sine_high!r}"
            raise argument_error("sine_low, sine_high", found, f"must rise, from 0 to {most:.3g}: what the spacing of the heights resolves")
        distance = np.hypot(self.xi_x[None, :], self.xi_y[:, None])
        return float(self.values[(distance >= sine_low) & (distance < sine_high)].sum()) * self.cell


def brdf(grid: Grid, wavelength_nm: float, metal: Optional[str], coherence_um: float, cos_sum: float) -> Brdf:
    """See ``HeightMap.brdf``."""
    fft = scipy("fft")
    wavelength = checked("wavelength_nm", wavelength_nm, 10, 1e6)
    cosines = checked("cos_sum", cos_sum, 0.01, 2)
    steps = grid.spacing_um
    sizes = [side * step for side, step in zip(grid.heights_nm.shape[::-1], steps)]
    coherence = checked_window(sizes, steps, coherence_um)
    reflectance = 1.0 if metal is None else float(optics.fresnel_metal(metal, 0.5 * cosines, wavelength))
    half = [int(np.floor(_REACH * coherence / step)) for step in steps]
    over = [np.arange(-n, n + 1) * step for n, step in zip(half, steps)]
    window = np.exp(-(over[1][:, None] ** 2 + over[0][None, :] ** 2) / (2 * coherence**2))
    shape = [fft.next_fast_len(2 * n + 1) for n in half[::-1]]
    per_nm = 2 * np.pi * cosines / wavelength
    rows, columns = grid.heights_nm.shape
    total = np.zeros(shape)
    count = 0
    # In single precision, whose error is 1e-7 of the mirror's amplitude, it takes half of the time.
    seen = window.astype(np.complex64)
    for top in _places(rows, half[1], coherence / steps[1]):
        for left in _places(columns, half[0], coherence / steps[0]):
            heights = grid.heights_nm[top : top + len(over[1]), left : left + len(over[0])]
            field = fft.fft2(seen * np.exp(1j * (per_nm * heights).astype(np.float32)), shape)
            total += field.real**2 + field.imag**2
            count += 1
    wavelength_um = 1e-3 * wavelength
    # By Parseval a flat mirror's integral is its reflectance, for this very window.
    cell = steps[0] * steps[1]
    values = fft.fftshift(total) * (reflectance * cell / (count * float((window**2).sum()) * wavelength_um**2))
    xi_x = wavelength_um * fft.fftshift(fft.fftfreq(shape[1], steps[0]))
    xi_y = wavelength_um * fft.fftshift(fft.fftfreq(shape[0], steps[1]))
    # Row 0 is at the top, so y runs against the rows.
    return Brdf(wavelength, xi_x, -xi_y[::-1], values[::-1])


def sent(grid: Grid, wavelength_nm: ArrayLike, sine_low: float, sine_high: float, coherence_um: float, cos_sum: float) -> Floats:
    """See ``HeightMap.sent``."""
    wavelengths = np.asarray(_numbers("wavelength_nm", wavelength_nm), dtype=np.float64)
    each = [brdf(grid, one, None, coherence_um, cos_sum).sent(sine_low, sine_high) for one in wavelengths.reshape(-1)]
    return np.array(each).reshape(wavelengths.shape)


def _places(side: int, half: int, coherence: float) -> npt.NDArray[np.intp]:
    """Where windows begin, in points of the grid: evenly, so near to one another that together they see all alike within 0.4 %."""
    room = side - (2 * half + 1)
    return np.round(np.linspace(0, room, int(np.ceil(room / (1.25 * coherence))) + 1)).astype(np.intp)


def attention(side: int, step_um: float, coherence_um: float, at_um: Floats) -> Floats:
    """How much the windows of a map see of a place along one of its axes, from the map's middle; its integral is 1. Near borders it is little."""
    half = int(np.floor(_REACH * coherence_um / step_um))
    middles = (_places(side, half, coherence_um / step_um) + half - 0.5 * (side - 1)) * step_um
    each = np.exp(-(((at_um[..., None] - middles) / coherence_um) ** 2))
    made: Floats = each.mean(axis=-1) / (np.sqrt(np.pi) * coherence_um)
    return made


def checked_window(sizes_um: Sequence[float], steps_um: Sequence[float], coherence_um: object) -> float:
    """The standard deviation of a window that fits into a map, and that its grid resolves."""
    coherence = checked("coherence_um", coherence_um, 1e-3, 1e6)
    least = min(size - 2 * step for size, step in zip(sizes_um, steps_um))
    if least < 2 * _REACH * coherence:
        right = f"must be {least / (2 * _REACH):.3g} at most, an eighth of the map"
        raise argument_error("coherence_um", f"found {coherence:g} for a map of {sizes_um[0]:.4g} x {sizes_um[1]:.4g} um", right)
    if coherence < 2 * max(steps_um):
        raise argument_error("coherence_um", f"found {coherence:g}", f"must be {2 * max(steps_um):.3g} at least, two points of the grid")
    return coherence


def checked(key: str, value: object, least: float, most: float) -> float:
    array = _numbers(key, value)
    if array.ndim or not least <= float(array) <= most:
        raise argument_error(key, f"found {value!r}", f"must be a number from {least:g} to {most:g}")
    return float(array)
