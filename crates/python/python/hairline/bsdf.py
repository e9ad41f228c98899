"""The reflection of scratched metal by itself: to evaluate, to sample, to plug in elsewhere (docs/model.md, section 13).

    from hairline.bsdf import Layer, Scratched

    steel = Scratched("steel", roughness=0.2, layers=[Layer(width_um=2.0, depth_nm=150.0, density_per_m2=2e6, length_m=0.01)])
    wi, pdf, value = steel.sample(wo, u)

The conventions are those of Mitsuba: unit vectors in the local frame, whose z axis is the normal; ``wi`` towards the light, ``wo`` towards the
viewer; values hold the cosine of ``wi``; densities are per solid angle. Arrays are broadcast against one another over all axes but the last.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np

from . import _hairline as core
from ._arrays import ArrayLike, Floats, _numbers, floats
from ._errors import SceneError, argument_error
from ._keys import Material
from .optics import n_k_rows

if TYPE_CHECKING:
    from ._scene import Scene

__all__ = ["Grating", "Layer", "Sample", "Scratched"]

Size = Union[float, tuple[float, float]]
"""A number, or a mean and a spread as those of scene files: log-normal."""

_Grooves = tuple[tuple[float, float, float], ...]
_WIDTHS_UM = (0.05, core.WIDEST_UM)
_DEPTHS_NM = (0.0, core.DEEPEST_NM)
_NODES = 5
"""Of the rule over a spread of widths or depths."""


def _number(key: str, value: Any, least: float, most: float) -> float:
    is_number = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)
    if not is_number or not least <= value <= most:
        raise argument_error(key, f"found {value!r}", f"must be a number from {least:g} to {most:g}")
    return float(value)


def _size(key: str, value: Any, least: float, most: float) -> tuple[float, float]:
    if isinstance(value, Sequence) and not isinstance(value, str):
        if len(value) != 2:
            raise argument_error(key, f"found {value!r}", "must be a number, or its mean and its spread")
        return _number(f"{key}.mean", value[0], least, most), _number(f"{key}.spread", value[1], 0, 3)
    return _number(key, value, least, most), 0.0


def _nodes(mean: float, spread: float, least: float, most: float) -> tuple[Floats, Floats]:
    """Values of a log-normal size and their weights, by the rule of Gauss and Hermite."""
    if spread == 0:
        return np.array([mean]), np.array([1.0])
    z, weight = np.polynomial.hermite_e.hermegauss(_NODES)
    values = mean * np.exp(spread * z - 0.5 * spread * spread)
    return np.clip(values, least, most), weight / weight.sum()


@dataclass(frozen=True)
class Layer:
    """Many scratches at random places, by their mean: what a wide pixel sees.

    :param width_um: width of the grooves, from 0.05 to 100: a number, or a mean and a spread.
    :param depth_nm: their depth, from 0 to 2000, likewise.
    :param coverage: width times length of all of them over the area that they lie on; overlaps count each time, so it may exceed 1. In its
        place ``density_per_m2`` and ``length_m``.
    :param direction_deg: mean direction, from the x axis. None: all directions are as frequent.
    :param spread_deg: standard deviation of the directions.
    :param profile: cross section of the grooves, as ``profile`` of scene files: a name, or depths from the middle to the rim.
    """

    width_um: Size = 1.5
    depth_nm: Size = 200.0
    coverage: Optional[float] = None
    density_per_m2: Optional[float] = None
    length_m: Optional[float] = None
    direction_deg: Optional[float] = None
    spread_deg: float = 0.0
    grooves: Optional[_Grooves] = None
    """In place of width and depth: the part, the width and the depth of each kind of groove."""
    profile: Union[str, tuple[float, ...]] = "rectangle"

    def __post_init__(self) -> None:
        _size("width_um", self.width_um, *_WIDTHS_UM)
        _size("depth_nm", self.depth_nm, *_DEPTHS_NM)
        both = (self.density_per_m2, self.length_m)
        if (self.coverage is None) == (None in both) or (self.coverage is not None and both != (None, None)):
            found = f"found coverage={self.coverage}, density_per_m2={both[0]}, length_m={both[1]}"
            raise argument_error("coverage", found, "must be coverage, or density_per_m2 and length_m")
        if self.coverage is not None:
            _number("coverage", self.coverage, 0, 1000)
        else:
            _number("density_per_m2", self.density_per_m2, 0, 1e15)
            _number("length_m", self.length_m, 0, 1000)
        if self.direction_deg is not None:
            _number("direction_deg", self.direction_deg, -360, 360)
        _number("spread_deg", self.spread_deg, 0, 90)
        if self.direction_deg is None and self.spread_deg != 0:
            raise argument_error("spread_deg", f"found {self.spread_deg:g} without direction_deg", "needs a direction to spread about")
        if self.grooves is not None:
            self._check_grooves(self.grooves)

    @staticmethod
    def _check_grooves(grooves: _Grooves) -> None:
        for i, (part, width, depth) in enumerate(grooves):
            _number(f"grooves[{i}].part", part, 0, 1)
            # Laid and measured ones may be narrower than what is asked for by width_um.
            _number(f"grooves[{i}].width_um", width, 1e-6, _WIDTHS_UM[1])
            _number(f"grooves[{i}].depth_nm", depth, *_DEPTHS_NM)
        parts = sum(groove[0] for groove in grooves)
        if abs(parts - 1) > 1e-6:
            raise argument_error("grooves", f"found parts that add up to {parts:g}", "must add up to 1")

    @property
    def share(self) -> float:
        """The coverage, whichever way it was given."""
        if self.coverage is not None:
            return self.coverage
        if self.grooves is None:
            mean, _ = _size("width_um", self.width_um, *_WIDTHS_UM)
        else:
            # Parts are those of areas: the mean width by number.
            mean = 1 / sum(part / width for part, width, _ in self.grooves)
        assert self.density_per_m2 is not None and self.length_m is not None
        return self.density_per_m2 * self.length_m * mean * 1e-6

    def _row(self) -> tuple[float, float, float, _Grooves, Union[str, list[float]]]:
        grooves = self.grooves
        if grooves is None:
            widths, by_width = _nodes(*_size("width_um", self.width_um, *_WIDTHS_UM), *_WIDTHS_UM)
            depths, by_depth = _nodes(*_size("depth_nm", self.depth_nm, *_DEPTHS_NM), *_DEPTHS_NM)
            parts = by_width * widths / np.sum(by_width * widths)
            grooves = tuple(
                (float(p * q), float(w), float(d)) for p, w in zip(parts, widths) for q, d in zip(by_depth, depths)
            )
        spread = math.inf if self.direction_deg is None else math.radians(self.spread_deg)
        profile = self.profile if isinstance(self.profile, str) else [float(depth) for depth in self.profile]
        return self.share, math.radians(self.direction_deg or 0.0), spread, grooves, profile


@dataclass(frozen=True)
class Grating:
    """A row of parallel grooves, as ``[[grating]]`` of scene files.

    :param pitch_um: from one groove to the next.
    :param width_um: width of a groove, at most the pitch.
    :param depth_nm: depth of a groove.
    :param coverage: the share of the surface that it covers.
    :param direction_deg: direction of the grooves, from the x axis.
    :param angle_std_deg: standard deviation of that at any place.
    :param depth_spread: standard deviation of a depth, a share of it.
    :param jitter_um: standard deviation of how far a groove is off its place.
    :param theory: ``"rigorous"``: below 4 um of pitch, and not in a coat, the orders have the energies of coupled waves, which take seconds to compute
        and are kept for the next time. ``"scalar"``: each floor mirrors by itself.
    """

    pitch_um: float
    width_um: float
    depth_nm: float
    coverage: float = 1.0
    direction_deg: float = 0.0
    angle_std_deg: float = 0.0
    depth_spread: float = 0.0
    jitter_um: float = 0.0
    theory: str = "rigorous"

    def __post_init__(self) -> None:
        _number("pitch_um", self.pitch_um, 0.1, 1000)
        _number("width_um", self.width_um, 0.01, self.pitch_um)
        _number("depth_nm", self.depth_nm, *_DEPTHS_NM)
        _number("coverage", self.coverage, 0, 1)
        _number("direction_deg", self.direction_deg, -360, 360)
        _number("angle_std_deg", self.angle_std_deg, 0, 90)
        _number("depth_spread", self.depth_spread, 0, 3)
        _number("jitter_um", self.jitter_um, 0, 1000)
        if self.theory not in ("rigorous", "scalar"):
            raise argument_error("theory", f"found {self.theory!r}", 'must be "rigorous" or "scalar"')

    def _row(self) -> tuple[float, float, float, list[float], bool]:
        row = [self.pitch_um, self.width_um, self.depth_nm, self.depth_spread, self.jitter_um]
        return self.coverage, math.radians(self.direction_deg), math.radians(self.angle_std_deg), row, self.theory == "rigorous"


class Sample(NamedTuple):
    """Drawn directions. Where none above the horizon was drawn ``wi`` points straight down, and the rest is 0: such a sample counts as zero."""

    wi: Floats
    """Unit vectors towards the light, shape (..., 3)."""
    pdf: Floats
    """Their density, 1/sr, shape (...)."""
    value: Floats
    """The reflection times the cosine of ``wi``: shape (..., 3), or (...) at a wavelength."""


class Scratched:
    """A scratched metal.

    :param metal: a name of :func:`hairline.optics.metals`; or rows of a wavelength in nm, n and k, as of
        :func:`hairline.optics.read_n_k`.
    :param roughness: of the base, as in scene files.
    :param layers: by their mean.
    :param gratings: their coverages add up to 1 at most.
    :param scratches: those near one point, n x 6, each by itself: the angle of its tangent in radians, then the distance of its line along the left
        normal, its start and its end along the tangent, its width, all in micrometres, then its depth in nanometres; as of
        :func:`hairline.optics.coherent_response`.
    :param coherence_um: standard deviation of the coherence window.
    :param clearcoat: the share of the surface under a clear coat, from 0 to 1; scratches and gratings lie in the coat.
    :param clearcoat_roughness: of the coat.
    :param cover: a clear plate over the metal and its gratings, ``{"ior": .., "thickness_mm": .., "color": ..}`` as in scene files, in place of a coat.
        A colour has no spectrum: with one there are no values at wavelengths.
    """

    def __init__(
        self,
        metal: Union[str, ArrayLike] = "steel",
        *,
        roughness: float = 0.2,
        layers: Iterable[Layer] = (),
        gratings: Iterable[Grating] = (),
        scratches: Optional[ArrayLike] = None,
        coherence_um: float = 20.0,
        clearcoat: Optional[float] = None,
        clearcoat_roughness: float = 0.0,
        cover: Optional[Mapping[str, Any]] = None,
    ) -> None:
        self.metal: Any = metal
        n_k = None if isinstance(metal, str) else n_k_rows("metal", metal)
        self.clearcoat, self.clearcoat_roughness, self.cover = _layer_over(clearcoat, clearcoat_roughness, cover)
        self.roughness = _number("roughness", roughness, 0, 1)
        self.coherence_um = _number("coherence_um", coherence_um, 1, 1000)
        self.layers, self.gratings = tuple(layers), tuple(gratings)
        for key, kind, all_of in (("layers", Layer, self.layers), ("gratings", Grating, self.gratings)):
            for i, one in enumerate(all_of):
                if not isinstance(one, kind):
                    found = f"found an object of type {type(one).__qualname__}"
                    raise argument_error(f"{key}[{i}]", found, f"must be a hairline.bsdf.{kind.__name__}")
        covered = sum(row.coverage for row in self.gratings)
        if covered > 1 + 1e-9:
            raise argument_error("gratings", f"found coverages that add up to {covered:g}", "must add up to 1 at most")
        listed = np.zeros((0, 6)) if scratches is None else floats("scratches", scratches, None, 6)
        if np.isnan(listed).any() or not np.isfinite(listed[:, [0, 1, 4, 5]]).all():
            raise argument_error("scratches", "found NaN or an infinite number", "must be numbers; only starts and ends may be infinite")
        if not ((listed[:, 4] > 0) & (listed[:, 5] >= 0) & (listed[:, 2] < listed[:, 3])).all():
            right = "must have a width above 0, a depth of 0 or more, and an end behind the start"
            raise argument_error("scratches", "found a scratch that is none", right)
        self.scratches = listed
        # Wider ones reflect at their edges alone, which is not part of this model.
        widest = core.NARROW * self.coherence_um
        wide = [width for layer in self.layers for _, width, _ in layer._row()[3] if width > widest]
        wide += listed[listed[:, 4] > widest, 4].tolist()
        if wide:
            right = f"must be {widest:g} at most, {core.NARROW:g} of coherence_um: wider grooves are lit at their edges, which is not part of this model"
            raise argument_error("width_um", f"found {max(wide):.4g}", right)

        bare = core.Bsdf(
            metal if isinstance(metal, str) else "",
            None if n_k is None else n_k.tolist(),
            self.roughness,
            self.coherence_um,
            None if self.clearcoat is None else (self.clearcoat, self.clearcoat_roughness),
            None if self.cover is None else (self.cover["ior"], self.cover["thickness_mm"], self.cover["color"]),
            [layer._row() for layer in self.layers],
            [row._row() for row in self.gratings],
            listed.tolist(),
        )
        self._made = lru_cache(maxsize=8)(bare.seen_through)

    @classmethod
    def from_scene(cls, scene: Scene, object: str, *, coherence_um: Optional[float] = None) -> Scratched:
        """The mean of what lies on an object: a layer for each table of scratches, of the directions, widths and depths that were laid.

        Directions are those in the world's x and y of a surface that faces z: of a plate. On other surfaces take layers without a direction. The
        material's metal, roughness, coat and cover are those of the object's; gratings stay out.
        """
        if object not in [str(one.name) for one in scene.objects]:
            raise argument_error("object", f"found {object!r}", "must be the name of an object of the scene")
        name = scene.objects.named(object).material
        if name is None:
            raise argument_error("object", f"found {object!r}, which has materials of its file", "must be an object of a material of the scene")
        material = scene.materials.named(str(name))
        if material.anisotropy:
            raise argument_error("object", f"found {object!r}, whose material has anisotropy", "must be metal that is alike all ways")
        built = scene.build()
        laid = built.laid(object)
        along = laid["end_m"] - laid["start_m"]
        length = np.linalg.norm(along, axis=1)
        layers = []
        for layer in np.unique(laid["layer"]):
            own = laid["layer"] == layer
            width, depth = laid["width_um"][own], laid["depth_nm"][own]
            area = width * length[own]
            doubled = np.sum(area * np.exp(2j * np.arctan2(along[own, 1], along[own, 0]))) / area.sum()
            # Random directions agree by about 1 / sqrt(n) by chance.
            agreement = min(abs(doubled), 1 - 1e-15)
            profile = scene.scratches[int(layer)].profile
            is_one_way = agreement > min(4 / math.sqrt(len(np.unique(laid["scratch"][own])) + 1), 0.95)
            layers.append(
                Layer(
                    coverage=float(1e-6 * area.sum() / laid["area_m2"]),
                    direction_deg=math.degrees(0.5 * float(np.angle(doubled))) if is_one_way else None,
                    spread_deg=min(math.degrees(math.sqrt(-0.5 * math.log(agreement))), 90.0) if is_one_way else 0.0,
                    grooves=_binned(width, depth, area),
                    profile=profile if isinstance(profile, str) else tuple(profile),
                )
            )
        sigma = coherence_um if coherence_um is not None else float(material.coherence_um)
        metal = material.metal if material.n_k is None else material.n_k
        if metal is None:
            raise argument_error("object", f"found {object!r}, whose material is no metal by n and k", 'must be of metal = ".." or n_k = [..]')
        return cls(
            metal,
            roughness=float(material.roughness),
            layers=layers,
            coherence_um=sigma,
            clearcoat=material.clearcoat,
            clearcoat_roughness=float(material.clearcoat_roughness or 0.0),
            cover=material.cover,
        )

    def eval(
        self,
        wi: ArrayLike,
        wo: ArrayLike,
        footprint_um: ArrayLike = 0.0,
        *,
        wavelength_nm: Optional[ArrayLike] = None,
        part: str = "all",
    ) -> Floats:
        """The reflection from ``wi`` to ``wo`` times the cosine of ``wi``, 1/sr: linear Rec.709 under D65, shape (..., 3); at wavelengths, shape
        (...).

        :param footprint_um: what single ``scratches`` are seen through, a Gaussian: its standard deviation, or its covariance in um^2, 2 x 2. 0
            for a point.
        :param part: ``"all"``, ``"base"`` or ``"scratches"``.
        """
        both, shape, nm = _rows({"wi": wi, "wo": wo}, wavelength_nm)
        made = self._at(footprint_um).eval(both["wi"], both["wo"], nm, part)
        return made.reshape(shape if nm is not None else (*shape, 3))

    def pdf(
        self, wi: ArrayLike, wo: ArrayLike, footprint_um: ArrayLike = 0.0, *, wavelength_nm: Optional[ArrayLike] = None
    ) -> Floats:
        """The density of :meth:`sample`, 1/sr, shape (...). Over the hemisphere it integrates to how often a direction is drawn at all."""
        both, shape, nm = _rows({"wi": wi, "wo": wo}, wavelength_nm)
        return self._at(footprint_um).pdf(both["wi"], both["wo"], nm).reshape(shape)

    def sample(
        self, wo: ArrayLike, u: ArrayLike, footprint_um: ArrayLike = 0.0, *, wavelength_nm: Optional[ArrayLike] = None
    ) -> Sample:
        """Draws directions towards the light.

        :param u: numbers in [0, 1), shape (..., 3).
        """
        both, shape, nm = _rows({"wo": wo, "u": u}, wavelength_nm)
        if ((both["u"] < 0) | (both["u"] >= 1)).any():
            raise argument_error("u", "found a number outside of [0, 1)", "must be at least 0 and below 1")
        wi, pdf, value = self._at(footprint_um).sample(both["wo"], both["u"], nm)
        return Sample(
            wi.reshape(*shape, 3), pdf.reshape(shape), value.reshape(shape if nm is not None else (*shape, 3))
        )

    def _at(self, footprint_um: ArrayLike) -> core.Bsdf:
        size = np.asarray(_numbers("footprint_um", footprint_um), dtype=np.float64)
        covariance = size * size * np.eye(2) if size.ndim == 0 else size
        if covariance.shape != (2, 2):
            raise argument_error("footprint_um", f"found an array of shape {size.shape}", "must be a number, or 2 x 2")
        (xx, xy), (yx, yy) = covariance
        if not (np.isfinite(covariance).all() and (size.ndim or size >= 0) and xx >= 0 and yy >= 0 and xy == yx and xx * yy >= xy * xy):
            raise argument_error("footprint_um", f"found {size.tolist()}", "must be 0 or more, or a covariance")
        return self._made((float(xx), float(xy), float(yy)))

    def __repr__(self) -> str:
        metal = self.metal if isinstance(self.metal, str) else "n and k"
        counts = f"{len(self.layers)} layers, {len(self.gratings)} gratings, {len(self.scratches)} scratches"
        return f"<hairline.bsdf.Scratched: {metal}, {counts}>"

    def __reduce__(self) -> Any:
        keys = ("roughness", "layers", "gratings", "scratches", "coherence_um", "clearcoat", "clearcoat_roughness", "cover")
        return _scratched, (self.metal, {key: getattr(self, key) for key in keys})


def _scratched(metal: Any, keys: dict[str, Any]) -> Scratched:
    return Scratched(metal, **keys)


def _layer_over(
    clearcoat: Optional[float], clearcoat_roughness: float, cover: Optional[Mapping[str, Any]]
) -> tuple[Optional[float], float, Optional[dict[str, Any]]]:
    """A coat, its roughness, and a plate, checked and completed as those of a scene's material."""
    keys: dict[str, Any] = {"clearcoat": clearcoat, "cover": cover}
    if clearcoat is not None or clearcoat_roughness != 0:
        keys["clearcoat_roughness"] = clearcoat_roughness
    try:
        checked = Material(name="plate", kind="metal", metal="steel", **keys).to_dict()
    except SceneError as error:
        raise argument_error(error.key.replace("material.", "", 1), error.found, error.right) from None
    return checked.get("clearcoat"), float(checked.get("clearcoat_roughness", 0.0)), checked.get("cover")


