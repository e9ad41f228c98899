"""Arrays as the compiled part takes them, or a clear error."""

from __future__ import annotations

from typing import Any, Callable, Sequence, TypeVar, Union

import numpy as np
import numpy.typing as npt

from ._errors import argument_error

Floats = npt.NDArray[np.float64]
T = TypeVar("T")
ArrayLike = Union[npt.ArrayLike, Sequence[Any]]


def _numbers(key: str, values: Any) -> npt.NDArray[Any]:
    try:
        array = np.asarray(values)
    except (ValueError, TypeError) as error:
        what = str(error).split(". ")[0]
        raise argument_error(key, f"found {type(values).__name__} ({what})", "must be an array of numbers") from None
    if array.dtype.kind not in "fiu":
        what = "texts" if array.dtype.kind in "US" else f"values of type {array.dtype}"
        if array.dtype.kind == "O":
            what = f"an object of type {type(values).__module__}.{type(values).__name__}"
        raise argument_error(key, f"found {what}", "must be an array of numbers")
    if np.ma.is_masked(values):
        raise argument_error(key, "found masked values", "must be an array of numbers, all of them known")
    return array


def _shaped(key: str, array: npt.NDArray[Any], shape: tuple[int | None, ...]) -> None:
    fits = array.ndim == len(shape) and all(n in (None, m) for n, m in zip(shape, array.shape))
    if not fits:
        right = " x ".join("n" if n is None else str(n) for n in shape)
        found = " x ".join(map(str, array.shape)) or "a single number"
        raise argument_error(key, f"found an array of shape {found}", f"must be of shape {right}")


def _plain(array: npt.NDArray[Any], kind: Any) -> npt.NDArray[Any]:
    # Bytes of a message between processes may begin at any address.
    return np.require(array, kind, ["C_CONTIGUOUS", "ALIGNED"])


def restored(kind: Callable[..., T], *arrays: npt.NDArray[Any] | None) -> T:
    """What was pickled, of its arrays."""
    return kind(*(None if array is None else _plain(array, array.dtype) for array in arrays))


def floats(key: str, values: Any, *shape: int | None) -> Floats:
    """A contiguous array of float64 of a shape, in which None stands for any length. No copy of what is one already."""
    array = _numbers(key, values)
    _shaped(key, array, shape)
    return _plain(array, np.float64)


def indices(key: str, values: Any, *shape: int | None) -> npt.NDArray[np.uint32]:
    """A contiguous array of uint32."""
    array = _numbers(key, values)
    _shaped(key, array, shape)
    if array.dtype.kind == "f":
        raise argument_error(key, f"found numbers of type {array.dtype}", "must be whole numbers")
    if array.size and (array.min() < 0 or array.max() >= 2**32):
        wrong = array.min() if array.min() < 0 else array.max()
        raise argument_error(key, f"found {wrong}", "must be from 0 to 2^32 - 1")
    return _plain(array, np.uint32)


def per_scratch(key: str, values: Any) -> Floats:
    """One number for each scratch, or one for all."""
    array = _numbers(key, values)
    return floats(key, array.reshape(1) if array.ndim == 0 else array, None)
