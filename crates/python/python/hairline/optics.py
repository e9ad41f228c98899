"""The physics over arrays of numpy, in double precision (docs/model.md numbers its equations).

Arguments are numbers or arrays; they are broadcast against one another, and the result has their common shape, with an axis of 3 at
its end where it is a colour. Depths and wavelengths are in nanometres, widths and other lengths on the surface in micrometres, cosines
are between a direction and the normal.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path as FilePath
from typing import Any, Callable, Mapping, NamedTuple, Sequence

import numpy as np

from . import _hairline as core
from ._arrays import ArrayLike, Floats, _numbers, floats
from ._errors import WorkError, argument_error
from ._table import Path

__all__ = [
    "Spectrum",
    "band_std",
    "black_body_rgb",
    "coherent_response",
    "depth_coherence",
    "fresnel_dielectric",
    "fresnel_metal",
    "mask",
    "metal_rgb",
    "metals",
    "oblique_depth_nm",
    "read_n_k",
    "phase_step_energy",
    "rgb_from_spectrum",
    "scratch_mean_energy",
    "scratch_radiance",
    "scratch_spectrum",
    "scratch_table",
    "spectrum",
    "window_overlap_um2",
    "window_share",
]


_POSITIVE = (5e-324, 1e9)
_RANGES = {
    "coherence_um": _POSITIVE,
    "cos_i": (0, 1),
    "cos_o": (0, 1),
    "cos_sum": (0, 2),
    "cos_theta": (0, 1),
    "depth_coherence": (0, 1),
    "depth_nm": (0, 1e9),
    "eta": _POSITIVE,
    "temperature_k": _POSITIVE,
    "wavelength_nm": _POSITIVE,
    "width_um": (0, 1e9),
}
_MEASURED_NM = (380, 780)
_TABULATED_NM = (0, 2000)


def _within(key: str, array: Floats, least: float, most: float) -> None:
    wrong = ~((array >= least) & (array <= most))
    if wrong.any():
        found = array[wrong].flat[0]
        right = "must be above 0" if (least, most) == _POSITIVE else f"must be from {least:g} to {most:g}"
        raise argument_error(key, f"found {found:g}", right)


def _over(
    call: Callable[..., Floats], channels: int, /, ranges: Mapping[str, tuple[float, float]] = _RANGES, **arguments: Any
) -> Floats:
    arrays = [np.asarray(_numbers(key, value), dtype=np.float64) for key, value in arguments.items()]
    for key, array in zip(arguments, arrays):
        if np.isnan(array).any():
            raise argument_error(key, "found NaN", "must be numbers")
        if key in ranges:
            _within(key, array, *ranges[key])
    try:
        together = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(f"{key} {array.shape}" for key, array in zip(arguments, arrays))
        found = f"found shapes that do not fit one another: {shapes}"
        raise argument_error(", ".join(arguments), found, "must be broadcast") from None
    made = call(*(np.ascontiguousarray(array).reshape(-1) for array in together))
    shape = together[0].shape if channels == 1 else (*together[0].shape, channels)
    return made.reshape(shape)


def metals() -> tuple[str, ...]:
    """The names of metals whose n and k were measured, as scene files have them."""
    return tuple(core.metal_names())


_MOST_ROWS = 4096


def n_k_rows(key: str, rows: Any) -> Floats:
    """Rows of a wavelength in nm, n and k, checked: m x 3."""
    array = floats(key, rows, None, 3)
    if not 1 <= len(array) <= _MOST_ROWS:
        raise argument_error(key, f"found {len(array)} rows", f"must have from 1 to {_MOST_ROWS}")
    nm, n, k = array.T
    for what, values, wrong, right in (
        ("wavelength", nm, ~((nm >= 100) & (nm <= 2000)), "must be from 100 to 2000 nm"),
        ("n", n, ~((n > 0) & (n <= 100)), "must be above 0, up to 100"),
        ("k", k, ~((k >= 0) & (k <= 100)), "must be from 0 to 100"),
    ):
        if wrong.any():
            i = int(np.argmax(wrong))
            raise argument_error(key, f"found the {what} {values[i]:g} in row {i}", right)
    falls = np.diff(nm) <= 0
    if falls.any():
        i = int(np.argmax(falls)) + 1
        raise argument_error(key, f"found the wavelength {nm[i]:g} in row {i} after {nm[i - 1]:g}", "must rise")
    if ((n == 1) & (k == 0)).all():
        raise argument_error(key, "found n = 1 and k = 0 in all rows, which is air", "must reflect some light")
    return array


def read_n_k(path: Path) -> Floats:
    """The refractive index in a file: rows of a wavelength in nm, n and k, shape (m, 3), as :class:`hairline.Material` takes them for ``n_k``.

    Reads the records of refractiveindex.info (.yml, tabulated; ``pip install 'hairline-render[nk]'``), and tables (.csv) whose first line names
    the columns ``wavelength_nm`` or ``wavelength_um`` (or ``wl``, in um), ``n`` and ``k``.
    """
    file = FilePath(path)
    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise WorkError(f"{file}: cannot be read: {error}") from None
    if file.suffix.lower() in (".yml", ".yaml"):
        rows = _of_yaml(file, text)
    elif file.suffix.lower() in (".csv", ".txt"):
        rows = _of_csv(file, text)
    else:
        raise argument_error(str(file), f"found the ending {file.suffix!r}", "must be .yml or .csv")
    # Of all that was measured, what scenes take.
    rows = rows[(rows[:, 0] >= 100) & (rows[:, 0] <= 2000)]
    return n_k_rows(str(file), rows)


def _numbers_of(file: FilePath, lines: Sequence[str], columns: int, first: int = 1) -> Floats:
    rows = []
    for i, line in enumerate(lines):
        cells = line.replace(",", " ").split()
        if not cells:
            continue
        try:
            row = [float(cell) for cell in cells]
        except ValueError:
            row = []
        if len(row) != columns:
            raise argument_error(f"{file}:{first + i}", f"found {line.strip()!r}", f"must be {columns} numbers")
        rows.append(row)
    return np.array(rows, dtype=np.float64).reshape(-1, columns)


def _of_yaml(file: FilePath, text: str) -> Floats:
    try:
        import yaml
    except ImportError as missing:  # pragma: no cover
        raise ImportError("records of refractiveindex.info need PyYAML: pip install 'hairline-render[nk]'") from missing
    try:
        record = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise argument_error(str(file), f"found no YAML: {str(error).splitlines()[0]}", "must be a record of refractiveindex.info") from None
    parts = record.get("DATA") if isinstance(record, dict) else None
    if not isinstance(parts, list):
        raise argument_error(str(file), "found no DATA", "must be a record of refractiveindex.info")
    tables = {}
    for part in parts:
        kind = str(part.get("type", "")) if isinstance(part, dict) else ""
        if kind in ("tabulated nk", "tabulated n", "tabulated k"):
            columns = 3 if kind.endswith("nk") else 2
            tables[kind.split()[1]] = _numbers_of(file, str(part.get("data", "")).splitlines(), columns)
    if "nk" in tables:
        rows = tables["nk"]
    elif "n" in tables and "k" in tables:
        n, k = tables["n"], tables["k"]
        rows = np.stack([n[:, 0], n[:, 1], np.interp(n[:, 0], k[:, 0], k[:, 1])], axis=1)
    else:
        found = ", ".join(str(part.get("type")) for part in parts if isinstance(part, dict)) or "nothing"
        raise argument_error(str(file), f"found {found}", 'must have "tabulated nk", or "tabulated n" and "tabulated k": metals are not of a formula')
    made: Floats = rows * np.array([1e3, 1, 1])
    return made


def _of_csv(file: FilePath, text: str) -> Floats:
    lines = text.splitlines()
    header = [name.strip().lower() for name in lines[0].split(",")] if lines else []
    lengths = {"wavelength_nm": 1.0, "wavelength_um": 1e3, "wl": 1e3}
    unit = next((name for name in lengths if name in header), None)
    if unit is None or "n" not in header or "k" not in header:
        raise argument_error(f"{file}:1", f"found the header {lines[0] if lines else ''!r}", "must name wavelength_nm, n and k")
    rows = _numbers_of(file, lines[1:], len(header), first=2)
    made: Floats = rows[:, [header.index(unit), header.index("n"), header.index("k")]] * np.array([lengths[unit], 1, 1])
    return made


def phase_step_energy(depth_nm: ArrayLike, wavelength_nm: ArrayLike) -> Floats:
    """|D|^2 = 4 sin^2(2 pi d / lambda), from 0 to 4: the energy of the phase step at a groove's floor."""
    return _over(core.phase_step_energy, 1, depth_nm=depth_nm, wavelength_nm=wavelength_nm)


