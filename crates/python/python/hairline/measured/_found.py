"""What was found in a height map: scratches and rows."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, NamedTuple, Optional, Union, overload

import numpy as np

from .. import optics
from .._arrays import ArrayLike, Floats, _numbers
from .._errors import WorkError, argument_error
from .._keys import Grating
from .._tables import Scratches
from .._whole_file import write_whole
from ..bsdf import Layer, _binned
from ._brdf import attention, checked_window

# Directions count as one, with some scatter, if their mean vector is longer than this.
_ALONG_ONE = 0.5


class Scratch(NamedTuple):
    """A straight scratch, as the rectangle that fits the median of its profiles best."""

    ends_m: Floats
    """Both ends, shape (2, 2): x and y from the middle of the map."""
    width_um: float
    depth_nm: float
    wall_um: float
    """Standard deviation of the Gaussian that softens the walls: by it the rectangle is an approximation."""
    residual_nm: float
    """Root of the mean square of what the softened rectangle leaves of the profile."""
    profile: Floats
    """The median of the profiles: offsets across in micrometres and heights in nanometres, shape (n, 2)."""

    @property
    def length_m(self) -> float:
        """From end to end."""
        return float(np.hypot(*(self.ends_m[1] - self.ends_m[0])))


class Found(Sequence[Scratch]):
    """The scratches of a height map."""

    def __init__(self, scratches: tuple[Scratch, ...], size_m: tuple[float, float], step_m: float) -> None:
        self._scratches, self._step_m = scratches, step_m
        self.size_m = size_m
        """Width and height of the map."""

    @overload
    def __getitem__(self, at: int) -> Scratch: ...
    @overload
    def __getitem__(self, at: slice) -> Sequence[Scratch]: ...
    def __getitem__(self, at: Any) -> Any:
        return self._scratches[at]

    def __len__(self) -> int:
        return len(self._scratches)

    def __repr__(self) -> str:
        return f"Found({len(self)} scratches, {1e3 * self.length_m.sum():.3g} mm of them in {1e3 * self.size_m[0]:.3g} x {1e3 * self.size_m[1]:.3g} mm)"

    @property
    def ends_m(self) -> Floats:
        """Shape (n, 2, 2): both ends of each, x and y from the middle of the map."""
        return np.array([one.ends_m for one in self]).reshape(-1, 2, 2)

    @property
    def width_um(self) -> Floats:
        """Shape (n,)."""
        return np.array([one.width_um for one in self])

    @property
    def depth_nm(self) -> Floats:
        """Shape (n,)."""
        return np.array([one.depth_nm for one in self])

    @property
    def residual_nm(self) -> Floats:
        """Shape (n,)."""
        return np.array([one.residual_nm for one in self])

    @property
    def length_m(self) -> Floats:
        """Shape (n,)."""
        return np.array([one.length_m for one in self])

    def listed(self, object: str, *, name: Optional[str] = None) -> Scratches:
        """These scratches where they are, on an object's xy plane, the middle of the map at its origin."""
        self._need_some()
        ends = np.concatenate([self.ends_m, np.zeros((len(self), 2, 1))], axis=2)
        return Scratches.from_arrays(object=object, ends_m=ends, width_um=self.width_um, depth_nm=self.depth_nm, name=name)

    def save_csv(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the list that ``pattern = "file"`` of scene files reads."""
        self._need_some()
        rows = [
            f"{a[0]:.9g},{a[1]:.9g},0,{b[0]:.9g},{b[1]:.9g},0,{one.width_um:.6g},{one.depth_nm:.6g}"
            for one, (a, b) in zip(self, self.ends_m)
        ]
        text = "\n".join(["x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm", *rows, ""])
        try:
            write_whole(path, text.encode())
        except OSError as error:
            raise WorkError(f"{os.fspath(path)}: cannot be written: {error.strerror}") from None

    def layers(self, object: str, *, length_m: Optional[float] = None, seed: int = 1) -> list[Scratches]:
        """Layers that repeat the statistics of these scratches on an object: their number on an area, lengths, widths, depths and
        directions.

        A map's border cuts scratches short. So their number is half of that of the ends within the map, and the mean length all length over
        that number: both are right in the mean however small the map is.

        :param length_m: the mean length, where too few scratches end within the map to know it.
        """
        self._need_some()
        inside = self._ends_inside()
        area = self.size_m[0] * self.size_m[1]
        total = float(self.length_m.sum())
        if length_m is None:
            if inside.sum() < 2:
                found = f"{inside.sum()} ends of scratches lie within the map of {1e3 * self.size_m[0]:.3g} x {1e3 * self.size_m[1]:.3g} mm"
                raise argument_error("length_m", found, "must be given: all reach through")
            length_m = 2 * total / float(inside.sum())
        elif not 0 < length_m <= 1000:
            raise argument_error("length_m", f"found {length_m!r}", "must be above 0, up to 1000")
        whole = self.length_m[inside == 2]
        # The numbers of whole ones are too few for a spread where most are cut.
        spread = float(np.std(np.log(whole))) if len(whole) >= 0.5 * len(self) and len(whole) > 2 else 0.5
        keys: dict[str, Any] = {"pattern": "random"}
        way = self._one_way()
        if way is not None:
            angle, scatter = way
            keys = {"pattern": "parallel", "direction": (float(np.cos(angle)), float(np.sin(angle)), 0.0), "jitter_deg": float(np.degrees(scatter))}
        layer = Scratches(
            object=object,
            density_per_m2=total / (area * length_m),
            length_m={"mean": length_m, "spread": min(spread, 3.0)},
            width_um=self._sizes(self.width_um),
            depth_nm=self._sizes(self.depth_nm),
            seed=seed,
            **keys,
        )
        return [layer]

    def mean(self) -> Layer:
        """Their mean for :class:`hairline.bsdf.Scratched`: the share of the map that they cover, directions, widths and depths. A map's border
        does not change it, as none of these needs whole scratches."""
        self._need_some()
        covered = self.width_um * self.length_m
        way = self._one_way()
        return Layer(
            coverage=min(1e-6 * float(covered.sum()) / (self.size_m[0] * self.size_m[1]), 1.0),
            direction_deg=None if way is None else float(np.degrees(way[0])),
            spread_deg=0.0 if way is None else float(np.degrees(way[1])),
            grooves=_binned(self.width_um, self.depth_nm, covered),
        )

    def _one_way(self) -> Optional[tuple[float, float]]:
        """The mean direction and its standard deviation, radians, weighted by length; None where directions have no mean."""
        way = self.ends_m[:, 1] - self.ends_m[:, 0]
        # A direction is one with its opposite: doubled angles (Mardia and Jupp, Directional Statistics, 2000).
        doubled = np.exp(2j * np.arctan2(way[:, 1], way[:, 0]))
        mean = complex((self.length_m * doubled).sum()) / float(self.length_m.sum())
        if abs(mean) <= _ALONG_ONE:
            return None
        return 0.5 * float(np.angle(mean)), 0.5 * float(np.sqrt(-2 * np.log(min(abs(mean), 1.0))))

    def _sizes(self, values: Floats) -> dict[str, float]:
        """Log-normal, weighted by length, as a longer scratch is met more often."""
        weight = self.length_m / self.length_m.sum()
        logs = np.log(values)
        spread = np.sqrt(max(float(weight @ logs**2 - (weight @ logs) ** 2), 0.0))
        return {"mean": float(weight @ values), "spread": float(spread)}

    def _ends_inside(self) -> Any:
        """How many ends of each lie within the map, and not at its border: 0 to 2."""
        near = 3 * self._step_m
        within = (np.abs(self.ends_m) < 0.5 * np.array(self.size_m) - near).all(axis=2)
        return within.sum(axis=1)

    def _need_some(self) -> None:
        if not self._scratches:
            raise argument_error("scratches", "found none in the map", "a smaller least_depth_nm or other widths_um may find some")

    def sent(
        self, wavelength_nm: ArrayLike, sine_low: float, sine_high: float, *, coherence_um: float = 20.0, cos_sum: float = 2.0
    ) -> Floats:
        """The share of the light that these scratches send beside the mirror's direction, between two sines, by Hairline's closed form:
        the sum of (6) and (10) of docs/model.md over all of them, for a reflectance of 1. One number for each wavelength.

        :param coherence_um: scratches count by how much the windows of :meth:`HeightMap.sent` see of them, which stay within the map.
        """
        wavelengths = np.asarray(_numbers("wavelength_nm", wavelength_nm), dtype=np.float64)
        step_um = 1e6 * self._step_m
        coherence_um = checked_window([1e6 * size for size in self.size_m], [step_um, step_um], coherence_um)
        made = np.zeros(wavelengths.shape)
        for one in self:
            deep = optics.oblique_depth_nm(one.depth_nm, 0.5 * cos_sum, 0.5 * cos_sum)
            # To both sides.
            made += 2 * self._covered(one, coherence_um) * optics.scratch_spectrum(one.width_um, deep, sine_low, sine_high, wavelengths)
        return made

    def _covered(self, one: Scratch, coherence_um: float) -> float:
        """The share of what the windows see that a scratch covers."""
        count = max(2, int(np.ceil(4e6 * one.length_m / coherence_um)))
        along = (np.arange(count) + 0.5) / count
        points = 1e6 * (one.ends_m[0] + along[:, None] * (one.ends_m[1] - one.ends_m[0]))
        step_um = 1e6 * self._step_m
        sides = (int(round(size / self._step_m)) for size in self.size_m)
        x, y = (attention(side, step_um, coherence_um, points[:, axis]) for axis, side in enumerate(sides))
        return one.width_um * 1e6 * one.length_m * float((x * y).mean())


class Rows(NamedTuple):
    """A row of grooves that repeats over a map."""

    pitch_um: float
    direction: tuple[float, float]
    """Along the grooves: x and y of a unit vector."""
    width_um: float
    depth_nm: float
    jitter_um: float
    """Standard deviation of how far grooves are off their places."""
    residual_nm: float
    """Root of the mean square of what a softened rectangle leaves of the mean profile."""
    share: float
    """Of the variance of the heights that the row explains."""
    profile: Floats
    """The mean profile over one pitch: offsets in micrometres and heights in nanometres, shape (n, 2)."""

    def grating(self, object: str) -> Grating:
        """As a ``[[grating]]`` on an object, the map in its xy plane."""
        return Grating(
            pattern="parallel",
            object=object,
            pitch_um=self.pitch_um,
            width_um=min(self.width_um, self.pitch_um),
            depth_nm=self.depth_nm,
            jitter_um=min(self.jitter_um, self.pitch_um),
            direction=(*self.direction, 0.0),
        )
