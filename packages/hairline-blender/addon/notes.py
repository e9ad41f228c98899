# SPDX-License-Identifier: GPL-3.0-or-later
"""Notes about parts of a scene that a picture lacks, and the error for scenes that cannot be rendered."""


class Refused(Exception):
    """The scene cannot be rendered. The text names the object, what was found and what would be right."""


class Notes:
    """Unique lines, in order of insertion."""

    def __init__(self):
        self._lines = {}

    def add(self, subject, what, instead):
        """`subject`: kind and name, `light "Key"`. `what`: the unsupported setting. `instead`: what the picture has in its place."""
        self._lines[f"{subject}: {what}; {instead}"] = True

    def __iter__(self):
        return iter(self._lines)

    def __len__(self):
        return len(self._lines)


_last = {}


def keep(scene, notes):
    """Stores the notes of a scene's last picture for the render panel."""
    _last[scene.name_full] = list(notes)


def last(scene):
    """Notes of the scene's last picture; None before the first one."""
    return _last.get(scene.name_full)
