# SPDX-License-Identifier: GPL-3.0-or-later
"""Matrices of Blender as the keys of scene files."""

import math

from mathutils import Matrix, Vector


def tidy(values):
    """Rounds single-precision numbers to seven digits: 4.2 instead of 4.199999809."""
    if isinstance(values, (int, str, bool)):
        return values
    if isinstance(values, float):
        return float(f"{values:.7g}")
    return [tidy(value) for value in values]


def placing(matrix):
    """`translation_m`, `rotation_deg` and `scale` of a matrix; None if it shears."""
    translation, rotation, scale = matrix.decompose()
    again = Matrix.LocRotScale(translation, rotation, scale)
    size = max(max(abs(x) for x in row[:3]) for row in matrix) or 1.0
    if any(abs(a - b) > 1e-5 * size for row, other in zip(again, matrix) for a, b in zip(row[:3], other[:3])):
        return None
    turn = rotation.to_euler("XYZ")
    return {
        "translation_m": tidy(list(translation)),
        "rotation_deg": [float(f"{math.degrees(angle):.9g}") for angle in turn],
        "scale": tidy(list(scale)),
    }


def unit_axes(matrix):
    """Position and unit x, y and z axes of a camera or light; its scale is ignored."""
    turned = matrix.to_quaternion()
    return matrix.translation.copy(), *(turned @ Vector(axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