def oblique_depth_nm(depth_nm: ArrayLike, cos_i: ArrayLike, cos_o: ArrayLike) -> Floats:
    """The depth whose phase step along the normal equals that of ``depth_nm`` for light from ``cos_i`` to ``cos_o``, nm."""
    return _over(core.oblique_depth_nm, 1, depth_nm=depth_nm, cos_i=cos_i, cos_o=cos_o)


def window_overlap_um2(
    offset_um: ArrayLike, start_um: ArrayLike, end_um: ArrayLike, coherence_um: ArrayLike
) -> Floats:
    """How strongly the coherence window at a point sees a groove, um^2.

    :param offset_um: distance of the point from the groove's line.
    :param start_um: where the groove begins along its line, from the point; may be -inf.
    :param end_um: where it ends; may be inf.
    """
    return _over(
        core.window_overlap_um2,
        1,
        offset_um=offset_um,
        start_um=start_um,
        end_um=end_um,
        coherence_um=coherence_um,
    )


def window_share(width_um: ArrayLike, overlap_um2: ArrayLike, coherence_um: ArrayLike) -> Floats:
    """rho: the share of the window's energy that a groove covers."""
    return _over(core.window_share, 1, width_um=width_um, overlap_um2=overlap_um2, coherence_um=coherence_um)


