"""The grid that all rooms work on: nanometres over micrometres."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._arrays import Floats
from .._errors import argument_error
from ._packages import scipy

LEAST_SIDE, MOST_SIDE = 16, 10_000


class Grid(NamedTuple):
    """Heights with row 0 at the top."""

    heights_nm: Floats
    spacing_um: tuple[float, float]

    @property
    def area_um2(self) -> float:
        return self.heights_nm.size * self.spacing_um[0] * self.spacing_um[1]

    def square(self) -> Grid:
        """With the same step both ways: the finer one."""
        across, down = self.spacing_um
        step = min(across, down)
        if max(across, down) < 1.0001 * step:
            return self
        rows, columns = self.heights_nm.shape
        made = (round(rows * down / step), round(columns * across / step))
        if max(made) > MOST_SIDE:
            found = f"found steps that make {made[1]} x {made[0]} heights of the finer one"
            raise argument_error("spacing_m", found, f"must make {MOST_SIDE} a side at most: crop the map")
        finer = scipy("ndimage").zoom(self.heights_nm, (down / step, across / step), order=1, mode="nearest", grid_mode=True)
        return Grid(finer, (columns * across / finer.shape[1], rows * down / finer.shape[0]))

    def xy_um(self, points: Floats) -> Floats:
        """Places from (row, column), shape (..., 2)."""
        rows, columns = self.heights_nm.shape
        x = (points[..., 1] - 0.5 * (columns - 1)) * self.spacing_um[0]
        y = (0.5 * (rows - 1) - points[..., 0]) * self.spacing_um[1]
        return np.stack([x, y], axis=-1)


def checked_sides(key: str, shape: tuple[int, ...]) -> None:
    """Refuses what is no map, or larger than one that fits into memory a few times."""
    if len(shape) != 2:
        found = " x ".join(map(str, shape)) or "a single number"
        raise argument_error(key, f"found an array of shape {found}", "must be of shape rows x columns")
    if not all(LEAST_SIDE <= side <= MOST_SIDE for side in shape):
        right = f"must be from {LEAST_SIDE} to {MOST_SIDE} heights a side"
        raise argument_error(key, f"found {shape[1]} x {shape[0]} heights", right)
