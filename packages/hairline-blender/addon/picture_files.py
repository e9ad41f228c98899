# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes pictures of numpy arrays: PNG for textures, OpenEXR (uncompressed scan lines of float) for environments."""

import struct
import zlib

import numpy as np


def png(values):
    """A PNG of numbers from 0 to 1, rows from the top: height x width x 3, or x 4 with alpha."""
    codes = np.rint(255 * np.clip(values, 0, 1)).astype(np.uint8)
    height, width, channels = codes.shape
    # Each row begins with the number of its filter: none.
    rows = np.zeros((height, 1 + width * channels), np.uint8)
    rows[:, 1:] = codes.reshape(height, -1)
    head = struct.pack(">IIBBBBB", width, height, 8, 6 if channels == 4 else 2, 0, 0, 0)
    chunks = [(b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes(), 1)), (b"IEND", b"")]
    whole = [struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in chunks]
    return b"\x89PNG\r\n\x1a\n" + b"".join(whole)


def exr(values):
    """An OpenEXR file of linear Rec.709, rows from the top: height x width x 3."""
    height, width, _ = values.shape
    channels = b"".join(name + struct.pack("<xiB3xii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    attributes = [
        (b"channels", b"chlist", channels),
        (b"compression", b"compression", b"\0"),
        (b"dataWindow", b"box2i", window),
        (b"displayWindow", b"box2i", window),
        (b"lineOrder", b"lineOrder", b"\0"),
        (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        (b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0)),
        (b"screenWindowWidth", b"float", struct.pack("<f", 1)),
    ]
    head = struct.pack("<II", 20000630, 2)
    head += b"".join(n + b"\0" + t + b"\0" + struct.pack("<I", len(v)) + v for n, t, v in attributes) + b"\0"
    row_bytes = 12 * width
    first = len(head) + 8 * height
    offsets = first + np.arange(height, dtype="<u8") * (8 + row_bytes)
    rows = np.zeros(height, [("y", "<i4"), ("bytes", "<i4"), ("pixels", "<f4", (3, width))])
    rows["y"], rows["bytes"] = np.arange(height), row_bytes
    rows["pixels"] = np.moveaxis(values[..., ::-1], 2, 1)
    return head + offsets.tobytes() + rows.tobytes()
