"""Reading height maps from files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Optional, Sequence, Union

import numpy as np

from .._errors import SceneError, WorkError
from ._grid import checked_sides
from ._height_map import HeightMap
from ._packages import needed

# What SurfaceTopography reads and is a grid of heights from an instrument, by the ending.
_INSTRUMENTS = (".al3d", ".mnt", ".nms", ".opd", ".opdx", ".plu", ".plux", ".sdf", ".sur", ".tmd", ".vk3", ".vk4", ".vk6", ".x3p", ".zon", ".datx", ".gwy")


def read(
    path: Union[str, "os.PathLike[str]"],
    *,
    spacing_m: Union[None, float, Sequence[float]] = None,
    range_m: Optional[float] = None,
    fill: bool = False,
) -> HeightMap:
    """The height map of a file.

    ============================================================== =================================================
    ``.npy``                                                       an array of metres; needs ``spacing_m``
    ``.png``                                                       16 bits of grey; needs ``spacing_m``, ``range_m``
    ``.al3d .mnt .opd .plu .sur .x3p`` and others of instruments   has its own sizes
    ============================================================== =================================================

    :param spacing_m: from one height to the next: one number, or two for columns and rows.
    :param range_m: how much higher white is than black.
    :param fill: see :class:`HeightMap`.
    """
    file = Path(path)
    ending = file.suffix.lower()
    if ending not in (".npy", ".png", *_INSTRUMENTS):
        known = " ".join((".npy", ".png", *_INSTRUMENTS))
        raise _wrong(file, f"found the ending {ending!r}" if ending else "found no ending", f"height maps have one of {known}")
    if ending in _INSTRUMENTS and (spacing_m is not None or range_m is not None):
        key = "spacing_m" if spacing_m is not None else "range_m"
        raise _wrong(file, f"{key} was given", "the file has its own sizes")
    if ending != ".png" and range_m is not None:
        raise _wrong(file, "range_m was given", "it belongs to .png; heights of .npy are metres")
    if ending in (".npy", ".png") and spacing_m is None:
        raise _wrong(file, "spacing_m is missing", "must say how many metres one height is from the next")
    try:
        with open(file, "rb") as opened:
            if not opened.read(1):
                raise _wrong(file, "found an empty file", "must be a height map")
    except OSError as error:
        raise WorkError(f"{file}: cannot be read: {error.strerror}") from None
    try:
        if ending == ".npy":
            heights, spacing = _numpy(file), spacing_m
        elif ending == ".png":
            heights, spacing = _png(file, range_m), spacing_m
        else:
            heights, spacing = _instrument(file)
        assert spacing is not None
        return HeightMap(heights, spacing, fill=fill)
    except SceneError as error:
        if error.file:
            raise
        raise SceneError(f"{file}: {error}", str(file), None, error.key, error.found, error.right) from None


def _wrong(file: Path, found: str, right: str) -> SceneError:
    return SceneError(f"{file}: {found}; {right}", str(file), None, "", found, right)


def _cut(file: Path, error: Exception) -> SceneError:
    what = " ".join(str(error).split())[:160] or type(error).__name__
    return _wrong(file, f"cannot be read as {file.suffix.lower()} ({what})", "is it whole, and of this kind?")


def _numpy(file: Path) -> Any:
    try:
        # Mapped, so that nothing is read before its shape is known.
        array = np.lib.format.open_memmap(file, mode="r")
    except (ValueError, EOFError, OSError) as error:
        raise _cut(file, error) from None
    checked_sides("heights_m", array.shape)
    return array


def _png(file: Path, range_m: Optional[float]) -> Any:
    if range_m is None or not 0 < range_m <= 1:
        found = "range_m is missing" if range_m is None else f"found range_m = {range_m!r}"
        raise _wrong(file, found, "must say how many metres white is above black, up to 1")
    image = needed("PIL.Image", "pillow")
    try:
        # A limit of ours stands in the place of Pillow's warnings.
        with open(file, "rb") as opened, needed("PIL.PngImagePlugin", "pillow").PngImageFile(opened) as picture:
            checked_sides("heights_m", picture.size[::-1])
            if picture.mode not in ("I;16", "I;16B", "I"):
                modes = {"L": "8 bits of grey", "RGB": "colours", "RGBA": "colours and alpha", "P": "a palette", "1": "one bit", "LA": "8 bits of grey and alpha"}
                raise _wrong(file, f"found {modes.get(picture.mode, picture.mode)}", "must have 16 bits of grey: 256 levels are too few for heights")
            codes = np.asarray(picture, dtype=np.float64)
    except SceneError:
        raise
    except (image.UnidentifiedImageError, SyntaxError, OSError, ValueError, EOFError) as error:
        raise _cut(file, error) from None
    return codes * (range_m / 65535)


def _instrument(file: Path) -> tuple[Any, tuple[float, float]]:
    topography = needed("SurfaceTopography", "SurfaceTopography")
    try:
        with topography.open_topography(os.fspath(file)) as reader:
            channel = reader.default_channel
            if channel.dim == 2:
                # Its arrays run along x first, ours from row to row.
                checked_sides("heights_m", tuple(channel.nb_grid_pts[::-1]))
            read_in = reader.topography()
    except SceneError:
        raise
    except Exception as error:  # Its readers raise what the bytes lead them to.
        raise _cut(file, error) from None
    if read_in.dim != 2 or not read_in.is_uniform:
        raise _wrong(file, "found a single line, or heights without a grid", "must be a grid of heights")
    if read_in.unit is None:
        raise _wrong(file, "found no unit of length", "must say in which unit it is: save it as .npy, in metres")
    in_metres = read_in.to_unit("m")
    heights = in_metres.heights()
    spacing = tuple(float(size) / side for size, side in zip(in_metres.physical_sizes, heights.shape))
    return heights.T[::-1], (spacing[0], spacing[1])
