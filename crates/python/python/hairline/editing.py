"""What a panel of another program needs: what is known of each number, and what there is to begin with, as the viewer has them.

    from hairline import editing

    editing.controls()["scratches.width_um"].tooltip
    [preset.name for preset in editing.presets("wear")]
    scene.scratches.extend(editing.from_preset("wear", "Worn", "plate", diagonal_m=0.28))
"""

from __future__ import annotations

from typing import NamedTuple, Union

from . import _hairline as core
from ._keys import Grating
from ._tables import Scratches

__all__ = ["Control", "Preset", "controls", "from_preset", "presets"]


class Control(NamedTuple):
    """What is known of a number of a scene."""

    label: str
    """What a panel calls it."""
    unit: str
    """``"m"``, ``"µm"``, ``"nm"``, ``"°"``, ``"1/m"``, ``"1/m²"``, ``"EV"``, ``"px"``, ``"K"`` or ``""``."""
    slider: tuple[float, float]
    """From one end of a slider to the other: what looks good lies within."""
    hard: tuple[float, float]
    """What may be typed."""
    is_logarithmic: bool
    """Whether equal ways of the slider are equal factors."""
    is_whole: bool
    """Whether it has no digits behind the point."""
    tooltip: str
    """What it does to the look."""


class Preset(NamedTuple):
    """Something to begin with."""

    name: str
    tooltip: str
    """What it looks like."""


def controls(diagonal_m: float = 0.3) -> dict[str, Control]:
    """What is known of each number of a scene, by its key: ``"scratches.width_um"``, ``"scratches.width_um.spread"``, ``"grating.radius_m.second"``. Sliders of lengths fit an object whose bounding box has this diagonal."""
    return {name: Control(*control) for name, control in core.controls(diagonal_m).items()}


def presets(kind: str) -> list[Preset]:
    """The presets of a kind, ``"scratches"``, ``"grating"`` or ``"wear"``, in the order of a menu."""
    return [Preset(*preset) for preset in core.presets(kind)]


def from_preset(kind: str, name: str, object: str, diagonal_m: float) -> list[Union[Scratches, Grating]]:
    """The layers or the grating of a preset, for an object whose bounding box has this diagonal."""
    of = Grating if kind == "grating" else Scratches
    return [of._of(table) for table in core.from_preset(kind, name, object, diagonal_m)]
