"""Writes scenes/bumpy.glb, a ball of metal with a normal map that is finer than the pixels of the peers' pictures, and with the same map
scenes/bumpy-suzi.glb from the folder $HAIRLINE_ASSETS, if it is there.
"""

import json, os, struct, tempfile
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


def write(name, positions, normals, tangents, uvs, indices):
    arrays = [positions.astype("<f4"), normals.astype("<f4"), tangents.astype("<f4"), uvs.astype("<f4"), indices.astype("<u4")]
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
    (Path(__file__).parent / f"scenes/{name}.glb").write_bytes(glb)


write("bumpy", normal * RADIUS, normal, tangent, np.stack([u, v], -1), quads)

source = Path(os.environ.get("HAIRLINE_ASSETS", "")) / "suzi.glb"
if source.is_file():
    data = source.read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    gltf = json.loads(data[20:20 + length])
    def accessor(i):
        a = gltf["accessors"][i]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[a["type"]]
        begin = 28 + length + gltf["bufferViews"][a["bufferView"]].get("byteOffset", 0)
        return np.frombuffer(data, {5126: "<f4", 5123: "<u2"}[a["componentType"]], a["count"] * width, begin).reshape(-1, width).astype(float)
    primitive = gltf["meshes"][0]["primitives"][0]
    p, n, uv = [accessor(primitive["attributes"][k]) for k in ("POSITION", "NORMAL", "TEXCOORD_0")]
    faces = accessor(primitive["indices"]).astype(int).reshape(-1, 3)
    # Where u grows.
    e1, e2 = p[faces[:, 1]] - p[faces[:, 0]], p[faces[:, 2]] - p[faces[:, 0]]
    d1, d2 = uv[faces[:, 1]] - uv[faces[:, 0]], uv[faces[:, 2]] - uv[faces[:, 0]]
    area = (d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0])[:, None]
    along_u = (e1 * d2[:, 1:] - e2 * d1[:, 1:]) * np.sign(area)
    sums, flips = np.zeros_like(p), np.zeros(len(p))
    for corner in range(3):
        np.add.at(sums, faces[:, corner], along_u)
        np.add.at(flips, faces[:, corner], area[:, 0])
    t = sums - n * (sums * n).sum(1, keepdims=True)
    t /= np.maximum(np.linalg.norm(t, axis=1, keepdims=True), 1e-12)
    write("bumpy-suzi", p, n, np.concatenate([t, np.where(flips > 0, 1, -1)[:, None]], 1), uv, faces.ravel())
