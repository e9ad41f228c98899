"""Renders the coloured, hair-thin scratches of worn surfaces.

    import hairline

    scene = hairline.load("plate.toml")
    scene.lights.append(hairline.SphereLight(center_m=(0, 0.2, 0.3), radius_m=0.01, radiance=500))
    image = scene.render(size=(640, 360))
    image.save("plate.exr")
"""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any

if sys.platform == "linux":
    # Mesa's drivers look for a Wayland display, and complain on stderr where there is none. With a folder to look in they are quiet. Now, while
    # most programs have one thread: others may read the environment later.
    os.environ.setdefault("XDG_RUNTIME_DIR", "/nonexistent")

from ._bands import Bands
from ._compare import Comparison, compare
from ._errors import Error, InterruptedWarning, SceneError, WorkError
from ._hairline import Image, Labels, __version__, read_image, threads
from ._host import set_threads
from ._keys import (
    DiskLight,
    Environment,
    Grating,
    Ground,
    Light,
    Look,
    Material,
    PolygonLight,
    RectangleLight,
    Settings,
    SphereLight,
    Studio,
    SunLight,
    TubeLight,
)
from ._scene import Gradient, Scene, load
from ._tables import Camera, Object, Scratches

if TYPE_CHECKING:
    from . import bsdf, cluster, editing, inspect, measured, mitsuba, optics

__all__ = [
    "Bands",
    "Camera",
    "Comparison",
    "DiskLight",
    "Environment",
    "Error",
    "Gradient",
    "Grating",
    "Ground",
    "Image",
    "InterruptedWarning",
    "Labels",
    "Light",
    "Look",
    "Material",
    "Object",
    "PolygonLight",
    "RectangleLight",
    "Scene",
    "SceneError",
    "Scratches",
    "Settings",
    "SphereLight",
    "Studio",
    "SunLight",
    "TubeLight",
    "WorkError",
    "__version__",
    "bsdf",
    "cluster",
    "compare",
    "editing",
    "inspect",
    "load",
    "measured",
    "mitsuba",
    "optics",
    "read_image",
    "set_threads",
    "threads",
]


def __getattr__(name: str) -> Any:
    # Imported at the first use: the cluster needs a package that may be absent.
    if name in ("bsdf", "cluster", "editing", "inspect", "measured", "mitsuba", "optics"):
        import importlib

        return importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
