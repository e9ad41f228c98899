"""The profile of a groove: the rectangle that it stands for."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .._arrays import Floats
from ._packages import scipy


class Groove(NamedTuple):
    """A rectangle with soft walls, on a straight base."""

    middle_um: float
    width_um: float
    depth_nm: float
    wall_um: float
    """Standard deviation of what softens the walls: the instrument, or the groove itself."""
    base_nm: float
    slope_nm_per_um: float
    residual_nm: float
    """Root of the mean square of what the rectangle leaves."""


def shape(offset_um: Floats, width_um: float, wall_um: float) -> Floats:
    """A box of height 1 about 0, smoothed by a Gaussian: the depth's share at each offset."""
    erf = scipy("special").erf
    scale = np.sqrt(2) * wall_um
    made: Floats = 0.5 * (erf((offset_um + 0.5 * width_um) / scale) - erf((offset_um - 0.5 * width_um) / scale))
    return made


@lru_cache(maxsize=256)
def _boxes(offsets_um: bytes, widths_um: bytes, wall_um: float) -> tuple[Floats, Floats, Floats, Floats]:
    """Middles, a straight base, the boxes of all widths and middles without their part in it, and the square of each: lines of one width ask for
    the same ones."""
    offset, widths = np.frombuffer(offsets_um), np.frombuffer(widths_um)
    reach = float(offset.max())
    middles = np.linspace(-0.5 * reach, 0.5 * reach, 41 if len(widths) > 1 else 161)
    off = offset - middles[:, None]
    boxes = np.concatenate([shape(off, width, wall_um) for width in widths])
    line = np.linalg.qr(np.stack([np.ones_like(offset), offset], axis=1))[0]
    boxes = boxes - (boxes @ line) @ line.T
    return middles, line, boxes, np.maximum((boxes**2).sum(axis=1), 1e-9)


def located(offset_um: Floats, heights_nm: Floats, widths_um: Floats, wall_um: float) -> tuple[float, float, float]:
    """Middle, width and depth of the groove of one of some widths that leaves least of a profile, on a base that may slope: the best of a grid."""
    middles, line, boxes, norm = _boxes(offset_um.tobytes(), widths_um.tobytes(), wall_um)
    target = heights_nm - line @ (line.T @ heights_nm)
    depths = -(boxes @ target) / norm
    best = int(np.argmax(np.maximum(depths, 0) ** 2 * norm))
    return float(middles[best % len(middles)]), float(widths_um[best // len(middles)]), float(depths[best])


def fitted(offset_um: Floats, heights_nm: Floats, step_um: float, width_um: float, *, middle_um: float = 0.0, pitch_um: float = 0.0) -> Groove:
    """The groove that fits a profile best, by least squares.

    :param step_um: of the map's grid, the least that walls are soft by.
    :param width_um: about which it is looked for: the sum of squares has more than one hollow. So is ``middle_um``.
    :param pitch_um: of a row that repeats, or 0 for one groove on a base that may slope.
    """
    base = float(np.percentile(heights_nm, 75))
    depth = max(base - float(heights_nm.min()), 1e-3)
    reach = float(offset_um.max() - offset_um.min())
    most_wide = 0.95 * (pitch_um or reach)
    erf = scipy("special").erf
    # The grooves to both sides of one in a row reach in.
    copies = pitch_um * np.arange(-1, 2) if pitch_um else np.zeros(1)
    places = offset_um[None, :] + copies[:, None]

    def heights(of: Floats) -> Floats:
        middle, width, deep, wall, level, slope = of
        off, scale = places - middle, np.sqrt(2) * wall
        boxes = 0.5 * (erf((off + 0.5 * width) / scale) - erf((off - 0.5 * width) / scale)).sum(axis=0)
        made: Floats = level - deep * boxes + (0 if pitch_um else slope) * offset_um
        return made

    def slopes(of: Floats) -> Floats:
        """Derivatives of the heights by each of these."""
        middle, width, deep, wall, _, _ = of
        off, scale = places - middle, np.sqrt(2) * wall
        ends = (off + 0.5 * width) / scale, (off - 0.5 * width) / scale
        near, far = (np.exp(-end * end) / np.sqrt(np.pi) for end in ends)
        by_middle = (far - near).sum(axis=0) / scale
        by_width = 0.5 * (near + far).sum(axis=0) / scale
        by_wall = (far * ends[1] - near * ends[0]).sum(axis=0) / wall
        boxes = 0.5 * (erf(ends[0]) - erf(ends[1])).sum(axis=0)
        by_slope = np.zeros_like(offset_um) if pitch_um else offset_um
        made: Floats = np.stack(
            [-deep * by_middle, -deep * by_width, -boxes, -deep * by_wall, np.ones_like(offset_um), by_slope], axis=1
        )
        return made

    low = [float(offset_um.min()), 0.5 * step_um, 0.0, 0.25 * step_um, -np.inf, -np.inf]
    high = [float(offset_um.max()), most_wide, 10 * depth, 0.5 * most_wide, np.inf, np.inf]
    scale = [step_um, step_um, depth, step_um, depth, depth / reach]
    best, least = None, np.inf
    for factor in (0.7, 1.4):
        wide = float(np.clip(factor * width_um, 0.6 * step_um, 0.9 * most_wide))
        start = [middle_um, wide, depth, min(0.5 * step_um, 0.4 * most_wide), base, 0.0]
        done = scipy("optimize").least_squares(
            lambda of: heights(of) - heights_nm, start, slopes, bounds=(low, high), x_scale=scale, max_nfev=60, ftol=1e-6, xtol=1e-6
        )
        if done.cost < least:
            best, least = done.x, float(done.cost)
    assert best is not None
    middle, width, deep, wall, level, slope = map(float, best)
    return Groove(middle, width, deep, wall, level, slope, float(np.sqrt(2 * least / len(offset_um))))
