# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasterises the weights of a vertex group in a UV map."""

import numpy as np

_SIZE_PX = 1024


def picture(evaluated, group, surface, uv_map):
    """Weights as a square grey picture, height x width x 3."""
    weights = _weights(evaluated, group, surface)
    uvs = surface.uvs[uv_map][surface.corners] * _SIZE_PX
    of_corner = weights[surface.corners]
    extent = np.ptp(uvs, axis=1).max(axis=1)
    sums, counts = np.zeros(_SIZE_PX**2), np.zeros(_SIZE_PX**2)
    # Triangles of similar size are sampled together, at points less than a pixel apart.
    steps = 2 ** np.ceil(np.log2(np.clip(1.5 * extent, 1, 2 * _SIZE_PX))).astype(int)
    for step in np.unique(steps):
        chosen = np.flatnonzero(steps == step)
        a, b = np.meshgrid(np.arange(step + 1) / step, np.arange(step + 1) / step)
        shares = np.stack([a, b, 1 - a - b], axis=-1)[a + b <= 1 + 1e-9]
        # Bounds the memory: a few million points at once.
        for part in np.array_split(chosen, max(1, len(chosen) * len(shares) // 4_000_000)):
            at = np.floor(np.einsum("sk,tkc->tsc", shares, uvs[part])).astype(int) % _SIZE_PX
            place = (at[..., 1] * _SIZE_PX + at[..., 0]).ravel()
            value = np.einsum("sk,tk->ts", shares, of_corner[part]).ravel()
            sums += np.bincount(place, value, _SIZE_PX**2)
            counts += np.bincount(place, minlength=_SIZE_PX**2)
    grey = (sums / np.maximum(counts, 1)).reshape(_SIZE_PX, _SIZE_PX)
    grey = _bordered(grey, counts.reshape(grey.shape) > 0)
    return np.repeat(grey[..., None], 3, axis=2)


def _weights(evaluated, group, surface):
    mesh = evaluated.to_mesh()
    try:
        of_vertex = np.zeros(len(mesh.vertices), np.float32)
        for vertex in mesh.vertices:
            for element in vertex.groups:
                if element.group == group.index:
                    of_vertex[vertex.index] = element.weight
    finally:
        evaluated.to_mesh_clear()
    return of_vertex[surface.vertex_of]


def _bordered(grey, is_known, rings=3):
    """Extends UV islands by some pixels for texture filters."""
    for _ in range(rings):
        grown, known = grey.copy(), is_known.copy()
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            other, is_other = np.roll(grey, step, axis), np.roll(is_known, step, axis)
            fresh = ~known & is_other
            grown[fresh] = other[fresh]
            known |= fresh
        grey, is_known = grown, known
    return grey
