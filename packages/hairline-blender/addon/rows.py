# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of the numbers of layers and gratings. Properties, panels, import and export are built from it.

Labels, units, ranges and tooltips are those of Hairline's viewer (`hairline.editing`), defaults and the keys of each pattern those of scene files
(`hairline.Scratches`, `hairline.Grating`).
"""

from dataclasses import dataclass
from functools import lru_cache

import hairline
from bpy.props import FloatProperty, FloatVectorProperty, IntProperty
from hairline import editing

from .frames import tidy

# Sliders of lengths fit objects of this diagonal.
_DIAGONAL_M = 1.0
_CONTROLS = editing.controls(_DIAGONAL_M)
_LARGEST_INT = 2**31 - 1


def tag(group, _context=None):
    """Marks the owner as changed: the dependency graph does not watch properties of add-ons."""
    group.id_data.update_tag()


@dataclass(frozen=True)
class Row:
    """A property: its name in Blender, its keys in a table of a scene file, and that table."""

    attribute: str
    way: tuple
    section: str
    size: int = 1

    @property
    def control(self):
        """Name of the control with its range and tooltip."""
        ends = {"mean": [], "where": [], 0: [], 1: ["second"]}
        return ".".join([self.section, *(name for part in self.way for name in ends.get(part, [part]))])

    @property
    def key(self):
        return self.way[0]

    def read(self, table):
        """Value in a table; None if absent."""
        value = table.get(self.key)
        if value is None or len(self.way) == 1:
            return value
        part = self.way[1]
        if self.key != "where" and isinstance(part, str) and not isinstance(value, dict):
            # A plain number is a mean without a spread.
            value = {"mean": value, "spread": 0.0}
        return value.get(part) if isinstance(value, dict) else value[part]

    def write(self, group, table):
        """Puts the group's value into a table."""
        value = getattr(group, self.attribute)
        value = tidy(value if self.size == 1 else list(value))
        if len(self.way) == 1:
            table[self.key] = value
        else:
            table.setdefault(self.key, [0.0, 0.0] if isinstance(self.way[1], int) else {})[self.way[1]] = value

    def definition(self, default):
        """The property definition for Blender."""
        control = _CONTROLS[self.control]
        unit = f" ({control.unit})" if control.unit else ""
        (low, high), (least, most) = control.slider, control.hard
        settings = {
            "name": control.label + unit,
            "description": control.tooltip,
            "min": least,
            "max": most,
            "soft_min": low,
            "soft_max": high,
            "override": {"LIBRARY_OVERRIDABLE"},
            "update": tag,
        }
        if control.is_whole:
            for key in ("min", "max", "soft_min", "soft_max"):
                settings[key] = int(min(max(settings[key], 0), _LARGEST_INT))
            return IntProperty(default=int(default), **settings)
        settings["precision"] = 4 if control.unit == "m" else 2
        settings["step"] = 100 if high - low > 20 else 10 if high - low > 2 else 1
        if self.size > 1:
            return FloatVectorProperty(default=default, size=self.size, **settings)
        return FloatProperty(default=float(default), **settings)


def _sizes(section, key):
    spread = key.rsplit("_", 1)[0].split("_per")[0] + "_spread"
    return Row(key, (key, "mean"), section), Row(spread, (key, "spread"), section)


def _axes(section):
    return tuple(Row(key, (key,), section, 3) for key in ("direction", "axis", "center_m"))


def _rows(section, *keys):
    return tuple(Row(key, (key,), section) for key in keys)


SCRATCHES = (
    *_rows("scratches", "count", "density_per_m2"),
    *_sizes("scratches", "width_um"),
    *_sizes("scratches", "depth_nm"),
    *_sizes("scratches", "length_m"),
    *_rows("scratches", "jitter_deg"),
    *_sizes("scratches", "curvature_per_m"),
    *_axes("scratches"),
    *_rows("scratches", "seed"),
)

PLACE = tuple(Row(key, ("where", key), "where") for key in ("edges", "edge_width_m", "tile_m"))

STROKES = (
    Row("brush_radius_m", ("radius_m",), "strokes"),
    Row("brush_density_per_m", ("density_per_m",), "strokes"),
)

GRATING = (
    *_rows("grating", "pitch_um", "width_um"),
    *_sizes("grating", "depth_nm"),
    *_rows("grating", "jitter_um", "jitter_deg", "curvature_per_m", "spacing_m"),
    *_axes("grating"),
    *_rows("grating", "coverage", "seed"),
)

RING = (
    Row("inner_radius_m", ("radius_m", 0), "grating"),
    Row("outer_radius_m", ("radius_m", 1), "grating"),
)

# Defaults of rows for which scene files have none.
_OTHER_DEFAULTS = {
    "count": 5000,
    "density_per_m2": 1e4,
    "edges": 0.0,
    "edge_width_m": 0.02,
    "tile_m": 0.1,
    "brush_radius_m": 0.02,
    "brush_density_per_m": 2000.0,
    "inner_radius_m": 0.0,
    "outer_radius_m": 1.0,
}

PATTERNS = {
    "random": "Every place and every direction: daily wear",
    "parallel": "All along one direction: a brushed panel",
    "circular": "Rings and arcs around an axis: a turned pan",
    "radial": "Straight away from an axis: the sunburst of a watch dial",
    "spun": "Equal arcs that sweep from the axis to the rim",
    "swirl": "Arcs around many centres: the cobweb on a polished car",
    "drawn": "Along curves or strokes of a grease pencil",
}
PROFILES = {
    "rectangle": "A flat floor, which shows the purest colours",
    "v": "Two straight flanks, of a sharp point",
    "round": "Of a grain or a stylus",
    "shoulders": "Round with ridges beside it, which a blunt point pushes up in soft metal",
}
GRATING_PATTERNS = {
    "parallel": PATTERNS["parallel"],
    "circular": PATTERNS["circular"],
    "radial": PATTERNS["radial"],
    "spun": PATTERNS["spun"],
    "swirl": "Spots of circles in rows: engine turning",
    "uv": "Along the texture coordinates of the surface",
}


@lru_cache(maxsize=None)
def _defaults(kind, pattern):
    if kind == "grating":
        return hairline.Grating(object="object", pattern=pattern, pitch_um=1.6).to_dict()
    amount = {"strokes": [_DAB]} if pattern == "drawn" else {"count": 1}
    return hairline.Scratches(object="object", pattern=pattern, **amount).to_dict()


_DAB = {"points_m": [[0.0, 0.0, 0.0]], "radius_m": 0.01, "density_per_m": 1.0}


def rows_of(kind, pattern):
    """Rows of a pattern."""
    table = _defaults(kind, pattern)
    rows = GRATING if kind == "grating" else SCRATCHES
    amounts = ("count", "density_per_m2") if pattern != "drawn" else ()
    return [row for row in rows if row.key in table and row.key != "count" or row.key in amounts]


def default_of(kind, row):
    """Default of a row's property."""
    if row.attribute in _OTHER_DEFAULTS:
        return _OTHER_DEFAULTS[row.attribute]
    for pattern in GRATING_PATTERNS if kind == "grating" else PATTERNS:
        value = row.read(_defaults(kind, pattern))
        if value is not None:
            return value
    raise KeyError(f"no pattern of {kind} has {row.way}")
