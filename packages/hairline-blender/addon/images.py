# SPDX-License-Identifier: GPL-3.0-or-later
"""The pixels and the files of Blender's images."""

import os

import bpy
import numpy as np


def is_missing(image):
    """Whether Blender has no pixels of it."""
    return image is None or not image.has_data and (image.size[0] == 0 or image.size[1] == 0)


def path_of(image):
    """Path of its file; None for packed, painted and generated images."""
    if image.packed_file or image.is_dirty or image.source != "FILE":
        return None
    path = bpy.path.abspath(image.filepath, library=image.library)
    return path if os.path.isfile(path) else None


def file_bytes(image):
    """Bytes of its PNG or JPEG, from its file or packed in the .blend; None for other images."""
    data = None
    if image.packed_file and not image.is_dirty:
        data = bytes(image.packed_file.data)
    elif (path := path_of(image)) and path.lower().endswith((".png", ".jpg", ".jpeg")):
        with open(path, "rb") as file:
            data = file.read()
    return data if data and data[:4] in (b"\x89PNG", b"\xff\xd8\xff\xe0", b"\xff\xd8\xff\xe1", b"\xff\xd8\xff\xdb") else None


def pixels(image):
    """Stored values, height x width x 4, rows from the top: sRGB codes from 0 to 1 for 8-bit images."""
    width, height = image.size
    values = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)[::-1]


def is_srgb(image):
    return image.colorspace_settings.name == "sRGB"


def is_data(image):
    return image.colorspace_settings.is_data


def is_understood(image):
    """Whether the add-on converts its colour space."""
    linear = ("Linear Rec.709", "Linear", "scene_linear")
    return is_srgb(image) or is_data(image) or image.colorspace_settings.name in linear


def linear(image):
    """Pixels in linear Rec.709; those of data images unchanged."""
    values = pixels(image)
    if is_srgb(image) and not image.is_float:
        values = values.copy()
        values[..., :3] = linear_of_srgb(values[..., :3])
    return values


def linear_of_srgb(codes):
    return np.where(codes <= 0.04045, codes / 12.92, ((np.maximum(codes, 0.04045) + 0.055) / 1.055) ** 2.4)


def srgb_of_linear(values):
    values = np.clip(values, 0, 1)
    return np.where(values <= 0.0031308, 12.92 * values, 1.055 * np.maximum(values, 0.0031308) ** (1 / 2.4) - 0.055)


def resized(values, height, width):
    """Nearest-neighbour resize."""
    rows = (np.arange(height) * values.shape[0]) // height
    columns = (np.arange(width) * values.shape[1]) // width
    return values[rows][:, columns]