def band_std(coherence_um: ArrayLike, wavelength_nm: ArrayLike) -> Floats:
    """Standard deviation, in direction cosines along a groove, of the band that it lights."""
    return _over(core.band_std, 1, coherence_um=coherence_um, wavelength_nm=wavelength_nm)


def fresnel_metal(metal: str, cos_theta: ArrayLike, wavelength_nm: ArrayLike) -> Floats:
    """Unpolarised reflectance of a metal, from 0 to 1, at wavelengths from 380 to 780 nm."""
    return _over(
        lambda *arrays: core.fresnel_metal(metal, *arrays),
        1,
        ranges={**_RANGES, "wavelength_nm": _MEASURED_NM},
        cos_theta=cos_theta,
        wavelength_nm=wavelength_nm,
    )


def fresnel_dielectric(cos_theta: ArrayLike, eta: ArrayLike) -> Floats:
    """Unpolarised reflectance of a dielectric, from 0 to 1; ``eta`` is the index behind the surface over that before it."""
    return _over(core.fresnel_dielectric, 1, cos_theta=cos_theta, eta=eta)


def metal_rgb(metal: str, cos_theta: ArrayLike = 1.0) -> Floats:
    """Reflectance of a metal in linear Rec.709 under D65, shape (..., 3)."""
    return _over(lambda *arrays: core.metal_rgb(metal, *arrays), 3, cos_theta=cos_theta)


def black_body_rgb(temperature_k: ArrayLike) -> Floats:
    """The colour of a black body in linear Rec.709, of luminance 1, shape (..., 3)."""
    return _over(core.black_body_rgb, 3, temperature_k=temperature_k)


class Spectrum(NamedTuple):
    """The wavelengths that colours are sums over."""

    wavelength_nm: Floats
    """From 380 to 780 nm every 5 nm, shape (81,)."""
    weight: Floats
    """Of each wavelength in linear Rec.709 under D65, shape (81, 3); each channel sums to 1."""


@lru_cache(maxsize=1)
def spectrum() -> Spectrum:
    """The tabulated wavelengths and their weights."""
    wavelength_nm, weight = core.spectrum_samples()
    weight = weight.reshape(-1, 3)
    for array in (wavelength_nm, weight):
        array.setflags(write=False)
    return Spectrum(wavelength_nm, weight)


def rgb_from_spectrum(values: ArrayLike) -> Floats:
    """Linear Rec.709 of spectra over :func:`spectrum`'s wavelengths seen under D65: (..., 81) to (..., 3)."""
    array = _numbers("values", values)
    weight = spectrum().weight
    if array.ndim == 0 or array.shape[-1] != len(weight):
        raise argument_error("values", f"found an array of shape {array.shape}", f"must end in {len(weight)} wavelengths")
    made: Floats = np.asarray(array, dtype=np.float64) @ weight
    return made


@lru_cache(maxsize=16)
def _table(metal: str) -> core.ScratchTable:
    return core.ScratchTable(metal)


def scratch_table(metal: str, u_um: ArrayLike, depth_nm: ArrayLike) -> Floats:
    """T_c(u, d) of a metal, the table that pictures are made with, shape (..., 3). Odd in u, the groove's width times a sine; depths from
    0 to 2000 nm."""
    return _over(_table(metal).at, 3, ranges={"depth_nm": _TABULATED_NM}, u_um=u_um, depth_nm=depth_nm)


def scratch_mean_energy(metal: str, depth_nm: ArrayLike) -> Floats:
    """The mean of |D|^2 over the spectrum in each channel, shape (..., 3): what a groove scatters of the light on it."""
    return _over(_table(metal).total, 3, ranges={"depth_nm": _TABULATED_NM}, depth_nm=depth_nm)


