# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders an exported scene by the package `hairline` and converts its layers to passes of Blender."""

import logging
import re
import warnings

import hairline
import numpy as np

from .notes import Refused

# Blender's depth where there is no surface.
FAR_M = 1e10


class Stopped(Exception):
    """The artist pressed Esc, or the view changed."""


def scene_of(exported, folder):
    """The scene as an object of the package. Errors name objects of Blender."""
    try:
        return hairline.Scene.from_dict(exported.table, folder.path)
    except hairline.SceneError as error:
        raise Refused(in_words(error, exported.table)) from error


_KINDS = {"object": "object", "light": "light", "scratches": "the layer", "grating": "the grating", "material": "material"}


def in_words(error, table):
    """A message of the package with names in place of indices: `object[3]` becomes `object "Cube"`."""

    def name(match):
        entry = table.get(match[1], [])[int(match[2])]
        words = f'{_KINDS[match[1]]} "{entry.get("name", match[2])}"'
        words = f'{words} of object "{entry["object"]}"' if "object" in entry else words
        return f"{words}: {match[3]}" if match[3] else words

    return re.sub(r"\b(object|light|scratches|grating|material)\[(\d+)\]\.?(\w*)", name, str(error))


class _Lines(logging.Handler):
    """Forwards log lines of the package."""

    def __init__(self, tell):
        super().__init__(logging.INFO)
        self._tell = tell

    def emit(self, record):
        self._tell(record.getMessage())


def render(scene, table, settings, is_transparent, progress, is_stopped, tell, size_px=None):
    """Renders the picture. `progress` takes the stage and its share; `is_stopped` ends the work with `Stopped`; `tell` takes log lines."""

    def host(what, share):
        if is_stopped():
            raise KeyboardInterrupt
        progress(what, share)

    log = logging.getLogger("hairline")
    lines = _Lines(tell)
    log.addHandler(lines)
    level = log.level
    log.setLevel(logging.INFO)
    try:
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            built = scene.build(size=size_px, progress=host)
            _announce(built, tell)
            picture = scene.render(
                size=size_px,
                backend=settings.backend,
                samples=settings.samples,
                shadows=settings.shadows,
                bounces=settings.bounces if settings.shadows else None,
                transparent=is_transparent,
                progress=host,
            )
        for warning in warned:
            if not issubclass(warning.category, hairline.InterruptedWarning):
                tell(str(warning.message))
    except KeyboardInterrupt:
        raise Stopped from None
    except hairline.SceneError as error:
        raise Refused(in_words(error, table)) from error
    except hairline.WorkError as error:
        raise Refused(str(error)) from error
    finally:
        log.removeHandler(lines)
        log.setLevel(level)
    return picture


def _announce(built, tell):
    needed, available = built.memory_bytes()
    free = f", {available / 1e9:.1f} GB are free" if available else ""
    tell(f"{sum(built.scratch_counts()):,} scratches; about {needed / 1e9:.2f} GB of memory{free}")


# Passes by name: number of channels, channel names, type, and the layer of the picture.
AOVS = {
    "Hairline Base": (3, "RGB", "COLOR", lambda picture: picture.base),
    "Hairline Scratches": (3, "RGB", "COLOR", lambda picture: picture.scratches),
    "Hairline Density": (3, "RGB", "COLOR", lambda picture: picture.density),
}


def pixels(picture, name, size_px):
    """A pass in Blender's layout: one row of the array per pixel, from the bottom. Coarse pictures are enlarged to `size_px`."""
    if name == "Combined":
        alpha = picture.alpha if picture.alpha is not None else np.ones(picture.beauty.shape[:2], np.float32)
        values = np.dstack([picture.beauty, alpha])
    elif name == "Depth":
        values = np.where(picture.depth_m > 0, picture.depth_m, FAR_M)[..., None]
    elif name == "Normal":
        values = picture.normal
    else:
        values = AOVS[name][3](picture)
    height, width = values.shape[:2]
    if (width, height) != tuple(size_px):
        rows = np.arange(size_px[1]) * height // size_px[1]
        columns = np.arange(size_px[0]) * width // size_px[0]
        values = values[rows][:, columns]
    return np.ascontiguousarray(values[::-1].reshape(size_px[0] * size_px[1], -1), np.float32)
