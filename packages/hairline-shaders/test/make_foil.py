"""Writes foil_mask.png, a ring and stripes, and foil_directions.png, which turns grooves. `python3 make_foil.py`"""

import math

from png_file import png


def mask(u, v):
    """Hard edges and a grey slope; no mirror image of itself."""
    if u > 0.75:
        return (v, v, v)
    on = 1.0 if 0.2 < math.hypot(u - 0.4, v - 0.55) < 0.3 or v < 0.12 and u < 0.5 else 0.0
    return (on, on, on)


def directions(u, v):
    """Unit vectors by up to 40 degrees to either side; the picture repeats."""
    angle = math.radians(40) * math.sin(2 * math.pi * (u + 2 * v))
    return (0.5 + 0.5 * math.cos(angle), 0.5 + 0.5 * math.sin(angle), 0.5)


for name, size, pixel in (("mask", 128, mask), ("directions", 32, directions)):
    with open(f"foil_{name}.png", "wb") as file:
        file.write(png(size, pixel))
