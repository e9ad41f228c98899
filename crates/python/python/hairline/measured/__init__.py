"""Measured surfaces: height maps, the scratches and rows in them, and the light that the heights themselves send.

    from hairline import measured

    plate = measured.read("plate.sur").levelled()
    found = plate.scratches()
    scene.scratches.extend(found.layers("plate"))

The functions need SciPy and scikit-image, and SurfaceTopography for the files of instruments: ``pip install 'hairline-render[measured]'``.
"""

from ._brdf import Brdf
from ._files import read
from ._found import Found, Rows, Scratch
from ._height_map import HeightMap

__all__ = ["Brdf", "Found", "HeightMap", "Rows", "Scratch", "read"]
