"""Writes sky.hdr, a map of an environment that has no symmetry, with a sun and a window: `python3 make_sky.py`."""

from math import cos, exp, pi, sin
from pathlib import Path

WIDTH, HEIGHT = 256, 128
# Parts of the sky are even: runs of equal texels take little room.
COLUMNS, ROWS = 16, 12


def sky(column, row):
    """Radiance of a part of the sky, brighter above and to one side, of other colours on each side."""
    up = cos(pi * (row + 0.5) / ROWS)
    turn = 2.0 * pi * (column + 0.5) / COLUMNS
    side = 0.3 * cos(turn) + 0.12 * sin(2.0 * turn)
    return [exp(0.5 * up + side) * 0.3, exp(0.4 * up + 0.5 * side) * 0.3, exp(0.7 * up - 0.4 * side) * 0.3]


def radiance(x, y):
    longitude, polar = 2.0 * pi * ((x + 0.5) / WIDTH - 0.5), pi * (y + 0.5) / HEIGHT
    toward = [sin(polar) * sin(longitude), cos(polar), -sin(polar) * cos(longitude)]
    sun = [sin(0.8) * sin(1.1), cos(0.8), -sin(0.8) * cos(1.1)]
    if sum(a * b for a, b in zip(toward, sun)) > cos(0.05):
        return [500.0, 440.0, 360.0]
    if abs(longitude + 0.9) < 0.2 and abs(polar - 1.2) < 0.15:
        return [7.0, 8.0, 9.0]
    return sky(x * COLUMNS // WIDTH, y * ROWS // HEIGHT)


def shared_exponent(rgb):
    exponent = 0
    while max(rgb) >= 2.0**exponent:
        exponent += 1
    while max(rgb) < 2.0 ** (exponent - 1):
        exponent -= 1
    return [int(c * 256.0 / 2.0**exponent) for c in rgb] + [exponent + 128]


def runs(values):
    """Run-length code of one channel of a row."""
    code, i = [], 0
    while i < len(values):
        end = i
        while end < len(values) and values[end] == values[i] and end - i < 127:
            end += 1
        code += [128 + end - i, values[i]]
        i = end
    return code


def row(y):
    texels = [shared_exponent(radiance(x, y)) for x in range(WIDTH)]
    return [2, 2, WIDTH // 256, WIDTH % 256] + [byte for c in range(4) for byte in runs([texel[c] for texel in texels])]


head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode()
body = bytes(byte for y in range(HEIGHT) for byte in row(y))
Path(__file__).with_name("sky.hdr").write_bytes(head + body)
