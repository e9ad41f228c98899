"""Writes sheet.glb: a part of a ball with a colour, a metallic-roughness and a normal map. `python3 make_sheet.py`"""

import json
import math
import struct

from png_file import png

COLUMNS, ROWS = 17, 13
RADIUS = 0.15
HALF = (0.04, 0.03)


def wave(x):
    """Repeats with the texture."""
    return math.sin(2 * math.pi * x)


def color(u, v):
    return (0.8 + 0.1 * wave(u), 0.65 + 0.15 * wave(v), 0.6 + 0.2 * wave(u + v))


def metallic_roughness(u, v):
    return (0.0, 0.3 + 0.12 * wave(u + 2 * v), 0.75 + 0.25 * wave(v))


def normal(u, v):
    x, y = 0.025 * wave(2 * u), 0.025 * wave(u - v)
    length = math.sqrt(x * x + y * y + 1)
    return tuple(0.5 + 0.5 * c / length for c in (x, y, 1))


positions, normals, tangents, uvs, indices = [], [], [], [], []
for row in range(ROWS):
    for column in range(COLUMNS):
        u, v = column / (COLUMNS - 1), row / (ROWS - 1)
        x, z = HALF[0] * (2 * u - 1), HALF[1] * (2 * v - 1)
        y = math.sqrt(RADIUS * RADIUS - x * x - z * z)
        positions += [x, y - RADIUS, z]
        normals += [x / RADIUS, y / RADIUS, z / RADIUS]
        side = math.hypot(x, y)
        tangents += [y / side, -x / side, 0.0, 1.0]
        uvs += [u, v]
        if row and column:
            at = row * COLUMNS + column
            corners = (at - COLUMNS - 1, at - 1, at, at - COLUMNS)
            indices += [corners[i] for i in (0, 1, 2, 0, 2, 3)]

blob, views, accessors = b"", [], []


def push(data):
    global blob
    blob += b"\0" * (-len(blob) % 4)
    views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
    blob += data
    return len(views) - 1


def accessor(numbers, width, kind, **more):
    code, size = ("f", 5126) if kind != "SCALAR" else ("H", 5123)
    view = push(struct.pack(f"<{len(numbers)}{code}", *numbers))
    accessors.append({"bufferView": view, "componentType": size, "count": len(numbers) // width, "type": kind, **more})
    return len(accessors) - 1


columns = [positions[i::3] for i in range(3)]
single = [[struct.unpack("f", struct.pack("f", f(c)))[0] for c in columns] for f in (min, max)]
attributes = {
    "POSITION": accessor(positions, 3, "VEC3", min=single[0], max=single[1]),
    "NORMAL": accessor(normals, 3, "VEC3"),
    "TANGENT": accessor(tangents, 4, "VEC4"),
    "TEXCOORD_0": accessor(uvs, 2, "VEC2"),
}
primitive = {"attributes": attributes, "indices": accessor(indices, 1, "SCALAR"), "material": 0}
images = [{"bufferView": push(png(8, of)), "mimeType": "image/png"} for of in (color, metallic_roughness, normal)]
material = {
    "name": "sheet",
    "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}},
    "normalTexture": {"index": 2},
}
root = {
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "sheet", "mesh": 0}],
    "meshes": [{"primitives": [primitive]}],
    "materials": [material],
    "samplers": [{"magFilter": 9729, "minFilter": 9987}],
    "textures": [{"source": i, "sampler": 0} for i in range(3)],
    "images": images,
    "accessors": accessors,
    "bufferViews": views,
    "buffers": [{"byteLength": len(blob)}],
}
text = json.dumps(root, separators=(",", ":")).encode()
text += b" " * (-len(text) % 4)
blob += b"\0" * (-len(blob) % 4)
with open("sheet.glb", "wb") as file:
    file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(blob)))
    file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
    file.write(struct.pack("<II", len(blob), 0x004E4942) + blob)
