"""Finding straight scratches: ridges, lines through them, and the groove across each line."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np

from .._arrays import Floats
from .._errors import argument_error
from ._brdf import checked
from ._found import Found, Scratch
from ._grid import Grid
from ._packages import scipy, skimage
from ._profile import Groove, fitted, located, shape

# A line's ridge may turn from it by so much, and lie so many points of the grid off it.
_TURN_RAD = np.radians(12)
_OFF_PX = 1.5
# A line begins with the points so near to its seed.
_FIRST_REACH_PX = 12.0
# What is missing of a line without ending it: where another one crosses, or noise covers it.
_GAP_PX = 12.0
# A wider one, where the line goes on behind it for as long.
_WIDE_GAP_PX = 60.0
# A line that lies in others by this share of its length is a part of them.
_WITHIN = 0.6
# A profile reaches so many widths to both sides.
_REACH_WIDTHS = 2.2


class _Ridges(NamedTuple):
    """Points on the middle lines of valleys, strongest first: (row, column), and the angle of each valley from the columns' axis."""

    points: Floats
    angle_rad: Floats
    tree: Any
    """Finds those near a place."""

    def near(self, place: Floats, reach: float) -> Any:
        """Which lie within a distance, in rising order."""
        return np.array(self.tree.query_ball_point(place, reach, return_sorted=True), dtype=np.intp)


class _Valley(NamedTuple):
    """What lies across a line, before a groove is fitted to it."""

    ends: Floats
    """From one end to the other, (row, column)."""
    offset_um: Floats
    heights_nm: Floats
    middle_um: float
    width_um: float

    def line(self, step: float) -> _Line:
        """The line with the groove that fits best: what takes most of the time."""
        groove = fitted(self.offset_um, self.heights_nm, step, self.width_um, middle_um=self.middle_um)
        profile = np.stack([self.offset_um - groove.middle_um, self.heights_nm - groove.base_nm], axis=1)
        return _Line(self.ends, groove, profile)


class _Line(NamedTuple):
    """From one end to the other, (row, column)."""

    ends: Floats
    groove: Groove
    profile: Floats


def found_scratches(
    grid: Grid, least_depth_nm: Optional[float], least_length_um: Optional[float], widths_um: Optional[tuple[float, float]]
) -> Found:
    """See ``HeightMap.scratches``."""
    square = grid.square()
    step = square.spacing_um[0]
    if widths_um is None:
        low, high = 2 * step, 16 * step
    else:
        pair = widths_um if isinstance(widths_um, (tuple, list)) else (widths_um,)
        if len(pair) != 2:
            raise argument_error("widths_um", f"found {widths_um!r}", "must be two numbers")
        low, high = (checked("widths_um", width, 0, 0.5 * step * min(grid.heights_nm.shape)) for width in pair)
    if not 0.5 * step <= low < high:
        raise argument_error("widths_um", f"found {widths_um!r}", f"must be two widths, the first from {0.5 * step:.3g}, half a point of the grid, the second greater")
    if least_length_um is not None and not least_length_um >= 4 * step:
        raise argument_error("least_length_um", f"found {least_length_um!r}", f"must be from {4 * step:.3g}, four points of the grid")
    if least_depth_nm is not None and not least_depth_nm > 0:
        raise argument_error("least_depth_nm", f"found {least_depth_nm!r}", "must be above 0")
    length_px = 20.0 if least_length_um is None else least_length_um / step
    noise = _noise(square.heights_nm)
    least = max(3 * noise, 1e-3) if least_depth_nm is None else float(least_depth_nm)
    ridges = _ridges(square.heights_nm, (low / step, high / step), least)
    lines = _lines(square.heights_nm, step, ridges, length_px, least, (low, high))
    scratches = []
    for line in lines:
        ends = square.xy_um(line.ends)
        scratches.append(Scratch(1e-6 * ends, line.groove.width_um, line.groove.depth_nm, line.groove.wall_um, line.groove.residual_nm, line.profile))
    rows, columns = square.heights_nm.shape
    return Found(tuple(scratches), (1e-6 * step * columns, 1e-6 * step * rows), (1e-6 * step))