def scratch_radiance(
    metal: str, width_um: ArrayLike, depth_nm: ArrayLike, sine_low: ArrayLike, sine_high: ArrayLike
) -> Floats:
    """Radiance of a groove under light of radiance 1, for each share of the coherence window that it covers, and before the metal's own
    colour: shape (..., 3), linear Rec.709.

    :param width_um: the groove's width.
    :param depth_nm: its depth along the normal; see :func:`oblique_depth_nm`.
    :param sine_low: where the light begins beside the mirror direction, as a sine across the groove.
    :param sine_high: where it ends.
    """
    width = np.asarray(_numbers("width_um", width_um), dtype=np.float64)
    low, high = (
        width * np.asarray(_numbers(key, sine), dtype=np.float64)
        for key, sine in (("sine_low", sine_low), ("sine_high", sine_high))
    )
    made: Floats = scratch_table(metal, high, depth_nm) - scratch_table(metal, low, depth_nm)
    return made


def scratch_spectrum(
    width_um: ArrayLike,
    depth_nm: ArrayLike,
    sine_low: ArrayLike,
    sine_high: ArrayLike,
    wavelength_nm: ArrayLike,
) -> Floats:
    """What :func:`scratch_radiance` sums up, at each wavelength and without the metal: |D|^2 times the share of sinc^2 within the light."""

    def chord(sine: Any) -> Floats:
        u_um = np.asarray(_numbers("width_um", width_um), dtype=np.float64) * np.asarray(_numbers("sine", sine))
        return _over(core.sinc_squared_integral, 1, u_um=u_um, wavelength_nm=wavelength_nm)

    wavelength_um = 1e-3 * np.asarray(_numbers("wavelength_nm", wavelength_nm), dtype=np.float64)
    made: Floats = phase_step_energy(depth_nm, wavelength_nm) * (chord(sine_high) - chord(sine_low)) / wavelength_um
    return made


def depth_coherence(depth_nm: ArrayLike, weight: ArrayLike = 1.0) -> float:
    """How alike the phase steps of grooves of these depths are: 1 for equal ones, 1/2 for phases spread evenly.

    :param depth_nm: shape (n,).
    :param weight: of each, shape (n,), or one for all.
    """
    depths = floats("depth_nm", depth_nm, None)
    weights = np.ascontiguousarray(np.broadcast_to(_numbers("weight", weight).astype(np.float64), depths.shape))
    return core.depth_coherence(depths, weights)


def mask(
    share: ArrayLike, mean_energy: ArrayLike, share_by_line: ArrayLike = 0.0, depth_coherence: ArrayLike = 1.0
) -> Floats:
    """The share of the base's energy that grooves take, shape (..., 3), equation (9).

    :param share: the sum of rho over the grooves, shape (...).
    :param mean_energy: the mean of |D|^2, shape (..., 3); see :func:`scratch_mean_energy`.
    :param share_by_line: the sum of rho, each times that of its whole line; 0 for many thin grooves.
    :param depth_coherence: see :func:`depth_coherence`.
    """
    energy = _numbers("mean_energy", mean_energy)
    if energy.ndim == 0 or energy.shape[-1] != 3:
        raise argument_error("mean_energy", f"found an array of shape {energy.shape}", "must end in 3 channels")
    total = np.asarray(_numbers("share", share), dtype=np.float64)
    return _over(
        core.mask_taken,
        3,
        share=total,
        share_by_line=share_by_line,
        energy_r=energy[..., 0] * total,
        energy_g=energy[..., 1] * total,
        energy_b=energy[..., 2] * total,
        depth_coherence=depth_coherence,
    )


def coherent_response(
    grooves: Sequence[Sequence[float]],
    xi_x: ArrayLike,
    xi_y: ArrayLike,
    wavelength_nm: ArrayLike,
    coherence_um: float = 20.0,
    cos_sum: ArrayLike = 2.0,
) -> Floats:
    """The whole field of straight grooves at a point, with every phase: |B - S|^2 / (pi sigma^2) in its parts base, cross and
    scratches, shape (..., 3). Their sum is a BRDF with the cosine inside.

    :param grooves: n x 6: the angle of the tangent to x in radians, then the distance of the line along its left normal, its start and
        its end along the tangent, and its width, all in micrometres, then its depth in nanometres.
    :param xi_x: the tangential part of wi + wo along x.
    :param xi_y: the same along y.
    :param cos_sum: the sum of the cosines of both directions; 2 along the normal.
    """
    rows = _numbers("grooves", grooves)
    if rows.ndim != 2 or rows.shape[1] != 6 or np.isnan(rows).any():
        raise argument_error("grooves", f"found an array of shape {rows.shape}", "must be n x 6 numbers")
    listed = [tuple(map(float, row)) for row in rows]
    return _over(
        lambda *arrays: core.coherent_response(listed, *arrays, float(coherence_um)),
        3,
        xi_x=xi_x,
        xi_y=xi_y,
        cos_sum=cos_sum,
        wavelength_nm=wavelength_nm,
    )
