"""Heights on a grid."""

from __future__ import annotations

from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from .._arrays import ArrayLike, Floats, _numbers
from .._errors import argument_error
from ._brdf import Brdf, brdf, sent
from ._find import found_scratches
from ._found import Found, Rows
from ._grid import LEAST_SIDE, Grid, checked_sides
from ._level import form
from ._packages import needed
from ._rows import found_rows


class HeightMap:
    """Heights of a surface on a grid: row 0 is at the top, x runs to the right, y up, and the origin is the middle of the map.

    :param heights_m: shape (rows, columns), metres, upwards from the surface; sides from 16 to 10000.
    :param spacing_m: metres from one column to the next and from one row to the next: one number, or two where they differ.
    :param fill: whether heights that are unknown (NaN, masked) take the value of the nearest known one. Without it they are an error.
    """

    heights_m: Floats
    """Shape (rows, columns), metres. Cannot be written to."""
    spacing_m: tuple[float, float]
    """From one column to the next, and from one row to the next."""

    def __init__(self, heights_m: ArrayLike, spacing_m: Union[float, Sequence[float]], *, fill: bool = False) -> None:
        masked = np.ma.getmaskarray(np.ma.asarray(heights_m)) if np.ma.is_masked(heights_m) else None
        array = _numbers("heights_m", np.ma.getdata(heights_m) if masked is not None else heights_m)
        checked_sides("heights_m", array.shape)
        heights = np.array(array, dtype=np.float64)
        unknown = np.isnan(heights) if masked is None else np.isnan(heights) | masked
        if unknown.any():
            if not fill or unknown.all():
                found = f"{int(unknown.sum())} of {unknown.size} heights are unknown (NaN)"
                raise argument_error("heights_m", found, "fill=True gives them the nearest known height" if not unknown.all() else "must be known")
            heights = _filled(heights, unknown)
        if not np.isfinite(heights).all():
            raise argument_error("heights_m", "found an infinite height", "must be finite")
        heights.setflags(write=False)
        self.heights_m = heights
        self.spacing_m = _spacing(spacing_m)

    @property
    def size_m(self) -> tuple[float, float]:
        """Width and height of the map."""
        rows, columns = self.heights_m.shape
        return columns * self.spacing_m[0], rows * self.spacing_m[1]

    @property
    def _grid(self) -> Grid:
        return Grid(1e9 * self.heights_m, (1e6 * self.spacing_m[0], 1e6 * self.spacing_m[1]))

    def __repr__(self) -> str:
        rows, columns = self.heights_m.shape
        width, height = (1e6 * side for side in self.size_m)
        rms = 1e9 * float(self.heights_m.std())
        return f"HeightMap({columns} x {rows} heights, {width:.4g} x {height:.4g} um, {rms:.3g} nm rms)"

    def levelled(self, degree: int = 1) -> HeightMap:
        """Without its form: a polynomial in x and y that the surface between scratches follows is taken off, and the zero is there.

        :param degree: of the polynomial, from 0 to 6: 1 is a plane, 2 a plane and a bow.
        """
        if isinstance(degree, bool) or not isinstance(degree, (int, np.integer)) or not 0 <= degree <= 6:
            raise argument_error("degree", f"found {degree!r}", "must be a whole number from 0 to 6")
        return HeightMap(self.heights_m - form(self.heights_m, int(degree)), self.spacing_m)

    def cropped(self, left: int, top: int, columns: int, rows: int) -> HeightMap:
        """A part of the map, in points of its grid."""
        inside = left >= 0 and top >= 0 and min(columns, rows) >= LEAST_SIDE
        if not inside or left + columns > self.heights_m.shape[1] or top + rows > self.heights_m.shape[0]:
            found = f"{columns} x {rows} at ({left}, {top}) of {self.heights_m.shape[1]} x {self.heights_m.shape[0]}"
            raise argument_error("cropped", found, f"must lie within, and be {LEAST_SIDE} or more each way")
        return HeightMap(self.heights_m[top : top + rows, left : left + columns], self.spacing_m)

    def shown(self, range_nm: Optional[tuple[float, float]] = None) -> npt.NDArray[np.uint8]:
        """Grey levels of the heights, uint8 of the shape of the map, for eyes.

        :param range_nm: the heights that are black and white. By default one in 200 heights lies below, and one above.
        """
        low, high = np.percentile(self.heights_m, (0.5, 99.5)) if range_nm is None else 1e-9 * np.asarray(range_nm, dtype=np.float64)
        if not high > low:
            if range_nm is not None:
                raise argument_error("range_nm", f"found {range_nm!r}", "must be two heights, the second greater")
            high = low + 1e-12
        grey: npt.NDArray[np.uint8] = np.round(255 * np.clip((self.heights_m - low) / (high - low), 0, 1)).astype(np.uint8)
        return grey

    def _repr_png_(self) -> bytes:
        import io

        image = needed("PIL.Image", "pillow").fromarray(self.shown())
        image.thumbnail((1024, 1024))
        image.save(buffer := io.BytesIO(), "PNG")
        return buffer.getvalue()

    def scratches(
        self,
        *,
        least_depth_nm: Optional[float] = None,
        least_length_um: Optional[float] = None,
        widths_um: Optional[tuple[float, float]] = None,
    ) -> Found:
        """The straight scratches in a levelled map; curved ones come in straight pieces.

        :param least_depth_nm: shallower ones are left out. Three times the noise by default.
        :param least_length_um: shorter ones are left out. 20 points of the grid by default.
        :param widths_um: what is looked for. From 2 to 16 points of the grid by default.
        """
        return found_scratches(self._grid, least_depth_nm, least_length_um, widths_um)

    def rows(self, *, least_share: float = 0.1) -> Optional[Rows]:
        """The row of grooves that repeats over the map, or None where none does.

        :param least_share: the share of the variance of the heights, without what is longer than a tenth of the map, that the row explains at least.
        """
        return found_rows(self._grid, least_share)

    def brdf(
        self, wavelength_nm: float, metal: Optional[str] = None, *, coherence_um: float = 20.0, cos_sum: float = 2.0
    ) -> Brdf:
        """The light that the heights themselves send, by Fourier transform: no scratches are looked for.

        :param metal: whose reflectance along the normal is a factor; by default 1.
        :param coherence_um: standard deviation of the coherence window; the map must be 8 times as large.
        :param cos_sum: the sum of the cosines of both directions; 2 along the normal.
        """
        return brdf(self._grid, wavelength_nm, metal, coherence_um, cos_sum)

    def sent(
        self,
        wavelength_nm: ArrayLike,
        sine_low: float,
        sine_high: float,
        *,
        coherence_um: float = 20.0,
        cos_sum: float = 2.0,
    ) -> Floats:
        """The share of the light that the heights send beside the mirror's direction, between two sines: that of :meth:`brdf`, summed up,
        for a reflectance of 1. One number for each wavelength. :meth:`Found.sent` is its closed form."""
        return sent(self._grid, wavelength_nm, sine_low, sine_high, coherence_um, cos_sum)


def _spacing(spacing_m: Any) -> tuple[float, float]:
    steps = np.asarray(_numbers("spacing_m", spacing_m), dtype=np.float64).reshape(-1)
    if steps.size not in (1, 2) or not (np.isfinite(steps) & (steps >= 1e-10) & (steps <= 1e-3)).all():
        raise argument_error("spacing_m", f"found {spacing_m!r}", "must be one number or two, from 1e-10 to 0.001 metres")
    return float(steps[0]), float(steps[-1])


def _filled(heights: Floats, unknown: npt.NDArray[np.bool_]) -> Floats:
    from ._packages import scipy

    nearest = scipy("ndimage").distance_transform_edt(unknown, return_distances=False, return_indices=True)
    filled: Floats = heights[tuple(nearest)]
    return filled