def _noise(heights: Floats) -> float:
    """Standard deviation of what differs from point to point, by the median of second differences: that knows no slopes and few
    grooves. Across brushed lines, where there are many, it is what a scratch has to stand out of."""
    twice = [np.diff(heights, 2, axis=axis) for axis in (0, 1)]
    return max(1.4826 * float(np.median(np.abs(one))) / 6**0.5 for one in twice)


def _ridges(heights: Floats, widths_px: tuple[float, float], least_nm: float) -> _Ridges:
    """Middle lines of valleys by the filter of Sato and others (Medical Image Analysis 2, 143, 1998)."""
    feature, filters = skimage("feature"), skimage("filters")
    # A valley of width W answers most where the Gaussian is about W/2 wide.
    least, most = (max(0.7, 0.5 * width) for width in widths_px)
    sigmas = np.geomspace(least, most, max(2, int(np.ceil(2 * np.log2(most / least))) + 1))
    response = np.zeros_like(heights)
    angle = np.zeros_like(heights)
    for sigma in sigmas:
        strength = filters.sato(heights, sigmas=[sigma], black_ridges=True, mode="reflect")
        stronger = strength > response
        rr, rc, cc = feature.hessian_matrix(heights, sigma=sigma, mode="reflect", order="rc", use_gaussian_derivatives=False)
        # The direction of least curvature.
        across = 0.5 * np.arctan2(2 * rc, cc - rr)
        response = np.where(stronger, strength, response)
        angle = np.where(stronger, across + 0.5 * np.pi, angle)
    # A box under a Gaussian of half its width answers by about half of its depth.
    mask = filters.apply_hysteresis_threshold(response, 0.2 * least_nm, 0.4 * least_nm)
    # The middle line of a valley answers more than what is beside it.
    rows, columns = np.nonzero(mask)
    side = np.stack([np.cos(angle[mask]), -np.sin(angle[mask])])
    beside = [scipy("ndimage").map_coordinates(response, np.stack([rows, columns]) + way * side, order=1, mode="nearest") for way in (-1, 1)]
    middle = response[mask] >= np.maximum(*beside)
    points = np.stack([rows[middle], columns[middle]], axis=1)
    at = tuple(points.T)
    order = np.argsort(-response[at], kind="stable")
    ordered = points[order].astype(np.float64)
    return _Ridges(ordered, angle[at][order], scipy("spatial").cKDTree(ordered.reshape(-1, 2)))


def _lines(heights: Floats, step: float, ridges: _Ridges, length_px: float, least_nm: float, widths_um: tuple[float, float]) -> list[_Line]:
    """Lines through ridges, each from the strongest point that no line has yet."""
    free = np.ones(len(ridges.points), dtype=bool)
    lines: list[_Line] = []
    for seed in range(len(free)):
        if not free[seed]:
            continue
        free[seed] = False
        ends = _grown(ridges, free, seed, length_px)
        if ends is None:
            continue
        valley = _measured(heights, step, ends, widths_um, least_nm)
        if valley is None:
            _take(ridges, free, ends, _OFF_PX)
            continue
        _take(ridges, free, valley.ends, 0.5 * valley.width_um / step + 2)
        # Most are short or parts of others, and need no fit.
        if np.hypot(*(valley.ends[1] - valley.ends[0])) >= length_px and _within(valley.ends, lines, step) < _WITHIN:
            line = valley.line(step)
            if _accepted(line.groove, least_nm, widths_um):
                lines.append(line)
    return lines


def _accepted(groove: Groove, least_nm: float, widths_um: tuple[float, float]) -> bool:
    within = 0.7 * widths_um[0] <= groove.width_um <= 1.4 * widths_um[1]
    return within and groove.depth_nm >= max(least_nm, 5 * groove.residual_nm)


def _within(ends: Floats, others: list[_Line], step: float) -> float:
    """The share of a line that lies in the grooves of others."""
    points = ends[0] + np.linspace(0, 1, 101)[:, None] * (ends[1] - ends[0])
    inside = np.zeros(101, dtype=bool)
    for other in others:
        way = other.ends[1] - other.ends[0]
        along, off = _along(points, other.ends[0], float(np.arctan2(way[0], way[1])))
        inside |= (np.abs(off) < 0.5 * other.groove.width_um / step + 2) & (along > 0) & (along < np.hypot(*way))
    return float(inside.mean())


