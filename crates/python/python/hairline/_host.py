"""How far work has come, and what it says."""

from __future__ import annotations

import logging
import sys
import time
import warnings
from typing import Callable, Union

from . import _hairline as core
from ._errors import argument_error

Progress = Union[bool, Callable[[str, float], object]]

_log = logging.getLogger("hairline")


class Host:
    """Is told by work how it goes: a bar on stderr, a function, or nothing."""

    def __init__(self, progress: Progress) -> None:
        if not isinstance(progress, bool) and not callable(progress):
            raise TypeError(f"progress: found {progress!r}; must be True, False or a function of what is done and its share")
        self._call = progress if callable(progress) else None
        self._bar = progress is True
        self._shown = 0.0
        self._length = 0

    def tell(self, line: str) -> None:
        _log.info(line)

    def warn(self, line: str) -> None:
        warnings.warn(line, RuntimeWarning, stacklevel=4)

    def progress(self, what: str, share: float) -> None:
        if self._call is not None:
            self._call(what, share)
        elif self._bar and time.monotonic() - self._shown > 0.1:
            self._shown = time.monotonic()
            done = int(40 * share)
            self._write(f"{what:<20} [{'=' * done}{' ' * (40 - done)}] {100 * share:3.0f} %")

    def close(self) -> None:
        if self._length:
            self._write("")
            sys.stderr.write("\r")

    def _write(self, line: str) -> None:
        sys.stderr.write("\r" + line.ljust(self._length))
        sys.stderr.flush()
        self._length = len(line)


def set_threads(count: int) -> None:
    """Has all work of this process run on so many threads, before there is any. By itself it runs on all cores, or on ``RAYON_NUM_THREADS``."""
    if isinstance(count, bool) or not hasattr(count, "__index__") or not 1 <= count.__index__() <= 1024:
        raise argument_error("threads", f"found {count!r}", "must be a whole number from 1 to 1024")
    core.set_threads(int(count))
