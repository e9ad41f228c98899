# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture has not of its scene: each line names what it is about."""


class Refused(Exception):
    """The scene cannot be rendered. The text names the object, what was found and what would be right."""


class Notes:
    """Lines that are told once each, in the order in which they were met."""

    def __init__(self):
        self._lines = {}

    def add(self, subject, what, instead):
        """`subject` as artists know it: `light "Key"`; what is not carried over; what the picture has in its place."""
        self._lines[f"{subject}: {what}; {instead}"] = True

    def __iter__(self):
        return iter(self._lines)

    def __len__(self):
        return len(self._lines)


_last = {}


def keep(scene, notes):
    """Keeps the lines of a scene's last picture for its panel."""
    _last[scene.name_full] = list(notes)


def last(scene):
    """Those of the scene's last picture; None before the first one."""
    return _last.get(scene.name_full)