def _along(points: Floats, through: Floats, angle: float) -> tuple[Floats, Floats]:
    """Places along a line and off it."""
    way = np.array([np.sin(angle), np.cos(angle)])
    off = points - through
    return off @ way, off @ np.array([way[1], -way[0]])


def _run(places: Floats, at: float, wide_gaps: bool = False) -> tuple[float, float]:
    """The ends of the run of places about one of them that no gap parts."""
    ordered = np.sort(places)
    breaks = np.flatnonzero(np.diff(ordered) > _GAP_PX)
    runs = [(float(part[0]), float(part[-1])) for part in np.split(ordered, breaks + 1)]
    here = min(range(len(runs)), key=lambda n: max(runs[n][0] - at, at - runs[n][1], 0.0))
    start, stop = runs[here]
    if wide_gaps:
        for next_start, next_stop in runs[here + 1 :]:
            if next_start - stop > min(_WIDE_GAP_PX, next_stop - next_start):
                break
            stop = next_stop
        for next_start, next_stop in runs[:here][::-1]:
            if start - next_stop > min(_WIDE_GAP_PX, next_stop - next_start):
                break
            start = next_start
    return start, stop


def _grown(ridges: _Ridges, free: Any, seed: int, length_px: float) -> Optional[Floats]:
    """The ends of the line of ridge points through a seed, fitted to more and more of them."""
    through, angle = ridges.points[seed], float(ridges.angle_rad[seed])
    reach = _FIRST_REACH_PX
    while True:
        near = ridges.near(through, reach)
        near = near[free[near]]
        along, off = _along(ridges.points[near], through, angle)
        turned = _turn(ridges.angle_rad[near], angle)
        # The first direction is that of one point.
        wide = _OFF_PX + 0.02 * reach if reach < 40 else _OFF_PX
        mine = (np.abs(off) < wide) & (turned < _TURN_RAD)
        # Three quarters of the way, at least, as points lie along a line that is there.
        if mine.sum() < 0.75 * _FIRST_REACH_PX:
            return None
        start, stop = _run(along[mine], 0.0)
        points = ridges.points[near[mine & (along >= start) & (along <= stop)]]
        if len(points) < 0.75 * _FIRST_REACH_PX:
            return None
        through = points.mean(axis=0)
        way = np.linalg.svd(points - through, full_matrices=False)[2][0]
        angle = float(np.arctan2(way[0], way[1]))
        if reach > _FIRST_REACH_PX and max(-start, stop) < reach - _GAP_PX or reach > 1e5:
            break
        reach *= 2
    along, _ = _along(points, through, angle)
    if along.max() - along.min() < 0.6 * length_px:
        return None
    way = np.array([np.sin(angle), np.cos(angle)])
    return np.stack([through + along.min() * way, through + along.max() * way])


def _turn(angles: Floats, angle: float) -> Floats:
    """By how much directions differ from one, a direction being its opposite too."""
    made: Floats = np.abs((angles - angle + 0.5 * np.pi) % np.pi - 0.5 * np.pi)
    return made


def _take(ridges: _Ridges, free: Any, ends: Floats, off_px: float) -> None:
    """Marks the ridge points of a line as its own."""
    way = ends[1] - ends[0]
    length = float(np.hypot(*way))
    angle = float(np.arctan2(way[0], way[1]))
    near = ridges.near(ends.mean(axis=0), 0.5 * length + off_px + 3)
    along, off = _along(ridges.points[near], ends[0], angle)
    own = (np.abs(off) < off_px) & (along > -3) & (along < length + 3) & (_turn(ridges.angle_rad[near], angle) < 2 * _TURN_RAD)
    free[near[own]] = False


def _strip(heights: Floats, ends: Floats, along: Floats, across: Floats) -> Floats:
    """Heights in the frame of a line, shape (along, across), in points of the grid; NaN beyond the map."""
    way = (ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0]))
    side = np.array([way[1], -way[0]])
    places = ends[0][:, None, None] + along[None, :, None] * way[:, None, None] + across[None, None, :] * side[:, None, None]
    made: Floats = scipy("ndimage").map_coordinates(heights, places, order=1, mode="constant", cval=np.nan)
    return made


