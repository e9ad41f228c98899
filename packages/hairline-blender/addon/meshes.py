# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangles of an evaluated object, with split normals and UV maps, as arrays."""

from dataclasses import dataclass

import numpy as np

from .notes import Refused


@dataclass
class Triangles:
    """Triangles. Corners at one mesh vertex share a vertex if their normals and UVs are equal."""

    positions_m: np.ndarray
    normals: np.ndarray
    uvs: dict
    """By the name of the UV map, v downwards as in glTF."""
    corners: np.ndarray
    """Three vertices of each triangle."""
    slots: np.ndarray
    """Material slot of each triangle."""
    vertex_of: np.ndarray
    """Mesh vertex of each vertex."""

    @property
    def diagonal_m(self):
        return float(np.linalg.norm(np.ptp(self.positions_m, axis=0)))


def _got(collection, attribute, width, kind=np.float32):
    values = np.empty(len(collection) * width, kind)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, width) if width > 1 else values


def triangles(evaluated, notes):
    """Triangles of an evaluated object; None if it has no surface."""
    mesh = evaluated.to_mesh()
    try:
        if mesh is None or not len(mesh.polygons):
            return None
        return _of_mesh(mesh, f'object "{evaluated.name}"', notes)
    finally:
        evaluated.to_mesh_clear()


def _of_mesh(mesh, subject, notes):
    mesh.calc_loop_triangles()
    positions_m = _got(mesh.vertices, "co", 3)
    _refuse_unusable(positions_m, subject)
    # Attributes are copied in one piece; `mesh.loops` and `mesh.polygons` item by item.
    vertex_of = _got(mesh.attributes[".corner_vert"].data, "value", 1, np.int32)
    normals = _got(mesh.corner_normals, "vector", 3)
    _tell_bent(mesh, normals, vertex_of, subject, notes)
    uvs = {layer.name: _got(layer.uv, "vector", 2) for layer in mesh.uv_layers}
    corners = _got(mesh.loop_triangles, "loops", 3, np.int32)
    material = mesh.attributes.get("material_index")
    of_polygon = _got(material.data, "value", 1, np.int32) if material else np.zeros(len(mesh.polygons), np.int32)
    slots = of_polygon[_got(mesh.loop_triangle_polygons, "value", 1, np.int32)]
    kept, number = _distinct(vertex_of, len(positions_m), [normals, *uvs.values()])
    vertex_of = vertex_of[kept]
    flip = np.array([0, 1], np.float32), np.array([1, -1], np.float32)
    return Triangles(
        positions_m=positions_m[vertex_of],
        normals=_whole(normals[kept]),
        uvs={layer: np.nan_to_num(flip[0] + flip[1] * uv[kept]) for layer, uv in uvs.items()},
        corners=number[corners].astype(np.uint32),
        slots=slots,
        vertex_of=vertex_of,
    )


def _distinct(vertex_of, vertices, values):
    """The corners that become vertices, and the vertex index of each corner. A corner shares the vertex of the last corner at its mesh vertex
    if all values are equal."""
    last = np.zeros(vertices, np.int32)
    every = np.arange(len(vertex_of), dtype=np.int32)
    last[vertex_of] = every
    like = last[vertex_of]
    is_same = np.ones(len(vertex_of), bool)
    for value in values:
        is_same &= (value == value[like]).all(axis=1)
    kept = np.flatnonzero(~is_same | (like == every))
    number = np.zeros(len(vertex_of), np.int32)
    number[kept] = np.arange(len(kept), dtype=np.int32)
    return kept, np.where(is_same, number[like], number)


def _whole(normals):
    """Replaces zero normals, of corners without an area, by +z."""
    is_none = ~(np.abs(normals).sum(axis=1) > 0)
    if is_none.any():
        normals = normals.copy()
        normals[is_none] = (0, 0, 1)
    return normals


# Cosine of the turn of a normal that is seen.
_BENT = np.cos(np.radians(2))


def _tell_bent(mesh, normals, vertex_of, subject, notes):
    """Notes smooth faces that Cycles shades otherwise. Without sharp edges and custom normals it ignores that flat faces end a smooth surface:
    it takes the normals of vertices, which are the means over all faces."""
    flat, sharp = (mesh.attributes.get(name) for name in ("sharp_face", "sharp_edge"))
    if flat is None or mesh.has_custom_normals or sharp is not None and _got(sharp.data, "value", 1, bool).any():
        return
    is_smooth = ~np.repeat(_got(flat.data, "value", 1, bool), _got(mesh.polygons, "loop_total", 1, np.int32))
    if not is_smooth.any() or is_smooth.all():
        return
    of_vertices = _got(mesh.vertex_normals, "vector", 3)[vertex_of[is_smooth]]
    if ((normals[is_smooth] * of_vertices).sum(axis=1) < _BENT).any():
        notes.add(
            subject,
            "Cycles bends the shading of its smooth faces towards the flat ones beside them, where no sharp edge is between",
            "they are shaded as in the viewport: curved up to the edge",
        )


def _refuse_unusable(positions_m, subject):
    unusable = int((~np.isfinite(positions_m).all(axis=1)).sum())
    if unusable:
        raise Refused(
            f'{subject}: found {unusable} of {len(positions_m)} vertices without a finite position; '
            "remove them, or what makes them: a modifier, shape key or driver"
        )
