# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes binary glTF files (Khronos, glTF 2.0): arrays and images into one buffer, the rest as JSON."""

import json
import struct

_FLOAT, _UNSIGNED = 5126, 5125
_KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Glb:
    """A glTF file under construction. Callers add nodes, meshes and materials to `json`."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0", "generator": "hairline"}, "scene": 0, "scenes": [{"nodes": []}]}
        self._parts = []
        self._length = 0

    def add(self, kind, value):
        """Appends to a list of the JSON part and returns the index."""
        values = self.json.setdefault(kind, [])
        values.append(value)
        return len(values) - 1

    def _view(self, data):
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": self._length, "byteLength": len(data)})
        padding = -len(data) % 4
        self._parts += [data, b"\0" * padding]
        self._length += len(data) + padding
        return view

    def array(self, values, with_bounds=False):
        """Adds an array of float32 or uint32 and returns the index of its accessor."""
        components = values.shape[1] if values.ndim == 2 else 1
        accessor = {
            "bufferView": self._view(values.tobytes()),
            "componentType": _FLOAT if values.dtype == "float32" else _UNSIGNED,
            "count": len(values),
            "type": _KINDS[components],
        }
        if with_bounds:
            accessor["min"], accessor["max"] = values.min(axis=0).tolist(), values.max(axis=0).tolist()
        return self.add("accessors", accessor)

    def texture(self, data, repeats):
        """Adds a PNG or JPEG and returns the index of its texture."""
        kind = "image/jpeg" if data[:2] == b"\xff\xd8" else "image/png"
        image = self.add("images", {"bufferView": self._view(data), "mimeType": kind})
        wrap = 10497 if repeats else 33071
        sampler = self.add("samplers", {"wrapS": wrap, "wrapT": wrap})
        return self.add("textures", {"source": image, "sampler": sampler})

    def parts(self):
        """The bytes of the file, in pieces."""
        self.json["buffers"] = [{"byteLength": self._length}]
        text = json.dumps(self.json, allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + self._length)
        return [head, struct.pack("<I4s", len(text), b"JSON") + text, struct.pack("<I4s", self._length, b"BIN\0"), *self._parts]
