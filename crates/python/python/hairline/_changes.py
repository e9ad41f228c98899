"""Changes of a scene's table, by the way to a key."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from ._errors import argument_error

Change = Mapping[str, Any]
"""Values by the way to their keys: ``{"camera.position_m": (0, 0, 1), "light[0].radiance": 3}``."""

_STEP = re.compile(r"([a-z_0-9]+)((?:\[\d+\])*)$")


def _steps(way: str) -> list[Any]:
    """The names and numbers that a way consists of."""
    steps: list[Any] = []
    for part in way.split("."):
        match = _STEP.match(part)
        if match is None:
            raise argument_error(way, "found no way to a key", 'write it as in "light[0].radiance"')
        steps += [match[1], *map(int, re.findall(r"\d+", match[2]))]
    return steps


def _has(at: Any, step: Any) -> bool:
    if isinstance(at, Mapping):
        return step in at
    return isinstance(at, (list, tuple)) and isinstance(step, int) and step < len(at)


def changed(table: Mapping[str, Any], change: Change) -> dict[str, Any]:
    """A scene's table with other values. What is not on the way to them is shared."""
    result: dict[str, Any] = dict(table)
    for way, value in change.items():
        missing = argument_error(way, "found no such key in the scene", "must be there before it can be changed")
        at: Any = result
        steps = _steps(way)
        for step, after in zip(steps, steps[1:]):
            if not _has(at, step):
                raise missing
            below = at[step]
            if not isinstance(below, dict if isinstance(after, str) else (list, tuple)):
                raise missing
            at[step] = below = dict(below) if isinstance(below, dict) else list(below)
            at = below
        if isinstance(steps[-1], int) and not _has(at, steps[-1]):
            raise missing
        at[steps[-1]] = value
    return result


def found(table: Mapping[str, Any], way: str) -> Any:
    """The value that a way leads to."""
    at: Any = table
    for step in _steps(way):
        if not _has(at, step):
            raise argument_error(way, "found no such key in the scene", "must be there")
        at = at[step]
    return at
