"""Writes scenes/bumpy.glb: a ball of metal with a normal map that is finer than the pixels of the peers' pictures."""

import json, struct, tempfile
from pathlib import Path

import numpy as np
import mitsuba as mi

mi.set_variant("scalar_rgb")
ROWS, COLUMNS, RADIUS, SIZE = 64, 128, 0.05, 512
v, u = np.meshgrid(np.linspace(0, 1, ROWS + 1), np.linspace(0, 1, COLUMNS + 1), indexing="ij")
polar, longitude = v * np.pi, u * 2 * np.pi
normal = np.stack([np.sin(polar) * np.cos(longitude), np.sin(polar) * np.sin(longitude), np.cos(polar)], -1)
tangent = np.stack([-np.sin(longitude), np.cos(longitude), 0 * u, -np.ones_like(u)], -1)
i = (np.arange(ROWS)[:, None] * (COLUMNS + 1) + np.arange(COLUMNS)).ravel()
quads = np.stack([i, i + COLUMNS + 1, i + COLUMNS + 2, i, i + COLUMNS + 2, i + 1], -1).ravel()
# Waves of 8 to 60 periods, a slope of 0.15 rms in each direction.
random = np.random.default_rng(1)
x, y = np.meshgrid((np.arange(SIZE) + 0.5) / SIZE, (np.arange(SIZE) + 0.5) / SIZE)
slopes = np.zeros((2, SIZE, SIZE))
for _ in range(60):
    k = random.integers(-60, 61, 2)
    wave = np.cos(2 * np.pi * (k[0] * x + k[1] * y + random.random())) / np.linalg.norm(k + 1e-3)
    slopes += wave * k[:, None, None]
slopes *= 0.15 / slopes.std()
n = np.stack([-slopes[0], -slopes[1], np.ones_like(x)], -1)
n /= np.linalg.norm(n, axis=-1, keepdims=True)
with tempfile.NamedTemporaryFile(suffix=".png") as f:
    mi.Bitmap(np.round((n * 0.5 + 0.5) * 255).astype(np.uint8)).write(f.name)
    png = Path(f.name).read_bytes()
arrays = [(normal * RADIUS).astype("<f4"), normal.astype("<f4"), tangent.astype("<f4"), np.stack([u, v], -1).astype("<f4"), quads.astype("<u4")]
views, accessors, binary = [], [], b""
for a, kind in zip(arrays, ["VEC3", "VEC3", "VEC4", "VEC2", "SCALAR"]):
    flat = a.reshape(-1, a.shape[-1]) if kind != "SCALAR" else a.reshape(-1, 1)
    views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": a.nbytes})
    accessors.append({"bufferView": len(views) - 1, "componentType": 5125 if kind == "SCALAR" else 5126, "count": len(flat), "type": kind,
                      "min": flat.min(0).tolist(), "max": flat.max(0).tolist()})
    binary += a.tobytes()
views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(png)})
binary += png + b"\0" * (-len(png) % 4)
gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2, "TEXCOORD_0": 3}, "indices": 4, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.9, 0.9, 1], "metallicFactor": 1, "roughnessFactor": 0.2},
                       "normalTexture": {"index": 0}}],
        "textures": [{"source": 0}], "images": [{"mimeType": "image/png", "bufferView": len(views) - 1}],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
text = json.dumps(gltf).encode(); text += b" " * (-len(text) % 4)
glb = struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(binary)) + struct.pack("<II", len(text), 0x4E4F534A) + text
glb += struct.pack("<II", len(binary), 0x004E4942) + binary
(Path(__file__).parent / "scenes/bumpy.glb").write_bytes(glb)