def _middle_profile(strip: Floats) -> Optional[Floats]:
    """The median along a line: what crosses it does not count. Each part is brought to the same level before."""
    known = ~np.isnan(strip).any(axis=1)
    if known.sum() < 8:
        return None
    rows = strip[known]
    level = np.median(rows, axis=1)
    made: Floats = np.median(rows - level[:, None], axis=0) + float(np.median(level))
    return made


def _measured(heights: Floats, step: float, ends: Floats, widths_um: tuple[float, float], least_nm: float) -> Optional[_Valley]:
    """A line moved to the middle of its groove, with what lies across it."""
    widths = np.geomspace(0.7 * widths_um[0], 1.4 * widths_um[1], 12)
    # Half a point of the grid is what it softens walls by.
    wall = 0.5 * step
    width = float(np.sqrt(widths_um[0] * widths_um[1]))
    for turn in range(4):
        length = float(np.hypot(*(ends[1] - ends[0])))
        if length < 6:
            return None
        reach = float(np.ceil(max(_REACH_WIDTHS * width / step, 6)))
        across = np.arange(-reach, reach + 0.25, 0.5)
        strip = _strip(heights, ends, np.arange(0, length + 0.5, max(1.0, length / 200)), across)
        profile, offset = _middle_profile(strip), across * step
        if profile is None:
            return None
        middle, width, depth = located(offset, profile, widths, wall)
        if depth < 0.7 * least_nm:
            return None
        if turn == 3:
            break
        way = (ends[1] - ends[0]) / length
        side = np.array([way[1], -way[0]])
        parts = [_middle_profile(part) for part in np.array_split(strip, 2)]
        first, second = (middle if part is None else located(offset, part, np.array([width]), wall)[0] for part in parts)
        # The halves' middles are a quarter and three quarters along.
        shifts = np.array([1.5 * first - 0.5 * second, 1.5 * second - 0.5 * first]) / step
        ends = ends + shifts[:, None] * side
        if turn != 1:
            ends = _ends(heights, step, ends, width, wall, depth)
    assert profile is not None
    return _Valley(ends, offset, profile, middle, width)


def _ends(heights: Floats, step: float, ends: Floats, width_um: float, wall_um: float, depth_nm: float) -> Floats:
    """Where the groove is half as deep as it is in the mean, at both ends."""
    way = (ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0]))
    length = float(np.hypot(*(ends[1] - ends[0])))
    most = float(np.hypot(*heights.shape))
    along = np.arange(-most, length + most, 1.0)
    places = ends[0][:, None] + along * way[:, None]
    inside = ((places >= 0) & (places <= np.array(heights.shape)[:, None] - 1)).all(axis=0)
    along = along[inside]
    if len(along) < 2:
        return ends
    half = max(width_um / step, 3.0)
    across = np.arange(-np.ceil(half), np.ceil(half) + 0.25, 0.5)
    strip = _strip(heights, ends, along, across)
    known = ~np.isnan(strip)
    template = shape(across * step, width_um, wall_um)
    # The slope of heights by the template, about the mean of both: what is all around has no part in it.
    count = np.maximum(known.sum(axis=1), 1)
    off_template = np.where(known, template - (known @ template / count)[:, None], 0)
    norm = np.maximum((off_template**2).sum(axis=1), 1e-12)
    share = -(np.where(known, strip, 0) * off_template).sum(axis=1) / norm / depth_nm
    share[known.mean(axis=1) < 0.6] = np.nan
    share = np.interp(along, along[~np.isnan(share)], share[~np.isnan(share)]) if (~np.isnan(share)).any() else np.zeros_like(along)
    # The median of as many as noise asks for.
    noise = 1.4826 * float(np.median(np.abs(np.diff(share)))) / np.sqrt(2)
    size = 2 * int(np.clip((noise / 0.15) ** 2, 2, 15)) + 1
    smooth = scipy("ndimage").median_filter(share, size=size, mode="nearest")
    there = along[smooth > 0.5]
    there = there[(there > -most) & (there < length + most)]
    if len(there) < 4:
        return ends
    start, stop = _run(there, 0.5 * length, wide_gaps=True)
    if stop - start < 4:
        return ends
    return np.stack([ends[0] + start * way, ends[0] + stop * way])
