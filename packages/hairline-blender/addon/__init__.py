# SPDX-License-Identifier: GPL-3.0-or-later
"""Hairline in Blender: a render engine for hair-thin scratches that split light into colours."""

from . import engine, operators, panels, properties, scene_files

_MODULES = (properties, operators, panels, scene_files, engine)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
