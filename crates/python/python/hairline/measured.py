"""Measured surfaces: height maps, the scratches in them, and what light does to them by Fourier transform (``pip install 'hairline[measured]'``).

    from hairline import measured

    height = measured.read("plate.sur").levelled()
    found = height.scratches()
    layer = found.layer("plate")          # a layer of scenes that repeats their statistics
    height.brdf(wi, wo, wavelength_nm=550)  # the judge: the map's own, with every phase

Maps are in nanometres, rows from the top, pixels in micrometres. Instruments' files (.sur, .plu, .x3p, .al3d and others) are read by SurfaceTopography,
ridges are followed by scikit-image.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from ._arrays import ArrayLike, Floats, _numbers, floats
from ._errors import WorkError, argument_error
from ._table import Path
from ._tables import Scratches
from .bsdf import Layer, _number

__all__ = ["Found", "HeightMap", "read"]

_MOST_PX = 8192
_LEAST_PX = 16
_TO_NM = {"m": 1e9, "mm": 1e6, "µm": 1e3, "um": 1e3, "nm": 1.0, "Å": 0.1, "pm": 1e-3}


def _library(name: str) -> Any:
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError as missing:
        raise ImportError(f"hairline.measured needs {name.split('.')[0]}: pip install 'hairline[measured]'") from missing


class HeightMap:
    """Heights of a surface over a grid.

    :param height_nm: rows by columns, nanometres; NaN where nothing was measured.
    :param pixel_um: distance of neighbouring pixels: one number, or those from column to column and from row to row.
    """

    height_nm: Floats
    pixel_um: tuple[float, float]

    def __init__(self, height_nm: ArrayLike, pixel_um: Union[float, tuple[float, float]]) -> None:
        array = np.array(_numbers("height_nm", height_nm), dtype=np.float64)
        if array.ndim != 2:
            raise argument_error("height_nm", f"found an array of shape {array.shape}", "must be rows by columns")
        if not (_LEAST_PX <= min(array.shape) and max(array.shape) <= _MOST_PX):
            found = f"found {array.shape[1]} x {array.shape[0]} pixels"
            raise argument_error("height_nm", found, f"must have from {_LEAST_PX} to {_MOST_PX} to a side: crop or bin it")
        unknown = ~np.isfinite(array)
        if unknown.mean() > 0.5:
            raise argument_error("height_nm", f"found no height in {100 * unknown.mean():.0f} % of the pixels", "must have at least half of them")
        if unknown.any():
            # The nearest height that is known.
            nearest = _library("scipy.ndimage").distance_transform_edt(unknown, return_distances=False, return_indices=True)
            array = array[tuple(nearest)]
        both = pixel_um if isinstance(pixel_um, (tuple, list)) else (pixel_um, pixel_um)
        if len(both) != 2:
            raise argument_error("pixel_um", f"found {pixel_um!r}", "must be a number, or two")
        self.pixel_um = (_number("pixel_um", both[0], 1e-4, 1e4), _number("pixel_um", both[1], 1e-4, 1e4))
        self.height_nm = array
        self.height_nm.setflags(write=False)

    @property
    def size_um(self) -> tuple[float, float]:
        """Width and height of the map."""
        rows, columns = self.height_nm.shape
        return columns * self.pixel_um[0], rows * self.pixel_um[1]

    def levelled(self, waviness_um: Optional[float] = None) -> HeightMap:
        """The map without its tilt; and without what is longer than ``waviness_um``, if it is given.

        The plane is that of least squares over all but what is far from it, so that grooves do not pull it."""
        rows, columns = self.height_nm.shape
        y, x = np.mgrid[:rows, :columns].astype(np.float64)
        terms = np.stack([np.ones(x.size), x.ravel() / columns, y.ravel() / rows], axis=1)
        heights = self.height_nm.ravel()
        kept = np.ones(len(heights), bool)
        rest = heights
        for _ in range(6):
            plane, *_ = np.linalg.lstsq(terms[kept], heights[kept], rcond=None)
            rest = heights - terms @ plane
            middle = np.median(rest)
            kept = np.abs(rest - middle) <= max(2.5 * _spread(rest), 1e-9)
        level = (rest - np.median(rest)).reshape(rows, columns)
        if waviness_um is not None:
            sigma = _number("waviness_um", waviness_um, 1e-3, 1e6) / (2 * math.pi * np.array(self.pixel_um[::-1]))
            blurred = _library("scipy.ndimage").gaussian_filter
            calm = np.clip(level, -2 * _spread(level), 2 * _spread(level))
            level = level - blurred(calm, sigma, mode="nearest")
        return HeightMap(level, self.pixel_um)

    def scratches(self, *, least_depth_nm: Optional[float] = None, least_length_um: Optional[float] = None) -> Found:
        """The straight grooves in a levelled map.

        :param least_depth_nm: default: five times the noise.
        :param least_length_um: default: twenty pixels.
        """
        measure, morphology = _library("skimage.measure"), _library("skimage.morphology")
        feature = _library("skimage.feature")
        pixel = math.sqrt(self.pixel_um[0] * self.pixel_um[1])
        if abs(self.pixel_um[0] / self.pixel_um[1] - 1) > 0.01:
            raise argument_error("pixel_um", f"found {self.pixel_um}", "must be square pixels: scale the map before")
        noise = _spread(self.height_nm)
        bound = 5 * noise if least_depth_nm is None else _number("least_depth_nm", least_depth_nm, 0, 1e6)
        shortest = 20 * pixel if least_length_um is None else _number("least_length_um", least_length_um, pixel, 1e9)
        inside = self.height_nm < -max(bound, 1e-6)
        skeleton = morphology.skeletonize(inside)
        # The direction in which a groove runs: across it the height changes most.
        rr, rc, cc = feature.structure_tensor(inside.astype(float), sigma=3.0, order="rc")
        along = 0.5 * np.arctan2(2 * rc, rr - cc)
        pieces: list[Floats] = []
        left = skeleton.copy()
        turns = np.arange(0, math.pi, math.pi / 18)
        for _ in range(3):
            listed = []
            for turn in turns:
                off = np.abs(np.angle(np.exp(2j * (along - turn)))) / 2
                labels = measure.label(left & (off < math.pi / 18), connectivity=2)
                listed += [region.coords for region in measure.regionprops(labels) if region.num_pixels >= 4]
            listed.sort(key=len, reverse=True)
            for coords in listed:
                own = coords[left[coords[:, 0], coords[:, 1]]]
                if len(own) >= max(4, 0.6 * len(coords)):
                    left[own[:, 0], own[:, 1]] = False
                    pieces.append(own.astype(float))
        lines = _joined(pieces, shortest / pixel)
        rows = []
        for start, end in lines:
            size = self._section(start, end, bound)
            if size is not None and np.linalg.norm(end - start) * pixel >= shortest:
                rows.append((start, end, *size))
        ends = np.array([[row[0][::-1], row[1][::-1]] for row in rows]).reshape(-1, 2, 2)
        return Found(
            (ends + 0.5) * pixel,
            np.array([row[2] for row in rows], dtype=np.float64),
            np.array([row[3] for row in rows], dtype=np.float64),
            [row[4] for row in rows],
            pixel,
            self.size_um,
        )

    def _section(self, start: Floats, end: Floats, bound: float) -> Optional[tuple[float, float, Floats]]:
        """Width in um and depth in nm of the rectangle that stands for a groove, and its mean section, nm: the median over its length."""
        pixel = self.pixel_um[0]
        way = end - start
        length = float(np.linalg.norm(way))
        along = way / length
        across = np.array([-along[1], along[0]])
        reach = 40
        step = 0.5
        t = np.arange(-reach, reach + step, step)
        places = start + np.linspace(0.05, 0.95, max(8, int(length))).reshape(-1, 1) * way
        at = places[:, None, :] + t[None, :, None] * across
        values = _library("scipy.ndimage").map_coordinates(self.height_nm, at.reshape(-1, 2).T, order=1, mode="nearest")
        section: Floats = np.median(values.reshape(len(places), len(t)), axis=0)
        middle = len(t) // 2
        near = slice(middle - 6, middle + 7)
        lowest = middle - 6 + int(np.argmin(section[near]))
        depth = -float(section[lowest])
        if depth < bound:
            return None
        for _ in range(3):
            low = high = lowest
            while low > 0 and section[low - 1] < -depth / 2:
                low -= 1
            while high < len(t) - 1 and section[high + 1] < -depth / 2:
                high += 1
            inner = section[low + (high - low) // 5 : high + 1 - (high - low) // 5]
            depth = -float(np.mean(inner))

        def crossing(outer: int, inner_at: int) -> float:
            a, b = section[outer], section[inner_at]
            share = (-depth / 2 - a) / (b - a) if b != a else 0.5
            return float(t[outer] + share * (t[inner_at] - t[outer]))

        first = crossing(max(low - 1, 0), low)
        last = crossing(min(high + 1, len(t) - 1), high)
        return max(last - first, step) * pixel, depth, section

    def brdf(
        self,
        wi: ArrayLike,
        wo: ArrayLike,
        *,
        wavelength_nm: float,
        coherence_um: float = 20.0,
        center_um: Optional[tuple[float, float]] = None,
    ) -> Floats:
        """The map's reflection under a Gaussian coherence window, with every phase, times the cosine of ``wi``, 1/sr: (1) of docs/model.md by Fourier
        transform, reflectance 1. It is what :func:`hairline.optics.coherent_response` tells of grooves.

        :param wi: unit vectors towards the light, shape (..., 3): x along rows, y up the columns, z the normal.
        :param wo: unit vectors towards the viewer.
        :param center_um: middle of the window, from the upper left corner. Default: the map's.
        """
        nm = _number("wavelength_nm", wavelength_nm, 100, 20_000)
        sigma = _number("coherence_um", coherence_um, 0.1, 1e4)
        width, height = self.size_um
        middle = center_um or (width / 2, height / 2)
        reach = 4.0 * sigma
        if not (reach <= middle[0] <= width - reach and reach <= middle[1] <= height - reach):
            found = f"found a window of {2 * reach:g} um about {middle} in a map of {width:g} x {height:g} um"
            raise argument_error("coherence_um", found, "must fit into the map")
        nyquist = 0.5e-3 * nm
        if max(self.pixel_um) > nyquist:
            raise argument_error("pixel_um", f"found {max(self.pixel_um):g}", f"must be at most half a wavelength, {nyquist:g} um")
        vectors = [floats(key, np.atleast_2d(np.asarray(value)), None, 3) for key, value in (("wi", wi), ("wo", wo))]
        together = np.broadcast_arrays(*vectors)
        made = np.zeros(len(together[0]))
        rows, columns = self.height_nm.shape
        x = (np.arange(columns) + 0.5) * self.pixel_um[0] - middle[0]
        y = middle[1] - (np.arange(rows) + 0.5) * self.pixel_um[1]
        near_x, near_y = np.abs(x) <= 1.3 * reach, np.abs(y) <= 1.3 * reach
        x, y = x[near_x], y[near_y]
        heights = self.height_nm[np.ix_(near_y, near_x)]
        window = np.exp(-(x**2) / (2 * sigma**2))[None, :] * np.exp(-(y**2) / (2 * sigma**2))[:, None]
        k = 2 * math.pi / (1e-3 * nm)
        for i, (light, viewer) in enumerate(zip(*together)):
            if light[2] <= 0 or viewer[2] <= 0:
                continue
            xi = light + viewer
            # A groove's light has the longer way.
            field = window * np.exp(1j * k * 1e-3 * heights * xi[2])
            amplitude = np.exp(-1j * k * xi[1] * y) @ field @ np.exp(-1j * k * xi[0] * x)
            amplitude *= self.pixel_um[0] * self.pixel_um[1] / (1e-3 * nm)
            made[i] = abs(amplitude) ** 2 / (math.pi * sigma**2) * light[2]
        shape = np.broadcast_shapes(np.shape(wi)[:-1], np.shape(wo)[:-1])
        return made.reshape(shape)

    def _repr_png_(self) -> bytes:
        """The map as lit from the upper left."""
        from .inspect import _grey_png

        fewer = max(1, max(self.height_nm.shape) // 768)
        down, right = np.gradient(self.height_nm[::fewer, ::fewer])
        slope = np.asarray(down + right)
        most = max(4 * _spread(slope), 1e-12)
        return _grey_png((255 * np.clip(0.5 + 0.5 * slope / most, 0, 1)).astype(np.uint8))

    def __repr__(self) -> str:
        rows, columns = self.height_nm.shape
        width, height = self.size_um
        return f"<hairline.measured.HeightMap: {columns} x {rows} pixels, {width:g} x {height:g} um>"


def _spread(values: npt.NDArray[Any]) -> float:
    """The standard deviation of what is normal among values, by the median of their distances from the median."""
    return float(1.4826 * np.median(np.abs(values - np.median(values))))


def _joined(pieces: list[Floats], shortest: float) -> list[tuple[Floats, Floats]]:
    """Lines through pieces of skeletons, those of one line joined; ends as (row, column)."""
    lines: list[tuple[Floats, Floats, Floats]] = []
    for coords in sorted(pieces, key=len, reverse=True):
        best = None
        for i, (start, end, points) in enumerate(lines):
            way = (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
            off = coords - start
            aside = np.abs(off[:, 0] * way[1] - off[:, 1] * way[0])
            place = off @ way
            whole = float(np.linalg.norm(end - start))
            gap = max(0.0, float(place.min()) - whole, -float(place.max()))
            if np.quantile(aside, 0.8) < 2.5 and gap < max(12.0, 0.15 * whole):
                best = i
                break
        points = coords if best is None else np.concatenate([lines[best][2], coords])
        middle = points.mean(axis=0)
        _, _, axes = np.linalg.svd(points - middle, full_matrices=False)
        place = (points - middle) @ axes[0]
        line = (middle + place.min() * axes[0], middle + place.max() * axes[0], points)
        if best is None:
            lines.append(line)
        else:
            lines[best] = line
    return [
        (start, end)
        for start, end, points in lines
        if np.linalg.norm(end - start) >= shortest and len(points) >= 0.4 * np.linalg.norm(end - start)
    ]


@dataclass(frozen=True)
class Found:
    """Scratches that were found in a map."""

    ends_um: Floats
    """Both ends of each, n x 2 x 2: x to the right and y down, from the upper left corner."""
    width_um: Floats
    """Width of the rectangle that stands for each."""
    depth_nm: Floats
    """Its depth."""
    sections_nm: list[Floats]
    """Mean section of each, in steps of half a pixel, its line in the middle."""
    pixel_um: float
    size_um: tuple[float, float]

    def __len__(self) -> int:
        return len(self.width_um)

    @property
    def length_um(self) -> Floats:
        """Length of each; those that the border cuts are longer."""
        made: Floats = np.linalg.norm(self.ends_um[:, 1] - self.ends_um[:, 0], axis=1)
        return made

    def _some(self) -> None:
        if not len(self):
            raise WorkError("no scratches were found in the map: level it, or lower least_depth_nm")

    def _directions(self) -> tuple[float, Optional[float]]:
        """Mean direction in radians, y up, and the spread of directions; none where they have no mean."""
        way = self.ends_um[:, 1] - self.ends_um[:, 0]
        doubled = np.sum(self.length_um * np.exp(2j * np.arctan2(-way[:, 1], way[:, 0]))) / self.length_um.sum()
        agreement = min(abs(doubled), 1 - 1e-12)
        if agreement < max(0.3, 3 / math.sqrt(len(self) + 1)):
            return 0.0, None
        return 0.5 * float(np.angle(doubled)), math.sqrt(-0.5 * math.log(agreement))

    def laid(self, object: str, *, center_um: Optional[tuple[float, float]] = None) -> Scratches:
        """The very scratches on an object that faces z: x to the right, y up, the middle of the map at its origin."""
        self._some()
        x, y = center_um or (self.size_um[0] / 2, self.size_um[1] / 2)
        flat = 1e-6 * (self.ends_um - (x, y)) * (1, -1)
        ends = np.concatenate([flat, np.zeros((len(self), 2, 1))], axis=2)
        return Scratches.from_arrays(
            object=object, ends_m=ends, width_um=np.clip(self.width_um, 0.05, 100), depth_nm=np.clip(self.depth_nm, 0, 2000)
        )

    def layer(self, object: str, *, seed: int = 1) -> Scratches:
        """A layer of a scene that repeats their density, lengths, widths, depths and directions."""
        self._some()
        area_m2 = 1e-12 * self.size_um[0] * self.size_um[1]

        def sizes(values: Floats, factor: float) -> dict[str, float]:
            spread = float(np.std(np.log(values))) if len(values) > 1 else 0.0
            return {"mean": float(values.mean()) * factor, "spread": min(spread, 3.0)}

        direction, spread = self._directions()
        keys: dict[str, Any] = {"pattern": "random"}
        if spread is not None:
            along = (math.cos(direction), math.sin(direction), 0.0)
            keys = {"pattern": "parallel", "direction": along, "jitter_deg": min(math.degrees(spread), 90.0)}
        return Scratches(
            object=object,
            density_per_m2=len(self) / area_m2,
            length_m=sizes(self.length_um, 1e-6),
            width_um=sizes(np.clip(self.width_um, 0.05, 100), 1.0),
            depth_nm=sizes(np.clip(self.depth_nm, 1, 2000), 1.0),
            seed=seed,
            **keys,
        )

    def mean(self) -> Layer:
        """Their mean for :class:`hairline.bsdf.Scratched`, x to the right and y up."""
        self._some()
        direction, spread = self._directions()
        area = self.width_um * self.length_um
        return Layer(
            coverage=float(min(area.sum() / (self.size_um[0] * self.size_um[1]), 1.0)),
            direction_deg=None if spread is None else math.degrees(direction),
            spread_deg=0.0 if spread is None else min(math.degrees(spread), 90.0),
            grooves=tuple(
                (float(part), float(width), float(depth))
                for part, width, depth in zip(area / area.sum(), self.width_um, self.depth_nm)
            ),
        )


def read(path: Path, *, pixel_um: Optional[float] = None, nm_per_step: Optional[float] = None) -> HeightMap:
    """Reads a height map.

    :param path: ``.npy`` (heights in nanometres), ``.png`` of 16 bits, or a file of an instrument, such as ``.sur``, ``.plu``, ``.x3p`` or ``.al3d``.
    :param pixel_um: distance of neighbouring pixels: of ``.npy`` and ``.png`` alone.
    :param nm_per_step: height of one step of a ``.png``.
    """
    file = FilePath(path)
    kind = file.suffix.lower()
    if kind in (".npy", ".png"):
        if pixel_um is None:
            raise argument_error("pixel_um", "found none", f"{kind} does not tell it: give it in micrometres")
        if (nm_per_step is None) == (kind == ".png"):
            right = "a .png has steps: give their height in nanometres" if kind == ".png" else "an .npy holds nanometres: leave it out"
            raise argument_error("nm_per_step", f"found {nm_per_step}", right)
    elif pixel_um is not None or nm_per_step is not None:
        raise argument_error("pixel_um", f"found {pixel_um}, nm_per_step {nm_per_step}", f"{kind} tells both itself: leave them out")
    try:
        if kind == ".npy":
            return HeightMap(np.load(file, allow_pickle=False), pixel_um or 1.0)
        if kind == ".png":
            picture = _library("PIL.Image").open(file)
            if picture.mode not in ("I;16", "I;16B", "I;16L", "I"):
                raise argument_error(str(file), f"found a picture of mode {picture.mode}", "must be grey, of 16 bits")
            return HeightMap(np.asarray(picture).astype(np.float64) * (nm_per_step or 1.0), pixel_um or 1.0)
        return _of_instrument(file)
    except (OSError, EOFError) as error:
        raise WorkError(f"{file}: cannot be read: {error}") from None
    except ValueError as error:
        if isinstance(error, argument_error("", "", "").__class__):
            raise
        raise WorkError(f"{file}: cannot be read: {error}") from None


def _of_instrument(file: FilePath) -> HeightMap:
    io = _library("SurfaceTopography.IO")
    if not file.exists():
        raise FileNotFoundError("there is no such file")
    try:
        topography = io.open_topography(str(file)).topography()
        heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=np.float64), np.nan)
        unit, sizes = topography.unit, topography.physical_sizes
    except Exception as error:  # The library has exceptions of many kinds for files that are cut short.
        raise WorkError(f"{file}: cannot be read as a height map: {type(error).__name__}: {error}") from None
    if unit not in _TO_NM or heights.ndim != 2:
        raise WorkError(f"{file}: holds heights in {unit!r} and {heights.ndim} dimensions; must be a map in a unit of length")
    to_um = 1e-3 * _TO_NM[unit]
    # Its first axis is x, and y runs up.
    return HeightMap(
        heights.T[::-1] * _TO_NM[unit], (sizes[0] * to_um / heights.shape[0], sizes[1] * to_um / heights.shape[1])
    )