def _rows(
    vectors: dict[str, ArrayLike], wavelength_nm: Optional[ArrayLike]
) -> tuple[dict[str, Floats], tuple[int, ...], Optional[Floats]]:
    """Rows of a common shape, as the compiled part takes them; the shape; the wavelengths."""
    arrays = {key: np.asarray(_numbers(key, value), dtype=np.float64) for key, value in vectors.items()}
    for key, array in arrays.items():
        if array.ndim == 0 or array.shape[-1] != 3:
            raise argument_error(key, f"found an array of shape {array.shape}", "must end in 3 components")
        if key == "u" and np.isnan(array).any():
            raise argument_error(key, "found NaN", "must be numbers")
    shapes = [array.shape[:-1] for array in arrays.values()]
    nm = None
    if wavelength_nm is not None:
        nm = np.asarray(_numbers("wavelength_nm", wavelength_nm), dtype=np.float64)
        least, most = core.WAVELENGTHS_NM
        wrong = ~((nm >= least) & (nm <= most))
        if wrong.any():
            raise argument_error("wavelength_nm", f"found {nm[wrong].flat[0]:g}", f"must be from {least:g} to {most:g}")
        shapes.append(nm.shape)
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        told = ", ".join(f"{key} {array.shape}" for key, array in arrays.items())
        told += "" if nm is None else f", wavelength_nm {nm.shape}"
        raise argument_error(
            ", ".join(arrays), f"found shapes that do not fit one another: {told}", "must be broadcast"
        ) from None
    rows = {
        key: np.ascontiguousarray(np.broadcast_to(array, (*shape, 3))).reshape(-1) for key, array in arrays.items()
    }
    return rows, shape, None if nm is None else np.ascontiguousarray(np.broadcast_to(nm, shape)).reshape(-1)


_BINS = 5


def _binned(width: Floats, depth: Floats, area: Floats) -> _Grooves:
    """A few grooves that stand for many: bins of as many widths, and in each of as many depths."""
    made = []
    total = float(area.sum())
    for by_width in np.array_split(np.argsort(width, kind="stable"), _BINS):
        for own in np.array_split(by_width[np.argsort(depth[by_width], kind="stable")], _BINS):
            if len(own):
                part = area[own]
                weight = part / part.sum()
                made.append((float(part.sum()) / total, float(width[own] @ weight), float(depth[own] @ weight)))
    return tuple(made)
